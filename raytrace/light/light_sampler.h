// SPDX-License-Identifier: Apache-2.0
// All sources that shadow rays sample, in one list.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "raytrace/light/sun_strata.h"
#include "scenes/effects/world.h"
#include "scenes/light/emitters.h"
#include "scenes/light/lamp_light.h"
#include "scenes/light/light_tree.h"
#include "scenes/sky/sky.h"

namespace earthshine::raytrace {

// Samples sources by one shadow ray each; (u, v) determine the point on a source with extent.
class LightSampler {
 public:
  // Radiosity and None: each source once, sampled at random. Distributed: `distributed_lights`
  // fixed points or directions of equal share, the same for every pixel, replace each wide source;
  // for the Earth, points of earth_area (distributed_area.h) or directions to its disc. per_group:
  // every light group gets its own image, so that lamps are chosen within each group, and the Suns
  // of a sky in parts are divided into strata. mirrors: flat mirrors, each of which adds an image
  // of each light; not for distributed lights.
  LightSampler(const scenes::World& world, Indirect indirect, int distributed_lights,
               bool per_group = false, std::optional<scenes::Lamp> earth_area = std::nullopt,
               std::span<const scenes::FlatMirror> mirrors = {});

  // Appends the lights that get a shadow ray at the receiver. Of few lamps, all. Of many lamps, the
  // brightest with weight 1, and a random selection of the others with weight 1 / probability
  // (scenes/light/light_tree.h), for u uniform in [0, 1). Lights that are no lamps are always
  // included; so are all distributed lights, whose number is prescribed, and all Suns.
  void choose(const scenes::Receiver& receiver, double u,
              std::vector<scenes::LightChoice>& chosen) const;

  [[nodiscard]] const SunStrata& sun_strata() const { return sun_strata_; }

  // The first lamp surface on a ray, nearer than nearer_than_m.
  struct SeenLamp {
    std::size_t lamp;  // index in the scene
    scenes::LampHit hit;
  };
  [[nodiscard]] std::optional<SeenLamp> seen_lamp(const Vec3& origin, const Vec3& direction,
                                                  double nearer_than_m) const;

  // The lights themselves, then their images in each mirror.
  [[nodiscard]] std::size_t count() const { return lights_.size(); }
  [[nodiscard]] std::size_t group(std::size_t light) const { return lights_[light].group; }
  [[nodiscard]] scenes::LightKind kind(std::size_t light) const;
  // False if it is certain without a sample that no light reaches a surface that faces `normal`: a
  // Sun below the horizon; a lamp behind the surface or shining away from it; an image outside the
  // mirror, seen from the point.
  [[nodiscard]] bool may_reach(std::size_t light, const Vec3& point, const Vec3& normal) const;
  // Position of a lamp without size that shines directly, or nullptr.
  [[nodiscard]] const Vec3* lamp_point(std::size_t light) const {
    return light < sources_ && delta_lights_[light].is_delta ? &delta_lights_[light].position
                                                             : nullptr;
  }
  // visit(light) for each light that may reach such a surface, without Suns of other strata.
  template <class Visit>
  void each_that_may_reach(const Vec3& point, const Vec3& normal, std::size_t sun_stratum,
                           const Visit& visit) const {
    for (const MirrorLights& by : mirror_lights_) {
      if (by.mirror != nullptr && by.mirror->height_m(point) <= 0.0) continue;
      for (const std::size_t light : by.lights) {
        if (weight(lights_[light], sun_stratum) <= 0.0) continue;
        if (may_reach(light, point, normal)) visit(light);
      }
    }
  }
  [[nodiscard]] scenes::LightSample sample(std::size_t light, const Vec3& point, double u,
                                           double v) const;
  // One of a surface's samples of many lights, each by uniform(light), a pair in [0, 1). on_sun,
  // empty at first: the point on the disc that all Suns of a sky in parts share.
  template <class Uniform>
  [[nodiscard]] scenes::LightSample sample(std::size_t light, const Vec3& point,
                                           const Uniform& uniform,
                                           std::optional<Vec3>& on_sun) const {
    if (delta_lights_[light].is_delta) return sample(light, point, 0.0, 0.0);
    if (lights_[light].kind == Kind::SunPart) {
      if (!on_sun) {
        const auto u = uniform(light);
        on_sun = sun_parts_.front().disc.local(double(u[0]), double(u[1]));
      }
      return sample_sun(light, point, *on_sun);
    }
    const auto u = uniform(light);
    return sample(light, point, double(u[0]), double(u[1]));
  }

