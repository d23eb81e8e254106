// SPDX-License-Identifier: Apache-2.0
#include "raytrace/light/uncaught_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "raytrace/light/light_sampler.h"
#include "scenes/light/shadow_queue.h"
#include "scenes/text/message_text.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points = 2048;
constexpr std::size_t most_named = 3;

// Sides of triangles, to sample points uniformly in area.
struct Side {
  std::uint32_t triangle = 0;
  bool front = true;
};
struct Sides {
  std::vector<Side> sides;
  std::vector<double> area_to;  // running sum, m^2
  void add(const scenes::Scene& scene, std::uint32_t triangle, bool front) {
    sides.push_back({triangle, front});
    area_to.push_back(area_m2() + scenes::triangle_area(scene, triangle));
  }
  [[nodiscard]] double area_m2() const { return area_to.empty() ? 0.0 : area_to.back(); }
};

// Luminous exitance of the light on a point, direct and by flat mirrors.
struct Falling {
  double straight = 0.0, thrown = 0.0;
};

// Shares of the light on a triangle's side that it redirects where no shadow ray follows.
struct Sent {
  double by_mirror = 0.0, by_mirror_again = 0.0, by_glass = 0.0;
  [[nodiscard]] bool any() const { return by_mirror_again > 0.0 || by_glass > 0.0; }
};

class Finder {
 public:
  Finder(const scenes::World& study, Indirect indirect, SourcesOf which)
      : study_(study),
        mirrors_(indirect != Indirect::Distributed),
        which_(which),
        lights_(study, mirrors_ ? indirect : Indirect::None, 1, false, std::nullopt,
                mirrors_ ? study.query.specular_paths().mirrors()
                         : std::span<const scenes::FlatMirror>()) {}

  [[nodiscard]] UncaughtLight find() const {
    Sides all, senders;
    UncaughtLight found;
    const scenes::Scene& scene = study_.scene;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      for (const bool front : {true, false}) {
        if (!front && !scene.materials[scene.triangles[t].material].two_sided) continue;
        all.add(scene, t, front);
        const Sent sent = sent_by({t, front});
        if (!sent.any()) continue;
        senders.add(scene, t, front);
        found.mirrors.possible |= sent.by_mirror > 0.0;
        found.glass.possible |= sent.by_glass > 0.0;
      }
    }
    if (senders.sides.empty() || !any_asked()) return {};
    double falls = 0.0;
    for (const Falling& at : falling_on(all, 0)) falls += at.straight * all.area_m2() / points;
    const std::vector<Falling> on_senders = falling_on(senders, points);
    std::map<std::uint32_t, double> mirrors, glass;  // flux by object
    for (std::size_t k = 0; k < points; ++k) {
      const Side& side = side_of(senders, k);
      const Sent sent = sent_by(side);
      const Falling& at = on_senders[k];
      const std::uint32_t object = scene.triangles[side.triangle].object;
      const double area = senders.area_m2() / points;
      mirrors[object] += area * (sent.by_mirror * at.straight + sent.by_mirror_again * at.thrown);
      glass[object] += area * sent.by_glass * (at.straight + at.thrown);
    }
    fill(found.mirrors, mirrors, falls);
    fill(found.glass, glass, falls);
    return found;
  }

 private:
  [[nodiscard]] Sent sent_by(const Side& side) const {
    const scenes::Material& material =
        study_.scene.materials[study_.scene.triangles[side.triangle].material];
    Sent sent;
    sent.by_mirror_again = base::luminance(material.mirror);
    const scenes::SpecularPaths::Face* face = study_.query.specular_paths().face(side.triangle);
    const bool is_caught =
        mirrors_ && face != nullptr && face->mirror[side.front ? 0 : 1] != scenes::no_mirror;
    if (!is_caught) sent.by_mirror = sent.by_mirror_again;
    if (!scenes::is_straight_glass(material)) sent.by_glass = base::luminance(material.transmit);
    return sent;
  }

  // The side with point k of `points`.
  [[nodiscard]] static const Side& side_of(const Sides& from, std::size_t k) {
    const double wanted = (static_cast<double>(k) + 0.5) / points * from.area_m2();
    const auto at = std::upper_bound(from.area_to.begin(), from.area_to.end() - 1, wanted);
    return from.sides[static_cast<std::size_t>(at - from.area_to.begin())];
  }

  [[nodiscard]] std::vector<Falling> falling_on(const Sides& from, std::size_t first_key) const {
    std::vector<Falling> found(points);
    base::parallel_chunks(points, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        found[k] =
            falling(side_of(from, k), base::Key(1, base::Stream::LightSample, first_key + k));
      }
    });
    return found;
  }

  [[nodiscard]] Falling falling(const Side& side, const base::Key& key) const {
    scenes::Hit hit{side.triangle};
    const double root = std::sqrt(base::uniform(key, 0));
    hit.u = root * (1.0 - base::uniform(key, 1));
    hit.v = root * base::uniform(key, 1);
    const Vec3 at = scenes::hit_position(study_.scene, hit);
    const Vec3 normal =
        (side.front ? 1.0 : -1.0) * scenes::triangle_normal(study_.scene, side.triangle);
    const double offset = study_.query.offset_m(side.triangle);
    const Vec3 origin = at + offset * normal;
    std::vector<scenes::LightChoice> chosen;
    lights_.choose({at, normal, normal, 1.0, 0.0, 0.0}, base::uniform(key, 2), chosen);
    Falling found;
    struct Arriving {
      Rgb lx;
      double scale;
      bool thrown;
    };
    scenes::ShadowQueue<Arriving> shadows(study_.query);
    const auto take = [&](const Arriving& of, const Rgb& share) {
      (of.thrown ? found.thrown : found.straight) += of.scale * base::luminance(share * of.lx);
    };
    for (const auto& [light, weight] : chosen) {
      if (!is_asked(light)) continue;
      const base::Key own = key.with(light);
      const scenes::LightSample sample =
          lights_.sample(light, at, base::uniform(own, 0), base::uniform(own, 1));
      const double cosine = glm::dot(sample.direction, normal);
      if (cosine <= 0.0) continue;
      shadows.add(
          sample, at, origin,
          {sample.normal_illuminance_lx, weight * cosine, sample.mirror != scenes::no_mirror},
          take);
    }
    shadows.trace(take);
    return found;
  }

  [[nodiscard]] bool is_asked(std::size_t light) const {
    if (which_ == SourcesOf::All) return true;
    switch (lights_.kind(light)) {
      case scenes::LightKind::PointLamp:
      case scenes::LightKind::SpotLamp:
      case scenes::LightKind::MeasuredLamp:
      case scenes::LightKind::DistantLamp:
        return true;
      case scenes::LightKind::Sun:
        return study_.scene.sun->angular_radius_deg <= 0.0;
      default:
        return false;
    }
  }

  [[nodiscard]] bool any_asked() const {
    for (std::size_t light = 0; light < lights_.count(); ++light) {
      if (is_asked(light)) return true;
    }
    return false;
  }

  void fill(Uncaught& found, const std::map<std::uint32_t, double>& flux, double falls) const {
    std::vector<std::pair<double, std::uint32_t>> by;
    double all = 0.0;
    for (const auto& [object, lm] : flux) {
      if (lm > 0.0) by.emplace_back(-lm, object);
      all += lm;
    }
    std::sort(by.begin(), by.end());
    if (falls > 0.0) found.share = all / falls;
    for (std::size_t k = 0; k < std::min(by.size(), most_named); ++k) {
      found.objects.push_back(study_.scene.objects[by[k].second].name);
    }
  }

  const scenes::World& study_;
  bool mirrors_;
  SourcesOf which_;
  LightSampler lights_;
};

