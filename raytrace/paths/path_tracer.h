// SPDX-License-Identifier: Apache-2.0
// The reference: a plain path tracer. It has no patches and reads no radiosity, so that it shares
// only rays, sources and materials with the final gather that it checks (render.h).
//
// A path starts at the camera and continues at each surface by one mechanism, drawn at random:
// diffuse reflection, Phong lobe, mirror or glass. Each source is sampled by one strategy:
//
//   sources seen by the camera, directly or by      camera rays
//     mirrors and glass only
//   point, spot, rectangle, disk lamps; Sun;        a shadow ray from every diffuse or
//     narrow Earth; emitters that are a small         glossy surface of the path
//     part of the area
//   wide Earth; emitters that are a large part      paths that hit them
//   any of these by mirror or glass from a          paths that hit them by chance (caustics);
//     diffuse or glossy surface                       never for point and spot lamps
//
// Paths end by Russian roulette only, never at a fixed length. Paths are independent, hence the
// variance is the sample variance over the number of paths, without bias. Conventions are those of
// the final gather: lamps are visible but block no light; ambient light is added to surfaces that
// the camera sees (also by mirrors and glass) and is not reflected further.
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
  // Called once per row; if it returns true, the remaining rows stay black.
  std::function<bool()> stop = {};
  Window window = {};  // in the picture; without columns, the whole picture
};

// Channels R, G, B (cd/m^2); `variance`, of the pixel's mean luminance, (cd/m^2)^2; with per_light
// light_<group>.R/G/B, whose sum is R, G, B. Box filter over the pixel. The same bytes on any
// number of threads. In the report `gather` counts diffuse bounces, gather_rays is 0. Throws
// base::Error (Input) for a picture without pixels or fewer than two paths.
[[nodiscard]] Frame trace_paths(const scenes::World& world, const scenes::Camera& camera,
                                const PathOptions& options, const Progress& progress = {});

}  // namespace earthshine::raytrace
