// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky_cells.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {
namespace {

using base::pi;

// Numbers of sectors in proportion to `spans`, at least one per ring, about `wanted` in total.
std::vector<std::size_t> share_out(const std::vector<double>& spans, std::size_t wanted) {
  double sum = 0.0;
  for (const double span : spans) sum += span;
  std::vector<std::size_t> sectors;
  for (const double span : spans) {
    const double share = span / sum * static_cast<double>(wanted);
    sectors.push_back(static_cast<std::size_t>(std::max(1.0, std::round(share))));
  }
  return sectors;
}

}  // namespace

SkyCells::SkyCells(const Vec3& axis, std::vector<double> bounds_rad,
                   std::vector<std::size_t> sectors)
    : axis_(glm::normalize(axis)),
      frame_(base::frame_around(axis_)),
      bounds_rad_(std::move(bounds_rad)),
      sectors_(std::move(sectors)),
      first_{0} {
  for (const double bound : bounds_rad_) least_cosine_.push_back(std::cos(bound));
  for (const std::size_t count : sectors_) first_.push_back(first_.back() + count);
}

std::size_t SkyCells::cell_of(const Vec3& direction) const {
  const double cosine = glm::dot(direction, axis_);
  std::size_t ring = 0;
  while (ring + 1 < sectors_.size() && cosine < least_cosine_[ring]) ++ring;
  if (sectors_[ring] == 1) return first_[ring];
  const double circle_share =
      std::atan2(glm::dot(direction, frame_.bitangent), glm::dot(direction, frame_.tangent)) /
      (2.0 * pi);
  const auto count = static_cast<double>(sectors_[ring]);
  const auto sector =
      static_cast<std::size_t>((circle_share < 0.0 ? circle_share + 1.0 : circle_share) * count);
  return first_[ring] + std::min(sector, sectors_[ring] - 1);
}

void SkyCells::visit_grid(std::size_t cell, const std::vector<double>& shares,
                          const std::function<void(const Vec3&)>& visit) const {
  std::size_t ring = 0;
  while (first_[ring + 1] <= cell) ++ring;
  const double sector = 2.0 * pi / static_cast<double>(sectors_[ring]);
  std::vector<glm::dvec2> around;
  for (const double along : shares) {
    const double phi = sector * (static_cast<double>(cell - first_[ring]) + along);
    around.emplace_back(std::cos(phi), std::sin(phi));
  }
  // Equal steps of 1 - cos are equal solid angles; half angles avoid cancellation for small angles.
  const auto one_minus_cos = [](double angle) { return 2.0 * std::pow(std::sin(angle / 2), 2); };
  const double from = ring == 0 ? 0.0 : one_minus_cos(bounds_rad_[ring - 1]);
  const double height = one_minus_cos(bounds_rad_[ring]) - from;
  for (const double up : shares) {
    const double z = from + height * up;
    const double sine = std::sqrt(std::max(0.0, z * (2.0 - z)));
    for (const glm::dvec2& phi : around)
      visit(frame_.to_world({sine * phi.x, sine * phi.y, 1.0 - z}));
  }
}

void SkyCells::visit(std::size_t cell, int side,
                     const std::function<void(const Vec3&)>& visit) const {
  std::vector<double> shares;
  for (int k = 0; k < side; ++k) shares.push_back((k + 0.5) / side);
  visit_grid(cell, shares, visit);
}

void SkyCells::visit_lattice(std::size_t cell, int side,
                             const std::function<void(const Vec3&)>& visit) const {
  const double hair = 1e-8;
  std::vector<double> shares;
  for (int k = 0; k <= side; ++k) {
    shares.push_back(std::clamp(static_cast<double>(k) / side, hair, 1.0 - hair));
  }
  visit_grid(cell, shares, visit);
}

SkyCells cells_of_disc(const Vec3& direction, double half_angle_rad, std::size_t wanted) {
  const auto rings = static_cast<std::size_t>(
      std::max(1.0, std::round(std::sqrt(static_cast<double>(wanted) / 4.0))));
  // At angle t from the axis, the ground point is gamma = asin(sin t / sin h) - t from the
  // subpoint.
  const auto gamma = [&](double t) {
    return std::asin(std::min(1.0, std::sin(t) / std::sin(half_angle_rad))) - t;
  };
  const double whole = pi / 2 - half_angle_rad;
  const auto progress = [&](double t) {
    return 0.5 * std::pow(std::sin(t / 2) / std::sin(half_angle_rad / 2), 2) +
           0.5 * (whole > 0.0 ? gamma(t) / whole : t / half_angle_rad);
  };
  std::vector<double> bounds, spans;
  for (std::size_t ring = 1; ring <= rings; ++ring) {
    double low = 0.0, high = half_angle_rad;
    const double goal = static_cast<double>(ring) / static_cast<double>(rings);
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (progress(middle) < goal ? low : high) = middle;
    }
    bounds.push_back(ring == rings ? half_angle_rad : high);
    // Along a ring the ground's tilt to the Sun varies by sin(gamma).
    spans.push_back(gamma(bounds.back()) + 0.2 * whole * goal);
  }
  return SkyCells(direction, std::move(bounds), share_out(spans, wanted));
}

SkyCells cells_of_sphere(std::size_t wanted) {
  // n rings of equal width on a sphere of 4 pi with square cells: 4 n^2 / pi cells.
  const auto rings = static_cast<std::size_t>(
      std::max(2.0, std::round(std::sqrt(static_cast<double>(wanted) * pi / 4.0))));
  std::vector<double> bounds, spans;
  for (std::size_t ring = 1; ring <= rings; ++ring) {
    const double step = pi / static_cast<double>(rings);
    bounds.push_back(step * static_cast<double>(ring));
    spans.push_back(std::sin(bounds.back() - step / 2));
  }
  return SkyCells(Vec3(0.0, 0.0, 1.0), std::move(bounds), share_out(spans, wanted));
}

std::size_t earth_parts(const Scene& scene) {
  return scene.sky_parts && scene.sky_parts->cells ? scene.sky_parts->cells->count() : 1;
}

std::size_t earth_part(const Scene& scene, const Vec3& direction) {
  return scene.sky_parts && scene.sky_parts->cells ? scene.sky_parts->cells->cell_of(direction) : 0;
}

std::size_t sun_part(const Scene& scene, const Vec3& direction) {
  if (!scene.sky_parts) return 0;
  const std::vector<Sun>& suns = scene.sky_parts->suns;
  const auto met = std::find_if(suns.begin(), suns.end(), [&](const Sun& sun) {
    return glm::dot(direction, sun.direction) >= std::cos(base::radians(sun.angular_radius_deg));
  });
  return static_cast<std::size_t>(met - suns.begin());
}

}  // namespace earthshine::scenes
