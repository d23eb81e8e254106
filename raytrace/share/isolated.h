// SPDX-License-Identifier: Apache-2.0
// Isolated gather points: grid points without neighbours, and off-grid points without a grid point
// or mirror neighbours on their surface. Only the half differences of their few rounds measure
// their noise. They are right on average, but the halves of one point may agree by chance, and a
// point that seems exact would never get more samples.
//
// Allocation therefore uses half of the point's own variance and half of the variance that other
// points of its region predict for as many samples. This value is not stated: where noise differs
// from surface to surface, and the sample counts with it, it would be too large
// (docs/log/renderer.md).
#pragma once

#include <span>

#include "raytrace/share/off_grid.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {

// Fills Shared::variance_prior. neighbours: of the grid, whose points lie row by row in the window.
void regularise_isolated_variance(const Neighbours& neighbours, const Window& window,
                                  std::span<const OffGridPoint> off_grid_points,
                                  const Estimate& estimate, Shared& shared);

}  // namespace earthshine::raytrace
