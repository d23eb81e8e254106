// SPDX-License-Identifier: Apache-2.0
// Laws that predict the cost of a run from a small one.
#pragma once

#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/frame.h"

namespace earthshine::studies {

// Patches at the end of refinement, at most `most`: a power law through the errors of the first and
// the last round, error ~ patches^-p. The first rounds are noisy, so that p is limited to 0.25 to 1
// (piecewise constant light converges as patches^-1/2, slower around shadow edges). In the
// remaining rounds the patches grow by at most the largest factor of the last four rounds.
[[nodiscard]] double expected_patches(const std::vector<radiosity::RefineRound>& rounds,
                                      double wanted_error, double most);

struct SolveScale {
  double patches = 0.0;      // of the whole run
  double rays = 1.0;         // per patch, whole over small
  double row_entries = 0.0;  // of a mean row of the whole run
  bool refines = false;
};
// Rays and seconds of form factors are proportional to patches times rays. Shadow rays and their
// seconds are proportional to patches. Balance and linear solve are proportional to the entries of
// the matrix, and cost at least as much as in the small run. Refinement is proportional to patches
// times an eighth of the rays, which its rounds use, at least as many as in the small run.
[[nodiscard]] radiosity::SolveReport scaled(const radiosity::SolveReport& small,
                                            const SolveScale& scale);

struct PictureScale {
  double small_pixels = 1.0, pixels = 1.0;
  double paths = 0.0;  // per pixel of the whole picture; 0: no path tracing
};
// From two small pictures of one view: the finer one with the cost of its pixels as part of the
// whole picture. A pixel on an edge costs more, and the share of edge pixels falls with the
// picture's width: a pixel costs a + b / sqrt(pixels). At least a third of the finer one's cost;
// unchanged if its pixels did not cost less than the coarse ones.
struct SmallPicture {
  raytrace::RenderReport report;
  double pixels = 1.0;
};
[[nodiscard]] raytrace::RenderReport as_part_of(double whole_pixels, const SmallPicture& coarse,
                                                const SmallPicture& fine);

// Rays and seconds are proportional to pixels; for path tracing, to pixels times paths.
[[nodiscard]] raytrace::RenderReport scaled(const raytrace::RenderReport& small,
                                            const PictureScale& scale);

}  // namespace earthshine::studies
