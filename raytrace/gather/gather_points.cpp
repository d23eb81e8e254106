// SPDX-License-Identifier: Apache-2.0
// GatherField's points: surfaces behind the pixels' centres, and further surfaces in pixels.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/gather/gather_tiles.h"
#include "raytrace/share/share.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

// Positions of eight rays in a pixel: columns in order, rows by van der Corput's sequence.
constexpr std::array<double, packet_width> off_grid_columns = {0.0625, 0.1875, 0.3125, 0.4375,
                                                               0.5625, 0.6875, 0.8125, 0.9375};
constexpr std::array<double, packet_width> off_grid_rows = {0.0625, 0.5625, 0.3125, 0.8125,
                                                            0.1875, 0.6875, 0.4375, 0.9375};
constexpr float rounding = 0.02F;  // relative to the points' spacing

scenes::Hit hit_of(const HitPacket& hits, std::size_t k) {
  return {hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
}

// Visits the pixels of the window at Chebyshev distance `ring`.
template <class Visit>
void each_neighbour(const Window& window, int x, int y, int ring, const Visit& visit) {
  for (int qy = y - ring; qy <= y + ring; ++qy) {
    for (int qx = x - ring; qx <= x + ring; ++qx) {
      if (std::max(std::abs(qx - x), std::abs(qy - y)) != ring || !window.contains(qx, qy))
        continue;
      visit(window.index(qx, qy));
    }
  }
}

bool alike(const GatherPoint& a, const GatherPoint& b) {
  return a.material == b.material && stands_for(a, sighting_of(b));
}

}  // namespace

bool lies_on_surface(const GatherPoint& point, const Sighting& place) {
  return point.reach_m > 0.0F && (point.mirror != seen_straight) == place.in_mirror &&
         same_surface(point.position, point.normal, place.position, place.normal,
                      rounding * point.spacing_m);
}

bool stands_for(const GatherPoint& point, const Sighting& place) {
  return lies_on_surface(point, place) &&
         (point.lobe <= 0.0F || glm::dot(point.normal, place.normal) >= tuning::lobe_cosine);
}

bool GatherField::place(const Ray& ray, const scenes::Hit& hit, GatherPoint& point,
                        RayStart& start) const {
  GatherRequest wanted;
  if (hit.missed() || !surface_(hit, wanted)) return false;
  wanted.position = scenes::hit_position(world_.scene, hit, ray.origin, ray.direction);
  point.position = glm::vec3(wanted.position - origin_);
  point.normal = glm::vec3(wanted.normal);
  point.spacing_m = static_cast<float>(hit.t * camera_.pixel_angle(ray.direction));
  point.reach_m = std::numeric_limits<float>::max();
  point.reflectance = static_cast<float>(wanted.reflectance);
  point.lobe = static_cast<float>(wanted.lobe);
  point.material = wanted.material;
  point.triangle = hit.triangle;
  start = {wanted.position + wanted.normal * world_.query.offset_m(hit.triangle), point.normal,
           glm::vec3(ray.direction)};
  return true;
}

std::vector<GatherField::Found> GatherField::find_points() {
  std::vector<std::vector<Found>> shown(tile_count(window_));
  base::parallel_chunks(tile_count(window_), 4, [&](std::size_t begin, std::size_t end) {
    RayPacket packet;
    HitPacket hits;
    std::array<Ray, packet_width> rays;
    for (std::size_t t = begin; t < end; ++t) {
      const Window tile = tile_of(window_, t);
      for (int y = tile.y; y < tile.y + tile.rows; ++y) {
        const auto count = static_cast<std::size_t>(tile.columns);
        CameraModel moved;
        const CameraModel& camera = camera_of_sample(
            camera_, y, [] { return 0.5; }, moved);
        for (std::size_t k = 0; k < count; ++k) {
          rays[k] = camera.ray(tile.x + static_cast<double>(k) + 0.5, y + 0.5, 0.0, 0.0);
          world_.query.set(packet, k, rays[k].origin, rays[k].direction);
        }
        world_.query.closest(packet, count, hits);
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t index = window_.index(tile.x + static_cast<int>(k), y);
          place(rays[k], hit_of(hits, k), points_[index], start_[index]);
          Found mirrored;
          mirrored.off_grid_point = {static_cast<std::uint32_t>(index), no_base,
                                     region_of(index, static_cast<std::size_t>(window_.columns)),
                                     1.0F};
          if (place_mirrored(rays[k], hit_of(hits, k), mirrored.point, mirrored.start)) {
            shown[t].push_back(mirrored);
          }
        }
      }
    }
  });
  camera_rays_ = grid_;
  std::vector<Found> all;
  for (const auto& tile : shown) all.insert(all.end(), tile.begin(), tile.end());
  return all;
}

