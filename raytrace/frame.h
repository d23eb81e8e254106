// SPDX-License-Identifier: Apache-2.0
// What a render gives: named layers and a report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"

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
  double seconds = 0.0;
  double relative_noise = 0.0;  // RMS standard error of a pixel's luminance over the mean luminance
  int camera_samples = 0;       // per pixel
  int gather_rays = 0;          // per camera sample
};

// image: R, G, B radiance in cd/m^2; with per_light also light_<group>.R/G/B, whose sum is R, G, B;
// with aovs the channels of layers.h.
struct Frame {
  base::Image image;
  RenderReport report;
};

}  // namespace earthshine::raytrace
