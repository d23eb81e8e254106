// SPDX-License-Identifier: Apache-2.0
// Cases whose value is a radiosity. Cases of a continuum have narrow patches at the point of the
// value. The remaining discretisation error was computed with exact form factors of the patches
// (crossed strings, disks) and is the model_error of the case.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/support/case_builders.h"

namespace earthshine::tests {
namespace {

bool named(const CaseRecord& r, const char* part) { return r.name.find(part) != std::string::npos; }

void radiosity(Case& c, int rays) {
  c.kind = CaseKind::Radiosity;
  c.rays = rays;
}

// Two equal facing plates: mean B = M / (1 - rho F). In open scenes balancing reduces the landed
// light by 0.09 (squares) to 0.21 (disks) over the rays per patch (docs/theory.md).
double balancing_error(const Case& c, double rho) {
  return rho * c.record.value * c.record.value * 0.25 / c.rays;
}

// The faces of [0,1]^3 seen from inside, each a separate object of n x n patches, in the order z =
// 0, z = 1, x = 0, x = 1, y = 0, y = 1.
void room(int n, const std::array<std::uint32_t, 6>& material, CaseScene& s) {
  const Vec3 o(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const Vec3 corner[] = {o, z, o, x, o, y}, u[] = {x, y, y, z, z, x}, v[] = {y, x, z, y, x, z};
  for (std::size_t f = 0; f < 6; ++f) {
    s.object("face-" + std::to_string(f), material[f]);
    s.grid(corner[f], u[f], v[f], n, n);
  }
}

void uniform_box(const CaseRecord& r, Case& c) {
  const std::uint32_t m = c.made.material(r.at("rho"), r.at("E"));
  room(4, {m, m, m, m, m, m}, c.made);
  radiosity(c, 256);
}

void six_faces(const CaseRecord& r, Case& c) {
  std::array<std::uint32_t, 6> m{};
  for (std::size_t f = 0; f < 6; ++f) m[f] = c.made.material(r.at("rho", f), r.at("E", f));
  room(1, m, c.made);
  constexpr const char* face[] = {"_z0", "_z1", "_x0", "_x1", "_y0", "_y1"};
  while (!named(r, face[c.from])) ++c.from;
  radiosity(c, 65536);
}

void shining_ceiling(const CaseRecord& r, Case& c) {
  const std::uint32_t dark = c.made.material(r.at("rho")), lit = c.made.material(r.at("rho"), 1.0);
  const int n = int(r.at("n"));
  room(n, {dark, lit, dark, dark, dark, dark}, c.made);
  // The walls are equal: each of them has the mean of all.
  c.from = named(r, "floor_mean") ? 0 : named(r, "ceiling_mean") ? 1 : 2;
  radiosity(c, n > 4 ? 2048 : 8192);
}

// A polygonal sphere of `around` meridians; its zones have the given shares of its area. F_ij = A_j
// / A of the sphere holds for its facets to second order in their angles.
class ZonedSphere {
 public:
  static constexpr int around = 64;

  explicit ZonedSphere(const std::vector<double>& share) {
    // Every zone but the last gets its area; bisection finds the total area for which the last one
    // fits.
    double low = 2.0 * base::pi, high = 4.0 * base::pi;
    for (int step = 0; step < 60; ++step) {
      const double total = 0.5 * (low + high);
      cut(share, total);
      const double left = band_sum(ends_[share.size() - 1], base::pi, bands(share.size() - 1));
      (left > share.back() * total ? low : high) = total;
    }
  }

  // Zone k, front inward.
  void add(std::size_t k, CaseScene& s) const {
    const int n = bands(k);
    for (int band = 0; band < n; ++band) {
      const double a0 = at(k, band), a1 = at(k, band + 1);
      const bool last = k + 2 == ends_.size() && band + 1 == n;
      s.ring(around, k + band == 0 ? 0.0 : std::sin(a0), -std::cos(a0), last ? 0.0 : std::sin(a1),
             -std::cos(a1));
    }
  }

 private:
  // Angles from the south pole; bands are about as wide as a meridian.
  static int bands(std::size_t zone) { return zone < 3 ? 8 : 16; }
  [[nodiscard]] double at(std::size_t k, int band) const {
    return ends_[k] + (ends_[k + 1] - ends_[k]) * band / bands(k);
  }
  static double band_sum(double from, double to, int n) {
    const double side = 2.0 * std::sin(base::pi / around), apothem = std::cos(base::pi / around);
    double sum = 0.0;
    for (int k = 0; k < n; ++k) {
      const double a0 = from + (to - from) * k / n, a1 = from + (to - from) * (k + 1) / n;
      const double r0 = std::sin(a0), r1 = std::sin(a1);
      sum += around * 0.5 * side * (r0 + r1) *
             std::hypot(std::cos(a1) - std::cos(a0), apothem * (r1 - r0));
    }
    return sum;
  }
  void cut(const std::vector<double>& share, double total) {
    ends_.assign(1, 0.0);
    for (std::size_t k = 0; k + 1 < share.size(); ++k) {
      double low = ends_.back(), high = base::pi;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (band_sum(ends_.back(), middle, bands(k)) < share[k] * total ? low : high) = middle;
      }
      ends_.push_back(0.5 * (low + high));
    }
    ends_.push_back(base::pi);
  }

  std::vector<double> ends_;
};

void sphere_zones(const CaseRecord& r, Case& c) {
  const std::vector<double>&share = r.parameters.at("zone_fractions"),
        &rho = r.parameters.at("rho");
  const ZonedSphere sphere(share);
  for (std::size_t k = 0; k < share.size(); ++k) {
    c.made.object("zone", c.made.material(rho.size() > 1 ? rho[k] : rho[0], r.at("E", k)));
    sphere.add(k, c.made);
  }
  c.from = std::size_t(r.at("zone"));
  radiosity(c, 64);
  // Measured by convergence: with half and a quarter of the angle the error falls fourfold each
  // time.
  c.model_error = rho.size() > 1 ? 7e-4 : 2e-4;
}

void two_cylinders(const CaseRecord& r, Case& c) {
  constexpr int n = 32;
  const double r1 = same_length_radius(n, r.at("k")), r2 = same_length_radius(n, 1.0);
  c.made.object("inner", c.made.material(r.at("rho1"), r.at("E1")));
  c.made.ring(n, r1, 0, r1, strip_length, true);
  c.from = c.made.object("outer", c.made.material(r.at("rho2"), r.at("E2")));
  c.made.ring(n, r2, 0, r2, strip_length);
  c.made.object("ends", c.made.mirror());
  c.made.ring(n, r1, 0, r2, 0);
  c.made.ring(n, r1, strip_length, r2, strip_length, true);
  radiosity(c, 1024);
}

// Three walls of one patch each: F = 1/2 by symmetry.
void triangular_duct(const CaseRecord& r, Case& c) {
  const double l = 3.0 * strip_length, h = std::sqrt(0.75);
  const Vec3 p[] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, h}}, along(0, l, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    c.made.object("wall", c.made.material(r.at("rho", k), r.at("E", k)));
    c.made.grid(p[k], p[(k + 1) % 3] - p[k], along, 1, 1);
  }
  c.made.object("ends", c.made.mirror());
  c.made.triangle(p[0], p[2], p[1]);
  c.made.triangle(p[0] + along, p[1] + along, p[2] + along);
  c.from = std::size_t(r.at("surface")) - 1;
  radiosity(c, 16384);
}

