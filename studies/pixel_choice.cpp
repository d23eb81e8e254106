// SPDX-License-Identifier: Apache-2.0
#include "studies/pixel_choice.h"

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "raytrace/first_hit.h"
#include "raytrace/passes.h"

namespace earthshine::studies {

SurfacePixels::SurfacePixels(const StudyScene& scene, const scenes::Camera& camera,
                             const raytrace::RenderOptions& options)
    : window_(raytrace::window_of(options)), columns_(static_cast<std::uint32_t>(options.columns)) {
  base::Image map{window_.columns, window_.rows, {}};
  map.add("object");
  rays_ = raytrace::fill_first_hit(
      scene.scene, scene.query, raytrace::make_camera_model(camera, options.columns, options.rows),
      window_, map);
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

std::vector<std::uint32_t> spread_evenly(std::span<const std::uint32_t> pixels, std::size_t count,
                                         std::uint64_t seed) {
  if (pixels.size() <= count) return {pixels.begin(), pixels.end()};
  base::Rng rng(base::Key(seed, base::Stream::ErrorBudget, 0));
  std::vector<std::uint32_t> some;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t from = k * pixels.size() / count, to = (k + 1) * pixels.size() / count;
    some.push_back(pixels[from + static_cast<std::size_t>(rng.next() * double(to - from))]);
  }
  return some;
}

std::vector<std::size_t> spread_by_weight(std::span<const double> weights, std::size_t count,
                                          std::uint64_t seed) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::size_t> chosen;
  if (sum <= 0.0) return chosen;
  const double step = sum / static_cast<double>(count);
  double next = step * base::Rng(base::Key(seed, base::Stream::ErrorBudget, 1)).next(),
         so_far = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    so_far += weights[k];
    for (; next < so_far && chosen.size() < count; next += step) chosen.push_back(k);
  }
  return chosen;
}

}  // namespace earthshine::studies
