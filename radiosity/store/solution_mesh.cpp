// SPDX-License-Identifier: Apache-2.0
#include "radiosity/store/solution_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "radiosity/patches/cluster_members.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {
namespace {

constexpr double middle_grey = 0.18;
constexpr double least_lit = 1e-5;        // of the brightest patch
constexpr double clipped_at_most = 0.05;  // of the area
constexpr double smooth_cosine = 0.766;
constexpr double same_place = 1e7;  // grid steps over the scene's extent
// If more patches meet, such as at the pole of a finely divided sphere, comparing all pairs would
// take long; each then keeps its own colour.
constexpr std::size_t most_meeting = 256;

std::vector<Rgb> whole_radiosity(const scenes::Scene& scene, const Solution& solution) {
  const std::vector<bool> is_explicit = emitter_is_explicit(scene);
  std::vector<Rgb> sums(solution.patches.count(), Rgb(0.0));
  for (std::uint32_t i = 0; i < sums.size(); ++i) {
    for (std::size_t k = 0; k < solution.columns; ++k) {
      sums[i][static_cast<int>(k % 3)] += solution.radiosity[i * solution.columns + k];
    }
    const std::uint32_t m = solution.patches.material(i);
    if (is_explicit[m]) sums[i] += patch_emit(scene, solution.patches, i);
  }
  return sums;
}

// The luminance above which only `share` of the area lies.
double upper_luminance(const std::vector<double>& luminance, const std::vector<double>& area_m2,
                       double share) {
  std::vector<std::size_t> order(luminance.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return luminance[a] > luminance[b]; });
  double left = share * std::accumulate(area_m2.begin(), area_m2.end(), 0.0);
  for (const std::size_t i : order) {
    left -= area_m2[i];
    if (left < 0.0) return luminance[i];
  }
  return 0.0;
}

// Radiosity that is displayed as 1; 0 if nothing is lit.
double exposure(const std::vector<Rgb>& radiosity, const std::vector<double>& area_m2) {
  std::vector<double> luminance;
  luminance.reserve(radiosity.size());
  for (const Rgb& b : radiosity) luminance.push_back(base::luminance(b));
  const double brightest = *std::max_element(luminance.begin(), luminance.end());
  double log_sum = 0.0, area = 0.0;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    if (luminance[i] <= 0.0 || luminance[i] < least_lit * brightest) continue;
    log_sum += area_m2[i] * std::log(luminance[i]);
    area += area_m2[i];
  }
  if (area <= 0.0) return 0.0;
  return std::max(std::exp(log_sum / area) / middle_grey,
                  upper_luminance(luminance, area_m2, clipped_at_most));
}

// Corner k of patch i has the number 4 i + k. Corners of one object and material at one position
// are adjacent in the order.
class Corners {
 public:
  explicit Corners(const Patches& patches) : patches_(patches) {
    double extent = 0.0;
    for (std::uint32_t i = 0; i < patches.count(); ++i) {
      for (const Vec3& corner : patches.corners(i)) {
        places_.push_back(corner);
        extent = std::max(extent, base::max_component(glm::abs(corner)));
      }
    }
    // Neighbours compute a shared corner differently: equal to rounding.
    for (const Vec3& place : places_) grid_.push_back(glm::round(place * (same_place / extent)));
    order_.resize(places_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple_cat(key(a), std::tie(a)) < std::tuple_cat(key(b), std::tie(b));
    });
  }

  [[nodiscard]] const Vec3& place(std::size_t corner) const { return places_[corner]; }

  // Mean of the patches' values at each corner.
  [[nodiscard]] std::vector<Rgb> smooth(const std::vector<Rgb>& values) const {
    std::vector<Rgb> means(places_.size());
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      end = begin;
      while (end < order_.size() && key(order_[begin]) == key(order_[end])) ++end;
      for (std::size_t k = begin; k < end; ++k) {
        means[order_[k]] = end - begin > most_meeting ? values[order_[k] / 4]
                                                      : mean(order_[k], begin, end, values);
      }
    }
    return means;
  }

 private:
  [[nodiscard]] std::tuple<std::uint32_t, std::uint32_t, double, double, double> key(
      std::size_t corner) const {
    const auto patch = static_cast<std::uint32_t>(corner / 4);
    const Vec3& at = grid_[corner];
    return {patches_.object(patch), patches_.material(patch), at.x, at.y, at.z};
  }
  [[nodiscard]] Rgb mean(std::size_t corner, std::size_t begin, std::size_t end,
                         const std::vector<Rgb>& values) const {
    const Vec3 normal = patches_.normal(static_cast<std::uint32_t>(corner / 4));
    Rgb sum(0.0);
    double area = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
      const auto patch = static_cast<std::uint32_t>(order_[k] / 4);
      if (glm::dot(normal, patches_.normal(patch)) < smooth_cosine) continue;
      sum += patches_.area_m2[patch] * values[patch];
      area += patches_.area_m2[patch];
    }
    return sum / area;
  }

  const Patches& patches_;
  std::vector<Vec3> places_, grid_;
  std::vector<std::size_t> order_;
};