// Points in [0, 1], denser toward both ends.
std::vector<double> graded(int n) {
  std::vector<double> x;
  for (int k = 0; k <= n; ++k) x.push_back(0.5 * (1.0 - std::cos(base::pi * k / n)));
  return x;
}

// A value at a point needs a narrow cell there. Means do not: patches with very few ray hits reduce
// the accuracy of balanced form factors.
constexpr double narrow = 2e-4;

void two_strips(const CaseRecord& r, Case& c) {
  std::vector<double> x = graded(32);
  if (named(r, "edge")) x.insert(x.end(), {narrow, 1.0 - narrow});
  if (named(r, "centre")) {
    x.erase(x.begin() + 16);
    x.insert(x.end(), {0.4975, 0.5025});
  }
  std::sort(x.begin(), x.end());
  const std::uint32_t m = c.made.material(r.at("rho"), 1.0);
  const auto add = [&](std::size_t k) {
    c.made.level(x[k], x[k + 1], 0, strip_length, 0, true, 1, 1);
    c.made.level(x[k], x[k + 1], 0, strip_length, r.at("gap"), false, 1, 1);
  };
  const std::size_t last = x.size() - 2;
  const auto read = [&](std::size_t k) {
    return named(r, "centre") ? k == last / 2 : named(r, "edge") ? k == 0 || k == last : true;
  };
  c.from = c.made.object("read", m);
  for (std::size_t k = 0; k <= last; ++k) {
    if (read(k)) add(k);
  }
  c.made.object("rest", m);
  for (std::size_t k = 0; k <= last; ++k) {
    if (!read(k)) add(k);
  }
  c.made.object("ends", c.made.mirror());
  c.made.grid({0, 0, 0}, {0, 0, r.at("gap")}, {1, 0, 0}, 1, 1);
  c.made.grid({0, strip_length, 0}, {1, 0, 0}, {0, 0, r.at("gap")}, 1, 1);
  radiosity(c, 4096);
  c.model_error = 6e-5 + balancing_error(c, r.at("rho"));
}

