// SPDX-License-Identifier: Apache-2.0
#include "raytrace/error_budget.h"

#include <cmath>
#include <map>
#include <numeric>

#include "raytrace/adaptive/adaptive_render.h"
#include "raytrace/frame/first_hit.h"

namespace earthshine::raytrace {
namespace {

constexpr double one_sided_95 = 1.645;
constexpr int tile_px = 32;  // denoising hardly correlates errors over larger distances
// Squares of tiles are mostly small and seldom large, so that a sample of tiles underestimates
// their spread (docs/validation.md).
constexpr double unseen_spread = 1.5;

// Ratio of the 95 % bound of the mean square to the mean square.
double bound_ratio(const StatedError& stated, const std::vector<std::size_t>& pixels, int columns) {
  const ErrorSums whole = add_up(stated, pixels);
  if (whole.squared_error() <= 0.0) return 1.0;
  std::map<std::size_t, double> tiles;
  for (const std::size_t p : pixels) {
    if (stated.shows[p] == Shows::Nothing) continue;
    const double weight = stated.weight(p, whole.luminance);
    double square = 0.0;
    for (const float part : stated.squared[p]) square += double(part);
    const std::size_t x = p % static_cast<std::size_t>(columns) / tile_px;
    const std::size_t y = p / static_cast<std::size_t>(columns) / tile_px;
    tiles[y * static_cast<std::size_t>(columns) + x] += weight * weight * square;
  }
  const auto count = static_cast<double>(tiles.size());
  double sum = 0.0, squares = 0.0;
  for (const auto& [tile, value] : tiles) {
    sum += value;
    squares += value * value;
  }
  // A single tile has no spread: assume that all of the error is in one place.
  if (count < 2.0) return 1.0 + one_sided_95 * unseen_spread;
  const double spread =
      std::sqrt(std::max(0.0, squares - sum * sum / count) * count / (count - 1.0));
  return 1.0 + one_sided_95 * unseen_spread * spread / sum;
}

ErrorEstimate total_of(const StatedError& stated, const std::vector<std::size_t>& pixels,
                       int columns) {
  const double square = add_up(stated, pixels).squared_error();
  return {std::sqrt(square), std::sqrt(square * bound_ratio(stated, pixels, columns))};
}

}  // namespace

ErrorBudget error_budget(const scenes::World& scene, const WatchedPicture& picture,
                         const Frame& frame) {
  ErrorBudget budget;
  budget.not_captured = not_captured(scene, picture.options);
  const SurfacePixels seen(scene, *picture.camera, picture.options);
  const StatedError& stated = frame.error;
  std::vector<std::size_t> all(stated.luminance.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const ErrorSums whole = add_up(stated, all);
  budget.pixels = whole.reference_luminance > 0.0 ? whole.pixels : 0;
  budget.total = total_of(stated, all, frame.window.columns);
  const double bound =
      budget.total.estimate > 0.0 ? budget.total.bound_95 / budget.total.estimate : 1.0;
  const auto part = [&](ErrorPart which) {
    const double off = std::sqrt(whole.squared[static_cast<std::size_t>(which)]);
    return ErrorEstimate{off, bound * off};
  };
  budget.parts = {part(ErrorPart::Gather), part(ErrorPart::Residual), part(ErrorPart::Lobe),
                  part(ErrorPart::Camera)};
  for (std::uint32_t object = 0; object < scene.scene.objects.size(); ++object) {
    if (!scene.scene.objects[object].target) continue;
    TargetError& target = budget.targets.emplace_back();
    target.name = scene.scene.objects[object].name;
    std::vector<std::size_t> pixels;
    for (const std::uint32_t pixel : seen.of_object(object))
      pixels.push_back(seen.in_window(pixel));
    target.pixels = pixels.size();
    target.luminance = add_up(stated, pixels).luminance;
    target.error = total_of(stated, pixels, frame.window.columns);
  }
  return budget;
}

SurfacePixels::SurfacePixels(const scenes::World& scene, const scenes::Camera& camera,
                             const RenderOptions& options)
    : window_(window_of(options)), columns_(static_cast<std::uint32_t>(options.columns)) {
  base::Image map{window_.columns, window_.rows, {}};
  map.add("object");
  rays_ = fill_first_hit(scene.scene, scene.query,
                         make_camera_model(camera, options.columns, options.rows), window_, map);
  const std::vector<float>& objects = map.find("object")->values;
  for (int y = window_.y; y < window_.y + window_.rows; ++y) {
    for (int x = window_.x; x < window_.x + window_.columns; ++x) {
      const auto object = static_cast<std::int32_t>(std::lround(objects[window_.index(x, y)]));
      if (object < 0) continue;
      all_.push_back(static_cast<std::uint32_t>(y) * columns_ + static_cast<std::uint32_t>(x));
      object_.push_back(object);
    }
  }
}

std::vector<std::uint32_t> SurfacePixels::of_object(std::uint32_t object) const {
  std::vector<std::uint32_t> pixels;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    if (object_[k] == static_cast<std::int32_t>(object)) pixels.push_back(all_[k]);
  }
  return pixels;
}

std::size_t SurfacePixels::in_window(std::uint32_t pixel) const {
  return window_.index(static_cast<int>(pixel % columns_), static_cast<int>(pixel / columns_));
}

}  // namespace earthshine::raytrace
