// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/weighted_resels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "degrade/moments/point_moments.h"

namespace earthshine::studies {
namespace {

using degrade::AxisMap;
using degrade::Plane;

// A part of the grid with a value per resel.
struct Box {
  int x0 = 0, y0 = 0, columns = 0, rows = 0;
  std::vector<double> values;

  Box(int left, int top, int wide, int high)
      : x0(left),
        y0(top),
        columns(wide),
        rows(high),
        values(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), 0.0) {}
  [[nodiscard]] double* row(int y) {
    return values.data() + static_cast<std::ptrdiff_t>(y - y0) * columns;
  }
  [[nodiscard]] const double* row(int y) const {
    return values.data() + static_cast<std::ptrdiff_t>(y - y0) * columns;
  }
};

struct Range {
  int first = 0, count = 0;
};
Range sources_of(const AxisMap& map, int first, int count) {
  std::size_t low = map.source[map.start[static_cast<std::size_t>(first)]], high = low;
  for (std::size_t k = map.start[static_cast<std::size_t>(first)];
       k < map.start[static_cast<std::size_t>(first + count)]; ++k) {
    low = std::min(low, map.source[k]);
    high = std::max(high, map.source[k]);
  }
  return {static_cast<int>(low), static_cast<int>(high - low) + 1};
}

Box transposed_along(const Box& in, const AxisMap& map) {
  const Range to = sources_of(map, in.x0, in.columns);
  Box out(to.first, in.y0, to.count, in.rows);
  for (int y = in.y0; y < in.y0 + in.rows; ++y) {
    const double* from = in.row(y);
    double* line = out.row(y) - out.x0;
    for (int x = 0; x < in.columns; ++x) {
      if (from[x] == 0.0) continue;
      const std::size_t i = static_cast<std::size_t>(in.x0 + x);
      for (std::size_t k = map.start[i]; k < map.start[i + 1]; ++k) {
        line[map.source[k]] += map.weight[k] * from[x];
      }
    }
  }
  return out;
}

Box transposed_across(const Box& in, const AxisMap& map) {
  const Range to = sources_of(map, in.y0, in.rows);
  Box out(in.x0, to.first, in.columns, to.count);
  for (int y = in.y0; y < in.y0 + in.rows; ++y) {
    const double* from = in.row(y);
    const std::size_t i = static_cast<std::size_t>(y);
    for (std::size_t k = map.start[i]; k < map.start[i + 1]; ++k) {
      double* line = out.row(static_cast<int>(map.source[k]));
      for (int x = 0; x < in.columns; ++x) line[x] += map.weight[k] * from[x];
    }
  }
  return out;
}

// The smallest box around both sets, with values 0.
Box box_around(const WeightedResels& a, const WeightedResels& b, int columns) {
  int left = columns, right = -1, top = 0, bottom = -1;
  bool any = false;
  for (const WeightedResels* set : {&a, &b}) {
    for (const std::uint32_t resel : set->resel) {
      const int x = static_cast<int>(resel) % columns, y = static_cast<int>(resel) / columns;
      left = std::min(left, x);
      right = std::max(right, x);
      top = any ? std::min(top, y) : y;
      bottom = any ? std::max(bottom, y) : y;
      any = true;
    }
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

// w(x) f(x) on the rows of one field, or on all (field < 0).
template <class F>
Box filled(Box box, const WeightedResels& set, int columns, int field, F f) {
  for (std::size_t i = 0; i < set.resel.size(); ++i) {
    const int x = static_cast<int>(set.resel[i]) % columns;
    const int y = static_cast<int>(set.resel[i]) / columns;
    if (field >= 0 && y % 2 != field) continue;
    box.row(y)[x - box.x0] = set.weight[i] * f(set.resel[i]);
  }
  return box;
}

void multiply(Box& box, const Plane& by, int columns) {
  if (by.empty()) return;
  for (int y = box.y0; y < box.y0 + box.rows; ++y) {
    for (int x = 0; x < box.columns; ++x) {
      box.row(y)[x] *=
          static_cast<double>(by[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                 static_cast<std::size_t>(box.x0 + x)]);
    }
  }
}

// Weights g of the two sets where the noise enters, per field.
struct Seen {
  std::vector<Box> a, b;  // one or two fields; all with the same extent
};

// Sum over z of v(z) p(z) q(z) for two boxes p of one field and two boxes q of another.
template <class Variance>
MeanNoise sums_of(const Seen& g, std::size_t p, std::size_t q, Variance v) {
  const Box& place = g.a[p];
  MeanNoise sum;
  for (int y = place.y0; y < place.y0 + place.rows; ++y) {
    const double *a = g.a[p].row(y), *b = g.b[p].row(y), *a2 = g.a[q].row(y), *b2 = g.b[q].row(y);
    for (int x = 0; x < place.columns; ++x) {
      const double value = v(place.x0 + x, y), va = value * a[x];
      sum.variance_a += va * a2[x];
      sum.variance_b += value * b[x] * b2[x];
      sum.covariance += va * b2[x];
    }
  }
  return sum;
}

// Adds noise with these variances: within a field, and between the two.
template <class Variance>
void add_noise(MeanNoise& noise, const Seen& g, Variance v, const TimeFactors& time, double share) {
  for (std::size_t f = 0; f < g.a.size(); ++f) {
    for (std::size_t h = 0; h < g.a.size(); ++h) {
      const double factor = share * (f == h ? time.same : time.other);
      if (factor == 0.0) continue;
      const MeanNoise sum = sums_of(g, f, h, v);
      noise.variance_a += factor * sum.variance_a;
      noise.variance_b += factor * sum.variance_b;
      noise.covariance += factor * sum.covariance;
    }
  }
}

}  // namespace

WeightedResels weigh(const std::vector<std::uint32_t>& pixels, int picture_columns,
                     int picture_rows, int grid_columns, int grid_rows) {
  if (pixels.empty()) return {};
  const std::size_t wide = static_cast<std::size_t>(grid_columns);
  // Only the grid rows that the pixels can reach, because most sets are small.
  const auto row_of = [&](std::uint32_t pixel, std::uint32_t below) {
    const double row = pixel / static_cast<std::uint32_t>(picture_columns) + below;
    return std::min(static_cast<std::size_t>(row * grid_rows / picture_rows) + below,
                    static_cast<std::size_t>(grid_rows));
  };
  const auto [top, bottom] = std::minmax_element(pixels.begin(), pixels.end());
  const std::size_t first_row = row_of(*top, 0), rows = row_of(*bottom, 1) - first_row;
  std::vector<double> cover(wide * rows, 0.0);
  struct Part {
    std::size_t at;
    double share;
  };
  const auto parts = [](std::uint32_t pixel, int of, int onto, std::vector<Part>& into) {
    into.clear();
    const double step = static_cast<double>(onto) / of;
    const double begin = pixel * step, end = (pixel + 1.0) * step;
    for (int k = static_cast<int>(begin); k < onto && k < end; ++k) {
      const double share = std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k));
      if (share > 1e-9 * step) into.push_back({static_cast<std::size_t>(k), share});
    }
  };
  std::vector<Part> along, across;
  for (const std::uint32_t pixel : pixels) {
    const std::uint32_t width = static_cast<std::uint32_t>(picture_columns);
    parts(pixel % width, picture_columns, grid_columns, along);
    parts(pixel / width, picture_rows, grid_rows, across);
    for (const Part& y : across) {
      for (const Part& x : along) cover[(y.at - first_row) * wide + x.at] += x.share * y.share;
    }
  }
  WeightedResels set;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    if (cover[i] == 0.0) continue;
    set.resel.push_back(static_cast<std::uint32_t>(first_row * wide + i));
    set.weight.push_back(cover[i]);
    set.area += cover[i];
  }
  for (double& weight : set.weight) weight /= set.area;
  return set;
}