 private:
  enum class Kind { Sun, SunPart, Earth, EarthArea, Lamp, Emitters };
  struct Light {
    Kind kind;
    std::size_t group;
    std::size_t index = 0;  // of the lamp, emitter set or Sun of a sky in parts
    bool fixed = false;     // distributed: always the same (u, v)
    double u = 0.5, v = 0.5;
    double share = 1.0;                          // of the source's light
    const scenes::FlatMirror* mirror = nullptr;  // of an image
  };
  // Lamps without size, or their images: one ray to a point, within the lamp's cone and, for
  // images, through the mirror.
  struct DeltaLight {
    bool is_delta = false;       // whether the light has no size
    double field_cosine = -2.0;  // spot lamps: of half the field angle; others shine in all
                                 // directions
    double lamp_height_m = 0.0;  // above the mirror
    Vec3 position{0.0}, axis{0.0};
  };
  struct Cluster {
    scenes::LightTree tree;
    std::vector<std::size_t> lights;  // lights by their numbers in the tree
  };
  // Lights by one mirror, or directly.
  struct MirrorLights {
    const scenes::FlatMirror* mirror = nullptr;
    std::vector<std::size_t> lights;  // that reach the mirror
    std::vector<std::size_t> always;  // of these, the ones with a certain shadow ray
  };
  [[nodiscard]] scenes::LightSample sample_sun(std::size_t light, const Vec3& point,
                                               const Vec3& place) const;
  void add_images();
  void find_mirror_lights();
  [[nodiscard]] bool reaches_mirror(std::size_t light) const;
  [[nodiscard]] scenes::LightSample sample_straight(const Light& light, const Vec3& point, double u,
                                                    double v) const;
  void add(Light light, int copies);
  void gather_clusters(bool per_group);
  void find_delta_lights();
  // choose() for lights by one mirror, or directly; their numbers begin at `first`.
  void choose_thrown(const MirrorLights& by, const scenes::Receiver& receiver, double u,
                     std::size_t first, std::vector<scenes::LightChoice>& chosen) const;
  [[nodiscard]] double weight(const Light& light, std::size_t stratum) const {
    return light.kind == Kind::SunPart ? sun_strata_.weight(light.group, stratum) : 1.0;
  }
  [[nodiscard]] scenes::LightTree tree_of(const std::vector<std::size_t>& lamps) const;

  const scenes::Scene& scene_;
  bool distributed_;
  std::span<const scenes::FlatMirror> mirrors_;
  std::optional<scenes::Lamp> earth_area_;
  SunStrata sun_strata_;
  std::vector<Light> lights_;  // the sources themselves, then their images
  std::size_t sources_ = 0;
  std::vector<DeltaLight> delta_lights_;     // by light
  std::vector<MirrorLights> mirror_lights_;  // directly, then by each mirror
  std::vector<std::size_t> always_;          // lights with a certain shadow ray
  std::vector<Cluster> clusters_;
  Cluster surfaces_{scenes::LightTree({}), {}};  // lamps with a visible surface, by their numbers
                                                 // in the tree
  std::vector<scenes::EmitterSet> emitters_;
  std::vector<scenes::SpotCone> cones_;  // per lamp; of spot lamps
  Rgb sun_illuminance_lx_{0.0};
  std::optional<scenes::SunDirections> sun_;
  struct SunPart {
    Rgb illuminance_lx;
    scenes::Cone disc;
    Vec3 direction;
    double angle_rad;  // angular radius, with a margin for rounding
  };
  std::vector<SunPart> sun_parts_;
  std::optional<scenes::EarthLight> earth_;
};

}  // namespace earthshine::raytrace
