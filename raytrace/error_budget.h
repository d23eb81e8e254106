// SPDX-License-Identifier: Apache-2.0
// The error of a picture, part by part, as its own samples state it (raytrace/frame/frame.h).
//
// An error is the root mean square difference of luminance to the picture that all light paths but
// those of not_captured would make, over the pixels that show a surface that reflects and no edge
// of a source itself, relative to their mean luminance; light straight from a source is left out,
// and pixels brighter than four times the mean count in proportion (error_weight).
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
  ErrorEstimate gather;           // rays over the hemisphere, and what sharing them blurs
  ErrorEstimate interreflection;  // what the solution lacks, found by paths: their noise and blur
  ErrorEstimate lobes;            // the same of rays over Phong lobes
  ErrorEstimate camera_samples;   // edges, lamps, the lens, mirrors and glass
};

struct TargetError {
  std::string name;
  std::size_t pixels = 0;  // seen
  double luminance = 0.0;  // their mean, cd/m^2
  ErrorEstimate error;     // as of the whole picture, over the target's pixels and their mean
};

struct ErrorBudget {
  ErrorEstimate total;
  ErrorParts parts;
  std::size_t pixels = 0;  // that the errors are over; 0: no surface is seen or all are black
  std::vector<TargetError> targets;
  std::vector<std::string> not_captured;
};

struct WatchedPicture {
  const scenes::Camera* camera = nullptr;
  RenderOptions options;
};

// What `frame`, drawn so, states. Its 95 % bound is that of a mean square known from some tiles of
// the picture: 1.645 standard errors of their mean above it.
[[nodiscard]] ErrorBudget error_budget(const scenes::World& scene, const WatchedPicture& picture,
                                       const Frame& frame);

// Which pixels of a picture show what.

// The pixels of the picture's window whose centre shows an object, by ascending number
// row * columns + column in the whole picture.
class SurfacePixels {
 public:
  SurfacePixels(const scenes::World& scene, const scenes::Camera& camera,
                const RenderOptions& options);

  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }
  [[nodiscard]] std::vector<std::uint32_t> of_object(std::uint32_t object) const;
  // Where a pixel stands in images of the window.
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
