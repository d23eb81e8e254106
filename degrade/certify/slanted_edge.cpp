// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/slanted_edge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

constexpr double most_degrees = 15.0;

struct Line {
  double at_middle = 0.0, slope = 0.0;  // x = at_middle + slope * (y - middle)
};

std::size_t index(int x, int y, int columns) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(x);
}

// Centroid of the derivative of each line within `window` of the guess, then least squares.
Line fit_line(const Plane& plane, int columns, int rows, const Line& guess, double window) {
  const double middle = 0.5 * (rows - 1);
  double n = 0.0, sx = 0.0, sy = 0.0, sxy = 0.0, syy = 0.0;
  for (int y = 0; y < rows; ++y) {
    const double centre = guess.at_middle + guess.slope * (y - middle);
    const int first = std::max(0, static_cast<int>(std::ceil(centre - window)));
    const int last = std::min(columns - 2, static_cast<int>(std::floor(centre + window)));
    double weights = 0.0, moment = 0.0;
    for (int x = first; x <= last; ++x) {
      const double step = static_cast<double>(plane[index(x + 1, y, columns)]) -
                          static_cast<double>(plane[index(x, y, columns)]);
      weights += step;
      moment += step * (x + 0.5);
    }
    if (weights == 0.0) continue;
    const double found = moment / weights, t = y - middle;
    if (!std::isfinite(found)) continue;
    n += 1.0;
    sx += found;
    sy += t;
    sxy += found * t;
    syy += t * t;
  }
  const double spread = n * syy - sy * sy;
  if (!(spread > 0.0)) return guess;
  const double slope = (n * sxy - sx * sy) / spread;
  // Where noise buries the edge the line could lie anywhere; it is kept in the picture.
  const double steepest = std::tan(base::radians(most_degrees));
  return {std::clamp((sx - slope * sy) / n, 0.0, columns - 1.0),
          std::clamp(slope, -steepest, steepest)};
}

}  // namespace

SlantedEdge measure_edge(const Plane& plane, int columns, int rows, double reach, int bins) {
  Line line{0.5 * (columns - 1), 0.0};
  const double lean = 0.5 * rows * std::tan(base::radians(most_degrees));
  for (const double window : {lean + reach, reach, reach}) {
    line = fit_line(plane, columns, rows, line, window);
  }
  SlantedEdge edge;
  edge.bins = bins;
  edge.angle = std::atan(line.slope);
  const double cosine = std::cos(edge.angle);
  const int half = static_cast<int>(std::ceil(reach * bins));
  std::vector<double> sum(static_cast<std::size_t>(2 * half), 0.0), count = sum;
  for (int y = 0; y < rows; ++y) {
    const double centre = line.at_middle + line.slope * (y - 0.5 * (rows - 1));
    const int first = std::max(0, static_cast<int>(std::floor(centre - reach / cosine)) - 1);
    const int last =
        std::min(columns - 1, static_cast<int>(std::ceil(centre + reach / cosine)) + 1);
    for (int x = first; x <= last; ++x) {
      const int bin = static_cast<int>(std::floor((x - centre) * cosine * bins)) + half;
      if (bin < 0 || bin >= 2 * half) continue;
      sum[static_cast<std::size_t>(bin)] += static_cast<double>(plane[index(x, y, columns)]);
      count[static_cast<std::size_t>(bin)] += 1.0;
    }
  }
  for (std::size_t bin = 0; bin < sum.size(); ++bin) {
    if (count[bin] == 0.0) continue;
    edge.position.push_back((static_cast<double>(bin) + 0.5 - half) / bins);
    edge.profile.push_back(sum[bin] / count[bin]);
  }
  // The ends are what the edge stands between: an eighth of the reach, to hold noise down.
  const std::size_t size = edge.profile.size();
  const std::size_t end = std::max<std::size_t>(1, size / 16);
  for (std::size_t k = 0; k < end; ++k) {
    edge.low += edge.profile[k] / static_cast<double>(end);
    edge.high += edge.profile[size - 1 - k] / static_cast<double>(end);
  }
  for (double& value : edge.profile) value = (value - edge.low) / (edge.high - edge.low);
  return edge;
}

double SlantedEdge::modulation(double frequency) const {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const double phase = 2.0 * base::pi * frequency * 0.5 * (position[k] + position[k + 1]);
    sum += (profile[k + 1] - profile[k]) * std::polar(1.0, -phase);
  }
  const double u = base::pi * frequency / bins;
  const double damped = u == 0.0 ? 1.0 : std::pow(std::sin(u) / u, 2.0);
  return std::abs(sum) / damped;
}

double SlantedEdge::crossing(double level) const {
  for (std::size_t k = 1; k < profile.size(); ++k) {
    if (profile[k] < level) continue;
    const double share = (level - profile[k - 1]) / (profile[k] - profile[k - 1]);
    return position[k - 1] + share * (position[k] - position[k - 1]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double SlantedEdge::profile_at(double x) const {
  const auto above = std::lower_bound(position.begin(), position.end(), x);
  if (above == position.begin()) return profile.front();
  if (above == position.end()) return profile.back();
  const auto k = static_cast<std::size_t>(above - position.begin());
  const double share = (x - position[k - 1]) / (position[k] - position[k - 1]);
  return profile[k - 1] + share * (profile[k] - profile[k - 1]);
}

}  // namespace earthshine::degrade