WeightedResels screen_sources(const degrade::PlaneMap& spread, const WeightedResels& of) {
  WeightedResels sources;
  if (of.empty()) return sources;
  const int columns = spread.along.out();
  const Box target =
      filled(box_around(of, of, columns), of, columns, -1, [](std::uint32_t) { return 1.0; });
  const Box reach = transposed_across(transposed_along(target, spread.along), spread.across);
  for (int y = reach.y0; y < reach.y0 + reach.rows; ++y) {
    for (int x = 0; x < reach.columns; ++x) {
      if (reach.row(y)[x] == 0.0) continue;
      sources.resel.push_back(static_cast<std::uint32_t>(y * columns + reach.x0 + x));
      sources.weight.push_back(reach.row(y)[x]);
    }
  }
  return sources;
}

double screen_mean(const CctvSignal& line, const ShownMoments& moments,
                   const WeightedResels& screen) {
  double sum = 0.0;
  for (std::size_t i = 0; i < screen.resel.size(); ++i) {
    sum += screen.weight[i] * static_cast<double>(moments.luminance[screen.resel[i]]);
  }
  return sum + line.room_luminance;
}

MeanNoise mean_noise(const CctvSignal& line, const ShownMoments& moments, const WeightedResels& a,
                     const WeightedResels& b, int frames) {
  MeanNoise noise;
  const TimeFactors light = time_factors(line.lag_per_field, line.has_fields, frames),
                    read = time_factors(0.0, line.has_fields, frames), still{1.0, 1.0};
  const Box empty = box_around(a, b, line.columns);
  const std::vector<int> fields = line.has_fields ? std::vector<int>{0, 1} : std::vector<int>{-1};
  for (std::size_t p = 0; p < line.planes.size(); ++p) {
    const SignalPlane& plane = line.planes[p];
    const double share = line.luminance_share[p] * line.luminance_share[p];
    Seen by_amplifier, by_light;
    for (const int field : fields) {
      const auto seen = [&](const WeightedResels& set) {
        Box box = filled(empty, set, line.columns, field, [&](std::uint32_t resel) {
          return static_cast<double>(moments.slope[p][resel]);
        });
        return transposed_along(box, line.bandwidth);
      };
      const auto seen_by_light = [&](Box box) {
        multiply(box, plane.passed, line.columns);
        return transposed_across(transposed_along(box, line.blur_along), line.blur_across);
      };
      by_amplifier.a.push_back(seen(a));
      by_amplifier.b.push_back(seen(b));
      by_light.a.push_back(seen_by_light(by_amplifier.a.back()));
      by_light.b.push_back(seen_by_light(by_amplifier.b.back()));
    }
    const auto of = [&](const Plane& variance) {
      return [&variance, wide = line.columns](int x, int y) {
        return static_cast<double>(variance[static_cast<std::size_t>(y * wide + x)]);
      };
    };
    add_noise(noise, by_light, of(plane.grain), light, share);
    if (!plane.pattern.empty()) add_noise(noise, by_light, of(plane.pattern), still, share);
    const auto level = [](double variance) { return [variance](int, int) { return variance; }; };
    if (line.amplifier > 0.0) add_noise(noise, by_amplifier, level(line.amplifier), read, share);
    if (line.amplifier_pattern > 0.0) {
      add_noise(noise, by_amplifier, level(line.amplifier_pattern), still, share);
    }
  }
  const auto beyond = [&](const WeightedResels& set) {
    double sum = 0.0;
    for (std::size_t i = 0; i < set.resel.size(); ++i) {
      sum += set.weight[i] * set.weight[i] * static_cast<double>(moments.beyond[set.resel[i]]);
    }
    return sum / frames;
  };
  noise.variance_a += beyond(a);
  noise.variance_b += beyond(b);
  return noise;
}

TimeFactors time_factors(double lag, bool has_fields, int frames) {
  TimeFactors sum{0.0, 0.0};
  for (int i = 0; i < frames; ++i) {
    for (int j = 0; j < frames; ++j) {
      sum.same += std::pow(lag, 2.0 * std::abs(i - j));
      if (has_fields) sum.other += std::pow(lag, std::abs(2.0 * (i - j) + 1.0));
    }
  }
  const double count = static_cast<double>(frames) * frames;
  return {sum.same / count, sum.other / count};
}

}  // namespace earthshine::studies
