// SPDX-License-Identifier: Apache-2.0
// Which pixels of a picture show what.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/render.h"
#include "studies/study.h"

namespace earthshine::studies {

// The pixels of the picture's window whose centre shows an object, by ascending number
// row * columns + column in the whole picture.
class SurfacePixels {
 public:
  SurfacePixels(const StudyScene& scene, const scenes::Camera& camera,
                const raytrace::RenderOptions& options);

  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }
  [[nodiscard]] std::vector<std::uint32_t> of_object(std::uint32_t object) const;
  // Where a pixel stands in images of the window.
  [[nodiscard]] std::size_t in_window(std::uint32_t pixel) const;
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  raytrace::Window window_;
  std::uint32_t columns_;
  std::vector<std::uint32_t> all_;
  std::vector<std::int32_t> object_;  // of each of them
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::studies
