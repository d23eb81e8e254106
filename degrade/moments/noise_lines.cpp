// SPDX-License-Identifier: Apache-2.0
#include "degrade/moments/noise_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "base/free_memory.h"
#include "base/parallel.h"

namespace earthshine::degrade {
namespace {

constexpr double least_share = 1e-6;   // of the largest variance; smaller covariances are dropped
constexpr double least_weight = 1e-8;  // of the largest weight; below float rounding

// C_(dx, lag) for lags of both signs, read from the stored half.
struct Lag {
  int lag = 0;
  const Plane* plane = nullptr;
  bool stored = true;  // false: C_(-dx, -lag), read at z + d
  double largest = 0.0;
};

std::vector<Lag> lags_of(const Covariance& noise, int dx) {
  std::vector<Lag> lags;
  const auto largest = [](const Plane& plane) {
    float most = 0.0F;
    for (const float value : plane) most = std::max(most, std::abs(value));
    return static_cast<double>(most);
  };
  for (std::size_t k = 0; k < noise.planes.size(); ++k) {
    const Offset d = noise.offsets[k];
    const Plane& plane = noise.planes[k];
    if (d.dx == dx) lags.push_back({d.dy, &plane, true, largest(plane)});
    if (d.dx == -dx && !(d == Offset{})) {
      lags.push_back({-d.dy, &plane, false, largest(plane)});
    }
  }
  return lags;
}

// bound[e] >= largest |C'_(dx, e)|, from the largest |C| of each lag.
std::vector<double> bounds(const AxisMap& map, const std::vector<Lag>& lags) {
  const int lines = map.in;
  std::vector<double> bound(size(lines)), sum(size(lines)), mixed(size(lines));
  for (int y = 0; y < lines; ++y) {
    std::fill(mixed.begin(), mixed.end(), 0.0);
    int low = lines, high = -1;
    for (std::size_t k = map.start[size(y)]; k < map.start[size(y) + 1]; ++k) {
      for (const Lag& lag : lags) {
        const int v = static_cast<int>(map.source[k]) + lag.lag;
        if (v < 0 || v >= lines) continue;
        mixed[size(v)] += std::abs(map.weight[k]) * lag.largest;
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
    // Lines whose sources do not meet [low, high] are not correlated with line y.
    for (int partner = y; partner < lines; ++partner) {
      double total = 0.0;
      bool met = false;
      for (std::size_t k = map.start[size(partner)]; k < map.start[size(partner) + 1]; ++k) {
        const int v = static_cast<int>(map.source[k]);
        if (v < low || v > high) continue;
        total += std::abs(map.weight[k]) * mixed[size(v)];
        met = true;
      }
      if (!met && partner > y) break;
      double& most = bound[size(partner - y)];
      most = std::max(most, total);
    }
  }
  return bound;
}

// Offsets (dx, 0), (dx, 1), ...: for each line y, T(v) = sum over u of W(y, u) C(u, v), then C'(y,
// y + e) = sum over v of W(y + e, v) T(v).
class LineSum {
 public:
  LineSum(const AxisMap& map, const std::vector<Lag>& lags, int columns, int dx)
      : map_(map), lags_(lags), width_(size(columns)), dx_(dx) {}

  void add_line(int y, const std::vector<Plane*>& out) {
    mix(y);
    for (int e = 0; e < static_cast<int>(out.size()) && y + e < map_.in; ++e) {
      if (out[size(e)] == nullptr) continue;
      float* const line = out[size(e)]->data() + size(y) * width_;
      const std::size_t partner = size(y + e);
      for (std::size_t k = map_.start[partner]; k < map_.start[partner + 1]; ++k) {
        const int v = static_cast<int>(map_.source[k]);
        if (v < low_ || v > high_) continue;
        add(line, mixed_.data() + size(v - low_) * width_, map_.weight[k], width_);
      }
    }
  }

 private:
  static void add(float* out, const float* in, double weight, std::size_t count) {
    const float w = static_cast<float>(weight);
    for (std::size_t x = 0; x < count; ++x) out[x] += w * in[x];
  }

  void mix(int y) {
    low_ = map_.in;
    high_ = -1;
    for (std::size_t k = map_.start[size(y)]; k < map_.start[size(y) + 1]; ++k) {
      for (const Lag& lag : lags_) {
        const int v = static_cast<int>(map_.source[k]) + lag.lag;
        if (v < 0 || v >= map_.in) continue;
        low_ = std::min(low_, v);
        high_ = std::max(high_, v);
      }
    }
    if (high_ < low_) return;
    mixed_.assign(size(high_ - low_ + 1) * width_, 0.0F);
    // The other half is read at x + dx where this is inside the picture.
    const std::size_t left = size(std::max(0, -dx_)), cut = std::min(width_, size(std::abs(dx_)));
    const std::size_t from = size(std::max(0, dx_));
    for (std::size_t k = map_.start[size(y)]; k < map_.start[size(y) + 1]; ++k) {
      const int u = static_cast<int>(map_.source[k]);
      for (const Lag& lag : lags_) {
        const int v = u + lag.lag;
        if (v < 0 || v >= map_.in) continue;
        float* const line = mixed_.data() + size(v - low_) * width_;
        if (lag.stored) {
          add(line, lag.plane->data() + size(u) * width_, map_.weight[k], width_);
        } else {
          add(line + left, lag.plane->data() + size(v) * width_ + from, map_.weight[k],
              width_ - cut);
        }
      }
    }
  }

  const AxisMap& map_;
  const std::vector<Lag>& lags_;
  std::size_t width_;
  int dx_;
  int low_ = 0, high_ = -1;
  std::vector<float> mixed_;
};

bool negligible(const Plane& plane, float least) {
  return std::all_of(plane.begin(), plane.end(),
                     [&](float value) { return std::abs(value) <= least; });
}

}  // namespace

Plane transposed(const Plane& in, int columns, int rows) {
  constexpr std::size_t tile = 16;
  const std::size_t width = size(columns), height = size(rows);
  Plane out(in.size());
  base::parallel_chunks(width, tile, [&](std::size_t begin, std::size_t end) {
    for (std::size_t top = 0; top < height; top += tile) {
      for (std::size_t x = begin; x < end; ++x) {
        for (std::size_t y = top; y < std::min(height, top + tile); ++y) {
          out[x * height + y] = in[y * width + x];
        }
      }
    }
  });
  return out;
}

Covariance transposed(const Covariance& noise) {
  Covariance out{noise.rows, noise.columns, {}, {}};
  for (std::size_t k = 0; k < noise.planes.size(); ++k) {
    const Offset d{noise.offsets[k].dy, noise.offsets[k].dx};
    Plane plane = transposed(noise.planes[k], noise.columns, noise.rows);
    if (d.dy >= 0) {
      out.offsets.push_back(d);
      out.planes.push_back(std::move(plane));
      continue;
    }
    // The other half: C_(-d)(z + d) = C_d(z).
    Plane moved(plane.size());
    const std::size_t width = size(out.columns), right = size(d.dx), up = size(-d.dy);
    for (std::size_t y = up; y < size(out.rows); ++y) {
      for (std::size_t x = 0; x + right < width; ++x) {
        moved[(y - up) * width + x + right] = plane[y * width + x];
      }
    }
    out.offsets.push_back({-d.dx, -d.dy});
    out.planes.push_back(std::move(moved));
  }
  return out;
}

bool is_identity(const AxisMap& map) {
  if (map.out() != map.in || map.source.size() != size(map.in)) return false;
  for (std::size_t i = 0; i < map.source.size(); ++i) {
    if (map.start[i] != i || map.source[i] != i || map.weight[i] != 1.0) return false;
  }
  return true;
}

void add_lines(Plane& out, const Plane& in, std::size_t width, const AxisMap& map, double factor) {
  base::parallel_chunks(size(map.out()), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float* const line = out.data() + i * width;
      for (std::size_t k = map.start[i]; k < map.start[i + 1]; ++k) {
        const float* const source = in.data() + map.source[k] * width;
        const float weight = static_cast<float>(factor * map.weight[k]);
        for (std::size_t x = 0; x < width; ++x) line[x] += weight * source[x];
      }
    }
  });
}

namespace {

// Offsets (dx, 0), (dx, 1) ... of a filtered covariance.
struct Side {
  int dx = 0;
  std::vector<Lag> lags;
  std::vector<std::uint8_t> wanted;  // per offset dy from 0 on
};

// Selects offsets before their planes are allocated, because wide filters have many.
std::vector<Side> wanted_sides(const Covariance& noise, const AxisMap& map) {
  std::set<int> sides{0};
  for (const Offset& d : noise.offsets) sides.insert({d.dx, -d.dx});
  // (0, 0) comes first: its bound is the scale of the others.
  std::vector<int> order(sides.begin(), sides.end());
  std::stable_sort(order.begin(), order.end(),
                   [](int a, int b) { return std::abs(a) < std::abs(b); });
  std::vector<Side> wanted_of;
  double scale = 0.0;
  for (const int dx : order) {
    Side side{dx, lags_of(noise, dx), {}};
    const std::vector<double> bound = bounds(map, side.lags);
    if (dx == 0) scale = bound.front();
    for (std::size_t e = 0; e < bound.size(); ++e) {
      const bool variance = dx == 0 && e == 0;
      // Far below the final threshold, because the variance is also known by its bound only.
      const bool matters = variance || bound[e] > 0.1 * least_share * scale;
      side.wanted.push_back(matters && (dx >= 0 || e > 0) ? 1 : 0);
    }
    wanted_of.push_back(std::move(side));
  }
  return wanted_of;
}

void add_side(Covariance& out, const Side& side, const AxisMap& map) {
  std::vector<Plane> planes(side.wanted.size());
  std::vector<Plane*> made(side.wanted.size(), nullptr);
  for (std::size_t e = 0; e < side.wanted.size(); ++e) {
    if (side.wanted[e] == 0) continue;
    planes[e].resize(size(out.columns) * size(out.rows));
    made[e] = &planes[e];
  }
  base::parallel_chunks(size(out.rows), 8, [&](std::size_t begin, std::size_t end) {
    LineSum sum(map, side.lags, out.columns, side.dx);
    for (std::size_t y = begin; y < end; ++y) sum.add_line(static_cast<int>(y), made);
  });
  for (std::size_t e = 0; e < planes.size(); ++e) {
    if (made[e] == nullptr) continue;
    out.offsets.push_back({side.dx, static_cast<int>(e)});
    out.planes.push_back(std::move(planes[e]));
  }
}

}  // namespace

Covariance filtered_across(const Covariance& noise, const AxisMap& full) {
  double largest = 0.0;
  for (const double weight : full.weight) largest = std::max(largest, std::abs(weight));
  // Drops weights below float rounding.
  const AxisMap map = without_taps_below(full, least_weight * largest);
  const std::vector<Side> sides = wanted_sides(noise, map);
  std::uint64_t count = 0;
  for (const Side& side : sides) {
    for (const std::uint8_t wanted : side.wanted) count += wanted;
  }
  // Planes that exist at once: the result, its transpose and their filtered copy.
  constexpr std::uint64_t at_once = 3;
  base::check_room(
      at_once * count * noise.variance().size() * sizeof(float),
      "the twin: noise that a blur makes alike at " + std::to_string(count) + " offsets");
  Covariance out{noise.columns, noise.rows, {}, {}};
  for (const Side& side : sides) add_side(out, side, map);
  const float most = *std::max_element(out.variance().begin(), out.variance().end());
  Covariance kept{out.columns, out.rows, {}, {}};
  for (std::size_t k = 0; k < out.planes.size(); ++k) {
    if (k > 0 && negligible(out.planes[k], static_cast<float>(least_share) * most)) continue;
    kept.offsets.push_back(out.offsets[k]);
    kept.planes.push_back(std::move(out.planes[k]));
  }
  return kept;
}

}  // namespace earthshine::degrade
