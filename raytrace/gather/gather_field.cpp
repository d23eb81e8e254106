// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather/gather_field.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/gather/gather_tiles.h"
#include "raytrace/share/isolated.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_at_once = 4096;
// Initial capacity: one off-grid point for this many pixels.
constexpr std::size_t pixels_per_off_grid_point = 3;

}  // namespace

GatherField::GatherField(const PathWorld& world, const IncomingLight& incoming,
                         const GatherSurface& surface, const CameraModel& camera,
                         const Setting& setting)
    : world_(world),
      incoming_(incoming),
      surface_(surface),
      camera_(camera),
      origin_(world.query.near(camera.position)),
      eye_(camera.position - origin_),
      window_{0, 0, camera.columns / setting.step, camera.rows / setting.step},
      setting_(setting),
      grid_(window_.pixel_count()),
      image_layers_(setting.image_layers),
      layers_(setting.image_layers + (setting.keeps_sky_apart ? 1 : 0)) {
  camera_.columns = window_.columns;
  camera_.rows = window_.rows;
  points_.reserve(grid_ + grid_ / pixels_per_off_grid_point);
  start_.reserve(grid_ + grid_ / pixels_per_off_grid_point);
  points_.resize(grid_);
  start_.resize(grid_);
  find_off_grid_points(find_points());
  find_mirror_neighbours();
  lengths_.assign(points_.size(), {});
  over_pixel_.assign(points_.size(), 0);
  // Without sharing a picture is unbiased and linear in the light: the rays of all pixels start all
  // over them, whatever the light shows.
  if (!setting_.shares) std::fill_n(over_pixel_.begin(), grid_, std::uint8_t{1});
  find_first_origins();
  const std::size_t count = points_.size();
  const auto begin = [&](Gathered kind, std::size_t layers) {
    Estimate& estimate = estimate_[number(kind)];
    estimate.layers = layers;
    estimate.image_layers = image_layers_;
    for (auto* const of : {&estimate.luminance, &estimate.variance, &estimate.samples}) {
      of->assign(count, 0.0F);
    }
    if (image_layers_ > 1) estimate.total.assign(count, glm::vec3(0.0F));
  };
  if (!incoming.is_dark()) begin(Gathered::Solution, layers_);
  if (setting.gathers_residual) begin(Gathered::Residual, image_layers_);
  any_lobe_ = std::any_of(points_.begin(), points_.end(),
                          [](const GatherPoint& point) { return point.lobe > 0.0F; });
  if (any_lobe_) begin(Gathered::Lobe, image_layers_);
}

std::uint32_t GatherField::fewest_samples(Gathered kind) {
  return kind == Gathered::Solution ? 8 : 2;
}

std::array<int, 2> GatherField::picture_pixel(std::size_t point) const {
  const auto [x, y] = place_of(pixel_of(point));
  return {x * setting_.step + setting_.step / 2, y * setting_.step + setting_.step / 2};
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
    classify_origins(round, stop);
  } else {
    cast_paths(kind, more, round, stop);
  }
}

Shared GatherField::share_among(Gathered kind, Estimate& estimate, bool in_place) {
  if (!of_surface_) of_surface_.emplace(window_, points_);
  const bool lobe = kind == Gathered::Lobe;
  if (lobe && !of_material_) of_material_ = of_surface_->of_like_material(points_);
  const Neighbours& neighbours = lobe ? *of_material_ : *of_surface_;
  const Keep keep = setting_.shares ? Keep::AsTold : Keep::All;
  Shared shared = in_place ? share_in_place(neighbours, estimate, keep)
                           : raytrace::share(neighbours, estimate, keep);
  add_off_grid_points(off_grid_points_, estimate, shared);
  share_among_mirror_neighbours(
      {off_grid_points_, first_off_grid_, mirror_neighbours_, window_.columns}, estimate, shared);
  regularise_isolated_variance(neighbours, window_, off_grid_points_, estimate, shared);
  return shared;
}

void GatherField::share(Gathered kind, bool last) {
  if (!gathers(kind)) return;
  Estimate& estimate = estimate_[number(kind)];
  Shared& shared = shared_[number(kind)];
  shared = {};  // frees its memory
  if (!last && !estimate.total.empty()) {
    Estimate total = estimate.of_total();
    shared = share_among(kind, total, true);
    total_[number(kind)] = std::move(shared.radiance);
    add_totals(kind);
    return;
  }
  shared = share_among(kind, estimate, last);
  if (kind == Gathered::Lobe) return add_layers(kind);
  std::vector<glm::vec3> radiance;
  radiance.swap(shared.radiance);
  if (kind == Gathered::Solution) {
    diffuse_ = std::move(radiance);
    return add_layers(kind);
  }
  if (!gathers(Gathered::Solution)) diffuse_.assign(points_.size() * layers_, glm::vec3(0.0F));
  base::parallel_chunks(points_.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (std::size_t layer = 0; layer < image_layers_; ++layer) {
        diffuse_[p * layers_ + layer] += radiance[p * image_layers_ + layer];
      }
    }
  });
  add_layers(kind);
}

