// SPDX-License-Identifier: Apache-2.0
// Form factors between two flat polygons with occluders between them.
//
// At a point of one polygon the view of the other is exact: shadows are cut off the target, and
// Lambert's formula is applied to the visible part (or to the hidden part, which is subtracted from
// the unoccluded factor). Over the receiver the integrand is smooth except for kinks where a
// shadow's edge passes a corner of the target: 3 x 3 Gauss points in cells. The cell with the
// largest estimated error is divided across its stronger curvature until the sum of estimates is
// below the tolerance. Where kinks are parallel to the receiver's sides, as between right-angled
// bodies, cells are divided at the kinks (shadow_clip.h) and the integrand is smooth within.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/exact/occlusion/shadow_clip.h"

namespace earthshine::radiosity {

struct HiddenExchange {
  double exchange_m2 = 0.0;  // A_1 F_12
  double error_m2 = 0.0;     // estimated
  bool any_hidden = false, any_visible = false;
  int points = 0;
};

// Reuses its memory between calls; one per thread.
class HiddenFactor {
 public:
  // The polygons must be in front of each other, the blockers in front of both (heights >= 0).
  // unoccluded_m2: the exchange without blockers. Uses at most 20 000 points.
  [[nodiscard]] HiddenExchange exchange(const ConvexPolygon& first, const ConvexPolygon& second,
                                        std::span<const Blocker* const> blockers,
                                        double unoccluded_m2, double tolerance_m2, double margin_m);

 private:
  struct Quad {  // bilinear piece of the receiver in the target's frame
    Vec3 corner, ab, ad, twist;
  };
  struct Cell {
    std::size_t quad;
    double x0, x1, y0, y1;
    double value_m2, error_m2;
    bool halve_x;
    int depth;
  };

  void set_up(const ConvexPolygon& receiver, const ConvexPolygon& target,
              std::span<const Blocker* const> blockers, double margin_m);
  void put_largest_shadow_first(const Vec3& from, double margin_m);
  [[nodiscard]] double at(const Quad& quad, double x, double y);
  void sample(Cell& cell);
  void refine();

  ShadowClip clip_;
  ShadowKinks kinks_;
  std::optional<TargetFrame> frame_;
  ConvexPolygon target_;  // in its own frame
  std::vector<Blocker> blockers_, ordered_;
  std::vector<std::pair<double, std::size_t>> shadows_;  // visible share, blocker
  std::vector<Quad> quads_;
  std::vector<Cell> cells_;  // a heap by error
  Vec3 normal_{0.0};
  bool add_hidden_ = false;
  double tolerance_m2_ = 0.0;
  HiddenExchange result_;
};

}  // namespace earthshine::radiosity
