// SPDX-License-Identifier: Apache-2.0
// Samples the cameras' views with a coarse grid of rays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

inline constexpr int most_panes_passed = 8;  // by a ray

// Start of a ray that continues from a hit: off the surface, on the side of its direction.
[[nodiscard]] Vec3 leave_toward(const Scene& scene, const RayQuery& query, const Hit& hit,
                                const Vec3& direction);

// View of one camera. Rays pass straight through glass to the first other surface.
struct View {
  const Camera* camera = nullptr;
  std::size_t rays = 0, hits = 0, backs = 0;
  std::vector<std::size_t> hits_of, backs_of;  // by object
  // By object: number of backs toward the middle of its box minus number away from it.
  std::vector<std::ptrdiff_t> inner_backs_of;
  double farthest_near_m = 0.0;  // nine of ten rays end within this; else infinite
  Box seen;                      // where they end

  [[nodiscard]] bool is_blocked() const;  // by a surface right before the lens
  [[nodiscard]] double back_share() const {
    return hits == 0 ? 0.0 : static_cast<double>(backs) / static_cast<double>(hits);
  }
};

// Pinhole view at the lens's centre. bounds: of the objects.
[[nodiscard]] View sample_view(const Scene& scene, const RayQuery& query, const Camera& camera,
                               const std::vector<Box>& bounds);

// Problems of the views: backs only, a surface directly before the lens, a field of view in
// radians. At most one line for each problem and camera.
[[nodiscard]] std::vector<std::string> implausible_views(const Scene& scene,
                                                         const std::vector<View>& views);

// A line if all visible surfaces together measure less than 0.1 m: the unit is missing. If no
// camera sees anything, surfaces and cameras are measured.
[[nodiscard]] std::vector<std::string> implausible_size(const Scene& scene,
                                                        const std::vector<View>& views);

}  // namespace earthshine::scenes
