// SPDX-License-Identifier: Apache-2.0
// Slanted edge (ISO 12233): an edge tilted by a few degrees is sampled at many phases, so that its
// profile has a finer resolution than the grid.
//   ESF  edge spread along the edge's normal, in bins of a fraction of a resel
//   LSF  its derivative
//   MTF  modulus of the LSF's Fourier transform, 1 at frequency 0 because the ESF runs from 0 to 1
#pragma once

#include <vector>

#include "degrade/stage/picture.h"

namespace earthshine::degrade {

inline constexpr int bins_per_resel = 4;

struct SlantedEdge {
  double angle = 0.0;            // radians between the edge's normal and the line
  std::vector<double> position;  // resels along the normal; the edge is at 0
  std::vector<double> profile;   // ESF, 0 at the dark end and 1 at the bright end
  double low = 0.0, high = 0.0;  // signals at the ends
  int bins = bins_per_resel;

  // Corrects the mean over a bin and the difference of neighbours: each is a factor sinc(f / bins).
  [[nodiscard]] double modulation(double frequency) const;  // cycles per resel along the normal
  // First position at which the profile passes a level, by linear interpolation.
  [[nodiscard]] double crossing(double level) const;
  [[nodiscard]] double profile_at(double x) const;
};

// plane: dark on the left, bright on the right, the edge within 15 degrees of vertical and through
// the middle. reach: resels that are used on each side of the edge. The edge is the straight line
// through the centroids of the lines' derivatives (ISO 12233). Four bins per resel, as in the
// standard, suffice for the MTF; a profile needs more.
[[nodiscard]] SlantedEdge measure_edge(const Plane& plane, int columns, int rows, double reach,
                                       int bins = bins_per_resel);

// First frequency, from steps of 1/1000, at which the modulation falls to `level`; `most` if there
// is none.
template <class Modulation>
[[nodiscard]] double frequency_at(Modulation modulation, double level, double most) {
  constexpr double step = 1e-3;
  for (double f = step; f < most; f += step) {
    const double here = modulation(f);
    if (here > level) continue;
    const double before = modulation(f - step);
    return f - step * (level - here) / (before - here);
  }
  return most;
}

}  // namespace earthshine::degrade
