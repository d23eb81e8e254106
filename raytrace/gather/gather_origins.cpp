// SPDX-License-Identifier: Apache-2.0
// Validity radius of a gather point, and the origins of its rays.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers/random.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
float GatherField::footprint_radius(const GatherPoint& point) const {
  constexpr float half_diagonal = 0.7072F;
  const glm::vec3 view = point.position - eye_;
  const float distance = glm::length(view);
  const float cosine = std::abs(glm::dot(view, point.normal)) / std::max(distance, 1e-20F);
  return half_diagonal * point.spacing_m / std::max(cosine, 0.05F);
}

void GatherField::classify_origins(std::uint32_t round, const std::function<bool()>& stop) {
  Estimate& estimate = estimate_[number(Gathered::Solution)];
  std::vector<std::uint32_t> anew(points_.size(), 0U);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const GatherPoint& point = points_[p];
    if (over_pixel_[p] != 0 || estimate.samples[p] <= 0.0F) continue;
    // No ray has met a surface: small bodies that other rays will meet may be near.
    const bool met = lengths_[p].count > 0.0;
    // Without sharing (then of off-grid points) lengths alone decide, so that pictures are linear.
    const double of_rays = lengths_[p].harmonic_mean();
    const double reach_m =
        setting_.shares ? std::min(of_rays, lengths_[p].harmonic_mean_of_light()) : of_rays;
    if (met && footprint_radius(point) <= tuning::alike_share * float(reach_m)) continue;
    over_pixel_[p] = 1U;
    anew[p] = static_cast<std::uint32_t>(estimate.samples[p]);
    lengths_[p] = {};
    estimate.clear(p);
  }
  drop_notes(Gathered::Solution, anew);
  cast_solution(anew, round, stop);
}

RayOrigins GatherField::draw_origins(Gathered kind, std::size_t p, std::uint32_t stream,
                                     std::uint32_t rays, RayCounts& counts) const {
  RayOrigins origins;
  if (origins_at(p) > 1) {
    const base::Key key = base::Key(setting_.seed, base::Stream::GatherOrigin, random_number_of(p))
                              .with(number(kind))
                              .with(stream);
    const base::SobolOwen4 places(key);
    Places in_x, in_y;
    const auto [x, y] = place_of(pixel_of(p));
    // As many places as rays, or more if some of them show another surface.
    std::size_t drawn = 0;
    for (const std::size_t end :
         {std::min<std::size_t>(rays, RayOrigins::most), RayOrigins::most}) {
      if (origins.count >= rays || drawn >= end) break;
      for (std::size_t k = drawn; k < end; ++k) {
        const auto u = places.point2(static_cast<std::uint32_t>(k));
        in_x[k] = double(u[0]), in_y[k] = double(u[1]);
      }
      const auto met = trace_pixel(pixel_of(p), in_x, in_y, drawn, end);
      counts.camera += end - drawn;
      for (; drawn < end; ++drawn) {
        GatherPoint found;
        RayStart start;
        const bool mirrored = points_[p].mirror != seen_straight;
        counts.mirror += mirrored ? 1 : 0;
        const auto& [ray, hit] = met[drawn];
        if (!(mirrored ? place_mirrored(ray, hit, found, start) : place(ray, hit, found, start))) {
          continue;
        }
        // Accept only places that read this point: it estimates the mean over exactly these places.
        // During the initial sampling the distances are unknown, and the footprint limits the
        // places.
        const bool far = points_[p].reach_m == std::numeric_limits<float>::max() &&
                         glm::length(found.position - points_[p].position) > own_radius(p);
        if (far || find_in(x, y, sighting_of(found)) != p) continue;
        origins.add(start);
      }
    }
  }
  if (origins.count == 0) origins.add(start_[p]);
  return origins;
}

// An off-grid point lies anywhere in its pixel. If it estimates the mean over the pixel, the whole
// pixel has to read it.
float GatherField::own_radius(std::size_t p) const {
  const float radius = footprint_radius(points_[p]);
  return p >= grid_ && origins_at(p) > 1 ? 2.0F * radius : radius;
}