// For example ": about 3 % of what falls straight from them ("ball")"
std::string extent(const Uncaught& light) {
  std::string text = ": less than 0.1 % of what falls straight from them";
  if (light.share >= 0.001) {
    text = fmt::format(": about {} of what falls straight from them", scenes::percent(light.share));
  }
  if (light.objects.empty()) return text;
  return fmt::format("{} (\"{}\")", text, fmt::join(light.objects, "\", \""));
}

}  // namespace

UncaughtLight uncaught_light(const scenes::World& scene, Indirect indirect, SourcesOf which) {
  return Finder(scene, indirect, which).find();
}

std::vector<std::string> not_captured(const scenes::World& scene, const RenderOptions& options) {
  const scenes::Effects& effects = scene.effects;
  const bool throws_light = effects.mirror || effects.refraction;
  const bool by_paths = options.indirect == Indirect::Paths;
  const bool traced = by_paths && options.paths == PathSet::All;
  std::vector<std::string> missing;
  if (options.indirect == Indirect::Distributed) {
    missing.emplace_back(
        "light from surface to surface, and what N lights in place of a wide source change");
  } else if (options.indirect == Indirect::None) {
    missing.emplace_back("light from surface to surface");
  }
  if (!throws_light) return missing;
  const UncaughtLight light =
      uncaught_light(scene, by_paths ? Indirect::Radiosity : options.indirect,
                     traced ? SourcesOf::WithoutSize : SourcesOf::All);
  const std::string sources =
      traced ? "light of sources without size" : "light of lamps, Sun and emitters";
  if (light.mirrors.possible || light.mirrors.share > 0.0) {
    missing.push_back("caustics: " + sources +
                      " that curved mirrors, or two flat mirrors in turn, throw" +
                      extent(light.mirrors));
  }
  if (light.glass.possible) {
    missing.push_back("caustics: " + sources +
                      " through glass that bends it, which casts a shadow" + extent(light.glass));
  }
  return missing;
}

}  // namespace earthshine::raytrace
