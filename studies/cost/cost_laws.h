// SPDX-License-Identifier: Apache-2.0
// How the cost of a run follows from that of a small one.
#pragma once

#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/frame.h"

namespace earthshine::studies {

// Patches until refinement ends, at most `most`: a power law through the errors of the first and
// the last round, error ~ patches^-p, with p held between 0.25 and 1 (noise of the first rounds
// gives anything; piecewise constant light converges as patches^-1/2, around shadows' edges
// slower). In the rounds that are left they grow by no more a round than in the last four.
[[nodiscard]] double expected_patches(const std::vector<radiosity::RefineRound>& rounds,
                                      double wanted_error, double most);

struct SolveScale {
  double patches = 0.0;      // of the whole
  double rays = 1.0;         // per patch, whole over small
  double row_entries = 0.0;  // of a mean row of the whole
  bool refines = false;
};
// Rays and seconds of form factors: as patches times rays. Shadow rays and their seconds: as
// patches. Balance and linear solve: as the entries of the matrix, never less than the small one's.
// Refinement: as patches times an eighth of the rays, which its rounds are solved with, at least as
// many as the small one has.
[[nodiscard]] radiosity::SolveReport scaled(const radiosity::SolveReport& small,
                                            const SolveScale& scale);

struct PictureScale {
  double small_pixels = 1.0, pixels = 1.0;
  double paths = 0.0;  // per pixel of the whole; 0: not traced by paths
};
// Of two small pictures of one view, the finer one with what its pixels would cost as part of the
// whole. A pixel on an edge costs more, and edges' share of the pixels falls as one over the
// picture's width: a pixel's cost is a + b / sqrt(pixels). Never less than a third of the finer
// one's; where it was not the less for being fine, as it is.
struct SmallPicture {
  raytrace::RenderReport report;
  double pixels = 1.0;
};
[[nodiscard]] raytrace::RenderReport as_part_of(double whole_pixels, const SmallPicture& coarse,
                                                const SmallPicture& fine);

// Rays and seconds as pixels; of paths as pixels times paths.
[[nodiscard]] raytrace::RenderReport scaled(const raytrace::RenderReport& small,
                                            const PictureScale& scale);

}  // namespace earthshine::studies
