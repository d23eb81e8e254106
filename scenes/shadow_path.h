// SPDX-License-Identifier: Apache-2.0
// Shadow rays of RayQuery that pass glass without refraction and reflect in flat mirrors.
#pragma once

#include "scenes/ray_query.h"

namespace earthshine::scenes {

// Continues one ray from its first hit toward the source.
class ShadowPath {
 public:
  // reach_m: length of the whole path, ending just before the source. mirror: the mirror that
  // reflects its light, or no_mirror.
  ShadowPath(const RayQuery& query, const Vec3& origin, const Vec3& direction, double reach_m,
             std::uint32_t mirror)
      : query_(query),
        origin_(origin),
        direction_(direction),
        end_(origin + reach_m * direction),
        left_m_(reach_m),
        mirror_(mirror) {}

  // Share of the source's light that arrives.
  [[nodiscard]] Rgb follow(Hit hit);

 private:
  void leave(const Hit& hit, const SpecularPaths::Face& face, bool on_front);
  void aim_again();

  const RayQuery& query_;
  Vec3 origin_, direction_;
  Vec3 end_;  // end of the path, or its image in the mirror that is still ahead
  double left_m_;
  std::uint32_t mirror_;
  Rgb share_{1.0};
};

}  // namespace earthshine::scenes
