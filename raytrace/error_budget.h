// SPDX-License-Identifier: Apache-2.0
// The error of a picture, part by part, as its own samples state it (raytrace/frame/frame.h).
//
// The error is the root mean square difference of luminance to the picture with all light paths but
// those in not_captured, over the pixels that show a reflecting surface and no edge of a source,
// relative to their mean luminance. Light straight from a source is omitted. Pixels brighter than
// four times the mean have reduced weight (error_weight).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "raytrace/frame/error_estimate.h"
#include "raytrace/light/uncaught_light.h"
#include "raytrace/render.h"

namespace earthshine::raytrace {

struct ErrorParts {
  ErrorEstimate gather;           // rays over the hemisphere: noise and blur
  ErrorEstimate interreflection;  // residual paths: noise and blur
  ErrorEstimate lobes;            // rays over Phong lobes: noise and blur
  ErrorEstimate camera_samples;   // edges, lamps, the lens, mirrors and glass
};

struct TargetError {
  std::string name;
  std::size_t pixels = 0;  // visible
  double luminance = 0.0;  // mean, cd/m^2
  ErrorEstimate error;     // as total, over the pixels of the target, relative to their mean
};

struct ErrorBudget {
  ErrorEstimate total;
  ErrorParts parts;
  std::size_t pixels = 0;  // number of pixels in the mean; 0: no lit surface is visible
  std::vector<TargetError> targets;
  std::vector<std::string> not_captured;
};

struct WatchedPicture {
  const scenes::Camera* camera = nullptr;
  RenderOptions options;
};

// The stated errors of `frame`, drawn with these options. The 95 % bound is 1.645 standard errors
// of the mean square above the mean square; tiles of the picture give the standard error.
[[nodiscard]] ErrorBudget error_budget(const scenes::World& scene, const WatchedPicture& picture,
                                       const Frame& frame);

// The pixels of the picture's window whose centre shows an object, by ascending number
// row * columns + column in the whole picture.
class SurfacePixels {
 public:
  SurfacePixels(const scenes::World& scene, const scenes::Camera& camera,
                const RenderOptions& options);

  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }
  [[nodiscard]] std::vector<std::uint32_t> of_object(std::uint32_t object) const;
  // Index of a pixel in images of the window.
  [[nodiscard]] std::size_t in_window(std::uint32_t pixel) const;
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  Window window_;
  std::uint32_t columns_;
  std::vector<std::uint32_t> all_;
  std::vector<std::int32_t> object_;  // of each of them
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::raytrace
