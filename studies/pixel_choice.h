// SPDX-License-Identifier: Apache-2.0
// Which pixels of a picture show what, and some of them for a closer look.
#pragma once

#include <cstdint>
#include <span>
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

// At most `count` of them: one at random from each of as many equal runs, which are rows or parts
// of rows.
[[nodiscard]] std::vector<std::uint32_t> spread_evenly(std::span<const std::uint32_t> pixels,
                                                       std::size_t count, std::uint64_t seed);

// Numbers 0 .. weights.size() - 1, `count` of them, each as often as its weight deserves: in
// expectation count * weight / sum (systematic sampling). None if all weights are 0.
[[nodiscard]] std::vector<std::size_t> spread_by_weight(std::span<const double> weights,
                                                        std::size_t count, std::uint64_t seed);

}  // namespace earthshine::studies
