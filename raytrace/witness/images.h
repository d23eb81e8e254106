// SPDX-License-Identifier: Apache-2.0
// Images of sources in the picture: directly visible, in mirrors, and as highlights; and spots lit
// by narrow beams.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/shade/shading.h"
#include "raytrace/witness/spot_map.h"

namespace earthshine::raytrace {

// A source as a disc or a point; a distant source as a direction.
struct WitnessSource {
  Vec3 middle{0.0};  // distant: unit direction toward it
  Vec3 normal{0.0};  // of a disc
  double area_m2 = 0.0, radius_m = 0.0;
  double luminance = 0.0;  // cd/m^2, of its surface; 0: a point
  const scenes::Lamp* lamp = nullptr;
  bool is_distant = false, is_two_sided = false;
  double angle_rad = 0.0;       // distant: angular radius
  double illuminance_lx = 0.0;  // distant

  // Unoccluded illuminance of a plane at `point` that faces the source, lx.
  [[nodiscard]] double illuminance(const Vec3& point) const;
};

// Data that the parts of the witness share: sources, camera, and a ray counter.
class WitnessScene {
 public:
  // least: spots that add less to a pixel, cd/m^2, are omitted. The search ends when stop() returns
  // true.
  WitnessScene(const ShadingScene& shared, const CameraModel& camera, double least,
               std::function<bool()> stop);

  const ShadingScene& shared;
  const CameraModel& camera;
  const double least;
  // Suns and lamps, then emitting triangles.
  [[nodiscard]] std::span<const WitnessSource> sources() const { return sources_; }
  [[nodiscard]] bool stops() const { return stop_ && stop_(); }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  // A spot with the film position, radius and blur of a disc at `point`.
  [[nodiscard]] Spot spot_at(const Vec3& point, double radius_m) const;
  [[nodiscard]] scenes::Hit closest(const Vec3& from, const Vec3& direction) {
    ++rays_;
    return shared.query.closest(from, direction);
  }
  // Transmittance from one place to a source, or the camera, through straight glass and by that
  // flat mirror.
  [[nodiscard]] double share(const Vec3& from, const Vec3& direction, double reach_m,
                             std::uint32_t mirror = scenes::no_mirror);

 private:
  std::function<bool()> stop_;
  std::vector<WitnessSource> sources_;
  std::uint64_t rays_ = 0;
};

// Adds to `images` the visible images of sources that are smaller than a pixel, direct and in
// mirrors; and to `lit` highlights and spots of narrow beams.
void add_images(WitnessScene& scene, SpotMap& images, SpotMap& lit);

}  // namespace earthshine::raytrace
