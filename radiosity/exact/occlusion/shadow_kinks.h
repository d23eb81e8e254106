// SPDX-License-Identifier: Apache-2.0
// Where on a receiver the view of a target past blockers has kinks: a point crosses a plane through
// two parallel edges, of which one passes behind the other there. Only planes that cut the
// receiver parallel to one of its sides are found; between right-angled bodies these are all.
#pragma once

#include <span>
#include <vector>

#include "radiosity/exact/occlusion/shadow_clip.h"

namespace earthshine::radiosity {

class ShadowKinks {
 public:
  // The receiver is corner + x ab + y ad, x and y in [0, 1]. All in the target's frame.
  void find(const Vec3& corner, const Vec3& ab, const Vec3& ad, const TargetFrame& frame,
            const ConvexPolygon& target, std::span<const Blocker> blockers);
  void clear();

  // Where to split [low, high]: at the kink nearest to the middle, in the middle if there is none.
  [[nodiscard]] double split_x(double low, double high) const { return split(at_x_, low, high); }
  [[nodiscard]] double split_y(double low, double high) const { return split(at_y_, low, high); }

 private:
  struct Point {  // an edge seen along its own direction
    double across, towards;
  };

  struct Lookout {
    Vec3 corner, along, normal, across;
    double side_m, along_m;
  };

  void find(const Vec3& corner, const Vec3& side, const Vec3& along, const TargetFrame& frame,
            const ConvexPolygon& target, std::span<const Blocker> blockers,
            std::vector<double>& kinks);
  static void collect(const Vec3& from, const Vec3& to, const Lookout& lookout,
                      std::vector<Point>& points);
  [[nodiscard]] static double split(const std::vector<double>& kinks, double low, double high);

  std::vector<double> at_x_, at_y_;
  std::vector<Point> of_target_, of_blockers_;
};

}  // namespace earthshine::radiosity