void two_disks(const CaseRecord& r, Case& c) {
  constexpr int around = 24;
  std::vector<double> x = graded(24);
  if (named(r, "edge")) x.insert(x.end() - 1, 1.0 - narrow);
  const std::uint32_t m = c.made.material(r.at("rho"), 1.0);
  const std::size_t last = x.size() - 2;
  const auto read = [&](std::size_t k) {
    return named(r, "centre") ? k == 0 : named(r, "edge") ? k == last : true;
  };
  for (const bool wanted : {true, false}) {
    c.made.object(wanted ? "read" : "rest", m);
    for (std::size_t k = 0; k <= last; ++k) {
      if (read(k) != wanted) continue;
      const double inner = same_area_radius(around, x[k]),
                   outer = same_area_radius(around, x[k + 1]);
      c.made.ring(around, inner, 0, outer, 0);
      c.made.ring(around, inner, r.at("gap"), outer, r.at("gap"), true);
    }
  }
  radiosity(c, 1024);
  c.model_error = 1e-4 + balancing_error(c, r.at("rho"));
}

void two_squares(const CaseRecord& r, Case& c) {
  const int n = int(r.at("n"));
  const std::uint32_t m = c.made.material(r.at("rho"), 1.0);
  const bool corner = named(r, "corner");
  const auto at_corner = [&](int i, int j) {
    return (i == 0 || i == n - 1) && (j == 0 || j == n - 1);
  };
  for (const bool wanted : {true, false}) {
    c.made.object(wanted ? "read" : "rest", m);
    for (int k = 0; k < n * n; ++k) {
      const int i = k / n, j = k % n;
      if ((!corner || at_corner(i, j)) != wanted) continue;
      const double d = n;
      c.made.level(i / d, (i + 1) / d, j / d, (j + 1) / d, 0, true, 1, 1);
      c.made.level(i / d, (i + 1) / d, j / d, (j + 1) / d, 1, false, 1, 1);
    }
  }
  radiosity(c, n > 4 ? 4096 : 16384);
  c.model_error = balancing_error(c, r.at("rho"));
}

constexpr CaseBuilder builders[] = {{"uniform_closed_box", uniform_box},
                                    {"sphere_cavity", sphere_zones},
                                    {"infinite_concentric_cylinders", two_cylinders},
                                    {"equilateral_duct", triangular_duct},
                                    {"cube_6face", six_faces},
                                    {"cube_n1_ceiling", shining_ceiling},
                                    {"cube_n2_ceiling", shining_ceiling},
                                    {"cube_n4_ceiling", shining_ceiling},
                                    {"cube_n8_ceiling", shining_ceiling},
                                    {"two_infinite_strips", two_strips},
                                    {"two_coaxial_disks", two_disks},
                                    {"two_unit_squares", two_squares}};

}  // namespace

std::span<const CaseBuilder> radiosity_builders() { return builders; }

}  // namespace earthshine::tests
