// SPDX-License-Identifier: Apache-2.0
// One light path from the camera, of the path tracer (path_tracer.h says who carries what).
#pragma once

#include <span>
#include <vector>

#include "base/random.h"
#include "raytrace/camera.h"
#include "raytrace/light_sampler.h"
#include "raytrace/path_tracer.h"

namespace earthshine::raytrace {

// What all paths share; read only.
struct PathWorld {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const scenes::Effects& effects;
  const scenes::RayQuery& query;
  const LightSampler& lights;
  std::vector<Rgb> spread;            // per material: scenes/spread_reflectance.h
  std::vector<bool> sampled_emitter;  // per material: shadow rays carry its light
  std::vector<std::size_t> layer;     // of a light group: its image layer
  std::size_t layers = 1;
  PathSet paths = PathSet::All;
};

// Follows one path after another; one object per thread.
class PathWalker {
 public:
  explicit PathWalker(const PathWorld& world) : world_(world), radiance_(world.layers) {}

  // Radiance that one path brings, cd/m^2 per layer; valid until the next call. All its random
  // numbers come from `rng`.
  [[nodiscard]] std::span<const Rgb> walk(const Ray& start, base::Rng& rng);
  [[nodiscard]] const RayCounts& rays() const { return rays_; }

 private:
  struct Surface;

  bool step();
  bool survives(int bounce);
  void add(std::size_t group, const Rgb& radiance);
  void see_sky();
  bool see_lamp(const scenes::Hit& hit);
  void light_directly(const Surface& surface);
  bool go_on(const Surface& surface);
  void pass_on(const Surface& surface, bool through);
  void scatter(const Surface& surface, bool by_lobe);

  const PathWorld& world_;
  RayCounts rays_;
  base::Rng* rng_ = nullptr;  // of the current path
  std::vector<Rgb> radiance_;
  Ray ray_;
  Rgb weight_{1.0};
  bool sees_sampled_ = true;  // no shadow ray of the last surface carried the sources' light
  bool from_camera_ = true;   // by mirrors and glass alone
  bool glossy_ = true;        // surfaces still have their lobe
};

}  // namespace earthshine::raytrace