std::array<GatherField::Met, packet_width> GatherField::trace_pixel(std::size_t pixel,
                                                                    const Places& x_of,
                                                                    const Places& y_of,
                                                                    std::size_t first,
                                                                    std::size_t end) const {
  const auto [x, y] = place_of(pixel);
  RayPacket packet{};
  HitPacket hits;
  std::array<Met, packet_width> met;
  CameraModel moved;
  const CameraModel& camera = camera_of_sample(
      camera_, y, [] { return 0.5; }, moved);
  for (std::size_t k = first; k < end; ++k) {
    met[k].ray = camera.ray(x + x_of[k], y + y_of[k], 0.0, 0.0);
    world_.query.set(packet, k - first, met[k].ray.origin, met[k].ray.direction);
  }
  world_.query.closest(packet, end - first, hits);
  for (std::size_t k = first; k < end; ++k) met[k].hit = hit_of(hits, k - first);
  return met;
}

bool GatherField::one_surface_around(std::size_t pixel) const {
  const auto [x, y] = place_of(pixel);
  const GatherPoint& own = points_[pixel];
  bool one = true;
  each_neighbour(window_, x, y, 1, [&](std::size_t q) {
    const bool gathers = points_[q].reach_m > 0.0F;
    one = one && gathers == (own.reach_m > 0.0F) && (!gathers || alike(own, points_[q]));
  });
  return one;
}

std::vector<GatherField::Found> GatherField::points_beside(std::size_t pixel) const {
  std::vector<Found> found;
  for (const Met& met : trace_pixel(pixel, off_grid_columns, off_grid_rows)) {
    Found more;
    if (!place(met.ray, met.hit, more.point, more.start)) continue;
    if (points_[pixel].reach_m > 0.0F && alike(points_[pixel], more.point)) continue;
    auto same =
        std::ranges::find_if(found, [&](const Found& one) { return alike(one.point, more.point); });
    if (same == found.end()) {
      more.off_grid_point.pixel = static_cast<std::uint32_t>(pixel);
      same = found.insert(same, more);
    }
    same->off_grid_point.cover += 1.0F / packet_width;
  }
  // Slivers get no point.
  std::erase_if(found,
                [](const Found& one) { return one.off_grid_point.cover < tuning::least_cover; });
  const auto [x, y] = place_of(pixel);
  for (auto& [off_grid_point, point, start] : found) {
    off_grid_point.base = no_base;
    const int rings = setting_.shares ? 2 : 0;
    for (int ring = 1; ring <= rings && off_grid_point.base == no_base; ++ring) {
      each_neighbour(window_, x, y, ring, [&, &of = off_grid_point, &at = point](std::size_t q) {
        if (of.base == no_base && points_[q].reach_m > 0.0F && alike(at, points_[q])) {
          of.base = static_cast<std::uint32_t>(q);
        }
      });
    }
    off_grid_point.region = region_of(pixel, static_cast<std::size_t>(window_.columns));
  }
  return found;
}

