// SPDX-License-Identifier: Apache-2.0
// What a render gives: named layers and a report.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/camera.h"
#include "scenes/effects.h"

namespace earthshine::raytrace {

// Each ray counts once, as what it was cast for. A lens has no rays of its own: camera rays start
// on it.
struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t shadow = 0;                                   // all of them
  std::array<std::uint64_t, scenes::light_kinds> to_light{};  // shadow by LightKind
  std::uint64_t gather = 0;      // over the hemisphere of diffuse surfaces
  std::uint64_t lobe = 0;        // over the lobe of glossy ones
  std::uint64_t mirror = 0;      // on from mirrors, whatever ray met them
  std::uint64_t refraction = 0;  // on from glass
  std::uint64_t planning = 0;    // of the look ahead, all kinds together
  std::uint64_t layers = 0;      // for layers alone

  void add_shadow(scenes::LightKind kind, std::uint64_t count = 1) {
    shadow += count;
    to_light[static_cast<std::size_t>(kind)] += count;
  }
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera;
    shadow += other.shadow;
    gather += other.gather;
    lobe += other.lobe;
    mirror += other.mirror;
    refraction += other.refraction;
    planning += other.planning;
    layers += other.layers;
    for (std::size_t k = 0; k < to_light.size(); ++k) to_light[k] += other.to_light[k];
    return *this;
  }
  [[nodiscard]] std::uint64_t total() const {
    return camera + shadow + gather + lobe + mirror + refraction + planning + layers;
  }
};

struct RenderReport {
  RayCounts rays;
  double seconds = 0.0;         // wall
  double gather_seconds = 0.0;  // of them for the gather field
  // RMS standard error of a pixel's luminance over the mean luminance, both without the pixels that
  // show a source itself.
  double relative_noise = 0.0;
  double gather_noise = 0.0;    // the part of it that gather points have
  double camera_samples = 0.0;  // per pixel, mean
  int most_camera_samples = 0;
  int gather_rays = 0;           // per pixel
  int least_camera_samples = 0;  // of a finished pixel
  double finished_share = 1.0;   // of the pixels; less than 1 if it was stopped, the others then
                                 // show a single sample
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
  // Per pixel of the window: of its luminance, as its samples and gather points state it,
  // (cd/m^2)^2; shows_source where a sample saw a source itself. Not of traced paths.
  std::vector<float> squared_error;
  RenderReport report;
};
inline constexpr float shows_source = -1.0F;

}  // namespace earthshine::raytrace
