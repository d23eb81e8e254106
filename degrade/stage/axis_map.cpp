// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/axis_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "base/parallel.h"
#include "base/units.h"

namespace earthshine::degrade {
namespace {

std::size_t mirrored(int index, int size) {
  const int period = 2 * size;
  const int m = ((index % period) + period) % period;
  return static_cast<std::size_t>(m < size ? m : period - 1 - m);
}

// Range of the nonzero values of a line; bloom and smear often cover a small part of a picture.
struct Extent {
  std::size_t first = std::numeric_limits<std::size_t>::max(), end = 0;

  void cover(const float* line, std::size_t width) {
    std::size_t x = 0;
    while (x < width && line[x] == 0.0F) ++x;
    if (x == width) return;
    first = std::min(first, x);
    for (x = width; line[x - 1] == 0.0F;) --x;
    end = std::max(end, x);
  }
};

// Processes eight rows at a time with interleaved values, so that each weight applies to eight
// adjacent values in memory.
constexpr std::size_t side_by_side = 8;

Plane map_rows(const Plane& in, int columns, int rows, const AxisMap& map) {
  const std::size_t width = static_cast<std::size_t>(columns);
  const std::size_t out_width = static_cast<std::size_t>(map.out());
  Plane out(out_width * static_cast<std::size_t>(rows));
  base::parallel_chunks(static_cast<std::size_t>(rows), side_by_side,
                        [&](std::size_t begin, std::size_t end) {
                          std::vector<std::array<float, side_by_side>> block(width);
                          Extent lit;
                          for (std::size_t y = begin; y < end; ++y) {
                            const float* const line = in.data() + y * width;
                            lit.cover(line, width);
                            for (std::size_t x = 0; x < width; ++x) block[x][y - begin] = line[x];
                          }
                          for (std::size_t x = 0; x < out_width; ++x) {
                            std::array<double, side_by_side> sum{};
                            const std::size_t stop = map.start[x + 1];
                            // Sources are in ascending order.
                            if (map.start[x] == stop || map.source[map.start[x]] >= lit.end ||
                                map.source[stop - 1] < lit.first) {
                              continue;
                            }
                            for (std::size_t k = map.start[x]; k < stop; ++k) {
                              const std::array<float, side_by_side>& values = block[map.source[k]];
                              const double weight = map.weight[k];
                              for (std::size_t r = 0; r < side_by_side; ++r) {
                                sum[r] += weight * static_cast<double>(values[r]);
                              }
                            }
                            for (std::size_t y = begin; y < end; ++y) {
                              out[y * out_width + x] = static_cast<float>(sum[y - begin]);
                            }
                          }
                        });
  return out;
}

Plane map_columns(const Plane& in, int columns, const AxisMap& map) {
  const std::size_t width = static_cast<std::size_t>(columns);
  const std::size_t out_rows = static_cast<std::size_t>(map.out());
  Plane out(width * out_rows);
  std::vector<Extent> lit(static_cast<std::size_t>(map.in));
  for (std::size_t y = 0; y < lit.size(); ++y) lit[y].cover(in.data() + y * width, width);
  base::parallel_chunks(out_rows, 8, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(width);
    for (std::size_t y = begin; y < end; ++y) {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (std::size_t k = map.start[y]; k < map.start[y + 1]; ++k) {
        const float* const line = in.data() + map.source[k] * width;
        const double weight = map.weight[k];
        const Extent& part = lit[map.source[k]];
        for (std::size_t x = part.first; x < part.end; ++x) {
          sum[x] += weight * static_cast<double>(line[x]);
        }
      }
      std::transform(sum.begin(), sum.end(), out.begin() + static_cast<std::ptrdiff_t>(y * width),
                     [](double value) { return static_cast<float>(value); });
    }
  });
  return out;
}

}  // namespace

void add_output(AxisMap& map, int first, const std::vector<double>& weight) {
  double total = 0.0;
  for (const double value : weight) total += value;
  const auto add = [&](std::size_t source, double value) {
    if (value == 0.0) return;
    map.source.push_back(source);
    map.weight.push_back(value / total);
  };
  if (first >= 0 && first + static_cast<int>(weight.size()) <= map.in) {
    for (std::size_t k = 0; k < weight.size(); ++k) {
      add(static_cast<std::size_t>(first) + k, weight[k]);
    }
  } else {
    std::map<std::size_t, double> folded;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      folded[mirrored(first + static_cast<int>(k), map.in)] += weight[k];
    }
    for (const auto& [source, value] : folded) add(source, value);
  }
  map.start.push_back(map.source.size());
}