void add_vertex(scenes::GltfPart& part, const Vec3& place, const Rgb& colour) {
  for (int c = 0; c < 3; ++c) {
    part.positions.push_back(static_cast<float>(place[c]));
    part.colours.push_back(static_cast<float>(std::clamp(colour[c], 0.0, 1.0)));
  }
}

// Adds the triangles of a cluster with one colour.
void add_several(scenes::GltfPart& part, const Patches& patches, std::uint32_t patch,
                 const Rgb& colour) {
  const ClusterMembers& members = *patches.clustered;
  const ClusterSpan span = span_of(patches.facets[patches.facet[patch]], patches.cell[patch]);
  const bool back = patches.is_back[patch] != 0;
  for (std::uint32_t m = span.first; m < span.first + span.count; ++m) {
    auto first = static_cast<std::uint32_t>(part.positions.size() / 3);
    for (const std::uint32_t v : members.corner[m]) add_vertex(part, members.vertices[v], colour);
    part.indices.insert(part.indices.end(),
                        {first, first + (back ? 2U : 1U), first + (back ? 1U : 2U)});
  }
}

}  // namespace

SolutionMesh solution_mesh(const scenes::Scene& scene, const Solution& solution) {
  SolutionMesh mesh;
  for (const scenes::Object& object : scene.objects)
    mesh.parts.push_back({object.name, {}, {}, {}});
  const Patches& patches = solution.patches;
  const std::vector<Rgb> radiosity = whole_radiosity(scene, solution);
  if (radiosity.empty()) return mesh;
  mesh.lm_m2_per_unit = exposure(radiosity, patches.area_m2);
  const double scale = mesh.lm_m2_per_unit > 0.0 ? 1.0 / mesh.lm_m2_per_unit : 0.0;
  const Corners corners(patches);
  const std::vector<Rgb> shown = corners.smooth(radiosity);
  double clipped = 0.0, area = 0.0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    scenes::GltfPart& part = mesh.parts[patches.object(i)];
    const auto first = static_cast<std::uint32_t>(part.positions.size() / 3);
    area += patches.area_m2[i];
    if (base::max_component(scale * radiosity[i]) > 1.0) clipped += patches.area_m2[i];
    if (patches.is_several(i)) {
      add_several(part, patches, i, scale * radiosity[i]);
      continue;
    }
    for (std::size_t k = 4 * std::size_t{i}; k < 4 * std::size_t{i} + 4; ++k) {
      add_vertex(part, corners.place(k), scale * shown[k]);
    }
    // If a triangle's apex is repeated, one of the two halves has no area.
    const auto same = [&](std::size_t a, std::size_t b) {
      return corners.place(4 * std::size_t{i} + a) == corners.place(4 * std::size_t{i} + b);
    };
    if (!same(0, 1) && !same(1, 2)) {
      part.indices.insert(part.indices.end(), {first, first + 1, first + 2});
    }
    if (!same(2, 3) && !same(3, 0)) {
      part.indices.insert(part.indices.end(), {first, first + 2, first + 3});
    }
  }
  mesh.clipped_share = clipped / area;
  return mesh;
}

}  // namespace earthshine::radiosity