void GatherField::find_off_grid_points(const std::vector<Found>& mirrored) {
  std::vector<std::vector<Found>> found(tile_count(window_));
  interior_.assign(grid_, 0);
  std::atomic<std::uint64_t> rays{0};
  base::parallel_chunks(found.size(), 1, [&](std::size_t t, std::size_t) {
    const Window tile = tile_of(window_, t);
    for (int y = tile.y; y < tile.y + tile.rows; ++y) {
      for (int x = tile.x; x < tile.x + tile.columns; ++x) {
        const std::size_t pixel = window_.index(x, y);
        interior_[pixel] = one_surface_around(pixel) ? 1 : 0;
        if (interior_[pixel] != 0) continue;
        rays += packet_width;
        std::ranges::move(points_beside(pixel), std::back_inserter(found[t]));
      }
    }
  });
  camera_rays_ += rays;
  if (!mirrored.empty()) found.push_back(mirrored);
  append_off_grid_points(found);
}

void GatherField::append_off_grid_points(const std::vector<std::vector<Found>>& found) {
  std::vector<std::uint32_t> of_pixel(grid_ + 1, 0U);
  for (const auto& tile : found) {
    for (const Found& one : tile) ++of_pixel[one.off_grid_point.pixel + 1U];
  }
  std::partial_sum(of_pixel.begin(), of_pixel.end(), of_pixel.begin());
  first_off_grid_ = of_pixel;
  off_grid_points_.resize(of_pixel.back());
  points_.resize(grid_ + off_grid_points_.size());
  start_.resize(points_.size());
  for (const auto& tile : found) {
    for (const Found& one : tile) {
      const std::size_t at = of_pixel[one.off_grid_point.pixel]++;
      off_grid_points_[at] = one.off_grid_point;
      points_[grid_ + at] = one.point;
      start_[grid_ + at] = one.start;
    }
  }
}

void GatherField::find_first_origins() {
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const GatherPoint& point = points_[p];
    if (p < grid_ && interior_[p] == 0) over_pixel_[p] = 1;
    if (point.lobe <= 0.0F) continue;
    const auto [x, y] = place_of(pixel_of(p));
    for (int ring = 0; ring <= 1; ++ring) {
      each_neighbour(window_, x, y, ring, [&](std::size_t q) {
        const bool curved = points_[q].reach_m > 0.0F && points_[q].material == point.material &&
                            glm::dot(points_[q].normal, point.normal) < tuning::turning_cosine;
        if (curved) over_pixel_[p] = 1;
      });
    }
  }
}

std::array<int, 2> GatherField::place_of(std::size_t pixel) const {
  const auto columns = static_cast<std::size_t>(window_.columns);
  return {window_.x + static_cast<int>(pixel % columns),
          window_.y + static_cast<int>(pixel / columns)};
}

std::vector<std::size_t> GatherField::points_of_tile(std::size_t t) const {
  std::vector<std::size_t> points;
  const Window tile = tile_of(window_, t);
  for (int y = tile.y; y < tile.y + tile.rows; ++y) {
    for (int x = tile.x; x < tile.x + tile.columns; ++x) {
      const std::size_t pixel = window_.index(x, y);
      points.push_back(pixel);
      for (std::size_t k = first_off_grid_[pixel]; k < first_off_grid_[pixel + 1]; ++k) {
        points.push_back(grid_ + k);
      }
    }
  }
  return points;
}

std::uint64_t GatherField::random_number_of(std::size_t point) const {
  const std::size_t pixel = pixel_of(point), columns = static_cast<std::size_t>(window_.columns);
  const std::uint64_t x = static_cast<std::uint64_t>(window_.x) + pixel % columns;
  const std::uint64_t y = static_cast<std::uint64_t>(window_.y) + pixel / columns;
  const std::uint64_t number = y * static_cast<std::uint64_t>(camera_.columns) + x;
  const std::uint64_t all =
      static_cast<std::uint64_t>(camera_.columns) * static_cast<std::uint64_t>(camera_.rows);
  return point < grid_ ? number : number + all * (1 + point - grid_ - first_off_grid_[pixel]);
}

}  // namespace earthshine::raytrace
