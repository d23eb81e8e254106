// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather/gather_field.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/gather/gather_tiles.h"
#include "raytrace/share/alone.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t points_at_once = 4096;
// Pixels to a stray, or more: room for so many strays is asked for at once.
constexpr std::size_t pixels_per_stray = 3;

}  // namespace

GatherField::GatherField(const PathWorld& world, const IncomingLight& incoming,
                         const GatherSurface& surface, const CameraModel& camera,
                         const Window& window, const Setting& setting)
    : world_(world),
      incoming_(incoming),
      surface_(surface),
      camera_(camera),
      origin_(world.query.near(camera.position)),
      eye_(camera.position - origin_),
      window_(window),
      setting_(setting),
      grid_(window.pixel_count()),
      image_layers_(setting.image_layers),
      layers_(setting.image_layers + (setting.keeps_sky_apart ? 1 : 0)) {
  points_.reserve(grid_ + grid_ / pixels_per_stray);
  start_.reserve(grid_ + grid_ / pixels_per_stray);
  points_.resize(grid_);
  start_.resize(grid_);
  find_strays(find_points());
  find_peers();
  lengths_.assign(points_.size(), {});
  over_pixel_.assign(points_.size(), 0);
  find_first_origins();
  const std::size_t count = points_.size();
  const auto begin = [&](Gathered kind, std::size_t layers) {
    Estimate& estimate = estimate_[number(kind)];
    estimate.layers = layers;
    estimate.image_layers = image_layers_;
    for (auto* const of : {&estimate.luminance, &estimate.variance, &estimate.samples}) {
      of->assign(count, 0.0F);
    }
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

void GatherField::share(Gathered kind, bool last) {
  if (!gathers(kind)) return;
  if (!of_surface_) of_surface_.emplace(window_, points_);
  const bool lobe = kind == Gathered::Lobe;
  if (lobe && !of_material_) of_material_ = of_surface_->of_like_material(points_);
  Estimate& estimate = estimate_[number(kind)];
  Shared& shared = shared_[number(kind)];
  const Neighbours& neighbours = lobe ? *of_material_ : *of_surface_;
  const Keep keep = setting_.shares ? Keep::AsTold : Keep::All;
  shared = {};  // its memory is taken again
  shared = last ? share_in_place(neighbours, estimate, keep)
                : raytrace::share(neighbours, estimate, keep);
  add_strays(strays_, estimate, shared);
  share_among_peers({strays_, first_stray_, peers_, window_.columns}, estimate, shared);
  tell_alone(neighbours, window_, strays_, estimate, shared);
  if (lobe) return;
  std::vector<glm::vec3> radiance;
  radiance.swap(shared.radiance);
  if (kind == Gathered::Solution) {
    diffuse_ = std::move(radiance);
    return;
  }
  if (!gathers(Gathered::Solution)) diffuse_.assign(points_.size() * layers_, glm::vec3(0.0F));
  base::parallel_chunks(points_.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (std::size_t layer = 0; layer < image_layers_; ++layer) {
        diffuse_[p * layers_ + layer] += radiance[p * image_layers_ + layer];
      }
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

// samples: of both halves.
void GatherField::finish_note(Gathered kind, std::size_t point, double samples,
                              std::span<float> off, LayerNoise& notes) const {
  if (off.empty()) return;
  const auto factor = static_cast<float>(reflected(kind, point) / samples);
  for (float& of_layer : off) of_layer *= factor;
  notes.add(point, off);
}

void GatherField::add_notes(Gathered kind, const std::vector<LayerNoise>& of_tiles) {
  LayerNoise& all = noise_[number(kind)];
  for (const LayerNoise& tile : of_tiles) {
    all.place.insert(all.place.end(), tile.place.begin(), tile.place.end());
    all.off.insert(all.off.end(), tile.off.begin(), tile.off.end());
  }
}

double GatherField::reflected(Gathered kind, std::size_t point) const {
  return double(kind == Gathered::Lobe ? points_[point].lobe : points_[point].reflectance);
}

double GatherField::error_of(Gathered kind, std::size_t point) const {
  if (!gathers(kind)) return 0.0;
  return std::sqrt(double(shared_[number(kind)].squared_error[point]));
}

}  // namespace earthshine::raytrace
