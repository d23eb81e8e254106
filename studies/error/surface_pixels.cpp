// SPDX-License-Identifier: Apache-2.0
#include "studies/error/surface_pixels.h"

#include <cmath>

#include "raytrace/frame/first_hit.h"
#include "raytrace/passes/passes.h"

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

}  // namespace earthshine::studies
