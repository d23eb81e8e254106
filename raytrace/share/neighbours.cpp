// SPDX-License-Identifier: Apache-2.0
// Neighbourhoods of gather points, and means over them.
#include <algorithm>

#include "base/parallel.h"
#include "raytrace/share/share.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t mask_levels = share_levels + tuning::window_blurs - 1;
constexpr std::size_t taps = 5;
constexpr std::array<float, taps> spline = {1.0F / 16, 1.0F / 4, 3.0F / 8, 1.0F / 4, 1.0F / 16};
// The five of a point's row, then the five of its column.
constexpr std::uint16_t all_bits = (1U << (2U * taps)) - 1U;
constexpr std::uint16_t own_bits = (1U << (taps / 2U)) | (1U << (taps + taps / 2U));

// Tolerance for the rounding of single-precision positions.
float slack(const GatherPoint& point) { return 0.02F * point.spacing_m; }

// The triangle of each point and the mirror that shows it; no_face without a surface.
constexpr std::uint64_t no_face = ~std::uint64_t{0};
std::vector<std::uint64_t> faces_of(const std::vector<GatherPoint>& points, std::size_t count) {
  std::vector<std::uint64_t> faces(count);
  for (std::size_t p = 0; p < count; ++p) {
    const GatherPoint& point = points[p];
    faces[p] =
        point.reach_m > 0.0F ? (std::uint64_t{point.triangle} << 32U) | point.mirror : no_face;
  }
  return faces;
}

constexpr std::size_t rows_at_once = 4;
// Rows of a chain; they are `step` apart, as neighbours are.
constexpr std::size_t longest_chain = 16;

// Weights of five neighbours whose bits are set, for the points of a row: share[tap * width + x].
void find_shares(const std::uint16_t* mask, std::size_t first_bit, std::size_t width,
                 float* share) {
  for (std::size_t k = 0; k < taps; ++k, share += width) {
    for (std::size_t x = 0; x < width; ++x) {
      share[x] = spline[k] * static_cast<float>((std::int32_t{mask[x]} >> (first_bit + k)) & 1);
    }
  }
}

// Weighted sum of five rows.
void add_up(const float* share, const std::array<const float*, taps>& rows, std::size_t width,
            float* sum) {
  const float *s0 = share, *s1 = s0 + width, *s2 = s1 + width, *s3 = s2 + width, *s4 = s3 + width;
  const auto [r0, r1, r2, r3, r4] = rows;
  for (std::size_t x = 0; x < width; ++x) {
    sum[x] = (((s0[x] * r0[x] + s1[x] * r1[x]) + s2[x] * r2[x]) + s3[x] * r3[x]) + s4[x] * r4[x];
  }
}

}  // namespace

template <class Keep>
void Neighbours::sift(std::size_t level, const Keep& keep) {
  std::vector<std::uint16_t>& mask = masks_[level];
  const int step = 1 << level;
  base::parallel_chunks(
      static_cast<std::size_t>(rows_), rows_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin * static_cast<std::size_t>(columns_);
             p < end * static_cast<std::size_t>(columns_); ++p) {
          const int x = static_cast<int>(p) % columns_, y = static_cast<int>(p) / columns_;
          for (std::size_t bit = 0; bit < 2 * taps; ++bit) {
            const int away = (static_cast<int>(bit % taps) - 2) * step;
            if (away == 0 || ((mask[p] >> bit) & 1U) == 0) continue;
            const int qx = bit < taps ? x + away : x, qy = bit < taps ? y : y + away;
            const bool inside = qx >= 0 && qy >= 0 && qx < columns_ && qy < rows_;
            if (!inside || !keep(p, static_cast<std::size_t>(qy * columns_ + qx))) {
              mask[p] = static_cast<std::uint16_t>(mask[p] & ~(1U << bit));
            }
          }
        }
      });
}

