// SPDX-License-Identifier: Apache-2.0
// Which gather points share, and means over them.
#include <algorithm>

#include "base/parallel.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t mask_levels = share_levels + window_blurs - 1;
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
              const int qx = x + dx * step, qy = y + dy * step, q = qy * columns_ + qx;
              const bool inside = qx >= 0 && qy >= 0 && qx < columns_ && qy < rows_;
              if (!inside || !keep(p, static_cast<std::size_t>(q))) {
                mask[p] &= ~bit;
              }
            }
          }
        }
      });
}

Neighbours::Neighbours(const Window& window, const std::vector<GatherPoint>& points)
    : columns_(window.columns), rows_(window.rows), masks_(mask_levels) {
  for (std::size_t level = 0; level < mask_levels; ++level) {
    masks_[level].resize(window.pixel_count());
    for (std::size_t p = 0; p < masks_[level].size(); ++p) {
      masks_[level][p] = points[p].reach_m <= 0.0F ? 0U : all_bits;
    }
    sift(level, [&](std::size_t p, std::size_t q) {
      const GatherPoint &a = points[p], &b = points[q];
      return b.reach_m > 0.0F &&
             ((a.triangle == b.triangle && a.mirror == b.mirror) ||
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

// The points of a row go side by side, by the five neighbours of one row after another.
void Neighbours::blur_row(std::size_t level, std::size_t y, const Planes& values,
                          const std::vector<float>* weight, Planes& means) const {
  const auto columns = static_cast<std::ptrdiff_t>(columns_);
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * columns;
  const std::ptrdiff_t step = std::ptrdiff_t{1} << level;
  const std::uint32_t* mask = &masks_[level][static_cast<std::size_t>(first)];
  const auto width = static_cast<std::size_t>(columns_);
  std::vector<float> sum(width, 0.0F);
  // Shares of the five, and values: those of points beside the row are 0.
  std::vector<float> share(spline.size() * width);
  const std::ptrdiff_t margin = 2 * step;
  std::vector<float> from(width + static_cast<std::size_t>(2 * margin), 0.0F);
  for (std::vector<float>& mean : means) std::fill_n(mean.begin() + first, columns, 0.0F);
  std::uint32_t bit = 0;
  for (std::ptrdiff_t dy = -2; dy <= 2; ++dy, bit += 5) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) + dy * step;
    if (row < 0 || row >= rows_) continue;
    for (std::size_t k = 0; k < spline.size(); ++k) {
      const float kernel = spline[static_cast<std::size_t>(dy + 2)] * spline[k];
      float* of = &share[k * width];
      for (std::size_t x = 0; x < width; ++x) {
        of[x] = kernel * static_cast<float>(static_cast<std::int32_t>((mask[x] >> (bit + k)) & 1U));
      }
    }
    // What lies beside the row in memory has no share: only the first and last rows need margins.
    const std::ptrdiff_t begin = row * columns - margin;
    const bool inside = begin >= 0 && begin + columns + 2 * margin <= columns * rows_;
    const auto load = [&](const std::vector<float>& plane) -> const float* {
      if (inside) return plane.data() + begin;
      std::copy_n(plane.begin() + row * columns, columns, from.begin() + margin);
      return from.data();
    };
    const float *w0 = share.data(), *w1 = w0 + width, *w2 = w1 + width, *w3 = w2 + width,
                *w4 = w3 + width;
    if (weight != nullptr) {
      const float* at = load(*weight);
      for (std::size_t k = 0; k < spline.size(); ++k) {
        float* of = &share[k * width];
        const float* by = at + static_cast<std::ptrdiff_t>(k) * step;
        for (std::size_t x = 0; x < width; ++x) of[x] *= by[x];
      }
    }
    for (std::size_t x = 0; x < width; ++x) {
      sum[x] = ((((sum[x] + w0[x]) + w1[x]) + w2[x]) + w3[x]) + w4[x];
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
      const float* v0 = load(values[k]);
      const float *v1 = v0 + step, *v2 = v1 + step, *v3 = v2 + step, *v4 = v3 + step;
      float* mean = means[k].data() + first;
      for (std::size_t x = 0; x < width; ++x) {
        mean[x] = ((((mean[x] + w0[x] * v0[x]) + w1[x] * v1[x]) + w2[x] * v2[x]) + w3[x] * v3[x]) +
                  w4[x] * v4[x];
      }
    }
  }
  for (float& of : sum) of = of > 0.0F ? 1.0F / of : 0.0F;
  for (std::vector<float>& mean : means) {
    float* of = mean.data() + first;
    for (std::size_t x = 0; x < width; ++x) of[x] *= sum[x];
  }
}

}  // namespace earthshine::raytrace
