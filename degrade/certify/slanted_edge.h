// SPDX-License-Identifier: Apache-2.0
// Slanted edge (ISO 12233): an edge a few degrees off the lines of the grid is sampled at many
// phases, so its profile can be read finer than the grid.
//   ESF  edge spread along the edge's normal, in bins of a fraction of a resel
//   LSF  its derivative
//   MTF  modulus of the LSF's transform, 1 at frequency 0 because the ESF runs from 0 to 1
#pragma once

#include <vector>

#include "degrade/stage/picture.h"

namespace earthshine::degrade {

inline constexpr int bins_per_resel = 4;

struct SlantedEdge {
  double angle = 0.0;            // radians between the edge's normal and the line
  std::vector<double> position;  // resels along the normal, the edge at 0
  std::vector<double> profile;   // ESF, 0 at the dark end and 1 at the bright end
  double low = 0.0, high = 0.0;  // signals at the ends
  int bins = bins_per_resel;

  // Mean over a bin and difference of neighbours each damp by sinc(f / bins); this is undone.
  [[nodiscard]] double modulation(double frequency) const;  // cycles per resel along the normal
  // Position where the profile first passes a level, by straight lines between bins.
  [[nodiscard]] double crossing(double level) const;
  [[nodiscard]] double profile_at(double x) const;
};

// plane: dark on the left, bright on the right, the edge within 15 degrees of upright through the
// middle. reach: resels on either side of the edge that are looked at. The edge is found from the
// centroid of each line's derivative and a straight line through these, as ISO 12233 has it; its
// four bins to a resel are right for the MTF, a profile wants more.
[[nodiscard]] SlantedEdge measure_edge(const Plane& plane, int columns, int rows, double reach,
                                       int bins = bins_per_resel);

// First frequency, in steps of 1/1000, where the modulation falls to `level`; `most` if it does
// not.
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
