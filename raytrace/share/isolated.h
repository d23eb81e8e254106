// SPDX-License-Identifier: Apache-2.0
// Gather points that stand alone: of the grid, without neighbours, and off-grid points that neither
// a point of the grid nor mirror neighbours stand beside. All that they know of their noise is what
// the halves of their own few rounds differ by. That is right on the average over such points, but
// the halves of one may agree by chance, and a point that seems exact would get no more samples for
// ever.
//
// So the noise that is likely tells where samples go: half the point's own, half that of as many
// samples of any point of its region of the picture. It is not stated: where noise differs from
// surface to surface, and samples with it, it would be too large (docs/log/renderer.md).
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