void GatherField::add_totals(Gathered kind) {
  if (kind == Gathered::Lobe) {
    sums_[1] = total_[number(kind)];
    return;
  }
  sums_[0].assign(points_.size(), glm::vec3(0.0F));
  for (const Gathered part : {Gathered::Solution, Gathered::Residual}) {
    const std::vector<glm::vec3>& total = total_[number(part)];
    for (std::size_t p = 0; p < total.size(); ++p) sums_[0][p] += total[p];
  }
}

void GatherField::add_layers(Gathered kind) {
  const bool lobe = kind == Gathered::Lobe;
  const std::vector<glm::vec3>& radiance = lobe ? shared_[number(kind)].radiance : diffuse_;
  const std::size_t layers = lobe ? image_layers_ : layers_;
  std::vector<glm::vec3>& sums = sums_[lobe ? 1 : 0];
  sums.resize(points_.size());
  base::parallel_chunks(points_.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      glm::vec3 sum(0.0F);
      for (std::size_t layer = 0; layer < image_layers_; ++layer)
        sum += radiance[p * layers + layer];
      sums[p] = sum;
    }
  });
}

std::span<const glm::vec3> GatherField::lobe(std::size_t point) const {
  if (points_[point].lobe <= 0.0F) return {};
  const Shared& shared = shared_[number(Gathered::Lobe)];
  return {&shared.radiance[point * image_layers_], image_layers_};
}

void GatherField::note_half(std::uint32_t half, std::span<const Rgb> sum, std::span<float> off) {
  for (std::size_t layer = 0; layer < off.size(); ++layer) {
    const auto luminance = static_cast<float>(base::luminance(sum[layer]));
    off[layer] += half == 0 ? luminance : -luminance;
  }
}

float GatherField::noted_weight(std::size_t point) const {
  if (!setting_.notes_layers) return 0.0F;
  const auto [x, y] = picture_pixel(point);
  const auto columns =
      static_cast<std::size_t>(window_.columns) * static_cast<std::size_t>(setting_.step);
  const std::size_t pixel = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
  if (pixel < setting_.noted.size() && setting_.noted[pixel] != 0) return 1.0F;
  const std::size_t step = layer_noise_step(points_.size());
  return point % step == 0 ? static_cast<float>(step) : 0.0F;
}

void GatherField::Notes::add(std::size_t at, std::span<const float> off_by) {
  if (off_by.empty()) return;
  point.push_back(static_cast<std::uint32_t>(at));
  off.insert(off.end(), off_by.begin(), off_by.end());
}

void GatherField::add_notes(Gathered kind, const std::vector<Notes>& of_tiles) {
  Notes& all = notes_[number(kind)];
  for (const Notes& tile : of_tiles) {
    all.point.insert(all.point.end(), tile.point.begin(), tile.point.end());
    all.off.insert(all.off.end(), tile.off.begin(), tile.off.end());
  }
}

void GatherField::drop_notes(Gathered kind, const std::vector<std::uint32_t>& anew) {
  Notes kept;
  Notes& all = notes_[number(kind)];
  for (std::size_t k = 0; k < all.point.size(); ++k) {
    if (anew[all.point[k]] == 0)
      kept.add(all.point[k], {&all.off[k * image_layers_], image_layers_});
  }
  all = std::move(kept);
}

LayerNoise GatherField::layer_noise(Gathered kind, std::size_t one_in) const {
  LayerNoise noise;
  noise.edge_px = setting_.step;
  const Notes& notes = notes_[number(kind)];
  const std::size_t columns =
      static_cast<std::size_t>(window_.columns) * static_cast<std::size_t>(setting_.step);
  std::vector<float> off(image_layers_);
  for (std::size_t k = 0; k < notes.point.size(); ++k) {
    const std::size_t p = notes.point[k];
    const auto [x, y] = picture_pixel(p);
    LayerNoise::Row place{static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x),
                          static_cast<float>(cover_of(p)), noted_weight(p)};
    if (!LayerNoise::selects(place, one_in)) continue;
    const auto factor = static_cast<float>(reflected(kind, p)) / samples(kind, p);
    for (std::size_t layer = 0; layer < off.size(); ++layer) {
      off[layer] = factor * notes.off[k * image_layers_ + layer];
    }
    noise.add(place, off);
  }
  return noise;
}

double GatherField::reflected(Gathered kind, std::size_t point) const {
  return double(kind == Gathered::Lobe ? points_[point].lobe : points_[point].reflectance);
}

double GatherField::error_of(Gathered kind, std::size_t point) const {
  if (!gathers(kind)) return 0.0;
  return std::sqrt(double(shared_[number(kind)].squared_error[point]));
}

}  // namespace earthshine::raytrace