AxisMap area_average(int in, int out) {
  AxisMap map;
  map.in = in;
  const double step = static_cast<double>(in) / out;
  for (int i = 0; i < out; ++i) {
    // Both ends by the same formula, so that neighbours meet without gap or overlap.
    const double begin = i * static_cast<double>(in) / out;
    const double end = (i + 1) * static_cast<double>(in) / out;
    const int first = std::min(static_cast<int>(begin), in - 1);
    std::vector<double> weight;
    for (int j = first; j < in && (j < end || j == first); ++j) {
      const double share = std::min(end, j + 1.0) - std::max(begin, static_cast<double>(j));
      // A sliver is the rounding of an end on a pixel's border.
      weight.push_back(share > 1e-12 * step ? share : 0.0);
    }
    add_output(map, first, weight);
  }
  return map;
}

namespace {

std::vector<double> find_discrete_gaussian(double sigma) {
  const double t = sigma * sigma;
  // e^-t I_n(t) = (1/pi) integral over [0, pi] of exp(-t (1 - cos u)) cos(n u) du. For a periodic
  // function the trapezoidal rule is exact up to terms of order 2 * steps - n, far beyond any
  // kernel here.
  const int steps = std::max(512, static_cast<int>(std::ceil(16.0 * sigma)));
  std::vector<double> weight;  // of each step, for all n
  for (int k = 0; k <= steps; ++k) {
    const double end = k == 0 || k == steps ? 0.5 : 1.0;
    weight.push_back(end * std::exp(-t * (1.0 - std::cos(base::pi * k / steps))));
  }
  const auto term = [&](int n) {
    double sum = 0.0;
    for (int k = 0; k <= steps; ++k) {
      sum += weight[static_cast<std::size_t>(k)] * std::cos(n * (base::pi * k / steps));
    }
    return sum / steps;
  };
  std::vector<double> half = {term(0)};
  while (half.back() > 1e-10 && half.size() < static_cast<std::size_t>(steps) / 2) {
    half.push_back(std::max(0.0, term(static_cast<int>(half.size()))));
  }
  std::vector<double> kernel(half.rbegin(), half.rend());
  kernel.insert(kernel.end(), half.begin() + 1, half.end());
  return kernel;
}

}  // namespace

// Cached, because a study uses the same few widths thousands of times.
std::vector<double> discrete_gaussian(double sigma) {
  constexpr std::size_t most_kept = 64;
  static std::mutex guard;
  static std::map<double, std::vector<double>> kept;
  const std::lock_guard lock(guard);
  if (kept.size() >= most_kept) kept.clear();
  std::vector<double>& kernel = kept[sigma];
  if (kernel.empty()) kernel = find_discrete_gaussian(sigma);
  return kernel;
}

AxisMap without_taps_below(const AxisMap& map, double least) {
  AxisMap kept;
  kept.in = map.in;
  for (std::size_t i = 0; i + 1 < map.start.size(); ++i) {
    for (std::size_t k = map.start[i]; k < map.start[i + 1]; ++k) {
      if (std::abs(map.weight[k]) < least) continue;
      kept.source.push_back(map.source[k]);
      kept.weight.push_back(map.weight[k]);
    }
    kept.start.push_back(kept.source.size());
  }
  return kept;
}

AxisMap symmetric_filter(int size, const std::vector<double>& taps) {
  AxisMap map;
  map.in = size;
  const int radius = static_cast<int>(taps.size() / 2);
  std::size_t first = 0, count = 0;  // of the first output away from the borders
  for (int i = 0; i < size; ++i) {
    const bool inside = i >= radius && i + radius < size;
    if (!inside || count == 0) {
      add_output(map, i - radius, taps);
      if (inside) first = map.start[map.start.size() - 2], count = map.source.size() - first;
      continue;
    }
    // The same taps, shifted.
    const std::size_t on = static_cast<std::size_t>(i - radius);
    for (std::size_t k = first; k < first + count; ++k) {
      map.source.push_back(map.source[k] + on);
      map.weight.push_back(map.weight[k]);
    }
    map.start.push_back(map.source.size());
  }
  return map;
}

AxisMap gaussian_blur(int size, double sigma) {
  return symmetric_filter(size, sigma > 0.0 ? discrete_gaussian(sigma) : std::vector<double>{1.0});
}

Picture apply(const Picture& picture, const AxisMap& along, const AxisMap& across) {
  Picture result{along.out(), across.out(), {}};
  for (const Plane& plane : picture.planes) {
    result.planes.push_back(
        map_columns(map_rows(plane, picture.columns, picture.rows, along), along.out(), across));
  }
  return result;
}

}  // namespace earthshine::degrade
