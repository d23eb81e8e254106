// SPDX-License-Identifier: Apache-2.0
// What a render gives: named layers and a report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/camera.h"

namespace earthshine::raytrace {

struct RayCounts {
  std::uint64_t camera = 0, shadow = 0, gather = 0, lobe = 0, mirror = 0;
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera;
    shadow += other.shadow;
    gather += other.gather;
    lobe += other.lobe;
    mirror += other.mirror;
    return *this;
  }
  [[nodiscard]] std::uint64_t total() const { return camera + shadow + gather + lobe + mirror; }
};

struct RenderReport {
  RayCounts rays;
  double seconds = 0.0;         // wall
  double gather_seconds = 0.0;  // of them for the gather field
  // RMS standard error of a pixel's luminance over the mean luminance, both without the pixels that
  // show a source itself.
  double relative_noise = 0.0;
  double camera_samples = 0.0;  // per pixel, mean
  int most_camera_samples = 0;
  int gather_rays = 0;          // per pixel
  double finished_share = 1.0;  // of the pixels; less than 1 if it was stopped
  bool stopped = false;
};

// image: R, G, B radiance in cd/m^2; with per_light also light_<group>.R/G/B, whose sum is R, G, B;
// with aovs:
//   direct, indirect, specular .R/G/B: what the camera sees of sources themselves and of light
//   straight from them on diffuse surfaces; light that other surfaces reflected first; highlights,
//   glossy and mirror reflections, glass. Their sum is R, G, B.
//   variance: of the mean luminance of the pixel, (cd/m^2)^2
//   the unfiltered layers of first_hit.h and the coverages of cryptomatte.h
struct Frame {
  base::Image image;
  Window window;  // which part of the picture the image is
  RenderReport report;
};

}  // namespace earthshine::raytrace
