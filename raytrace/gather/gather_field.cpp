// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather/gather_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/gather/gather_tiles.h"

namespace earthshine::raytrace {
namespace {

// Of its mean ray's length: how far off a point may stand for another.
constexpr float most_found_share = 0.1F;
constexpr float half_diagonal = 0.7072F;  // of a pixel

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
      picture_pixels_(static_cast<std::uint64_t>(camera.columns) *
                      static_cast<std::uint64_t>(camera.rows)),
      setting_(setting),
      grid_(window.pixel_count()),
      image_layers_(setting.image_layers),
      layers_(setting.image_layers + (setting.keeps_sky_apart ? 1 : 0)),
      points_(window.pixel_count()),
      origin_(window.pixel_count(), Vec3(0.0)) {
  find_points(surface, camera);
  find_strays(surface, camera);
  inverse_length_.assign(points_.size(), 0.0);
  const std::size_t count = points_.size();
  const auto begin = [&](Gathered kind, std::size_t layers) {
    Estimate& estimate = estimate_[number(kind)];
    estimate.layers = layers;
    estimate.image_layers = image_layers_;
    estimate.luminance.assign(count, {0.0F, 0.0F});
    estimate.samples.assign(count, 0.0F);
  };
  begin(Gathered::Solution, layers_);
  if (setting.gathers_residual) begin(Gathered::Residual, image_layers_);
  any_lobe_ = std::any_of(points_.begin(), points_.end(),
                          [](const GatherPoint& point) { return point.lobe > 0.0F; });
  if (any_lobe_) begin(Gathered::Lobe, image_layers_);
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
  Estimate& estimate = estimate_[number(kind)];
  estimate.sum.resize(points_.size() * estimate.layers, glm::vec3(0.0F));
  if (kind == Gathered::Solution) {
    cast_solution(more, round, stop);
  } else {
    cast_paths(kind, more, round, stop);
  }
}

void GatherField::share(Gathered kind, bool last) {
  if (!gathers(kind)) return;
  if (!of_surface_) of_surface_.emplace(window_, points_, setting_.shares);
  const bool lobe = kind == Gathered::Lobe;
  if (lobe && !of_material_) of_material_ = of_surface_->of_like_material(points_);
  Estimate& estimate = estimate_[number(kind)];
  Shared& shared = shared_[number(kind)];
  shared = raytrace::share(lobe ? *of_material_ : *of_surface_, estimate);
  add_strays(strays_, estimate, shared);
  if (last) std::vector<glm::vec3>().swap(estimate.sum);
  if (lobe) return;
  std::vector<glm::vec3> radiance;
  radiance.swap(shared.radiance);
  if (kind == Gathered::Solution) {
    diffuse_ = std::move(radiance);
    return;
  }
  for (std::size_t p = 0; p < points_.size(); ++p) {
    for (std::size_t layer = 0; layer < image_layers_; ++layer) {
      diffuse_[p * layers_ + layer] += radiance[p * image_layers_ + layer];
    }
  }
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
  // Further off, irradiance may be another: a gap in a wall, the foot of a box. A few rays of each
  // sample's own are exact there, and grain: where that is not wanted, the point stands for the
  // mean over its pixel.
  const auto if_near = [&](std::size_t index) {
    const GatherPoint& point = points_[index];
    const float pixel = point.spacing_m * stretch(point);
    const float least = setting_.whole_pixels ? half_diagonal * pixel : 0.0F;
    const float most = std::max(least, std::min(3.0F * pixel, most_found_share * point.reach_m));
    return glm::length(position - point.position) <= most ? index : no_point;
  };
  if (!window_.contains(x, y)) return no_point;
  const std::size_t own = window_.index(x, y);
  if (stands_for(points_[own], position, normal)) return if_near(own);
  for (std::size_t k = first_stray_[own]; k < first_stray_[own + 1]; ++k) {
    if (stands_for(points_[grid_ + k], position, normal)) return if_near(grid_ + k);
  }
  return no_point;
}

}  // namespace earthshine::raytrace
