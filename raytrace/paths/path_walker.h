// SPDX-License-Identifier: Apache-2.0
// One light path from the camera, of the path tracer (path_tracer.h says who carries what).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/numbers/random.h"
#include "raytrace/camera/camera.h"
#include "raytrace/incoming/incoming_light.h"
#include "raytrace/light/light_sampler.h"
#include "raytrace/paths/path_tracer.h"
#include "scenes/light/shadow_queue.h"
#include "scenes/reflect/brdf.h"

namespace earthshine::raytrace {

// What all paths share; read only.
struct PathWorld : scenes::World {
  const LightSampler& lights;
  std::vector<bool> sampled_emitter;  // per material: shadow rays carry its light
  std::vector<std::size_t> layer;     // of a light group: its image layer
  std::size_t layers = 1;
  PathSet paths = PathSet::All;
};

// Follows one path after another; one object per thread.
class PathWalker {
 public:
  explicit PathWalker(const PathWorld& world)
      : world_(world), radiance_(world.layers), shadows_(world.query) {
    if (world.scene.earth) earth_.emplace(world.scene);
  }

  // Which stratum of Suns (light/sun_strata.h) the paths that follow carry.
  void select_sun_stratum(std::uint64_t first, std::uint64_t k, std::size_t half) {
    sun_stratum_ = world_.lights.sun_strata().of_sample(first, k, half);
  }

  // Radiance that one path brings, cd/m^2 per layer; valid until the next call. All its random
  // numbers come from `rng`.
  [[nodiscard]] std::span<const Rgb> walk(const Ray& start, base::Rng& rng);
  // What the camera itself saw on the last walk: luminance of sources, cd/m^2, and whether there is
  // a surface that reflects.
  [[nodiscard]] double source_luminance() const { return source_luminance_; }
  [[nodiscard]] bool met_surface() const { return met_surface_; }
  // An unbiased estimate of L - L~ along a ray that left a diffuse or glossy surface and met
  // `first`; L~ is what `solution` reads there. Of rays that share with others, its part.
  [[nodiscard]] std::span<const Rgb> residual(const IncomingLight& solution, const Ray& ray,
                                              const scenes::Hit& first, const MisContext& share,
                                              base::Rng& rng);
  // The mean over the cosine-weighted hemisphere of L - L~ that arrives at a surface point, by one
  // ray; (u, v) in [0, 1)^2 choose its direction, if it is not aimed at a bright patch.
  [[nodiscard]] std::span<const Rgb> residual_at(const IncomingLight& solution, const Vec3& origin,
                                                 const Vec3& normal, double u, double v,
                                                 base::Rng& rng);
  [[nodiscard]] const RayCounts& rays() const { return rays_; }

 private:
  struct Surface {
    scenes::Brdf brdf;  // its normal on the side that the path arrives from
    Vec3 position;
    Vec3 outward;  // unit normal of the front
    bool shines;   // reflects and emits: false inside glass
    std::uint32_t triangle;
    double offset_m;  // of rays that leave it
    [[nodiscard]] const scenes::Material& material() const { return brdf.material; }
    [[nodiscard]] Vec3 lifted() const { return position + offset_m * brdf.normal; }
    [[nodiscard]] bool reflects() const { return shines && material().reflects(); }
  };

  // Radiance toward the path by one shadow ray, if nothing is in its way.
  struct Arriving {
    Rgb radiance;
    std::size_t group;
    scenes::LightKind kind;
  };

  void begin(const Ray& start, base::Rng& rng);
  std::span<const Rgb> finished();
  bool step();
  [[nodiscard]] Surface surface_at(const scenes::Hit& hit, const Vec3& position) const;
  [[nodiscard]] static bool is_black(const Surface& surface);
  void shine(const Surface& surface, const scenes::Hit& hit);
  bool survives(int bounce);
  void add(std::size_t group, const Rgb& radiance);
  void see(std::size_t group, const Rgb& radiance);
  void see_sky();
  bool see_lamp(const scenes::Hit& hit);
  void light_directly(const Surface& surface);
  bool go_on(const Surface& surface, const IncomingLight* solution);
  bool turn_diffusely(const IncomingLight& solution, const Vec3& origin, const Vec3& normal,
                      double u, double v);
  void follow(const IncomingLight& solution, scenes::Hit hit);
  void pass_on(const Surface& surface, bool through);
  bool shadow_rays_follow(const Surface& surface, bool through);
  void turn() {  // the path leaves a surface that shadow rays light
    straight_ = true;
    mirrors_ = 0;
  }
  void scatter(const Surface& surface, scenes::Brdf::Term term);

  const PathWorld& world_;
  std::optional<scenes::EarthRadiance> earth_;
  RayCounts rays_;
  base::Rng* rng_ = nullptr;  // of the current path
  std::vector<Rgb> radiance_;
  scenes::ShadowQueue<Arriving> shadows_;
  Ray ray_;
  Rgb weight_{1.0};
  bool sees_sampled_ = true;  // no shadow ray of the last surface carried the sources' light
  bool from_camera_ = true;   // by mirrors and glass alone
  bool straight_ = true;      // } since the last turn: only where shadow rays go,
  int mirrors_ = 0;           // } and by so many flat mirrors
  bool at_first_ = false;     // on the way from the camera to what it sees itself
  bool met_surface_ = false;
  double source_luminance_ = 0.0;
  std::size_t sun_stratum_ = 0;
  MisContext share_;                 // of the last ray, with those aimed at bright patches
  double kept_ = 1.0;              // its part of what the surface sends that it met
  bool goes_straight_on_ = false;  // as before that surface: through glass
};

}  // namespace earthshine::raytrace
