// SPDX-License-Identifier: Apache-2.0
#include "degrade/moments/noise_moments.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "degrade/moments/noise_lines.h"

namespace earthshine::degrade {
namespace {

void check_fits(const AxisMap& map, int size, const char* axis) {
  if (map.in == size) return;
  throw base::Error(base::Blame::Input, "noise moments",
                    std::string("a map of ") + std::to_string(map.in) + " pixels for " +
                        std::to_string(size) + " " + axis,
                    "A map takes as many pixels as the picture has", "Make it for this picture");
}

void check_same_size(const AxisMap& map) {
  if (map.out() == map.in) return;
  throw base::Error(
      base::Blame::Input, "noise moments",
      "a filter that makes " + std::to_string(map.out()) + " pixels of " + std::to_string(map.in),
      "A filter keeps the size of the picture",
      "Use variance_after, which gives the variance on another grid");
}

// Weights w(i, u) v(i, u + lag) of C at this lag; both maps have the same outputs.
AxisMap product(const AxisMap& w, const AxisMap& v, int lag) {
  AxisMap map;
  map.in = w.in;
  for (std::size_t i = 0; i + 1 < w.start.size(); ++i) {
    const auto first = v.source.begin() + static_cast<std::ptrdiff_t>(v.start[i]);
    const auto last = v.source.begin() + static_cast<std::ptrdiff_t>(v.start[i + 1]);
    for (std::size_t k = w.start[i]; k < w.start[i + 1]; ++k) {
      const std::ptrdiff_t partner = static_cast<std::ptrdiff_t>(w.source[k]) + lag;
      if (partner < 0) continue;
      const auto found = std::find(first, last, static_cast<std::size_t>(partner));
      if (found == last) continue;
      map.source.push_back(w.source[k]);
      map.weight.push_back(w.weight[k] *
                           v.weight[size(static_cast<int>(found - v.source.begin()))]);
    }
    map.start.push_back(map.source.size());
  }
  return map;
}

// Adds the sum over z and the stored d of a(z) b(z + d) C_d(z), with weight `zero` for d = 0 and
// `others` for the rest. `columns_first`: the transposed planes, so that sums over x run along
// whole lines.
void add_pairs(Plane& out, const Covariance& noise, const std::vector<Plane>& columns_first,
               const PlaneMap& a, const PlaneMap& b, double zero, double others) {
  const std::size_t rows = size(noise.rows), wide = size(a.along.out());
  int most = 0;
  for (const Offset& d : noise.offsets) most = std::max(most, d.dy);
  for (int dy = 0; dy <= most; ++dy) {
    Plane lines(wide * rows);
    bool any = false;
    for (std::size_t k = 0; k < columns_first.size(); ++k) {
      const Offset d = noise.offsets[k];
      const double factor = d == Offset{} ? zero : others;
      if (d.dy != dy || factor == 0.0) continue;
      add_lines(lines, columns_first[k], rows, product(a.along, b.along, d.dx), factor);
      any = true;
    }
    if (!any) continue;
    add_lines(out, transposed(lines, noise.rows, a.along.out()), wide,
              product(a.across, b.across, dy), 1.0);
  }
}

std::vector<Plane> transposed_planes(const Covariance& noise) {
  std::vector<Plane> columns_first;
  for (const Plane& plane : noise.planes) {
    columns_first.push_back(transposed(plane, noise.columns, noise.rows));
  }
  return columns_first;
}

// C_d(z) <- f(C_d(z), z, z + d) for pairs inside the picture.
template <class F>
Covariance for_pairs(Covariance noise, F f) {
  const std::ptrdiff_t columns = noise.columns, rows = noise.rows;
  for (std::size_t k = 0; k < noise.planes.size(); ++k) {
    Plane& plane = noise.planes[k];
    const Offset d = noise.offsets[k];
    const std::ptrdiff_t step = d.dy * columns + d.dx;
    const std::ptrdiff_t left = std::max(0, -d.dx), right = columns - std::max(0, d.dx);
    base::parallel_chunks(size(noise.rows), 32, [&](std::size_t begin, std::size_t end) {
      const std::ptrdiff_t last = std::min(static_cast<std::ptrdiff_t>(end), rows - d.dy);
      for (std::ptrdiff_t y = static_cast<std::ptrdiff_t>(begin); y < last; ++y) {
        for (std::ptrdiff_t x = left; x < right; ++x) {
          const std::ptrdiff_t z = y * columns + x;
          float& value = plane[static_cast<std::size_t>(z)];
          value = f(value, static_cast<std::size_t>(z), static_cast<std::size_t>(z + step));
        }
      }
    });
  }
  return noise;
}

}  // namespace

Covariance white(int columns, int rows, Plane variance) {
  return {columns, rows, {Offset{}}, {std::move(variance)}};
}

Covariance filtered(const Covariance& noise, const AxisMap& along, const AxisMap& across) {
  check_fits(along, noise.columns, "columns");
  check_fits(across, noise.rows, "rows");
  check_same_size(along);
  check_same_size(across);
  const bool rows_mix = !is_identity(across), columns_mix = !is_identity(along);
  if (!columns_mix) return rows_mix ? filtered_across(noise, across) : noise;
  const Covariance mixed = rows_mix ? filtered_across(noise, across) : noise;
  return transposed(filtered_across(transposed(mixed), along));
}

Covariance scaled(const Covariance& noise, const Plane& gain) {
  return for_pairs(noise, [&](float c, std::size_t z, std::size_t partner) {
    return c * gain[z] * gain[partner];
  });
}

Covariance shared(const Covariance& noise, const MomentPlanes& moments) {
  const Plane &slope = moments.slope, &curvature = moments.curvature;
  return for_pairs(noise, [&](float c, std::size_t z, std::size_t partner) {
    return c * slope[z] * slope[partner] + 0.5F * (c * curvature[z]) * (c * curvature[partner]);
  });
}

Covariance mapped(const Covariance& noise, const MomentPlanes& moments) {
  Covariance result = shared(noise, moments);
  result.planes.front() = moments.variance;
  return result;
}

Covariance weave(Covariance noise, double across_fields) {
  Covariance result{noise.columns, noise.rows, {}, {}};
  for (std::size_t k = 0; k < noise.planes.size(); ++k) {
    const bool two_fields = noise.offsets[k].dy % 2 != 0;
    if (two_fields && across_fields == 0.0) continue;
    if (two_fields) {
      for (float& value : noise.planes[k]) value *= static_cast<float>(across_fields);
    }
    result.offsets.push_back(noise.offsets[k]);
    result.planes.push_back(std::move(noise.planes[k]));
  }
  return result;
}

Covariance times(Covariance noise, double factor) {
  for (Plane& plane : noise.planes) {
    for (float& value : plane) value *= static_cast<float>(factor);
  }
  return noise;
}

Covariance plus(Covariance a, const Covariance& b) {
  if (a.columns != b.columns || a.rows != b.rows) {
    throw base::Error(base::Blame::Input, "noise moments",
                      "noises of " + std::to_string(a.columns) + " x " + std::to_string(a.rows) +
                          " and " + std::to_string(b.columns) + " x " + std::to_string(b.rows) +
                          " pixels",
                      "Noises that add are of one picture", "Carry both to the same stage first");
  }
  for (std::size_t k = 0; k < b.planes.size(); ++k) {
    const auto found = std::find(a.offsets.begin(), a.offsets.end(), b.offsets[k]);
    if (found == a.offsets.end()) {
      a.offsets.push_back(b.offsets[k]);
      a.planes.push_back(b.planes[k]);
      continue;
    }
    Plane& sum = a.planes[static_cast<std::size_t>(found - a.offsets.begin())];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += b.planes[k][i];
  }
  return a;
}

Plane variance_after(const Covariance& noise, const AxisMap& along, const AxisMap& across) {
  check_fits(along, noise.columns, "columns");
  check_fits(across, noise.rows, "rows");
  Plane out(size(along.out()) * size(across.out()));
  const PlaneMap map{along, across};
  // d and -d give the same sum.
  add_pairs(out, noise, transposed_planes(noise), map, map, 1.0, 2.0);
  return out;
}

Plane covariance_between(const Covariance& noise, const PlaneMap& a, const PlaneMap& b) {
  for (const PlaneMap* map : {&a, &b}) {
    check_fits(map->along, noise.columns, "columns");
    check_fits(map->across, noise.rows, "rows");
  }
  Plane out(size(a.along.out()) * size(a.across.out()));
  const std::vector<Plane> columns_first = transposed_planes(noise);
  add_pairs(out, noise, columns_first, a, b, 1.0, 1.0);
  // The offsets -d: a and b are swapped.
  add_pairs(out, noise, columns_first, b, a, 0.0, 1.0);
  return out;
}

}  // namespace earthshine::degrade
