// SPDX-License-Identifier: Apache-2.0
// What cameras see, by a coarse grid of rays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

// Where a ray starts that goes on from a hit: off the surface, on the side of its direction.
[[nodiscard]] Vec3 leave_toward(const Scene& scene, const RayQuery& query, const Hit& hit,
                                const Vec3& direction);

// Of one camera; rays go straight on through glass, to the first surface that is none.
struct View {
  const Camera* camera = nullptr;
  std::size_t rays = 0, hits = 0, backs = 0;
  std::vector<std::size_t> hits_of, backs_of;  // by object
  // By object: of the backs, more that turn to the middle of its box than away from it.
  std::vector<std::ptrdiff_t> inner_backs_of;
  double farthest_near_m = 0.0;  // within which nine in ten rays end; infinite where fewer end
  Box seen;                      // where they end

  [[nodiscard]] bool is_blocked() const;  // by a surface right before the lens
  [[nodiscard]] double back_share() const {
    return hits == 0 ? 0.0 : static_cast<double>(backs) / static_cast<double>(hits);
  }
};

// Through a pinhole at the lens's centre. bounds: of the objects.
[[nodiscard]] View look(const Scene& scene, const RayQuery& query, const Camera& camera,
                        const std::vector<Box>& bounds);

// What is wrong with the views: backs alone, a surface right before the lens, a field of view that
// was given in radians. At most one line for each and a camera.
[[nodiscard]] std::vector<std::string> implausible_views(const Scene& scene,
                                                         const std::vector<View>& views);

// A line where all that cameras see is less than 0.1 m across: the unit was forgotten. Where no
// camera sees anything, the surfaces and the cameras count.
[[nodiscard]] std::vector<std::string> implausible_size(const Scene& scene,
                                                        const std::vector<View>& views);

}  // namespace earthshine::scenes
