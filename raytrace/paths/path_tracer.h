// SPDX-License-Identifier: Apache-2.0
// The reference: a plain path tracer. It knows no patches and reads no radiosity, so that it shares
// only rays, sources and materials with the final gather that it is there to check (render.h).
//
// A path starts at the camera and goes on at each surface by one of its mechanisms, chosen by
// chance: diffuse reflection, Phong lobe, mirror, glass. Each source is reached by one strategy:
//
//   seen along mirrors and glass alone from the camera     what the ray meets
//   point, spot, rectangle, disk lamps; Sun; Earth, if     a shadow ray from every diffuse or
//   glossy
//     narrow; emitters that are a small part of the area     surface of the path
//   Earth, if wide; emitters that are a large part         paths that meet them
//   any of these by mirror or glass from a surface that    paths that meet them: caustics, found by
//     is neither                                             chance, of point and spot lamps never
//
// Paths end by Russian roulette alone, never at a fixed length. Sampling is independent from path
// to path, hence the variance is the sample variance over the number of paths, without bias. What
// is not physics is as in the final gather: lamps are seen but block no light; the ambient term
// lights what the camera sees (also along mirrors and glass) and goes no further.
#pragma once

#include <cstdint>
#include <functional>

#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

struct PathOptions {
  int columns = 512;
  int rows = 512;
  int paths_per_pixel = 256;  // at least 2
  bool per_light = false;
  PathSet paths = PathSet::All;
  std::uint64_t seed = 1;
  // Asked once per row; once it says true the rows that are left stay black.
  std::function<bool()> stop = {};
  Window window = {};  // of the picture, within it; without columns the whole of it
};

// Channels R, G, B (cd/m^2); `variance`, of the pixel's mean luminance, (cd/m^2)^2; with per_light
// light_<group>.R/G/B, whose sum is R, G, B. Box filter over the pixel. The same bytes on any
// number of threads. In the report `gather` counts diffuse bounces, gather_rays is 0.
// Throws base::Error (Input) for a picture without pixels or fewer than two paths.
[[nodiscard]] Frame trace_paths(const scenes::World& world, const scenes::Camera& camera,
                                const PathOptions& options, const Progress& progress = {});

}  // namespace earthshine::raytrace
