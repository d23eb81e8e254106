// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "raytrace/gather_tiles.h"
#include "raytrace/same_surface.h"

namespace earthshine::raytrace {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr std::size_t width = RayPacket::width;
// Of its mean ray's length: how far off a point may stand for another.
constexpr float most_found_share = 0.25F;

float slack(const GatherPoint& point) { return 0.02F * point.spacing_m; }

// How much further apart neighbours are along the surface than across the view.
float stretch(const GatherPoint& point) {
  const float distance = glm::length(point.position);
  const float cosine =
      std::abs(glm::dot(point.position, point.normal)) / std::max(distance, 1e-20F);
  return 1.0F / std::max(cosine, 0.05F);
}

}  // namespace

GatherField::GatherField(const PathWorld& world, const IncomingLight& incoming,
                         const GatherSurface& surface, const CameraModel& camera,
                         const Window& window, const Setting& setting)
    : world_(world),
      incoming_(incoming),
      window_(window),
      picture_columns_(camera.columns),
      setting_(setting),
      image_layers_(setting.image_layers),
      layers_(setting.image_layers + (setting.keeps_sky_apart ? 1 : 0)),
      points_(window.pixel_count()),
      origin_(window.pixel_count(), Vec3(0.0)),
      inverse_length_(window.pixel_count(), 0.0) {
  find_points(surface, camera);
  const std::size_t count = points_.size();
  estimate_[number(Gathered::Solution)] = Estimate(count, layers_, image_layers_);
  if (setting.gathers_residual) {
    estimate_[number(Gathered::Residual)] = Estimate(count, image_layers_, image_layers_);
  }
  any_lobe_ = std::any_of(points_.begin(), points_.end(),
                          [](const GatherPoint& point) { return point.lobe > 0.0F; });
  if (any_lobe_) estimate_[number(Gathered::Lobe)] = Estimate(count, image_layers_, image_layers_);
}

void GatherField::find_points(const GatherSurface& surface, const CameraModel& camera) {
  const double pixel_m = 2.0 * camera.half_height / camera.rows;  // at unit distance
  base::parallel_chunks(tile_count(window_), 4, [&](std::size_t begin, std::size_t end) {
    RayPacket packet;
    HitPacket hits;
    for (std::size_t t = begin; t < end; ++t) {
      const Window tile = tile_of(window_, t);
      for (int y = tile.y; y < tile.y + tile.rows; ++y) {
        const auto count = static_cast<std::size_t>(tile.columns);
        for (std::size_t k = 0; k < count; ++k) {
          const Ray ray = camera.ray(tile.x + static_cast<double>(k) + 0.5, y + 0.5, 0.0, 0.0);
          world_.query.set(packet, k, ray.origin, ray.direction);
        }
        world_.query.closest(packet, count, hits);
        for (std::size_t k = 0; k < count; ++k) {
          const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k],
                                hits.front[k] != 0};
          GatherRequest wanted;
          if (hit.missed() || !surface(hit, wanted)) continue;
          const std::size_t index = window_.index(tile.x + static_cast<int>(k), y);
          GatherPoint& point = points_[index];
          point.position = glm::vec3(wanted.position - camera.position);
          point.normal = glm::vec3(wanted.normal);
          point.spacing_m = static_cast<float>(hit.t * pixel_m);
          point.reach_m = std::numeric_limits<float>::max();
          point.reflectance = static_cast<float>(wanted.reflectance);
          point.lobe = static_cast<float>(wanted.lobe);
          point.material = wanted.material;
          point.triangle = hit.triangle;
          origin_[index] = wanted.position + wanted.normal * world_.query.surface_offset_m();
        }
      }
    }
  });
  camera_rays_ = window_.pixel_count();
}

std::uint32_t GatherField::fewest_samples(Gathered kind) {
  return kind == Gathered::Solution ? 16 : 2;
}

RayCounts GatherField::rays() const {
  RayCounts all;
  all.camera = camera_rays_;
  for (const RayCounts& kind : rays_of_) all += kind;
  return all;
}

bool GatherField::gathers(Gathered kind) const { return !estimate_[number(kind)].samples.empty(); }

void GatherField::cast(Gathered kind, const std::vector<std::uint32_t>& more, std::uint32_t round,
                       const std::function<bool()>& stop) {
  if (!gathers(kind)) return;
  if (kind == Gathered::Solution) {
    cast_solution(more, round, stop);
  } else {
    cast_paths(kind, more, round, stop);
  }
}

void GatherField::share() {
  if (!of_surface_) of_surface_.emplace(window_, points_, setting_.shares);
  diffuse_.assign(points_.size() * layers_, glm::vec3(0.0F));
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual}) {
    if (!gathers(kind)) continue;
    Shared& shared = shared_[number(kind)];
    shared = raytrace::share(*of_surface_, estimate_[number(kind)]);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      for (std::size_t layer = 0; layer < shared.layers; ++layer) {
        diffuse_[p * layers_ + layer] += shared.radiance[p * shared.layers + layer];
      }
    }
  }
  if (!any_lobe_) return;
  if (!of_material_) of_material_ = of_surface_->of_like_material(points_);
  shared_[number(Gathered::Lobe)] =
      raytrace::share(*of_material_, estimate_[number(Gathered::Lobe)]);
}

std::span<const glm::vec3> GatherField::lobe(std::size_t point) const {
  if (points_[point].lobe <= 0.0F) return {};
  const Shared& shared = shared_[number(Gathered::Lobe)];
  return {&shared.radiance[point * image_layers_], image_layers_};
}

double GatherField::reflected(Gathered kind, std::size_t point) const {
  return double(kind == Gathered::Lobe ? points_[point].lobe : points_[point].reflectance);
}

double GatherField::error_of(Gathered kind, std::size_t point) const {
  if (!gathers(kind)) return 0.0;
  return std::sqrt(double(shared_[number(kind)].squared_error[point]));
}

std::size_t GatherField::find(int x, int y, const glm::vec3& position,
                              const glm::vec3& normal) const {
  const auto fits = [&](std::size_t index, float& distance) {
    const GatherPoint& point = points_[index];
    if (point.reach_m <= 0.0F) return false;
    const glm::vec3 way = position - point.position;
    distance = glm::length(way);
    // Further off, irradiance may be another: a gap in a wall, the foot of a box.
    return distance <= std::min(3.0F * point.spacing_m * stretch(point),
                                most_found_share * point.reach_m) &&
           same_surface(point.position, point.normal, position, normal, slack(point));
  };
  float distance = 0.0F;
  if (window_.contains(x, y)) {
    const std::size_t own = window_.index(x, y);
    if (fits(own, distance)) return own;
  }
  for (int ring = 1; ring <= 2; ++ring) {
    std::size_t nearest = no_point;
    float least = std::numeric_limits<float>::infinity();
    for (int qy = y - ring; qy <= y + ring; ++qy) {
      for (int qx = x - ring; qx <= x + ring; ++qx) {
        if (!window_.contains(qx, qy)) continue;
        if (std::max(std::abs(qx - x), std::abs(qy - y)) != ring) continue;
        if (fits(window_.index(qx, qy), distance) && distance < least) {
          least = distance;
          nearest = window_.index(qx, qy);
        }
      }
    }
    if (nearest != no_point) return nearest;
  }
  return no_point;
}

}  // namespace earthshine::raytrace
