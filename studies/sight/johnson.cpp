// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/johnson.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "raytrace/camera/camera.h"

namespace earthshine::studies {
namespace {

using Point = std::array<double, 2>;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

// Convex hull by Andrew's monotone chain; one point per corner.
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Point> hull;
  const auto half = [&](auto first, auto last) {
    const std::size_t base = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), *p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();  // the other half begins with it
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return hull;
}

// Corners of the outermost pixels of each row; their hull is the hull of all pixels.
std::vector<Point> corners_of(const std::vector<std::uint32_t>& pixels, int columns) {
  std::vector<Point> corners;
  const auto add = [&](std::uint32_t pixel, double side) {
    const double x = static_cast<double>(pixel % static_cast<std::uint32_t>(columns)) + side;
    const double y = static_cast<double>(pixel / static_cast<std::uint32_t>(columns));
    corners.push_back({x, y});
    corners.push_back({x, y + 1.0});
  };
  const auto row = [&](std::size_t i) { return pixels[i] / static_cast<std::uint32_t>(columns); };
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i == 0 || row(i) != row(i - 1)) add(pixels[i], 0.0);
    if (i + 1 == pixels.size() || row(i) != row(i + 1)) add(pixels[i], 1.0);
  }
  return corners;
}

struct Strip {
  double width = 0.0;
  Point normal{1.0, 0.0};
  double low = 0.0;  // of normal * point
};

// One side of the narrowest strip is along an edge of the hull.
Strip narrowest_strip(const std::vector<Point>& hull) {
  Strip best;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const Point normal{(a[1] - b[1]) / length, (b[0] - a[0]) / length};
    double width = 0.0;
    for (const Point& p : hull) {
      width = std::max(width, normal[0] * (p[0] - a[0]) + normal[1] * (p[1] - a[1]));
    }
    if (i == 0 || width < best.width) {
      best = {width, normal, normal[0] * a[0] + normal[1] * a[1]};
    }
  }
  return best;
}

double log_threshold_of_cones(double x) {
  if (x <= -2.6) return -0.72;
  if (x >= 1.9) return x - 1.255;
  return std::pow(0.249 * x + 0.65, 2.7) - 0.72;
}

double log_threshold_of_rods(double x) {
  if (x <= -3.94) return -2.86;
  if (x >= -1.44) return x - 0.395;
  return std::pow(0.405 * x + 1.6, 2.18) - 2.86;
}

// Limited to a luminance where the laws are constant, so that no logarithm is infinite.
double log_luminance(double luminance) { return std::log10(std::max(luminance, 1e-12)); }

}  // namespace

double johnson_probability(double cycles, double needed) {
  const double r = cycles / needed;
  if (!(r > 0.0)) return 0.0;
  // r^q / (1 + r^q) without overflow.
  return 1.0 / (1.0 + std::exp(-(2.7 + 0.7 * r) * std::log(r)));
}

Probability johnson_probability(double cycles, const CyclesNeeded& needed) {
  return {johnson_probability(cycles, needed.detect), johnson_probability(cycles, needed.recognise),
          johnson_probability(cycles, needed.identify)};
}

Extent least_extent(const std::vector<std::uint32_t>& pixels, const scenes::Camera& camera,
                    int columns, int rows) {
  const raytrace::CameraModel model = raytrace::make_camera_model(camera, columns, rows);
  // Columns in heights of pixels, so that lengths compare in all directions.
  const double aspect = model.pixel_aspect();
  std::vector<Point> corners = corners_of(pixels, columns);
  for (Point& corner : corners) corner[0] *= aspect;
  const Strip strip = narrowest_strip(hull_of(std::move(corners)));
  Point centre{0.0, 0.0};
  for (const std::uint32_t pixel : pixels) {
    centre[0] += static_cast<double>(pixel % static_cast<std::uint32_t>(columns)) + 0.5;
    centre[1] += static_cast<double>(pixel / static_cast<std::uint32_t>(columns)) + 0.5;
  }
  const double count = static_cast<double>(pixels.size());
  centre[0] *= aspect / count;
  centre[1] /= count;
  const double disc = 2.0 * std::sqrt(count * aspect / base::pi);
  Extent extent;
  extent.pixels = std::min(strip.width, disc);
  extent.direction_rad = std::atan2(strip.normal[1], strip.normal[0]);
  double from = strip.low - (strip.normal[0] * centre[0] + strip.normal[1] * centre[1]);
  if (disc < strip.width) from = -0.5 * disc;
  const auto toward = [&](double offset) {
    return model
        .ray((centre[0] + offset * strip.normal[0]) / aspect, centre[1] + offset * strip.normal[1],
             0.0, 0.0)
        .direction;
  };
  const Vec3 a = toward(from), b = toward(from + extent.pixels);
  extent.angle_deg = base::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
  return extent;
}

double threshold_difference(double luminance) {
  const double x = log_luminance(luminance);
  return std::pow(10.0, std::min(log_threshold_of_cones(x), log_threshold_of_rods(x)));
}

double acuity_cycles_per_deg(double luminance) {
  return std::max(0.0, 17.25 * std::atan(1.4 * log_luminance(luminance) + 0.35) + 25.72);
}

double seeing_probability(double ratio, const EyeOptions& options) {
  if (!(ratio > 0.0)) return 0.0;
  return 1.0 - std::exp2(-std::pow(ratio, options.slope));
}

}  // namespace earthshine::studies
