// SPDX-License-Identifier: Apache-2.0
// The unit cube of 6 n^2 patches seen from inside, with form factors in closed form (Howell's
// catalogue, C-13 for facing and C-15 for perpendicular rectangles) and the radiosity by
// fixed-point iteration.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "radiosity/patches/patches.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {

// Sum over the corners of (-1)^{i+j+k+l} G(x_i, y_j, xi_k, eta_l), over the area of the first one.
inline double corner_sum(const std::array<double, 2>& x, const std::array<double, 2>& y,
                         const std::array<double, 2>& xi, const std::array<double, 2>& eta,
                         const std::function<double(double, double, double, double)>& g) {
  double sum = 0.0;
  for (int corner = 0; corner < 16; ++corner) {
    const int i = corner & 1, j = (corner >> 1) & 1, k = (corner >> 2) & 1, l = corner >> 3;
    const double sign = ((i + j + k + l) & 1) != 0 ? -1.0 : 1.0;
    sum += sign * g(x[std::size_t(i)], y[std::size_t(j)], xi[std::size_t(k)], eta[std::size_t(l)]);
  }
  return sum / ((x[1] - x[0]) * (y[1] - y[0]));
}

// C-13: rectangles in parallel planes at distance z.
inline double facing_rectangles(const std::array<double, 2>& x, const std::array<double, 2>& y,
                                const std::array<double, 2>& xi, const std::array<double, 2>& eta,
                                double z) {
  return corner_sum(x, y, xi, eta, [z](double a, double b, double c, double d) {
    const double u = a - c, v = b - d, p = std::hypot(u, z), q = std::hypot(v, z);
    return (v * p * std::atan(v / p) + u * q * std::atan(u / q) -
            0.5 * z * z * std::log(u * u + v * v + z * z)) /
           (2.0 * base::pi);
  });
}

// C-15: x is the first rectangle's distance from the intersection of the planes, xi the second
// one's; y and eta are along the intersection.
inline double perpendicular_rectangles(const std::array<double, 2>& x,
                                       const std::array<double, 2>& y,
                                       const std::array<double, 2>& xi,
                                       const std::array<double, 2>& eta) {
  return corner_sum(x, y, xi, eta, [](double a, double b, double c, double e) {
    const double c2 = a * a + c * c, c1 = std::sqrt(c2), d = b - e, all = c2 + d * d;
    const double arc = c1 > 0.0 ? d * c1 * std::atan(d / c1) : 0.0;
    const double logarithm = all > 0.0 ? 0.25 * (c2 - d * d) * std::log(all) : 0.0;
    return (arc - logarithm) / (2.0 * base::pi);
  });
}

class ExactCube {
 public:
  SceneBuilder builder;

  // Every patch is a separate quad. `material` returns one per face (x = 0, x = 1, y = 0 ...) and
  // cell (i, j) along the next two axes.
  ExactCube(int n,
            const std::function<std::uint32_t(SceneBuilder&, int face, int i, int j)>& material)
      : n_(n) {
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      Vec3 a(0.0), b(0.0), corner(0.0);
      a[(axis + 1) % 3] = b[(axis + 2) % 3] = 1.0 / n;
      corner[axis] = face % 2;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const Vec3 p = corner + double(i) * a + double(j) * b;
          const std::uint32_t m = material(builder, face, i, j);
          if (face % 2 == 0) {
            builder.quad(m, p, p + a, p + a + b, p + b);
          } else {
            builder.quad(m, p, p + b, p + a + b, p + a);
          }
        }
      }
    }
    tabulate();
  }

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(6 * n_ * n_); }

  // Patch k is quad k if the quads are not divided.
  [[nodiscard]] double form_factor(std::size_t from, std::size_t to) const {
    const Place p = place(from), q = place(to);
    if (p.face == q.face) return 0.0;
    if (p.face / 2 == q.face / 2)
      return facing_[index(std::abs(p.i - q.i), std::abs(p.j - q.j), 0)];
    const int axis_p = p.face / 2, axis_q = q.face / 2, common = 3 - axis_p - axis_q;
    const int away_p = distance(along(p, axis_q), q.face % 2);
    const int away_q = distance(along(q, axis_p), p.face % 2);
    return perpendicular_[index(away_p, away_q, std::abs(along(p, common) - along(q, common)))];
  }

  // B = source + rho F B.
  [[nodiscard]] std::vector<double> radiosity(const std::vector<double>& source, double rho) const {
    std::vector<float> matrix(count() * count());
    for (std::size_t i = 0; i < count(); ++i) {
      for (std::size_t j = 0; j < count(); ++j) {
        matrix[i * count() + j] = static_cast<float>(form_factor(i, j));
      }
    }
    double mean_source = 0.0;
    for (const double m : source) mean_source += m / double(count());
    // A start at the mean leaves only differences, which converge fast for any rho.
    std::vector<double> b(count(), mean_source / (1.0 - rho));
    for (int sweep = 0; sweep < 60; ++sweep) {
      std::vector<double> next(count());
      for (std::size_t i = 0; i < count(); ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < count(); ++j) sum += double(matrix[i * count() + j]) * b[j];
        next[i] = source[i] + rho * sum;
      }
      double mean = 0.0;
      for (const double x : next) mean += x / double(count());
      // The mean satisfies mean = mean_source + rho mean exactly.
      for (double& x : next) x += mean_source / (1.0 - rho) - mean;
      b = next;
    }
    return b;
  }

 private:
  struct Place {
    int face, i, j;
  };
  [[nodiscard]] Place place(std::size_t patch) const {
    const int k = static_cast<int>(patch);
    return {k / (n_ * n_), k / n_ % n_, k % n_};
  }
  [[nodiscard]] static int along(const Place& p, int axis) {
    return axis == (p.face / 2 + 1) % 3 ? p.i : p.j;
  }
  [[nodiscard]] int distance(int cell, int far_side) const {
    return far_side != 0 ? n_ - 1 - cell : cell;
  }
  [[nodiscard]] std::size_t index(int a, int b, int c) const {
    return static_cast<std::size_t>((a * n_ + b) * n_ + c);
  }
  void tabulate() {
    const double h = 1.0 / n_;
    const auto span = [h](int k) { return std::array<double, 2>{k * h, (k + 1) * h}; };
    const auto size = static_cast<std::size_t>(n_ * n_ * n_);
    facing_.assign(size, 0.0);
    perpendicular_.assign(size, 0.0);
    for (int a = 0; a < n_; ++a) {
      for (int b = 0; b < n_; ++b) {
        facing_[index(a, b, 0)] = facing_rectangles(span(0), span(0), span(a), span(b), 1.0);
        for (int c = 0; c < n_; ++c) {
          perpendicular_[index(a, b, c)] =
              perpendicular_rectangles(span(a), span(0), span(b), span(c));
        }
      }
    }
  }

  int n_;
  std::vector<double> facing_, perpendicular_;
};

}  // namespace earthshine::tests
