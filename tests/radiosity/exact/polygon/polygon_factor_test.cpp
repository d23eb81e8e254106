// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/polygon/polygon_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "radiosity/direct/lambert.h"

namespace earthshine::radiosity {
namespace {

ConvexPolygon quad(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return make_polygon({corner, corner + a, corner + a + b, corner + b},
                      glm::normalize(glm::cross(a, b)));
}

ConvexPolygon moved(ConvexPolygon polygon, const Vec3& by) {
  for (int k = 0; k < polygon.count; ++k) polygon.corner[static_cast<std::size_t>(k)] += by;
  return polygon;
}

double factor(const ConvexPolygon& from, const ConvexPolygon& to) {
  return exchange_m2(from, to) / area_m2(from);
}

// [x0,x1] x [y0,y1] in z = 0 and, facing it, [xi0,xi1] x [eta0,eta1] in z = height.
double parallel(double x0, double x1, double y0, double y1, double xi0, double xi1, double eta0,
                double eta1, double height) {
  return factor(quad({x0, y0, 0}, {x1 - x0, 0, 0}, {0, y1 - y0, 0}),
                quad({xi0, eta0, height}, {0, eta1 - eta0, 0}, {xi1 - xi0, 0, 0}));
}

// [x0,x1] x [y0,y1] in z = 0 and [eta0,eta1] x [xi0,xi1] (y, z) in x = 0, facing it.
double perpendicular(double x0, double x1, double y0, double y1, double xi0, double xi1,
                     double eta0, double eta1) {
  return factor(quad({x0, y0, 0}, {x1 - x0, 0, 0}, {0, y1 - y0, 0}),
                quad({0, eta0, xi0}, {0, eta1 - eta0, 0}, {0, 0, xi1 - xi0}));
}

// Common edge of length c, widths b (from) and a (to), angle phi between them.
double inclined(double phi_deg, double a, double b, double c) {
  const double phi = base::radians(phi_deg);
  return factor(quad({0, 0, 0}, {b, 0, 0}, {0, c, 0}),
                quad({0, 0, 0}, {0, c, 0}, {a * std::cos(phi), 0, a * std::sin(phi)}));
}

struct Case {
  const char* name;
  double computed, exact;
};

// All cases of rectangles in the view-factor library of the project's cases (mpmath, two methods).
// C-11, C-13: parallel; C-14, C-15: perpendicular; C-16: inclined with a common edge (Howell).
TEST(PolygonFactor, RectanglesMatchTheViewFactorLibrary) {
  const double cube = 1.0 / 16, fine = 1.0 / 24;
  const Case cases[] = {
      {"C-11 h 0.5", parallel(0, 1, 0, 1, 0, 1, 0, 1, 0.5), 0.41525328357715},
      {"C-11 h 2", parallel(0, 1, 0, 1, 0, 1, 0, 1, 2), 0.068589588818552},
      {"C-11 h 10", parallel(0, 1, 0, 1, 0, 1, 0, 1, 10), 0.0031620568387576},
      {"C-13 offset edge", parallel(0, 1, 0, 1, 1, 2, 0, 1, 1), 0.086050489152327},
      {"C-13 offset corner", parallel(0, 1, 0, 1, 1, 2, 1, 2, 1), 0.043327409574105},
      {"C-13 overlap", parallel(0, 1, 0, 1, -0.5, 2, 0.25, 0.75, 1.5), 0.1125340960737},
      {"C-13 coaxial", parallel(0, 1, 0, 1, -0.5, 1.5, -0.5, 1.5, 1), 0.51765307951553},
      {"C-13 small", parallel(.1, .2, .1, .2, .1, .2, .1, .2, .05), 0.41525328357715},
      {"C-14 1 2 .5", perpendicular(0, 2, 0, 1, 0, 0.5, 0, 1), 0.078650270505981},
      {"C-14 3 1 2", perpendicular(0, 1, 0, 3, 0, 2, 0, 3), 0.31899670147905},
      {"C-14 1 1 .1", perpendicular(0, 1, 0, 1, 0, 0.1, 0, 1), 0.043251369400686},
      {"C-15 gap", perpendicular(0.5, 1.5, 0, 1, 0.25, 1.25, 0, 1), 0.080144425956367},
      {"C-15 shifted", perpendicular(0, 1, 0, 1, 0, 1, 1, 2), 0.040592230101559},
      {"C-16 10", inclined(10, 1, 1, 1), 0.84960612496285},
      {"C-16 45", inclined(45, 1, 1, 1), 0.48334769547888},
      {"C-16 60", inclined(60, 1, 1, 1), 0.37090532115005},
      {"C-16 90", inclined(90, 1, 1, 1), 0.2000437760754},
      {"C-16 170", inclined(170, 1, 1, 1), 0.0023620566787691},
      {"C-16 60 wide", inclined(60, 2, 1, 1), 0.42997161957133},
      {"C-16 45 long", inclined(45, 1, 1, 5), 0.58843334266244},
      {"cube 4 par", parallel(0, .25, 0, .25, 0, .25, 0, .25, 1), 0.019106958038709},
      {"cube 4 perp", perpendicular(.75, 1, 0, .25, .5, .75, .75, 1), 0.0036817636762063},
      {"cube 16 perp", perpendicular(0, cube, 5 * cube, 6 * cube, 0, cube, 6 * cube, 7 * cube),
       0.040592230101559},
      {"cube 16 par", parallel(0, cube, 0, cube, 15 * cube, 1, 15 * cube, 1, 1),
       0.00016362690401092},
      {"cube 24 perp", perpendicular(23 * fine, 1, 0, fine, 23 * fine, 1, 23 * fine, 1),
       6.5878703305262e-5}};
  for (const Case& c : cases) {
    EXPECT_NEAR(c.computed, c.exact, 1e-9) << c.name;
    EXPECT_NEAR(c.computed / c.exact, 1.0, 2e-6) << c.name;
  }
}

TEST(PolygonFactor, ThinGapsLoseOnlyWhatLeavesAtTheirRim) {
  // C-11 for unit squares, X = Y = 1/h.
  const auto c11 = [](double h) {
    const double x = 1.0 / h, s = std::sqrt(1.0 + x * x);
    return 2.0 / (base::pi * x * x) *
           (std::log(std::sqrt((1 + x * x) * (1 + x * x) / (1 + 2 * x * x))) +
            2.0 * x * s * std::atan(x / s) - 2.0 * x * std::atan(x));
  };
  for (const double h : {0.1, 0.01, 1e-3, 1e-4}) {
    EXPECT_NEAR(parallel(0, 1, 0, 1, 0, 1, 0, 1, h), c11(h), 1e-9) << h;
  }
}

TEST(PolygonFactor, TouchingSquaresAtAnyAngleClosePrismsWithTheirCaps) {
  // A prism over an isosceles triangle with the angle phi at the common edge: from one flank, the
  // other flank + the base + the two caps add up to 1. All pairs touch, along edges or at corners.
  for (const double phi_deg : {5.0, 30.0, 90.0, 150.0, 175.0}) {
    const double phi = base::radians(phi_deg), c = 1.0;
    const Vec3 apex(0.0), right(1, 0, 0), left(std::cos(phi), 0, std::sin(phi)), along(0, c, 0);
    const ConvexPolygon flank = quad(apex, right, along);
    const ConvexPolygon other = quad(apex, along, left);
    const ConvexPolygon floor = quad(right, left - right, along);
    const ConvexPolygon cap = make_polygon({apex, left, right, right}, {0, 1, 0});
    const ConvexPolygon far_cap =
        make_polygon({along, along + right, along + left, along + left}, {0, -1, 0});
    const double sum =
        factor(flank, other) + factor(flank, floor) + factor(flank, cap) + factor(flank, far_cap);
    EXPECT_NEAR(sum, 1.0, 2e-9) << phi_deg;
  }
}

TEST(PolygonFactor, PartsOfATwistedPairAddUpToTheWhole) {
  // A_1 F_1(2) = sum over parts of both: the whole uses the contour, the parts use contour, Lambert
  // or area rules. Nothing is parallel or perpendicular.
  const Vec3 a(1.0, 0.1, 0.2), b(-0.2, 0.9, 0.1), c(0.1, 1.0, 0.3), d(1.1, -0.2, 0.25);
  const Vec3 from(0.1, 0.2, 0.0), to(0.2, -0.1, 0.9);
  const double whole = exchange_m2(quad(from, a, b), quad(to, c, d));
  const int n = 6;
  double sum = 0.0;
  for (int i = 0; i < n * n; ++i) {
    const ConvexPolygon part = quad(from + (i % n) / double(n) * a + (i / n) / double(n) * b,
                                    a / double(n), b / double(n));
    for (int j = 0; j < n * n; ++j) {
      sum += exchange_m2(part, quad(to + (j % n) / double(n) * c + (j / n) / double(n) * d,
                                    c / double(n), d / double(n)));
    }
  }
  EXPECT_NEAR(sum / whole, 1.0, 1e-7);
}

TEST(PolygonFactor, FarAndTinyPolygonsKeepTheirRelativeAccuracy) {
  // Point approximation cos cos A / (pi r^2): exact to (size / distance)^2 at 100 m.
  const ConvexPolygon floor = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(factor(floor, quad({0, 0, 100}, {0, 1, 0}, {1, 0, 0})) * base::pi * 1e4, 1.0, 1e-4);
  // 1 mm at the foot of the axis of a 10 m square, at the distance h: twice the differential factor
  // of the four quarters, B-3 of Howell: F = 4/(2 pi) [2 X/sqrt(1+X^2) atan(X/sqrt(1+X^2))], X = 5
  // m / h.
  for (const double h : {0.01, 1.0, 100.0}) {
    const double x = 5.0 / h, s = std::sqrt(1.0 + x * x);
    const double exact = 4.0 / base::pi * (x / s) * std::atan(x / s);
    const ConvexPolygon speck = quad({-5e-4, -5e-4, h}, {0, 1e-3, 0}, {1e-3, 0, 0});
    const ConvexPolygon wall = quad({-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
    EXPECT_NEAR(factor(speck, wall) / exact, 1.0, 1e-5) << h;
    EXPECT_NEAR(factor(wall, speck) * 1e8 / exact, 1.0, 1e-5) << h;  // areas 100 m^2 and 1 mm^2
  }
  // The small square at the wall's edge, at a right angle, sees it in at most half of its view:
  // C-14 with l = 1 mm and a much wider wall is 1/2 to a relative (1 mm / 10 m) ln.
  const ConvexPolygon foot = quad({0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0});
  const ConvexPolygon wall = quad({0, -5, 0}, {0, 10, 0}, {0, 0, 10});
  EXPECT_NEAR(factor(foot, wall), 0.5, 1e-4);
  EXPECT_NEAR(factor(wall, foot) * 1e8, factor(foot, wall), 1e-9);
}

TEST(PolygonFactor, CoplanarAndAvertedPolygonsExchangeNothingAtAll) {
  const ConvexPolygon floor = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(exchange_m2(floor, floor), 0.0);
  EXPECT_EQ(exchange_m2(floor, quad({1, 0, 0}, {1, 0, 0}, {0, 1, 0})), 0.0);
  EXPECT_EQ(exchange_m2(floor, quad({0, 0, 0}, {0, 1, 0}, {1, 0, 0})), 0.0);  // back on front
  EXPECT_EQ(exchange_m2(floor, quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0})), 0.0);
  EXPECT_EQ(exchange_m2(floor, quad({0, 0, -1}, {0, 1, 0}, {1, 0, 0})), 0.0);
}

TEST(PolygonFactor, WhatLiesBehindThePlaneIsCutOff) {
  // A wall through the floor's plane counts with its upper half only: C-14, unit squares.
  const ConvexPolygon floor = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(factor(floor, quad({0, 0, -1}, {0, 1, 0}, {0, 0, 2})), 0.2000437760754, 1e-9);
}

TEST(PolygonFactor, TrianglesWithTwinCornersCountAsTriangles) {
  const ConvexPolygon floor = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Vec3 p(0, 0, 1), q(0, 1, 1), r(1, 0, 1), s(1, 1, 1);
  const ConvexPolygon one = make_polygon({p, q, r, r}, {0, 0, -1});
  const ConvexPolygon two = make_polygon({r, q, s, s}, {0, 0, -1});
  EXPECT_EQ(one.count, 3);
  EXPECT_NEAR(factor(floor, one) + factor(floor, two), 0.19982489569838, 1e-9);
}

TEST(PolygonFactor, AMillionMetresFromTheOriginOnlyTheCoordinatesRounding) {
  // Near 1e6 m the spacing of doubles is 1.2e-10 m; the factor of touching unit squares changes by
  // about as much.
  const Vec3 far(1e6, -1e6, 1e6);
  const ConvexPolygon floor = moved(quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), far);
  const ConvexPolygon wall = moved(quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), far);
  EXPECT_NEAR(factor(floor, wall), 0.2000437760754, 1e-8);
}

TEST(PolygonFactor, AnglesAgreeWithTheStandardLibrary) {
  for (int k = 0; k <= 1000; ++k) {
    const double angle = base::pi * k / 1000.0, y = std::abs(std::sin(angle)), x = std::cos(angle);
    EXPECT_NEAR(angle_of(y, x), std::atan2(y, x), 1e-15);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
