// SPDX-License-Identifier: Apache-2.0
// The final gather on a grid: at the surface point behind every pixel's centre, the mean of the
// radiance that cosine-distributed rays bring (the irradiance over pi), shared by all of the
// pixel's camera samples. Irradiance varies slowly where nothing is near, so that neighbouring
// points may also share their rays (smooth()); how far is read from the rays' own lengths, as
// irradiance caching does (Ward et al. 1988).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/camera.h"
#include "raytrace/incoming_light.h"

namespace earthshine::raytrace {

inline constexpr std::size_t no_point = static_cast<std::size_t>(-1);

struct GatherPoint {
  glm::vec3 position{0.0F};  // m, relative to the camera
  float reach_m = -1.0F;     // harmonic mean length of its rays; negative: nothing gathered here
  glm::vec3 normal{0.0F};    // unit, on the camera's side
  float spacing_m = 0.0F;    // how far apart neighbouring pixels are there, across the view
  float reflectance = 0.0F;  // luminance of the surface's k_d
  float rays = 0.0F;         // that its radiance is the mean of
};

struct GatherField {
  Window window;                     // of the picture, in pixels
  std::size_t image_layers = 0;      // of radiance, per point
  std::size_t layers = 0;            // with one more, if wanted: what came straight from the sky
  std::vector<GatherPoint> points;   // row by row
  std::vector<glm::vec3> radiance;   // points * layers, cd/m^2
  std::vector<float> squared_error;  // per point, of the luminance of all image layers together
  std::uint64_t gather_rays = 0, camera_rays = 0;
  RayCounts onward;  // from mirrors and glass

  // A point whose irradiance may stand for the surface point that pixel (x, y) meets: the pixel's
  // own, or the nearest that lies on the same surface within two pixels; no_point if there is none.
  [[nodiscard]] std::size_t find(int x, int y, const glm::vec3& position,
                                 const glm::vec3& normal) const;
  [[nodiscard]] std::span<const glm::vec3> at(std::size_t point) const {
    return {&radiance[point * layers], layers};
  }
};

// Where irradiance is wanted: a point on a diffuse surface of reflectance > 0, on a side that
// shines.
struct GatherRequest {
  Vec3 position, normal;
  double reflectance = 1.0;  // luminance of k_d
};
using GatherSurface = std::function<bool(const scenes::Hit&, GatherRequest&)>;

struct GatherOptions {
  int rays = 64;  // per point, a power of two, 8 or more
  std::uint64_t seed = 1;
  std::size_t image_layers = 1;
  bool keeps_sky_apart = false;     // one more layer, see GatherField::layers
  std::function<bool()> stop = {};  // asked once per tile; true: leave the rest of the points out
  std::function<void(std::size_t done, std::size_t total)> progress = {};  // tiles; one at a time
};

// Rays are cast eight at a time from neighbouring pixels into the same cell of the hemisphere.
[[nodiscard]] GatherField gather_field(const scenes::RayQuery& query, const IncomingLight& incoming,
                                       const GatherSurface& surface, const CameraModel& camera,
                                       const Window& window, const GatherOptions& options);

// The same with other rays for some of the field's points, those with a mark: their radiance is
// replaced by that of options.rays new rays.
void gather_again(GatherField& field, const std::vector<std::uint8_t>& marks,
                  const scenes::RayQuery& query, const IncomingLight& incoming,
                  const GatherSurface& surface, const CameraModel& camera,
                  const GatherOptions& options);

// Replaces every point's radiance by the value there of a plane fitted to its neighbours' on the
// same surface, weighted by their rays and down to nothing at `share` of the reach. Linear in the
// radiance, and exact where that is linear in position. Errors are estimated from what the fits
// leave.
void smooth(GatherField& field, double share, int most_pixels);

}  // namespace earthshine::raytrace