std::size_t GatherField::find(int x, int y, const Sighting& place) const {
  return find_in(x / setting_.step, y / setting_.step, place);
}

std::size_t GatherField::find_in(int x, int y, const Sighting& place) const {
  // Limits the distance: camera samples of a lens out of focus reach farther, where the irradiance
  // may differ.
  const auto if_near = [&](std::size_t index) {
    const GatherPoint& point = points_[index];
    const float wide =
        std::min(6.0F * footprint_radius(point), tuning::alike_share * point.reach_m);
    const float most = std::max(own_radius(index), wide);
    return glm::length(place.position - point.position) <= most ? index : no_point;
  };
  if (!window_.contains(x, y)) return no_point;
  const std::size_t own = window_.index(x, y);
  if (stands_for(points_[own], place)) return if_near(own);
  for (std::size_t k = first_off_grid_[own]; k < first_off_grid_[own + 1]; ++k) {
    if (stands_for(points_[grid_ + k], place)) return if_near(grid_ + k);
  }
  return no_point;
}

GatherField::Reading GatherField::reading(int x, int y, const Sighting& place, std::size_t own,
                                          Gathered kind) const {
  Reading read;
  read.point[0] = own;
  read.weight[0] = 1.0F;
  read.count = 1;
  if (setting_.step == 1 || own >= grid_) return read;
  const auto [at_x, at_y] = place_of(own);
  const auto step = static_cast<float>(setting_.step);
  // Offset from the point's pixel centre, in pixels of the field.
  const float dx = (static_cast<float>(x) + 0.5F) / step - static_cast<float>(at_x) - 0.5F;
  const float dy = (static_cast<float>(y) + 0.5F) / step - static_cast<float>(at_y) - 0.5F;
  const int to_x = dx < 0.0F ? -1 : 1, to_y = dy < 0.0F ? -1 : 1;
  const float in_x = std::abs(dx), in_y = std::abs(dy);
  const auto add = [&](int by_x, int by_y, float weight) {
    if (!window_.contains(at_x + by_x, at_y + by_y)) return;
    const std::size_t index = window_.index(at_x + by_x, at_y + by_y);
    const GatherPoint& point = points_[index];
    if (!stands_for(point, place) || reflected(kind, index) <= 0.0) return;
    if (point.material != points_[own].material) return;
    read.point[read.count] = index;
    read.weight[read.count++] = weight;
    read.weight[0] -= weight;
  };
  add(to_x, 0, in_x * (1.0F - in_y));
  add(0, to_y, in_y * (1.0F - in_x));
  add(to_x, to_y, in_x * in_y);
  return read;
}

std::size_t GatherField::find_beside(int x, int y, const Sighting& place, Gathered kind) const {
  x /= setting_.step, y /= setting_.step;
  std::size_t nearest = no_point;
  float distance = std::numeric_limits<float>::max();
  const auto consider = [&](std::size_t index) {
    const GatherPoint& point = points_[index];
    if (point.reach_m <= 0.0F || reflected(kind, index) <= 0.0) return;
    const float away = glm::length(place.position - point.position);
    if (away >= distance || away > tuning::next_pixel_radius * footprint_radius(point)) return;
    const bool serves =
        kind == Gathered::Lobe ? stands_for(point, place) : lies_on_surface(point, place);
    if (!serves) return;
    nearest = index;
    distance = away;
  };
  for (int qy = y - 1; qy <= y + 1; ++qy) {
    for (int qx = x - 1; qx <= x + 1; ++qx) {
      if (!window_.contains(qx, qy)) continue;
      const std::size_t pixel = window_.index(qx, qy);
      consider(pixel);
      for (std::size_t k = first_off_grid_[pixel]; k < first_off_grid_[pixel + 1]; ++k) {
        consider(grid_ + k);
      }
    }
  }
  return nearest;
}

}  // namespace earthshine::raytrace
