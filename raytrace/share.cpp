// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/same_surface.h"

namespace earthshine::raytrace {
namespace {

// Mean squares are taken over three blurs, the last of which reaches four times as far as the
// detail.
constexpr std::size_t window_blurs = 3;
constexpr std::size_t mask_levels = share_levels + window_blurs - 1;
// Noise that is found by chance looks like signal half of the time: only what is well above it
// counts when details are kept.
constexpr float doubt = 1.5F;
constexpr std::array<float, 5> spline = {1.0F / 16, 1.0F / 4, 3.0F / 8, 1.0F / 4, 1.0F / 16};
constexpr std::uint32_t centre_bit = 1U << 12U, all_bits = (1U << 25U) - 1U;

// Rounding of single-precision positions.
float slack(const GatherPoint& point) { return 0.02F * point.spacing_m; }

constexpr std::size_t rows_at_once = 4;

}  // namespace

template <class Keep>
void Neighbours::sift(std::size_t level, const Keep& keep) {
  std::vector<std::uint32_t>& mask = masks_[level];
  const int step = 1 << level;
  base::parallel_chunks(
      static_cast<std::size_t>(rows_), rows_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin * static_cast<std::size_t>(columns_);
             p < end * static_cast<std::size_t>(columns_); ++p) {
          const int x = static_cast<int>(p) % columns_, y = static_cast<int>(p) / columns_;
          std::uint32_t bit = 1U;
          for (int dy = -2; dy <= 2; ++dy) {
            for (int dx = -2; dx <= 2; ++dx, bit <<= 1U) {
              if ((mask[p] & bit) == 0 || bit == centre_bit) continue;
              const int qx = x + dx * step, qy = y + dy * step;
              const bool inside = qx >= 0 && qy >= 0 && qx < columns_ && qy < rows_;
              if (!inside || !keep(p, static_cast<std::size_t>(qy * columns_ + qx))) {
                mask[p] &= ~bit;
              }
            }
          }
        }
      });
}

Neighbours::Neighbours(const Window& window, const std::vector<GatherPoint>& points, bool any)
    : columns_(window.columns), rows_(window.rows), masks_(mask_levels) {
  for (std::size_t level = 0; level < mask_levels; ++level) {
    masks_[level].resize(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      masks_[level][p] = points[p].reach_m <= 0.0F ? 0U : any ? all_bits : centre_bit;
    }
    sift(level, [&](std::size_t p, std::size_t q) {
      const GatherPoint &a = points[p], &b = points[q];
      return b.reach_m > 0.0F &&
             (a.triangle == b.triangle ||
              same_surface(a.position, a.normal, b.position, b.normal, slack(a)));
    });
  }
}

Neighbours Neighbours::of_like_material(const std::vector<GatherPoint>& points) const {
  Neighbours like = *this;
  for (std::size_t level = 0; level < mask_levels; ++level) {
    like.sift(level, [&](std::size_t p, std::size_t q) {
      return points[p].material == points[q].material;
    });
  }
  return like;
}

void Neighbours::blur(std::size_t level, const Planes& values, const std::vector<float>* weight,
                      Planes& means) const {
  means.resize(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) means[k].resize(values[k].size());
  base::parallel_chunks(static_cast<std::size_t>(rows_), rows_at_once,
                        [&](std::size_t begin, std::size_t end) {
                          for (std::size_t y = begin; y < end; ++y) {
                            blur_row(level, y, values, weight, means);
                          }
                        });
}

