// SPDX-License-Identifier: Apache-2.0
#include "radiosity/near_lamps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "radiosity/bodies/wall_traces.h"
#include "radiosity/patches/cluster_members.h"
#include "radiosity/patches/split.h"
#include "scenes/light/lamp_light.h"
#include "scenes/light/narrow_beams.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {
namespace {

// Limit of patches: twice the number without lamps plus this; more cost more than they gain.
constexpr std::size_t most_more = 4096;
// Length of a patch over its distance from the lamp: illuminance varies as 1 / d^2, and
// interpolation between patch centres has an error of about the square of this. On the payload bay
// by night, with lamps 25 mm off their housings, 1/4 instead of 1 makes 7 % more patches and leaves
// a fifth of the mean squared residual.
constexpr double most_length = 0.25;

double half_size(const scenes::Lamp& lamp) {
  const double edges = std::min(glm::length(lamp.edge_u), glm::length(lamp.edge_v));
  return std::max(lamp.radius_m, 0.5 * edges);
}

// Nearest point of the lamp's surface, or its position.
Vec3 nearest_on_lamp(const scenes::Lamp& lamp, const Vec3& point) {
  const Vec3 from_centre = point - lamp.position;
  if (lamp.kind == scenes::LampKind::Rectangle) {
    const Vec3 corner = lamp.position - 0.5 * (lamp.edge_u + lamp.edge_v);
    const Vec3 far = corner + lamp.edge_u + lamp.edge_v;
    const Vec3 first = scenes::nearest_on_triangle(point, corner, corner + lamp.edge_u, far);
    const Vec3 second = scenes::nearest_on_triangle(point, corner, far, corner + lamp.edge_v);
    return glm::length(first - point) < glm::length(second - point) ? first : second;
  }
  if (lamp.kind != scenes::LampKind::Disk) return lamp.position;
  const Vec3 in_plane = from_centre - glm::dot(from_centre, lamp.axis) * lamp.axis;
  const double r = glm::length(in_plane);
  return lamp.position + in_plane * (r > lamp.radius_m ? lamp.radius_m / r : 1.0);
}

double radius(const scenes::Lamp& lamp) {
  return scenes::is_wide(lamp.kind) ? scenes::row_of(lamp.kind).radius(lamp) : 0.0;
}

constexpr double angle_rounding = 1e-6;         // of small angles computed from cosines, rad
constexpr double most_beam_share = 1.0 / 32.0;  // of a beam's flux, on one patch

// Share of the beam's flux on the patch, without occlusion.
double share_on(const scenes::Beam& beam, const std::array<Vec3, 4>& corner, const Vec3& normal) {
  const double height = glm::dot(beam.origin - corner[0], normal);
  if (height <= 0.0) return 0.0;
  const Vec3 middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]) - beam.origin;
  double radius = 0.0;
  for (const Vec3& c : corner) radius = std::max(radius, glm::length(c - beam.origin - middle));
  const double distance = glm::length(middle);
  if (distance > radius) {
    const double off = std::acos(std::clamp(glm::dot(middle, beam.axis) / distance, -1.0, 1.0));
    if (off > beam.half_angle_rad + std::asin(radius / distance) + angle_rounding) return 0.0;
  }
  double share = 0.0;
  for (const scenes::Beam::Ray& ray : beam.rays) {
    const double sink = -glm::dot(ray.direction, normal);
    if (sink <= 0.0) continue;
    const Vec3 at = beam.origin + height / sink * ray.direction;
    bool inside = true;
    for (std::size_t k = 0; k < 4 && inside; ++k) {
      const Vec3 edge = corner[(k + 1) % 4] - corner[k];
      inside = glm::dot(glm::cross(normal, edge), at - corner[k]) >= 0.0;
    }
    if (inside) share += ray.share;
  }
  return share;
}

class LampCuts {
 public:
  explicit LampCuts(const scenes::Scene& scene) {
    for (scenes::Lamp lamp : scene.lamps) {
      if (lamp.is_distant() || !base::is_lit(lamp.strength())) continue;
      lamp.intensity_cd = lamp.exitance = Rgb(1.0);
      lamps_.push_back(lamp);
    }
    beams_ = scenes::narrow_beams(lamps_);
  }

  [[nodiscard]] Cut cut(const Patches& patches, std::uint32_t patch) const {
    const CellSize size = cell_size(patches, patch);
    const double longest = std::max(size.s_m, size.t_m);
    if (lamps_.empty()) return Cut::None;
    const double enough = longest / most_length;
    if (enough <= allowed(patches, patch, enough) && !holds_much_of_a_beam(patches, patch))
      return Cut::None;
    const Cut along = size.s_m >= size.t_m ? Cut::S : Cut::T;
    return can_cut(patches, patch, along) ? along : Cut::None;
  }

 private:
  [[nodiscard]] bool holds_much_of_a_beam(const Patches& patches, std::uint32_t patch) const {
    if (beams_.empty() || patches.is_several(patch)) return false;
    const auto corner = patches.corners(patch);
    const Vec3 normal = patches.normal(patch);
    return std::any_of(beams_.begin(), beams_.end(), [&](const scenes::Beam& beam) {
      return share_on(beam, corner, normal) > most_beam_share;
    });
  }

