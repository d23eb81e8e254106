// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/slanted_edge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "base/units.h"
#include "degrade/certify/test_bench.h"
#include "degrade/moments/noise_lines.h"

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

// Centroids of the derivative of each line within `window` of the guess, then a least-squares line.
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
  // Under strong noise the fit is arbitrary; this keeps it inside the picture.
  const double steepest = std::tan(base::radians(most_degrees));
  return {std::clamp((sx - slope * sy) / n, 0.0, columns - 1.0),
          std::clamp(slope, -steepest, steepest)};
}

// Slanted edge, 5 degrees off the lines or the columns, from near black to near white.

constexpr double tilt = 5.0 * base::pi / 180.0;
constexpr double low = 0.2, high = 0.8;
constexpr int profile_bins = 16;
constexpr double nyquist = 0.5;
constexpr double limit_of_sight = 0.05;  // modulation below which lines are not resolved
constexpr int chart_fineness = 2;        // also tests the area average onto the grid

base::Image edge_chart(const Bench& bench, Axis axis) {
  const double middle_x = 0.5 * bench.columns(), middle_y = 0.5 * bench.rows();
  return bench.chart(
      [&](double x, double y) {
        const double u = x - middle_x, v = y - middle_y;
        const double away = axis == Axis::Along ? u * std::cos(tilt) + v * std::sin(tilt)
                                                : v * std::cos(tilt) + u * std::sin(tilt);
        return low + (high - low) * edge_coverage(tilt, away * chart_fineness);
      },
      chart_fineness);
}

// Omits lines near the border: they contain the mirrored edge, which has a kink.
SlantedEdge measure(const Bench& bench, const Picture& picture, Axis axis, double reach,
                    int bins = bins_per_resel) {
  const bool along = axis == Axis::Along;
  const Plane upright =
      along ? picture.planes[0] : transposed(picture.planes[0], picture.columns, picture.rows);
  const int columns = along ? picture.columns : picture.rows;
  const int rows = along ? picture.rows : picture.columns;
  const std::ptrdiff_t border = static_cast<std::ptrdiff_t>(bench.margin()) * columns;
  return measure_edge(Plane(upright.begin() + border, upright.end() - border), columns,
                      rows - 2 * bench.margin(), reach, bins);
}

struct Laws {
  const Bench& bench;
  Axis axis;
  Filter filter;

  [[nodiscard]] double modulation(double f) const {
    return edge_modulation(bench.camera(), bench.monitor(), axis, tilt, f);
  }
  [[nodiscard]] double profile(double x) const { return edge_profile(filter, axis, tilt, x); }
  // The profile interpolated between two bins: the mean over both.
  [[nodiscard]] double profile_in_bins(double x) const {
    constexpr int steps = 8;
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
      sum += profile(x + ((k + 0.5) / steps - 0.5) * 2.0 / profile_bins);
    }
    return sum / steps;
  }
  // The first crossing, searched from the dark side.
  [[nodiscard]] double crossing(double level) const {
    double x = -filter.radius() - 2.0;
    while (profile(x + 0.01) < level) x += 0.01;
    const double before = profile(x), after = profile(x + 0.01);
    return x + 0.01 * (level - before) / (after - before);
  }
};

// With noise: mean modulation of sixteen cameras with different fixed patterns, and its scatter.
CertificateRow with_noise(const Bench& bench, const base::Image& chart, const Laws& law,
                          double reach, double most, std::string_view name) {
  if (!bench.noise().shows(high)) return absent(name, "1", "the camera has no noise that shows");
  const double sigma = std::sqrt(bench.noise().total(high));
  // Noise at the ends of a line moves its centroid by sigma sqrt 2 reach / step.
  const int lines = (law.axis == Axis::Along ? bench.rows() : bench.columns()) - 2 * bench.margin();
  const double shift = sigma * std::sqrt(2.0) * reach / (high - low) / std::sqrt(lines);
  if (shift > 0.12) return absent(name, "1", "its noise drowns the edge");
  constexpr double frequency = 0.25;
  std::vector<double> found;
  for (std::uint64_t copy = 0; copy < 16; ++copy) {
    Options options = bench.options({});
    options.seed += copy;
    found.push_back(
        measure(bench, bench.linear(chart, options), law.axis, reach).modulation(frequency));
  }
  return within_errors(name, "1", mean_of(found), law.modulation(frequency),
                       "product of the stages' transfers; 0.02 besides four standard errors",
                       0.02 * most);
}

