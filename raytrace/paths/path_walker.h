// SPDX-License-Identifier: Apache-2.0
// Traces one light path at a time, for the path tracer (path_tracer.h has the strategies) and for
// residual paths.
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

// Data that all paths share; read only.
struct PathWorld : scenes::World {
  const LightSampler& lights;
  std::vector<bool> sampled_emitter;  // per material: shadow rays carry its light
  std::vector<std::size_t> layer;     // per light group: its image layer
  std::size_t layers = 1;
  PathSet paths = PathSet::All;
};

// Traces one path after another; one object per thread.
class PathWalker {
 public:
  explicit PathWalker(const PathWorld& world)
      : world_(world), radiance_(world.layers), shadows_(world.query) {
    if (world.scene.earth) earth_.emplace(world.scene);
  }

  // Selects the stratum of Suns (light/sun_strata.h) for the next paths.
  void select_sun_stratum(std::uint64_t first, std::uint64_t k, std::size_t half) {
    sun_stratum_ = world_.lights.sun_strata().of_sample(first, k, half);
  }

  // Radiance along one path, cd/m^2 per layer; valid until the next call. All its random numbers
  // come from `rng`.
  [[nodiscard]] std::span<const Rgb> walk(const Ray& start, base::Rng& rng);
  // Directly visible on the last walk: luminance of sources, cd/m^2, and whether there is a
  // reflecting surface.
  [[nodiscard]] double source_luminance() const { return source_luminance_; }
  [[nodiscard]] bool met_surface() const { return met_surface_; }
  // An unbiased estimate of L - L~ along a ray that left a diffuse or glossy surface and met
  // `first`; L~ is the radiance that `solution` has there. Multiplied by the MIS weight of the ray.
  [[nodiscard]] std::span<const Rgb> residual(const IncomingLight& solution, const Ray& ray,
                                              const scenes::Hit& first, const MisContext& share,
                                              base::Rng& rng);
  // Estimates the mean of L - L~ over the cosine-weighted hemisphere of a surface point by one ray.
  // (u, v) in [0, 1)^2 determine its direction, or its target on a bright patch.
  [[nodiscard]] std::span<const Rgb> residual_at(const IncomingLight& solution, const Vec3& origin,
                                                 const Vec3& normal, double u, double v,
                                                 base::Rng& rng);
  [[nodiscard]] const RayCounts& rays() const { return rays_; }

 private:
  struct Surface {
    scenes::Brdf brdf;  // normal on the side of the incoming ray
    Vec3 position;
    Vec3 outward;  // unit normal of the front
    bool shines;   // reflects and emits: false inside glass
    std::uint32_t triangle;
    double offset_m;  // of rays that leave the surface
    [[nodiscard]] const scenes::Material& material() const { return brdf.material; }
    [[nodiscard]] Vec3 lifted() const { return position + offset_m * brdf.normal; }
    [[nodiscard]] bool reflects() const { return shines && material().reflects(); }
  };

  // Radiance toward the path by one shadow ray, if nothing blocks it.
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
  bool scatter_diffusely(const IncomingLight& solution, const Vec3& origin, const Vec3& normal,
                         double u, double v);
  void follow(const IncomingLight& solution, scenes::Hit hit);
  void pass_on(const Surface& surface, bool through);
  bool shadow_rays_follow(const Surface& surface, bool through);
  void restart_segment() {  // leaves a surface that shadow rays light
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
  bool from_camera_ = true;   // by mirrors and glass only
  bool straight_ =
      true;          // } since the last restart_segment(): by straight glass and flat mirrors only,
  int mirrors_ = 0;  // } and the number of flat mirrors
  bool at_first_ = false;  // on the direct way from the camera to the first surface
  bool met_surface_ = false;
  double source_luminance_ = 0.0;
  std::size_t sun_stratum_ = 0;
  MisContext share_;               // MIS context of the last ray
  double kept_ = 1.0;              // MIS weight of the surface that it met
  bool goes_straight_on_ = false;  // passed that surface as straight glass
};

}  // namespace earthshine::raytrace
