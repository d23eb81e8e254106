// SPDX-License-Identifier: Apache-2.0
// The visible parts of a surface that get direct light, by source, from shadow rays of surface
// points. Glass casts a shadow like any other surface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/light/emitters.h"
#include "scenes/ray_query.h"
#include "studies/targets/target_view.h"

namespace earthshine::studies {

struct SeenPoint {
  Vec3 position{0.0};
  Vec3 normal{0.0};          // unit, on the side that the camera sees
  double reflectance = 0.0;  // diffuse, of luminance; 0 on the black back of a surface
  double as_front = 0.0;     // on a black back: reflectance of its front
  Rgb diffuse{0.0};          // reflectance in colour
  Rgb emitted{0.0};          // emission, cd/m^2
  std::uint32_t material = 0;
  double offset_m = 0.0;  // of rays that leave it
  [[nodiscard]] Vec3 lifted() const { return position + offset_m * normal; }
};

// First hits of the rays through the centres of at most `most` of the pixels, spread evenly over
// them. pixels: indices into the camera's picture of columns x rows.
[[nodiscard]] std::vector<SeenPoint> seen_points(const scenes::Scene& scene,
                                                 const scenes::RayQuery& query,
                                                 const scenes::Camera& camera, int columns,
                                                 int rows, std::span<const std::uint32_t> pixels,
                                                 std::size_t most = 2000);

// Direct light of a source at the points. Masks have an entry per point, 1 or 0.
struct Reach {
  std::vector<std::uint8_t> lit;     // gets light from it
  std::vector<std::uint8_t> facing;  // would get light without occluders
  // Mean luminance by its direct light, cd/m^2, diffuse: actual, and without occluders.
  double luminance = 0.0, unshadowed = 0.0;
  double on_back = 0.0;  // additional luminance if black backs reflected like their fronts
  // The occluders, and the numbers of blocked rays: most first.
  struct Shadow {
    std::uint32_t object = 0;
    std::size_t rays = 0;
  };
  std::vector<Shadow> shadows;
};

// A distant source with the illuminance `illuminance_lx` on a plate facing it: the Sun (without
// dimming by the Earth, which the caller applies). direction: unit, toward it.
[[nodiscard]] Reach reach_of_direction(const scenes::Scene& scene, const scenes::RayQuery& query,
                                       std::span<const SeenPoint> points, const Vec3& direction,
                                       double illuminance_lx);

// A lamp, by `samples` of its points each; lit: by any of them.
[[nodiscard]] Reach reach_of_lamp(const scenes::Scene& scene, const scenes::RayQuery& query,
                                  std::span<const SeenPoint> points, const scenes::Lamp& lamp,
                                  int samples = 4);

// The emitting surfaces of a material.
[[nodiscard]] Reach reach_of_emitters(const scenes::Scene& scene, const scenes::RayQuery& query,
                                      std::span<const SeenPoint> points,
                                      const scenes::EmitterSet& emitters, int samples = 4);

// The Earth, by `directions` fixed directions of equal solid angle over its disc, without its night
// side; lit: by any of them.
[[nodiscard]] Reach reach_of_earth(const scenes::Scene& scene, const scenes::RayQuery& query,
                                   std::span<const SeenPoint> points, int directions = 64);
// Objects that shadow rays from points to the whole of the Earth's disc hit first, lit or not.
struct EarthBlockers {
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> object;  // by point and direction
};
[[nodiscard]] EarthBlockers blockers_of_earth(const scenes::Scene& scene,
                                              const scenes::RayQuery& query,
                                              std::span<const SeenPoint> points,
                                              const scenes::Earth& earth, int directions);

// reach_of_earth for another Earth and Sun than the scene's. known: blockers for these points,
// directions and position of the Earth; null: casts rays to the lit part of the disc.
[[nodiscard]] Reach reach_of_earth(const scenes::Scene& scene, const scenes::RayQuery& query,
                                   std::span<const SeenPoint> points, const scenes::Earth& earth,
                                   const std::optional<scenes::Sun>& sun, int directions = 64,
                                   const EarthBlockers* known = nullptr);

// Share of the points that are set in the mask; 0 without points.
[[nodiscard]] double share_of(const std::vector<std::uint8_t>& mask);

}  // namespace earthshine::studies