Neighbours::Neighbours(const Window& window, const std::vector<GatherPoint>& points)
    : columns_(window.columns), rows_(window.rows), masks_(mask_levels) {
  // Most neighbours lie on the same face. Comparing faces, side by side in memory, avoids reading
  // their points.
  const std::vector<std::uint64_t> faces = faces_of(points, window.pixel_count());
  for (std::size_t level = 0; level < mask_levels; ++level) {
    masks_[level].resize(window.pixel_count());
    for (std::size_t p = 0; p < masks_[level].size(); ++p) {
      masks_[level][p] = faces[p] == no_face ? std::uint16_t{0} : all_bits;
    }
    sift(level, [&](std::size_t p, std::size_t q) {
      if (faces[p] == faces[q]) return true;
      const GatherPoint &a = points[p], &b = points[q];
      return faces[q] != no_face &&
             same_surface(a.position, a.normal, b.position, b.normal, slack(a));
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

bool Neighbours::is_alone(std::size_t point) const {
  return std::all_of(masks_.begin(), masks_.end(),
                     [&](const auto& mask) { return (mask[point] & ~own_bits) == 0; });
}

Neighbours::Planes Neighbours::planes(std::size_t number) const {
  Planes all(number);
  base::resize_together(all, count());
  return all;
}

void Neighbours::blur(std::size_t level, const Planes& values, const std::vector<float>* weight,
                      Planes& means) const {
  means.resize(values.size());
  base::resize_together(means, count());
  const auto rows = static_cast<std::size_t>(rows_);
  const std::size_t step = std::size_t{1} << level, chains = std::min(step, rows);
  const std::size_t pieces = (rows + longest_chain * step - 1) / (longest_chain * step);
  base::parallel_chunks(chains * pieces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      blur_chain(level, k % chains + k / chains * longest_chain * step, values, weight, means);
    }
  });
}

// A chain of rows, `step` apart from `first` on. Each row is blurred along itself once; five
// blurred rows, one above the other, give one row of means.
void Neighbours::blur_chain(std::size_t level, std::size_t first, const Planes& values,
                            const std::vector<float>* weight, Planes& means) const {
  const auto width = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  const std::size_t step = std::size_t{1} << level;
  // The last five rows: the planes of each and its sum of weights.
  const std::size_t planes = values.size() + 1;
  std::vector<float> along(taps * planes * width), share(taps * width), sum(width);
  const auto row_of = [&](std::size_t y) { return &along[y / step % taps * planes * width]; };
  std::size_t next = first < 2 * step ? first % step : first - 2 * step;
  for (std::size_t y = first; y < std::min(rows, first + longest_chain * step); y += step) {
    for (; next < rows && next <= y + 2 * step; next += step) {
      blur_along(level, next, values, weight, row_of(next));
    }
    std::array<const float*, taps> from;
    for (std::size_t k = 0; k < taps; ++k) {
      // Outside the picture any row will do, because its weight is 0.
      const std::size_t at = y + k * step;
      from[k] = row_of(at < 2 * step || at - 2 * step >= rows ? y : at - 2 * step);
    }
    find_shares(&masks_[level][y * width], taps, width, share.data());
    const auto plane = [&](std::size_t k) {
      std::array<const float*, taps> of = from;
      for (const float*& row : of) row += k * width;
      return of;
    };
    add_up(share.data(), plane(values.size()), width, sum.data());
    for (float& of : sum) of = of > 0.0F ? 1.0F / of : 0.0F;
    for (std::size_t k = 0; k < values.size(); ++k) {
      float* mean = &means[k][y * width];
      add_up(share.data(), plane(k), width, mean);
      for (std::size_t x = 0; x < width; ++x) mean[x] *= sum[x];
    }
  }
}

// Sums over the five neighbours in the row of every point: plane after plane, then the weights.
void Neighbours::blur_along(std::size_t level, std::size_t y, const Planes& values,
                            const std::vector<float>* weight, float* sums) const {
  const auto width = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  const std::size_t step = std::size_t{1} << level, margin = 2 * step, begin = y * width;
  std::vector<float> share(taps * width), copy;
  find_shares(&masks_[level][begin], 0, width, share.data());
  // Values beside the row in memory have weight 0: only the first and last rows need margins.
  const bool inside = begin >= margin && begin + width + margin <= width * rows;
  if (!inside) copy.resize(width + 2 * margin);
  const auto load = [&](const std::vector<float>& plane) -> const float* {
    if (inside) return &plane[begin - margin];
    std::copy_n(&plane[begin], width, &copy[margin]);
    return copy.data();
  };
  if (weight != nullptr) {
    const float* by = load(*weight);
    for (std::size_t k = 0; k < taps; ++k, by += step) {
      float* of = &share[k * width];
      for (std::size_t x = 0; x < width; ++x) of[x] *= by[x];
    }
  }
  for (const std::vector<float>& plane : values) {
    const float* from = load(plane);
    add_up(share.data(), {from, from + step, from + 2 * step, from + 3 * step, from + 4 * step},
           width, sums);
    sums += width;
  }
  std::fill_n(sums, width, 0.0F);
  for (std::size_t k = 0; k < taps; ++k) {
    for (std::size_t x = 0; x < width; ++x) sums[x] += share[k * width + x];
  }
}

}  // namespace earthshine::raytrace
