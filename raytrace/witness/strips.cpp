// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/strips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "scenes/reflect/specular.h"
#include "scenes/sky/sky.h"

namespace earthshine::raytrace {
namespace {

using base::pi;

constexpr double wide_px = 1.0;  // from there on a strip is none
// Where a strip may end, as shares of wide_px; then bisected.
constexpr std::array<double, 4> places = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0};
constexpr int bisections = 4;
// Both edges of a strip report it.
constexpr double share_of_edge = 0.5;

// The width of what begins at 0 and holds `is_same` true, up to `wide`: nothing if it ends nowhere.
template <class IsSame>
std::optional<double> width_of(double wide, double least, const IsSame& is_same) {
  double low = least;
  for (const double place : places) {
    double high = place * wide;
    if (high <= low) continue;
    if (is_same(high)) {
      low = high;
      continue;
    }
    for (int k = 0; k < bisections; ++k) {
      const double middle = 0.5 * (low + high);
      (is_same(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return std::nullopt;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// What the camera sees of sources, along lines of the film.
class SourceStrips {
 public:
  SourceStrips(WitnessScene& scene, SpotMap& spots)
      : scene_(scene), shared_(scene.shared), camera_(scene.camera), spots_(spots) {
    find_pixels();
  }

  void find(std::span<const SceneEdge> edges) {
    if (!any_) return;
    for (const SceneEdge& edge : edges) {
      if (edge.is_outline(camera_.position, false)) add_line(edge.a, edge.b);
    }
    for (const WitnessSource& source : scene_.sources()) add_outline(source);
    const std::size_t stride = lines_.size() / most_probes + 1;
    for (std::size_t k = 0; k < lines_.size() && !scene_.stops(); k += stride) {
      probe(lines_[k], static_cast<double>(stride) * lines_[k].length_px);
    }
  }

 private:
  static constexpr double step_px = 0.5, beside_px = 5e-4, far_m = 1e9;
  static constexpr std::size_t most_probes = 16384;
  static constexpr int round_corners = 32, most_bounces = 8;
  struct Line {
    glm::dvec2 at, along;  // px; unit
    double length_px;
  };

  // Pixels where a source may be seen.
  void find_pixels() {
    pixels_.assign(
        static_cast<std::size_t>(camera_.columns) * static_cast<std::size_t>(camera_.rows), false);
    for (const WitnessSource& source : scene_.sources()) {
      if (source.luminance <= 0.0 || (source.is_distant && source.angle_rad <= 0.0)) continue;
      const Vec3 at = source.is_distant ? camera_.position + far_m * source.middle : source.middle;
      const double radius =
          source.is_distant ? far_m * std::tan(source.angle_rad) : source.radius_m;
      cover(at, radius);
      for (const scenes::FlatMirror& mirror : shared_.query.ways().mirrors()) {
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

  void add_line(Vec3 a, Vec3 b) {
    const double depth_a = glm::dot(a - camera_.position, camera_.forward);
    const double depth_b = glm::dot(b - camera_.position, camera_.forward);
    const double near = 1e-6 * std::max({1.0, std::abs(depth_a), std::abs(depth_b)});
    if (depth_a <= near && depth_b <= near) return;
    if (depth_a < near) a = glm::mix(a, b, (near - depth_a) / (depth_b - depth_a));
    if (depth_b < near) b = glm::mix(b, a, (near - depth_b) / (depth_a - depth_b));
    add_line(camera_.film_from(camera_.position, a), camera_.film_from(camera_.position, b));
  }

  void add_line(const glm::dvec2& a, const glm::dvec2& b) {
    // Its part over the picture, by Liang and Barsky.
    double from = 0.0, to = 1.0;
    const glm::dvec2 way = b - a, size(camera_.columns, camera_.rows);
    for (int k = 0; k < 2; ++k) {
      if (way[k] == 0.0 && (a[k] < 0.0 || a[k] > size[k])) return;
      if (way[k] == 0.0) continue;
      const double one = -a[k] / way[k], other = (size[k] - a[k]) / way[k];
      from = std::max(from, std::min(one, other));
      to = std::min(to, std::max(one, other));
    }
    const double length = glm::length(way);
    if (from >= to || !(length > 0.0)) return;
    const glm::dvec2 along = way / length;
    const double first = from * length, last = to * length;
    const int steps = std::max(1, static_cast<int>(std::lround((last - first) / step_px)));
    for (int k = 0; k < steps; ++k) {
      const glm::dvec2 at = a + (first + (k + 0.5) * (last - first) / steps) * along;
      const int x = std::min(static_cast<int>(at.x), camera_.columns - 1);
      const int y = std::min(static_cast<int>(at.y), camera_.rows - 1);
      if (x >= 0 && y >= 0 && pixels_[index(x, y)])
        lines_.push_back({at, along, (last - first) / steps});
    }
  }

  // Of what is no surface of the scene: lamps and Suns.
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
      for (int k = 0; k < round_corners; ++k) {
        const double phi = 2.0 * pi * k / round_corners;
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
      const double lit = luminance(line.at + beside_px * across);
      if (lit <= 0.0) continue;
      const auto is_lit = [&](double off) { return luminance(line.at + off * across) > 0.3 * lit; };
      if (is_lit(-beside_px)) continue;
      if (const auto width = width_of(wide_px, beside_px, is_lit)) {
        add(line.at + 0.5 * *width * across, *width, step, lit);
      }
      // Something thin before the source.
      const auto is_dark = [&](double off) { return !is_lit(-off); };
      if (const auto width = width_of(wide_px, beside_px, is_dark)) {
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

  // Of sources, at a place of the film, cd/m^2: through straight glass and off flat mirrors.
  double luminance(const glm::dvec2& film) {
    const scenes::Scene& scene = shared_.scene;
    Vec3 from = camera_.position;
    Vec3 direction = camera_.direction_from(from, film.x, film.y);
    double share = 1.0;
    for (int k = 0; k < most_bounces && share > 0.0; ++k) {
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
  std::vector<Line> lines_;
};

// A source of small extent, or its image in a flat mirror.
struct LightView {
  const WitnessSource* source = nullptr;
  const scenes::FlatMirror* mirror = nullptr;
  std::uint32_t number = scenes::no_mirror;
  bool is_distant = false;
  Vec3 from{0.0};  // its place, or the unit direction toward it

  [[nodiscard]] Vec3 toward(const Vec3& point) const {
    return is_distant ? from : glm::normalize(from - point);
  }
};

// What a source's light falls on, beyond the outlines that it sees.
class LightStrips {
 public:
  LightStrips(WitnessScene& scene, SpotMap& spots)
      : scene_(scene), shared_(scene.shared), camera_(scene.camera), spots_(spots) {
    const scenes::Box box = scenes::box_around(shared_.scene.vertices);
    diagonal_m_ = box.diagonal();
    beside_m_ =
        4.0 * std::max(shared_.query.offset_at_m(box.low), shared_.query.offset_at_m(box.high));
  }

  void find(std::span<const SceneEdge> edges) {
    list_views();
    if (views_.empty()) return;
    struct Outline {
      std::uint32_t view, edge;
      double length_m;
    };
    std::vector<Outline> outlines;
    double length_m = 0.0;
    for (std::uint32_t v = 0; v < views_.size(); ++v) {
      const LightView& view = views_[v];
      for (std::uint32_t e = 0; e < edges.size(); ++e) {
        if (!edges[e].is_outline(view.from, view.is_distant)) continue;
        outlines.push_back({v, e, glm::length(edges[e].b - edges[e].a)});
        length_m += outlines.back().length_m;
      }
    }
    const double pixels = double(camera_.columns) * camera_.rows;
    const double most = std::clamp(pixels / 2.0, 4096.0, 32768.0);
    const double step_m = 2.0 * length_m / most;
    const auto stride = static_cast<std::size_t>(2.0 * double(outlines.size()) / most) + 1;
    double next_m = 0.5 * step_m, at_m = 0.0;
    for (std::size_t k = 0; k < outlines.size() && !scene_.stops(); ++k) {
      const Outline& outline = outlines[k];
      const SceneEdge& edge = edges[outline.edge];
      const LightView& view = views_[outline.view];
      // Even over the length; and once each edge, or every so many, for small openings.
      const bool is_long = next_m < at_m + outline.length_m;
      if (!is_long && k % stride == 0) probe(view, edge, 0.0, 1.0);
      for (; next_m < at_m + outline.length_m; next_m += step_m) {
        const double middle = (next_m - at_m) / outline.length_m;
        const double half = 0.5 * step_m / outline.length_m;
        probe(view, edge, std::max(0.0, middle - half), std::min(1.0, middle + half));
      }
      at_m += outline.length_m;
    }
  }

 private:
  static constexpr int most_panes = 8, most_parts = 64;
  static constexpr double part_px = 0.5;
  static constexpr double widest = 0.05;  // of a source, over its distance from the scene

  struct Receiver {
    Vec3 position{0.0}, normal{0.0};  // normal: on the side of the light
    const scenes::Material* material = nullptr;
    double offset_m = 0.0;
  };

  void list_views() {
    for (const WitnessSource& source : scene_.sources()) {
      // Emitting triangles light surfaces as parts of something larger.
      if (source.lamp == nullptr && !source.is_distant) continue;
      if (!source.is_distant && source.radius_m > widest * diagonal_m_) continue;
      views_.push_back({&source, nullptr, scenes::no_mirror, source.is_distant, source.middle});
      std::uint32_t number = 0;
      for (const scenes::FlatMirror& mirror : shared_.query.ways().mirrors()) {
        const bool reaches = source.is_distant ? glm::dot(source.middle, mirror.normal) > 0.0
                                               : mirror.height_m(source.middle) > 0.0;
        if (reaches) {
          views_.push_back(
              {&source, &mirror, number, source.is_distant,
               source.is_distant ? mirror.turned(source.middle) : mirror.image(source.middle)});
        }
        ++number;
      }
    }
  }

  // Where the light that passes a point ends; nothing if it ends before it, or nowhere.
  std::optional<Receiver> receive(const LightView& view, const Vec3& point) {
    const scenes::Scene& scene = shared_.scene;
    const Vec3 direction = -view.toward(point);
    Vec3 from = view.is_distant ? point - 2.0 * diagonal_m_ * direction : view.from;
    if (view.mirror != nullptr) {
      const double fall = glm::dot(direction, view.mirror->normal);
      const double height = view.mirror->height_m(point);
      if (fall <= 0.0 || height <= 0.0) return std::nullopt;
      from = point - height / fall * direction + view.mirror->offset_m * view.mirror->normal;
    }
    for (int k = 0; k < most_panes; ++k) {
      const scenes::Hit hit = scene_.closest(from, direction);
      if (hit.missed()) return std::nullopt;
      const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
      Receiver receiver;
      receiver.position = scenes::hit_position(scene, hit, from, direction);
      receiver.normal = (hit.front ? 1.0 : -1.0) * scenes::triangle_normal(scene, hit.triangle);
      receiver.offset_m = shared_.query.offset_m(hit.triangle);
      receiver.material = &material;
      if (scenes::is_straight_glass(material)) {
        from = receiver.position - receiver.offset_m * receiver.normal;
        continue;
      }
      if (!hit.front && !material.two_sided) return std::nullopt;
      const double beyond = glm::dot(receiver.position - point, direction);
      if (beyond <= 8.0 * receiver.offset_m) return std::nullopt;
      return receiver;
    }
    return std::nullopt;
  }

  // Of the light that it reflects to the camera, cd/m^2; 0 where that is not in view.
  double luminance(const LightView& view, const Receiver& at) {
    if (!at.material->reflects()) return 0.0;
    const Vec3 to_camera = camera_.position - at.position;
    const Vec3 out = glm::normalize(to_camera), in = view.toward(at.position);
    const double seen = glm::dot(out, at.normal), cosine = glm::dot(in, at.normal);
    if (seen <= 0.0 || cosine <= 0.0) return 0.0;
    if (glm::dot(to_camera, camera_.forward) >= 0.0) return 0.0;
    const glm::dvec2 film = camera_.film_from(camera_.position, at.position);
    if (film.x < -1.0 || film.y < -1.0 || film.x > camera_.columns + 1.0 ||
        film.y > camera_.rows + 1.0) {
      return 0.0;
    }
    const Vec3 source_sees = view.mirror != nullptr ? view.mirror->image(at.position) : at.position;
    const double light = view.source->illuminance(source_sees) * cosine / pi;
    const double cos_alpha = glm::dot(2.0 * seen * at.normal - out, in);
    double reflected = base::luminance(at.material->diffuse);
    if (cos_alpha > 0.0 && base::is_lit(at.material->specular)) {
      reflected += base::luminance(at.material->specular) *
                   scenes::lobe_at(*at.material, cos_alpha, cosine, seen);
    }
    if (light * reflected <= scene_.least) return 0.0;
    const Vec3 start = at.position + at.offset_m * at.normal;
    const double in_view = scene_.share(start, glm::normalize(camera_.position - start),
                                        glm::length(camera_.position - start));
    if (in_view <= 0.0) return 0.0;
    const double reach =
        view.is_distant ? 1e9 : glm::length(view.from - start) * (1.0 - 1e-6) - at.offset_m;
    return light * reflected * in_view *
           scene_.share(start, view.toward(start), reach, view.number);
  }

  // [from, to]: the part of the edge that is asked for, in its lengths.
  void probe(const LightView& view, const SceneEdge& edge, double from, double to,
             bool is_part = false) {
    const Vec3 whole = edge.b - edge.a, at = edge.a + 0.5 * (from + to) * whole;
    const Vec3 across = glm::cross(whole, view.toward(at));
    if (glm::length(across) <= 1e-3 * glm::length(whole)) return;
    for (const double side : {-1.0, 1.0}) {
      const Strip strip{view, at, side * glm::normalize(across), (to - from) * whole};
      const double length_px = probe(strip);
      if (is_part || length_px <= 1.5 * part_px) continue;
      const int parts = std::min(most_parts, static_cast<int>(std::ceil(length_px / part_px)));
      for (int k = 0; k < parts; ++k) {
        const double step = (to - from) / parts;
        const double start = from + k * step;
        probe({view, edge.a + (start + 0.5 * step) * whole, strip.across, step * whole}, true);
      }
    }
  }

  struct Strip {
    const LightView& view;
    Vec3 at, across, step;
  };
  // Adds a strip that is no longer than a pixel, or any if `adds`. Returns its length, px.
  double probe(const Strip& strip, bool adds = false) {
    const double beside_m = beside_m_;
    const auto light_at = [&](double off) {
      return receive(strip.view, strip.at + off * strip.across);
    };
    const auto first = light_at(beside_m);
    if (!first) return 0.0;
    const double lit = luminance(strip.view, *first);
    if (lit <= 0.0) return 0.0;
    // The surface as a plane: where light that passes `target` falls on it.
    const auto on_plane = [&](const Vec3& target) {
      const Vec3 way = strip.view.toward(target);
      return target +
             glm::dot(first->position - target, first->normal) / glm::dot(way, first->normal) * way;
    };
    const auto film = [&](const Vec3& target) {
      return camera_.film_from(camera_.position, on_plane(target));
    };
    const Vec3 start = strip.at + beside_m * strip.across;
    const glm::dvec2 film_start = film(start);
    const double px_per_m =
        glm::length(film(start + beside_m * strip.across) - film_start) / beside_m;
    if (!(px_per_m > 0.0)) return 0.0;
    const auto is_same = [&](double off) {
      const Vec3 target = strip.at + off * strip.across;
      const auto there = receive(strip.view, target);
      if (!there) return false;
      const Vec3 expected = on_plane(target);
      return glm::length(there->position - expected) <=
             0.3 * glm::length(expected - first->position) + 8.0 * first->offset_m;
    };
    if (is_same(-beside_m)) return 0.0;
    const double wide_m = wide_px / px_per_m;
    auto width = width_of(wide_m, beside_m, is_same);
    double off = width ? 0.5 * *width : 0.0;
    if (!width) {  // the shadow of something thin
      width = width_of(wide_m, beside_m, [&](double dark) { return !is_same(-dark); });
      off = width ? -0.5 * *width : 0.0;
    }
    if (!width) return 0.0;
    const glm::dvec2 along = film(start + strip.step) - film_start;
    const glm::dvec2 down = film(start + *width * strip.across) - film_start;
    const double length_px = glm::length(along);
    if (!adds && length_px > 1.5 * part_px) return length_px;
    Spot spot = scene_.spot_at(on_plane(strip.at + off * strip.across), 0.0);
    spot.radius_px = 0.5 * std::max(length_px, glm::length(down));
    spot.area_px2 = share_of_edge * std::abs(cross(along, down));
    spot.luminance = lit;
    if (spots_.contains(spot)) spots_.add(spot);
    return length_px;
  }

  WitnessScene& scene_;
  const ShadingScene& shared_;
  const CameraModel& camera_;
  SpotMap& spots_;
  double diagonal_m_ = 0.0;
  double beside_m_ = 0.0;  // off an edge: rays tell its sides apart, wherever its ends lie
  std::vector<LightView> views_;
};

}  // namespace

void add_source_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots) {
  SourceStrips(scene, spots).find(edges);
}

void add_light_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots) {
  LightStrips(scene, spots).find(edges);
}

}  // namespace earthshine::raytrace
