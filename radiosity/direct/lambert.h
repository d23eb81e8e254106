// SPDX-License-Identifier: Apache-2.0
// Lambert's formula: cosine-weighted share of a point's view that a polygon covers,
//   f = 1/(2 pi) sum over edges of angle_k  n . (a_k x b_k) / |a_k x b_k|,
// a_k, b_k from the point to the ends of edge k, angle_k between them. Exact for any closed
// polygon, or a set of polygons with oriented edges.
#pragma once

#include <array>
#include <cmath>

#include "base/units.h"

namespace earthshine::radiosity {

// atan2(y, x) for y >= 0, accurate to a few rounding units and without branches, so that the
// compiler can vectorise it. Rational approximation: Moshier, Cephes, atan.c (range reduced to
// tan(pi/8)).
[[nodiscard]] inline double angle_of(double y, double x) {
  const double flat = std::abs(x);
  const double low = y < flat ? y : flat;
  const double high = y < flat ? flat : y;
  const bool steep = low > 0.41421356237309503 * high;
  const double top = steep ? low - high : low;
  const double bottom = steep ? low + high : high;
  const double t = bottom > 0.0 ? top / bottom : 0.0;
  const double z = t * t;
  const double p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z -
                     7.500855792314704667340e1) *
                        z -
                    1.228866684490136173410e2) *
                       z -
                   6.485021904942025371773e1;
  const double q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
                     4.328810604912902668951e2) *
                        z +
                    4.853903996359136964868e2) *
                       z +
                   1.945506571482613964425e2;
  const double small = t + t * (z * p / q) + (steep ? 0.25 * base::pi : 0.0);
  const double quarter = y < flat ? small : 0.5 * base::pi - small;
  return x < 0.0 ? base::pi - quarter : quarter;
}

// Collects edges for one point and evaluates several at a time.
class LambertSum {
 public:
  // normal: unit normal of the receiver.
  explicit LambertSum(const Vec3& normal) : normal_(normal) {}

  // Adds an edge from a to b, both relative to the point.
  void add(const Vec3& a, const Vec3& b) {
    if (count_ == width) work_off();
    ax_[count_] = a.x, ay_[count_] = a.y, az_[count_] = a.z;
    bx_[count_] = b.x, by_[count_] = b.y, bz_[count_] = b.z;
    ++count_;
  }
  // f, positive for contours that are counter-clockwise about a normal toward the point.
  [[nodiscard]] double share() {
    work_off();
    return -sum_ / (2.0 * base::pi);
  }

 private:
  static constexpr std::size_t width = 8, step = 4;

  void work_off() {
    // Pads with edges of length 0: their cross product, and thus their share, is 0.
    const std::size_t full = (count_ + step - 1) / step * step;
    for (std::size_t k = count_; k < full; ++k) {
      ax_[k] = bx_[k] = 1.0;
      ay_[k] = by_[k] = az_[k] = bz_[k] = 0.0;
    }
    for (std::size_t first = 0; first < full; first += step) {
      std::array<double, step> part;
      for (std::size_t lane = 0; lane < step; ++lane) {
        const std::size_t k = first + lane;
        const double cx = ay_[k] * bz_[k] - az_[k] * by_[k];
        const double cy = az_[k] * bx_[k] - ax_[k] * bz_[k];
        const double cz = ax_[k] * by_[k] - ay_[k] * bx_[k];
        const double sine = std::sqrt(cx * cx + cy * cy + cz * cz);
        const double cosine = ax_[k] * bx_[k] + ay_[k] * by_[k] + az_[k] * bz_[k];
        const double angle = angle_of(sine, cosine);
        const double projected = cx * normal_.x + cy * normal_.y + cz * normal_.z;
        part[lane] = sine > 0.0 ? angle * projected / sine : 0.0;
      }
      sum_ += (part[0] + part[1]) + (part[2] + part[3]);
    }
    count_ = 0;
  }

  Vec3 normal_;
  std::array<double, width> ax_, ay_, az_, bx_, by_, bz_;
  std::size_t count_ = 0;
  double sum_ = 0.0;
};

}  // namespace earthshine::radiosity