void measure_axis(const Bench& bench, Axis axis, Rows& rows, std::vector<SharpnessPoint>& points) {
  const bool along = axis == Axis::Along;
  const auto named = [&](std::string_view what) {
    return std::string(along ? "along the line: " : "across lines: ") + std::string(what);
  };
  const Laws law{bench, axis, filter_of(bench.camera(), bench.monitor(), Travels::Picture)};
  const double reach =
      std::min(law.filter.radius() + 6.0, 0.4 * (along ? bench.columns() : bench.rows()));
  const base::Image chart = edge_chart(bench, axis);
  const Picture picture = bench.linear(chart, 0, stage::noise);
  const SlantedEdge edge = measure(bench, picture, axis, reach);
  const SlantedEdge fine = measure(bench, picture, axis, reach, profile_bins);
  const auto measured = [&](double f) { return edge.modulation(f); };
  const auto expected = [&](double f) { return law.modulation(f); };

  // Sharpening raises the law, and its errors, above 1. Few lines leave few samples per bin.
  const int lines = (along ? bench.rows() : bench.columns()) - 2 * bench.margin();
  double worst = 0.0, most = std::max(1.0, 100.0 / lines);
  if (points.empty()) {
    for (int k = 0; k <= 20; ++k) points.push_back({.frequency = nyquist * k / 20.0});
  }
  for (SharpnessPoint& point : points) {
    const double found = measured(point.frequency), due = expected(point.frequency);
    (along ? point.along : point.across) = found;
    (along ? point.law_along : point.law_across) = due;
    worst = farther(worst, found - due);
    most = std::max(most, due);
  }
  rows.push_back(within(named("MTF, worst difference up to Nyquist"), "1", worst, 0.0, 0.02 * most,
                        "product of the stages' transfers with the resel's sinc"));
  rows.push_back(within(named("MTF at Nyquist"), "1", measured(nyquist), expected(nyquist),
                        0.02 * most, "the same at 0.5 cycles per resel"));
  rows.push_back(with_noise(bench, chart, law, reach, most, named("MTF at 0.25, noise on")));
  // The tolerance of a level's frequency is the tolerance of the MTF, 0.02, over the slope.
  const auto frequency_row = [&](std::string_view name, std::string_view unit, double level,
                                 double end, double factor, std::string_view text) {
    const double due = frequency_at(expected, level, end);
    const double early = frequency_at(expected, level + 0.02 * most, end);
    const double late = frequency_at(expected, level - 0.02 * most, end);
    rows.push_back(within(named(name), unit, factor * frequency_at(measured, level, end),
                          factor * due, factor * (std::max(due - early, late - due) + 0.005),
                          text));
  };
  frequency_row("MTF50", "cycles/resel", 0.5, 1.0, 1.0, "the transfers' product = 1/2");
  const double rise = law.crossing(0.9) - law.crossing(0.1);
  rows.push_back(within(named("10 to 90 % rise"), "resel", fine.crossing(0.9) - fine.crossing(0.1),
                        rise, 0.03 * std::max(rise, 1.0), "resel's box through the stages' taps"));
  rows.push_back(within(named("RER"), "1", fine.profile_at(0.5) - fine.profile_at(-0.5),
                        law.profile_in_bins(0.5) - law.profile_in_bins(-0.5), 0.02 * most,
                        "rise of the edge over one resel"));
  frequency_row("limiting resolution", "TV lines", limit_of_sight, nyquist, 2.0 * bench.rows(),
                "lines to a picture's height at 5 % modulation, at most the raster's");
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
  // Signals on both sides of the edge: means over an eighth of the reach, to reduce noise.
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

Rows edge_rows(const Bench& bench, std::vector<SharpnessPoint>& points) {
  Rows rows;
  measure_axis(bench, Axis::Along, rows, points);
  measure_axis(bench, Axis::Across, rows, points);
  return rows;
}

}  // namespace earthshine::degrade
