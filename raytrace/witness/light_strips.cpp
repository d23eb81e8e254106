// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "raytrace/tuning.h"
#include "raytrace/witness/strip_width.h"
#include "raytrace/witness/strips.h"
#include "scenes/reflect/brdf.h"
#include "scenes/reflect/specular.h"
#include "scenes/triangle_point.h"

namespace earthshine::raytrace {
namespace {

using base::pi;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// A source of small extent, or its image in a flat mirror.
struct LightView {
  const WitnessSource* source = nullptr;
  const scenes::FlatMirror* mirror = nullptr;
  std::uint32_t number = scenes::no_mirror;
  bool is_distant = false;
  Vec3 from{0.0};  // position, or unit direction toward it

  [[nodiscard]] Vec3 toward(const Vec3& point) const {
    return is_distant ? from : glm::normalize(from - point);
  }
};

// Finds the light on surfaces beyond the outlines that a source sees.
class LightStrips {
 public:
  LightStrips(WitnessScene& scene, SpotMap& spots, std::vector<LitSpot>& lit)
      : scene_(scene), shared_(scene.shared), camera_(scene.camera), spots_(spots), lit_(lit) {
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
      // Probes are evenly spaced over the total length. In addition each short edge, or one in
      // `stride`, is probed once, to find small openings.
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
  struct Receiver {
    Vec3 position{0.0}, normal{0.0};  // normal: on the lit side
    const scenes::Material* material = nullptr;
    double offset_m = 0.0;
  };

  void list_views() {
    for (const WitnessSource& source : scene_.sources()) {
      // Emitting triangles light surfaces as parts of larger sources.
      if (source.lamp == nullptr && !source.is_distant) continue;
      if (!source.is_distant && source.radius_m > tuning::widest * diagonal_m_) continue;
      views_.push_back({&source, nullptr, scenes::no_mirror, source.is_distant, source.middle});
      std::uint32_t number = 0;
      for (const scenes::FlatMirror& mirror : shared_.query.specular_paths().mirrors()) {
        const bool reaches = source.is_distant ? glm::dot(source.middle, mirror.normal) > 0.0
                                               : mirror.height_m(source.middle) > 0.0;
        if (reaches) {
          views_.push_back(
              {&source, &mirror, number, source.is_distant,
               source.is_distant ? mirror.reflected(source.middle) : mirror.image(source.middle)});
        }
        ++number;
      }
    }
  }

  // The end of the light ray through a point; empty if it ends before the point, or hits nothing.
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
    for (int k = 0; k < tuning::most_panes; ++k) {
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

  // Luminance of the light that the receiver reflects to the camera, cd/m^2; 0 if it is not in
  // view.
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
    const scenes::Brdf brdf{*at.material, at.material->diffuse, at.normal,
                            2.0 * seen * at.normal - out, seen};
    const double reflected = base::luminance(brdf.eval(in, cosine));
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

  // [from, to]: the part of the edge to probe, in units of its length.
  void probe(const LightView& view, const SceneEdge& edge, double from, double to,
             bool is_part = false) {
    const Vec3 whole = edge.b - edge.a, at = edge.a + 0.5 * (from + to) * whole;
    const Vec3 across = glm::cross(whole, view.toward(at));
    if (glm::length(across) <= 1e-3 * glm::length(whole)) return;
    for (const double side : {-1.0, 1.0}) {
      const Strip strip{view, at, side * glm::normalize(across), (to - from) * whole};
      if (!is_part) add_lit(strip);
      const double length_px = probe(strip);
      if (is_part || length_px <= 1.5 * tuning::part_px) continue;
      const int parts =
          std::min(tuning::most_parts, static_cast<int>(std::ceil(length_px / tuning::part_px)));
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

    // Takes the surface as a plane: where light through `target` reaches it.
    [[nodiscard]] Vec3 on_plane(const Receiver& first, const Vec3& target) const {
      const Vec3 direction = view.toward(target);
      return target + glm::dot(first.position - target, first.normal) /
                          glm::dot(direction, first.normal) * direction;
    }
  };

  // Whether light at that distance across the strip ends on the plane of the first receiver.
  bool is_on_plane(const Strip& strip, const Receiver& first, double off) {
    const Vec3 target = strip.at + off * strip.across;
    const auto there = receive(strip.view, target);
    if (!there) return false;
    const Vec3 expected = strip.on_plane(first, target);
    return glm::length(there->position - expected) <=
           0.3 * glm::length(expected - first.position) + 8.0 * first.offset_m;
  }

  // Records the light of a narrow strip, whether the camera sees it or not.
  void add_lit(const Strip& strip) {
    const auto first = receive(strip.view, strip.at + beside_m_ * strip.across);
    if (!first || !base::is_lit(first->material->diffuse)) return;
    const auto is_same = [&](double off) { return is_on_plane(strip, *first, off); };
    if (is_same(-beside_m_)) return;
    const auto width = width_of(tuning::wide_share * diagonal_m_, beside_m_, is_same);
    if (!width) return;
    // An opening may be shorter than the step.
    int passing = 0;
    for (int k = 0; k < tuning::strip_parts; ++k) {
      const double along = (k + 0.5) / tuning::strip_parts - 0.5;
      const Strip part{strip.view, strip.at + along * strip.step, strip.across, strip.step};
      passing += is_on_plane(part, *first, 0.5 * *width) ? 1 : 0;
    }
    const LightView& view = strip.view;
    const Vec3 in = view.toward(first->position),
               start = first->position + first->offset_m * first->normal;
    const Vec3 source_sees =
        view.mirror != nullptr ? view.mirror->image(first->position) : first->position;
    const double reach =
        view.is_distant ? 1e9 : glm::length(view.from - start) * (1.0 - 1e-6) - first->offset_m;
    const double light = view.source->illuminance(source_sees) *
                         std::max(0.0, glm::dot(in, first->normal)) *
                         scene_.share(start, in, reach, view.number);
    const Vec3 place = strip.on_plane(*first, strip.at + 0.5 * *width * strip.across);
    const Vec3 corner = strip.on_plane(*first, strip.at);
    const Vec3 across = strip.on_plane(*first, strip.at + *width * strip.across) - corner;
    const Vec3 along = strip.on_plane(*first, strip.at + strip.step) - corner;
    // Both edges of a strip report it, and the lids of an opening are often double.
    const double share = 0.5 * share_of_edge * passing / tuning::strip_parts;
    const double intensity_cd = share * light * base::luminance(first->material->diffuse) / pi *
                                glm::length(glm::cross(along, across));
    if (intensity_cd > 0.0) lit_.push_back({place, first->normal, intensity_cd});
  }

  // Adds a strip that is no longer than a pixel, or any strip if `adds`. Returns its length, px.
  double probe(const Strip& strip, bool adds = false) {
    const double beside_m = beside_m_;
    const auto light_at = [&](double off) {
      return receive(strip.view, strip.at + off * strip.across);
    };
    const auto first = light_at(beside_m);
    if (!first) return 0.0;
    const double lit = luminance(strip.view, *first);
    if (lit <= 0.0) return 0.0;
    const auto on_plane = [&](const Vec3& target) { return strip.on_plane(*first, target); };
    const auto film = [&](const Vec3& target) {
      return camera_.film_from(camera_.position, on_plane(target));
    };
    const Vec3 start = strip.at + beside_m * strip.across;
    const glm::dvec2 film_start = film(start);
    const double px_per_m =
        glm::length(film(start + beside_m * strip.across) - film_start) / beside_m;
    if (!(px_per_m > 0.0)) return 0.0;
    const auto is_same = [&](double off) { return is_on_plane(strip, *first, off); };
    if (is_same(-beside_m)) return 0.0;
    const double wide_m = tuning::wide_px / px_per_m;
    auto width = width_of(wide_m, beside_m, is_same);
    double off = width ? 0.5 * *width : 0.0;
    if (!width) {  // shadow of a thin body
      width = width_of(wide_m, beside_m, [&](double dark) { return !is_same(-dark); });
      off = width ? -0.5 * *width : 0.0;
    }
    if (!width) return 0.0;
    const glm::dvec2 along = film(start + strip.step) - film_start;
    const glm::dvec2 down = film(start + *width * strip.across) - film_start;
    const double length_px = glm::length(along);
    if (!adds && length_px > 1.5 * tuning::part_px) return length_px;
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
  std::vector<LitSpot>& lit_;
  double diagonal_m_ = 0.0;
  double beside_m_ = 0.0;  // distance from an edge at which rays distinguish its sides
  std::vector<LightView> views_;
};

}  // namespace

void add_light_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots,
                      std::vector<LitSpot>& lit) {
  LightStrips(scene, spots, lit).find(edges);
}

}  // namespace earthshine::raytrace
