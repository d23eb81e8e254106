// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "raytrace/tuning.h"
#include "raytrace/witness/strip_width.h"
#include "raytrace/witness/strips.h"

namespace earthshine::raytrace {
namespace {

using base::pi;

// Finds strips of sources along lines of the film.
class SourceStrips {
 public:
  SourceStrips(WitnessScene& scene, SpotMap& spots)
      : scene_(scene), shared_(scene.shared), camera_(scene.camera), spots_(spots) {
    find_pixels();
  }

  void find(std::span<const SceneEdge> edges) {
    if (!any_) return;
    add_lines(edges);
    for (const scenes::FlatMirror& mirror : shared_.query.specular_paths().mirrors()) {
      if (mirror.height_m(camera_.position) <= 0.0) continue;
      mirror_ = &mirror;
      add_lines(edges);
    }
    const std::size_t stride = lines_.size() / tuning::most_probes + 1;
    for (std::size_t k = 0; k < lines_.size() && !scene_.stops(); k += stride) {
      probe(lines_[k], static_cast<double>(stride) * lines_[k].length_px);
    }
  }

 private:
  static constexpr double far_m = 1e9;
  struct Line {
    glm::dvec2 at, along;  // px; unit
    double length_px;
  };

  // Pixels that may show a source.
  void find_pixels() {
    pixels_.assign(
        static_cast<std::size_t>(camera_.columns) * static_cast<std::size_t>(camera_.rows), false);
    for (const WitnessSource& source : scene_.sources()) {
      if (source.luminance <= 0.0 || (source.is_distant && source.angle_rad <= 0.0)) continue;
      const Vec3 at = source.is_distant ? camera_.position + far_m * source.middle : source.middle;
      const double radius =
          source.is_distant ? far_m * std::tan(source.angle_rad) : source.radius_m;
      cover(at, radius);
      for (const scenes::FlatMirror& mirror : shared_.query.specular_paths().mirrors()) {
        if (mirror.height_m(camera_.position) > 0.0) cover(mirror.image(at), radius);
      }
    }
  }