  // Allowed length of the patch; exact only if below `enough`.
  [[nodiscard]] double allowed(const Patches& patches, std::uint32_t patch, double enough) const {
    const bool several = patches.is_several(patch);
    const auto corner = several ? std::array<Vec3, 4>{} : patches.corners(patch);
    const Vec3 normal = several ? Vec3(0.0) : patches.normal(patch);
    const Vec3 middle = patches.point(patch, 0.5, 0.5);
    double least = std::numeric_limits<double>::infinity();
    for (const scenes::Lamp& lamp : lamps_) {
      // All points of the patch are within this distance of its middle.
      if (glm::length(middle - lamp.position) > 3.0 * enough + radius(lamp)) continue;
      if (!several && glm::dot(lamp.position - middle, normal) <= 0.0) continue;
      const Near near = several ? near_of_several(lamp, patches, patch) : near_of(lamp, corner);
      const double scale = std::max(near.distance_m, half_size(lamp));
      if (scale >= std::min(least, enough)) continue;
      if (shines_at(lamp, near.point) || shines_at(lamp, middle)) least = scale;
    }
    return least;
  }

  struct Near {
    Vec3 point{0.0};
    double distance_m = std::numeric_limits<double>::infinity();
  };
  // Alternating projections converge, because both are convex.
  static Near near_of(const scenes::Lamp& lamp, const std::array<Vec3, 4>& corner) {
    Near near;
    Vec3 from = lamp.position;
    for (int k = 0; k < (scenes::is_wide(lamp.kind) ? 4 : 1); ++k) {
      const auto nearest = [&](std::size_t b, std::size_t c) {
        return scenes::nearest_on_triangle(from, corner[0], corner[b], corner[c]);
      };
      const Vec3 first = nearest(1, 2), second = nearest(2, 3);
      const double to_first = glm::length(first - from);
      const double to_second = glm::length(second - from);
      near = {to_first < to_second ? first : second, std::min(to_first, to_second)};
      from = nearest_on_lamp(lamp, near.point);
    }
    return near;
  }
  // For a patch of several triangles that face the lamp.
  static Near near_of_several(const scenes::Lamp& lamp, const Patches& patches,
                              std::uint32_t patch) {
    const ClusterMembers& members = *patches.clustered;
    const ClusterSpan span = span_of(patches.facets[patches.facet[patch]], patches.cell[patch]);
    const double side = patches.is_back[patch] != 0 ? -1.0 : 1.0;
    Near near;
    for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
      const auto& [a, b, c] = members.corner[m];
      const Vec3 &pa = members.vertices[a], &pb = members.vertices[b], &pc = members.vertices[c];
      if (side * glm::dot(lamp.position - pa, glm::cross(pb - pa, pc - pa)) <= 0.0) continue;
      const Vec3 point = scenes::nearest_on_triangle(lamp.position, pa, pb, pc);
      const double distance_m = glm::length(point - lamp.position);
      if (distance_m < near.distance_m) near = {point, distance_m};
    }
    return near;
  }

  static bool shines_at(const scenes::Lamp& lamp, const Vec3& point) {
    if (point == lamp.position) return false;
    const scenes::LightSample light = scenes::sample_lamp(lamp, point, 0.5, 0.5);
    return base::max_component(light.normal_illuminance_lx) > 0.0;
  }

  std::vector<scenes::Lamp> lamps_;  // of unit strength
  std::vector<scenes::Beam> beams_;
};

}  // namespace

Patches subdivide_near_lamps(const scenes::Scene& scene, double edge_m) {
  Patches patches = subdivide(scene, edge_m, edge_m);
  Traces walls = find_wall_traces(scene, patches);
  patches = part_along(std::move(patches), std::move(walls));
  const LampCuts cuts(scene);
  const std::size_t most = 2 * patches.count() + most_more;
  std::vector<char> is_new(patches.count(), 1);
  while (patches.count() < most) {
    std::vector<Cut> wanted(patches.count(), Cut::None);
    base::parallel_chunks(patches.count(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (is_new[i] != 0) wanted[i] = cuts.cut(patches, static_cast<std::uint32_t>(i));
      }
    });
    if (std::all_of(wanted.begin(), wanted.end(), [](Cut cut) { return cut == Cut::None; })) {
      return patches;
    }
    grade(patches, wanted);
    Split made = split(patches, wanted);
    if (made.patches.count() == patches.count()) return patches;
    is_new.resize(made.parent.size());
    for (std::size_t i = 0; i < is_new.size(); ++i) {
      const Cell &now = made.patches.cell[i], &before = patches.cell[made.parent[i]];
      is_new[i] = now.s_cuts != before.s_cuts || now.t_cuts != before.t_cuts ? 1 : 0;
    }
    patches = std::move(made.patches);
  }
  return patches;
}

std::size_t count_near_lamps(const scenes::Scene& scene, double edge_m) {
  constexpr std::size_t most = 1'000'000;
  const std::size_t least = count_patches(scene, edge_m);
  return least > most ? least : subdivide_near_lamps(scene, edge_m).count();
}

}  // namespace earthshine::radiosity
