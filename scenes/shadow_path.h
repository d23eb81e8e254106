// SPDX-License-Identifier: Apache-2.0
// RayQuery's shadow rays: through glass that does not bend light, off flat mirrors.
#pragma once

#include "scenes/ray_query.h"

namespace earthshine::scenes {

// Goes on along one ray from its first hit, toward the source.
class ShadowPath {
 public:
  // reach_m: along all of the way, to short of the source; mirror: that throws its light, or
  // no_mirror.
  ShadowPath(const RayQuery& query, const Vec3& origin, const Vec3& direction, double reach_m,
             std::uint32_t mirror)
      : query_(query),
        origin_(origin),
        direction_(direction),
        end_(origin + reach_m * direction),
        left_m_(reach_m),
        mirror_(mirror) {}

  // The share of its light that arrives.
  [[nodiscard]] Rgb follow(Hit hit);

 private:
  void leave(const Hit& hit, const SpecularPaths::Face& face, bool on_front);
  void aim_again();

  const RayQuery& query_;
  Vec3 origin_, direction_;
  Vec3 end_;  // of the way; or its image in the mirror that is still to come
  double left_m_;
  std::uint32_t mirror_;
  Rgb share_{1.0};
};

}  // namespace earthshine::scenes