// One neighbour of all points of the row after another, so that the points go side by side.
void Neighbours::blur_row(std::size_t level, std::size_t y, const Planes& values,
                          const std::vector<float>* weight, Planes& means) const {
  const auto columns = static_cast<std::ptrdiff_t>(columns_);
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * columns;
  const std::ptrdiff_t step = std::ptrdiff_t{1} << level;
  const std::uint32_t* mask = &masks_[level][static_cast<std::size_t>(first)];
  std::vector<float> sum(static_cast<std::size_t>(columns_), 0.0F), share(sum.size());
  for (std::vector<float>& mean : means) std::fill_n(mean.begin() + first, columns, 0.0F);
  std::uint32_t bit = 0;
  for (std::ptrdiff_t dy = -2; dy <= 2; ++dy) {
    for (std::ptrdiff_t dx = -2; dx <= 2; ++dx, ++bit) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) + dy * step;
      const std::ptrdiff_t x0 = std::max<std::ptrdiff_t>(0, -dx * step);
      const std::ptrdiff_t x1 = std::min(columns, columns - dx * step);
      if (row < 0 || row >= rows_ || x0 >= x1) continue;
      const std::ptrdiff_t to =
          row * columns + dx * step;  // the neighbour of the row's first point
      const float kernel =
          spline[static_cast<std::size_t>(dy + 2)] * spline[static_cast<std::size_t>(dx + 2)];
      for (std::ptrdiff_t x = x0; x < x1; ++x) {
        share[static_cast<std::size_t>(x)] =
            kernel * static_cast<float>(static_cast<std::int32_t>((mask[x] >> bit) & 1U));
      }
      if (weight != nullptr) {
        const float* of = weight->data() + to;
        for (std::ptrdiff_t x = x0; x < x1; ++x) share[static_cast<std::size_t>(x)] *= of[x];
      }
      for (std::ptrdiff_t x = x0; x < x1; ++x) {
        sum[static_cast<std::size_t>(x)] += share[static_cast<std::size_t>(x)];
      }
      for (std::size_t k = 0; k < values.size(); ++k) {
        const float* from = values[k].data() + to;
        float* mean = means[k].data() + first;
        const float* w = share.data();
        for (std::ptrdiff_t x = x0; x < x1; ++x) mean[x] += w[x] * from[x];
      }
    }
  }
  for (float& of : sum) of = of > 0.0F ? 1.0F / of : 0.0F;
  for (std::vector<float>& mean : means) {
    float* of = mean.data() + first;
    for (std::ptrdiff_t x = 0; x < columns; ++x) of[x] *= sum[static_cast<std::size_t>(x)];
  }
}

namespace {

// The share of a detail of signal s and noise q that is kept, mean squares.
float kept_share(float s, float q) {
  const float sure = s - (doubt - 1.0F) * q;
  return sure > 0.0F ? sure / (sure + q) : 0.0F;
}

// What that leaves: what is kept of the noise, and what is not kept of the signal.
struct Left {
  float noise = 0.0F, blur = 0.0F;
  void add(float s, float q) {
    const float share = kept_share(s, q);
    noise += share * share * q;
    blur += (1.0F - share) * (1.0F - share) * s;
  }
  // Signals that are not there come out as often below zero as above; noise is never undone so.
  [[nodiscard]] float all() const { return noise + std::max(0.0F, blur); }
};

}  // namespace

double Shared::squared_error_with(std::size_t point, double factor) const {
  const auto more = static_cast<float>(factor);
  Left left{rest[point] / more, 0.0F};
  for (std::size_t level = 0; level < share_levels; ++level) {
    left.add(signal[point][level], noise[point][level] / more);
  }
  return double(left.all());
}

namespace {

class Sharer {
 public:
  Sharer(const Neighbours& neighbours, const Estimate& estimate)
      : neighbours_(neighbours), estimate_(estimate), points_(estimate.samples.size()) {}

  Shared run() {
    shared_.layers = estimate_.layers;
    shared_.signal.assign(points_, {});
    shared_.noise.assign(points_, {});
    shared_.squared_error.assign(points_, 0.0F);
    keep_.assign(points_, {});
    split_halves();
    take_layers();
    return std::move(shared_);
  }

 private:
  using Planes = Neighbours::Planes;