  void cover(const Vec3& at, double radius_m) {
    int x0 = 0, y0 = 0, x1 = camera_.columns, y1 = camera_.rows;
    const double depth = glm::dot(at - camera_.position, camera_.forward);
    if (depth < -radius_m) return;
    if (depth > 2.0 * radius_m) {
      const Spot spot = scene_.spot_at(at, radius_m);
      const double reach = 1.5 * spot.radius_px + 1.0;
      const auto limit = [](double film, int count) {
        return static_cast<int>(std::clamp(film, 0.0, double(count)));
      };
      x0 = limit(spot.film.x - reach, x1), x1 = limit(spot.film.x + reach + 1.0, x1);
      y0 = limit(spot.film.y - reach, y1), y1 = limit(spot.film.y + reach + 1.0, y1);
    }
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) pixels_[index(x, y)] = any_ = true;
    }
  }

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.columns) +
           static_cast<std::size_t>(x);
  }

  // Outlines that the camera sees directly, or in mirror_.
  void add_lines(std::span<const SceneEdge> edges) {
    const Vec3 eye = mirror_ != nullptr ? mirror_->image(camera_.position) : camera_.position;
    for (const SceneEdge& edge : edges) {
      if (edge.is_outline(eye, false)) add_line(edge.a, edge.b);
    }
    for (const WitnessSource& source : scene_.sources()) add_outline(source);
  }

  void add_line(Vec3 a, Vec3 b) {
    if (mirror_ != nullptr) {
      const double height_a = mirror_->height_m(a), height_b = mirror_->height_m(b);
      if (height_a <= mirror_->offset_m && height_b <= mirror_->offset_m) return;
      if (height_a < 0.0) a = glm::mix(a, b, height_a / (height_a - height_b));
      if (height_b < 0.0) b = glm::mix(b, a, height_b / (height_b - height_a));
      a = mirror_->image(a);
      b = mirror_->image(b);
    }
    const double depth_a = glm::dot(a - camera_.position, camera_.forward);
    const double depth_b = glm::dot(b - camera_.position, camera_.forward);
    const double near = 1e-6 * std::max({1.0, std::abs(depth_a), std::abs(depth_b)});
    if (depth_a <= near && depth_b <= near) return;
    if (depth_a < near) a = glm::mix(a, b, (near - depth_a) / (depth_b - depth_a));
    if (depth_b < near) b = glm::mix(b, a, (near - depth_b) / (depth_a - depth_b));
    for_straight_pieces(camera_, a, b, [this](const Vec3& from, const Vec3& to) {
      add_line(camera_.film_from(camera_.position, from), camera_.film_from(camera_.position, to));
    });
  }

  void add_line(const glm::dvec2& a, const glm::dvec2& b) {
    // Clips the line to the picture (Liang and Barsky).
    double from = 0.0, to = 1.0;
    const glm::dvec2 segment = b - a, size(camera_.columns, camera_.rows);
    for (int k = 0; k < 2; ++k) {
      if (segment[k] == 0.0 && (a[k] < 0.0 || a[k] > size[k])) return;
      if (segment[k] == 0.0) continue;
      const double one = -a[k] / segment[k], other = (size[k] - a[k]) / segment[k];
      from = std::max(from, std::min(one, other));
      to = std::min(to, std::max(one, other));
    }
    const double length = glm::length(segment);
    if (from >= to || !(length > 0.0)) return;
    const glm::dvec2 along = segment / length;
    const double first = from * length, last = to * length;
    const int steps = std::max(1, static_cast<int>(std::lround((last - first) / tuning::step_px)));
    for (int k = 0; k < steps; ++k) {
      const glm::dvec2 at = a + (first + (k + 0.5) * (last - first) / steps) * along;
      const int x = std::min(static_cast<int>(at.x), camera_.columns - 1);
      const int y = std::min(static_cast<int>(at.y), camera_.rows - 1);
      if (x >= 0 && y >= 0 && pixels_[index(x, y)] && may_be_in_mirror(at))
        lines_.push_back({at, along, (last - first) / steps});
    }
  }

  // Whether the ray through a film position passes the bounding sphere of mirror_, if any.
  [[nodiscard]] bool may_be_in_mirror(const glm::dvec2& film) const {
    if (mirror_ == nullptr) return true;
    const Vec3 direction = camera_.direction_from(camera_.position, film.x, film.y);
    const Vec3 offset = glm::cross(mirror_->centre - camera_.position, direction);
    return glm::length(offset) <= mirror_->radius_m;
  }

  // Outlines of sources that are no surfaces of the scene: lamps and Suns.
  void add_outline(const WitnessSource& source) {
    const bool is_sun = source.is_distant && source.angle_rad > 0.0;
    const bool is_lamp = source.lamp != nullptr && source.luminance > 0.0;
    if (!is_sun && !is_lamp) return;
    std::vector<Vec3> corners;
    if (is_lamp && source.lamp->kind == scenes::LampKind::Rectangle) {
      const Vec3 u = 0.5 * source.lamp->edge_u, v = 0.5 * source.lamp->edge_v;
      corners = {source.middle - u - v, source.middle + u - v, source.middle + u + v,
                 source.middle - u + v};
    } else {
      const base::Frame3 frame = base::frame_around(is_sun ? source.middle : source.normal);
      const Vec3 middle = is_sun ? camera_.position + far_m * source.middle : source.middle;
      const double radius = is_sun ? far_m * std::tan(source.angle_rad) : source.radius_m;
      for (int k = 0; k < tuning::round_corners; ++k) {
        const double phi = 2.0 * pi * k / tuning::round_corners;
        corners.push_back(
            middle + radius * (std::cos(phi) * frame.tangent + std::sin(phi) * frame.bitangent));
      }
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      add_line(corners[k], corners[(k + 1) % corners.size()]);
    }
  }

  void probe(const Line& line, double step) {
    for (const double side : {-1.0, 1.0}) {
      const glm::dvec2 across = side * glm::dvec2(-line.along.y, line.along.x);
      const double lit = luminance(line.at + tuning::beside_px * across);
      if (lit <= 0.0) continue;
      const auto is_lit = [&](double off) { return luminance(line.at + off * across) > 0.3 * lit; };
      if (is_lit(-tuning::beside_px)) continue;
      if (const auto width = width_of(tuning::wide_px, tuning::beside_px, is_lit)) {
        add(line.at + 0.5 * *width * across, *width, step, lit);
      }
      // A thin body in front of the source.
      const auto is_dark = [&](double off) { return !is_lit(-off); };
      if (const auto width = width_of(tuning::wide_px, tuning::beside_px, is_dark)) {
        add(line.at - 0.5 * *width * across, *width, step, lit);
      }
    }
  }

  void add(const glm::dvec2& film, double width, double step, double lit) {
    Spot spot;
    spot.film = film;
    spot.radius_px = 0.5 * std::max(width, step);
    spot.area_px2 = share_of_edge * width * step;
    spot.luminance = lit;
    if (spot.area_px2 * lit > scene_.least) spots_.add(spot);
  }

  // Luminance of sources at a film position, cd/m^2: through straight glass and by flat mirrors; 0
  // outside the picture, so that a source cut by its border is a strip.
  double luminance(const glm::dvec2& film) {
    if (film.x < 0.0 || film.y < 0.0 || film.x > camera_.columns || film.y > camera_.rows) {
      return 0.0;
    }
    const scenes::Scene& scene = shared_.scene;
    Vec3 from = camera_.position;
    Vec3 direction = camera_.direction_from(from, film.x, film.y);
    double share = 1.0;
    for (int k = 0; k < tuning::most_bounces && share > 0.0; ++k) {
      const scenes::Hit hit = scene_.closest(from, direction);
      const double reach = hit.missed() ? std::numeric_limits<double>::infinity() : hit.t;
      if (const auto lamp = shared_.lights.seen_lamp(from, direction, reach)) {
        return share * base::luminance(lamp->hit.radiance);
      }
      if (hit.missed()) {
        for (const WitnessSource& source : scene_.sources()) {
          if (!source.is_distant) continue;
          if (glm::dot(source.middle, direction) >= std::cos(source.angle_rad) &&
              source.angle_rad > 0.0) {
            return share * source.luminance;
          }
        }
        return 0.0;
      }
      const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
      if (material.emits()) {
        return hit.front || material.two_sided ? share * base::luminance(material.emit) / pi : 0.0;
      }
      const bool passes = scenes::is_straight_glass(material);
      if (!passes && !(base::is_lit(material.mirror) && (hit.front || material.two_sided))) {
        return 0.0;
      }
      share *= base::luminance(passes ? material.transmit : material.mirror);
      const Vec3 normal = (hit.front ? 1.0 : -1.0) * scenes::triangle_normal(scene, hit.triangle);
      const Vec3 lift = shared_.query.offset_m(hit.triangle) * normal;
      from = scenes::hit_position(scene, hit, from, direction) + (passes ? -lift : lift);
      if (!passes) direction = glm::reflect(direction, normal);
    }
    return 0.0;
  }

  WitnessScene& scene_;
  const ShadingScene& shared_;
  const CameraModel& camera_;
  SpotMap& spots_;
  std::vector<bool> pixels_;
  bool any_ = false;
  const scenes::FlatMirror* mirror_ = nullptr;
  std::vector<Line> lines_;
};

}  // namespace

void add_source_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots) {
  SourceStrips(scene, spots).find(edges);
}

}  // namespace earthshine::raytrace
