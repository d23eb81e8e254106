// SPDX-License-Identifier: Apache-2.0
// The sources that are reached by shadow rays, in one list.
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

// A source with one shadow ray per sample; (u, v) choose the point on it where it has extent.
class LightSampler {
 public:
  // Radiosity and None: each source once, sampled at random. Distributed: wide sources are replaced
  // by `distributed_lights` fixed points or directions of equal share, the same for every pixel;
  // the Earth by points of earth_area (distributed_area.h), or by directions to its disc.
  // per_group: every light group gets an image of its own, so that lamps are chosen within each and
  // the Suns of a sky in parts take turns.
  // mirrors: flat ones, that throw each source's light a second time; not of distributed lights.
  LightSampler(const scenes::World& world, Indirect indirect, int distributed_lights,
               bool per_group = false, std::optional<scenes::Lamp> earth_area = std::nullopt,
               std::span<const scenes::FlatMirror> mirrors = {});

  // Adds the lights that get a shadow ray at the receiver: of few lamps all, of many those that
  // matter, with weight 1, and some of the others by chance, with weight 1 / probability
  // (scenes/light/light_tree.h), for u uniform in [0, 1). Everything that is no lamp is always
  // among them, and so is every one of the distributed lights, whose number is the point of having
  // them, all Suns too.
  void choose(const scenes::Receiver& receiver, double u,
              std::vector<scenes::LightChoice>& chosen) const;

  [[nodiscard]] const SunStrata& turns() const { return turns_; }

  // The lamp whose shining surface a ray meets first, nearer than nearer_than_m.
  struct SeenLamp {
    std::size_t lamp;  // of the scene
    scenes::LampHit hit;
  };
  [[nodiscard]] std::optional<SeenLamp> seen_lamp(const Vec3& origin, const Vec3& direction,
                                                  double nearer_than_m) const;

  // The lights themselves, then their images in each mirror.
  [[nodiscard]] std::size_t count() const { return lights_.size(); }
  [[nodiscard]] std::size_t group(std::size_t light) const { return lights_[light].group; }
  [[nodiscard]] scenes::LightKind kind(std::size_t light) const;
  // False where no sample can reach a surface that faces `normal`, as far as it is known without
  // one: a Sun below the horizon, a lamp behind the surface or not turned to it, one whose image is
  // not seen in the mirror from there.
  [[nodiscard]] bool may_reach(std::size_t light, const Vec3& point, const Vec3& normal) const;
  // Whether (u, v) of sample() choose anything: not of lamps without size.
  [[nodiscard]] bool has_extent(std::size_t light) const { return !one_rays_[light].is_delta; }
  // Where a lamp without size is that shines straight, or nothing.
  [[nodiscard]] const Vec3* lamp_point(std::size_t light) const {
    return light < sources_ && one_rays_[light].is_delta ? &one_rays_[light].position : nullptr;
  }
  // visit(light) for each that may reach such a surface, but for the Suns of other turns.
  template <class Visit>
  void each_that_may_reach(const Vec3& point, const Vec3& normal, std::size_t turn,
                           const Visit& visit) const {
    for (const Throws& throws : throws_) {
      if (throws.mirror != nullptr && throws.mirror->height_m(point) <= 0.0) continue;
      for (const std::size_t light : throws.lights) {
        if (weight(lights_[light], turn) <= 0.0) continue;
        if (may_reach(light, point, normal)) visit(light);
      }
    }
  }
  [[nodiscard]] scenes::LightSample sample(std::size_t light, const Vec3& point, double u,
                                           double v) const;
  // The Suns of a sky in parts have discs of one size, so that a point of one, about its middle, is
  // one of all: sun_place(u, v).
  [[nodiscard]] bool is_sun_part(std::size_t light) const {
    return lights_[light].kind == Kind::SunPart;
  }
  [[nodiscard]] Vec3 sun_place(double u, double v) const {
    return sun_parts_.front().disc.local(u, v);
  }
  [[nodiscard]] scenes::LightSample sample_sun(std::size_t light, const Vec3& point,
                                               const Vec3& place) const;

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
  // What lamps without size, or their images, send to a point: one ray, within the lamp's cone and
  // off where the mirror is.
  struct OneRay {
    bool is_delta = false;       // that the light is
    double field_cosine = -2.0;  // spot lamps: of half their field; others shine all round
    double lamp_height_m = 0.0;  // over the mirror
    Vec3 position{0.0}, axis{0.0};
  };
  struct Cluster {
    scenes::LightTree tree;
    std::vector<std::size_t> lights;  // of the tree's numbers
  };
  // What comes by one mirror, or straight.
  struct Throws {
    const scenes::FlatMirror* mirror = nullptr;
    std::vector<std::size_t> lights;  // that reach it
    std::vector<std::size_t> always;  // of these, those that are not left to chance
  };
  void add_images();
  void find_throws();
  [[nodiscard]] bool reaches_mirror(std::size_t light) const;
  [[nodiscard]] scenes::LightSample sample_straight(const Light& light, const Vec3& point, double u,
                                                    double v) const;
  void add(Light light, int copies);
  void gather_clusters(bool per_group);
  void find_one_rays();
  // choose() of what comes by one mirror, or straight; the lights' numbers there begin at `first`.
  void choose_thrown(const Throws& throws, const scenes::Receiver& receiver, double u,
                     std::size_t first, std::vector<scenes::LightChoice>& chosen) const;
  [[nodiscard]] double weight(const Light& light, std::size_t turn) const {
    return light.kind == Kind::SunPart ? turns_.weight(light.group, turn) : 1.0;
  }
  [[nodiscard]] scenes::LightTree tree_of(const std::vector<std::size_t>& lamps) const;

  const scenes::Scene& scene_;
  bool distributed_;
  std::span<const scenes::FlatMirror> mirrors_;
  std::optional<scenes::Lamp> earth_area_;
  SunStrata turns_;
  std::vector<Light> lights_;  // the sources themselves, then their images
  std::size_t sources_ = 0;
  std::vector<OneRay> one_rays_;     // by number of the light
  std::vector<Throws> throws_;       // straight, then by each mirror
  std::vector<std::size_t> always_;  // lights that are not left to chance
  std::vector<Cluster> clusters_;
  Cluster surfaces_{scenes::LightTree({}), {}};  // lamps that a ray can meet, by their number there
  std::vector<scenes::EmitterSet> emitters_;
  std::vector<scenes::SpotCone> cones_;  // per lamp; of spots
  Rgb sun_illuminance_lx_{0.0};
  std::optional<scenes::SunDirections> sun_;
  struct SunPart {
    Rgb illuminance_lx;
    scenes::Cone disc;
    Vec3 direction;
    double angle_rad;  // of its radius, and rounding
  };
  std::vector<SunPart> sun_parts_;
  std::optional<scenes::EarthLight> earth_;
};

}  // namespace earthshine::raytrace