  // Values of one level become those of the next; the difference is the detail. Where nothing was
  // sampled there is none. Neighbours count by their samples; at coarser levels by the mean of
  // those around them.
  void step(std::size_t level, Planes& values, Planes& detail) {
    neighbours_.blur(level, values, level == 0 ? &estimate_.samples : &weight_, coarse_);
    detail.resize(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      detail[k].resize(points_);
      for (std::size_t p = 0; p < points_; ++p) {
        const bool none = level == 0 && estimate_.samples[p] <= 0.0F;
        detail[k][p] = none ? 0.0F : values[k][p] - coarse_[k][p];
      }
    }
    values.swap(coarse_);
  }

  void blur_squares(std::size_t level) {
    for (std::size_t k = 0; k < window_blurs; ++k) {
      neighbours_.blur(level + k, squares_, nullptr, coarse_);
      squares_.swap(coarse_);
    }
  }

  void split_halves() {
    Planes values(2, std::vector<float>(points_, 0.0F)), detail;
    for (std::size_t p = 0; p < points_; ++p) {
      const float n = 0.5F * estimate_.samples[p];
      if (n <= 0.0F) continue;
      values[0][p] = estimate_.luminance[p][0] / n;
      values[1][p] = estimate_.luminance[p][1] / n;
    }
    Planes weight;
    neighbours_.blur(0, {estimate_.samples}, nullptr, weight);
    weight_ = std::move(weight.front());
    for (std::size_t level = 0; level < share_levels; ++level) {
      step(level, values, detail);
      take_squares(detail);
      blur_squares(level);
      keep(level);
    }
    take_squares(values);
    blur_squares(share_levels - 1);
    shared_.rest = squares_[1];
    for (std::size_t p = 0; p < points_; ++p) {
      shared_.squared_error[p] = static_cast<float>(shared_.squared_error_with(p, 1.0));
    }
  }

  // Of the mean of both halves, and of its noise.
  void take_squares(const Planes& halves) {
    squares_.assign(2, std::vector<float>(points_));
    for (std::size_t p = 0; p < points_; ++p) {
      const float sum = halves[0][p] + halves[1][p], off = halves[0][p] - halves[1][p];
      squares_[0][p] = 0.25F * sum * sum;
      squares_[1][p] = 0.25F * off * off;
    }
  }

  void keep(std::size_t level) {
    for (std::size_t p = 0; p < points_; ++p) {
      const float q = squares_[1][p], s = squares_[0][p] - q;
      keep_[p][level] = kept_share(s, q);
      shared_.signal[p][level] = s;
      shared_.noise[p][level] = q;
    }
  }

  void take_layers() {
    Planes values(3 * estimate_.layers, std::vector<float>(points_, 0.0F)), detail, kept = values;
    for (std::size_t k = 0; k < values.size(); ++k) {
      for (std::size_t p = 0; p < points_; ++p) {
        if (estimate_.samples[p] <= 0.0F) continue;
        values[k][p] = estimate_.sum[p * estimate_.layers + k / 3][static_cast<int>(k % 3)] /
                       estimate_.samples[p];
      }
    }
    for (std::size_t level = 0; level < share_levels; ++level) {
      step(level, values, detail);
      for (std::size_t k = 0; k < values.size(); ++k) {
        for (std::size_t p = 0; p < points_; ++p) kept[k][p] += keep_[p][level] * detail[k][p];
      }
    }
    shared_.radiance.resize(points_ * estimate_.layers);
    for (std::size_t k = 0; k < shared_.radiance.size(); ++k) {
      const std::size_t p = k / estimate_.layers, plane = 3 * (k % estimate_.layers);
      for (std::size_t c = 0; c < 3; ++c) {
        shared_.radiance[k][static_cast<int>(c)] = values[plane + c][p] + kept[plane + c][p];
      }
    }
  }

  const Neighbours& neighbours_;
  const Estimate& estimate_;
  std::size_t points_;
  Shared shared_;
  std::vector<std::array<float, share_levels>> keep_;
  std::vector<float> weight_;
  Planes coarse_, squares_;
};

}  // namespace

Shared share(const Neighbours& neighbours, const Estimate& estimate) {
  return Sharer(neighbours, estimate).run();
}

}  // namespace earthshine::raytrace
