// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/covered_patches.h"

#include <algorithm>

namespace earthshine::radiosity {

std::vector<double> open_areas(const OpenParts& open, std::span<const double> area_m2) {
  std::vector<double> areas(area_m2.begin(), area_m2.end());
  for (std::size_t i = 0; i < open.share.size(); ++i) areas[i] *= open.share[i];
  return areas;
}

void lose_hits_on_covered(FormFactors& factors) {
  const auto [begin, end] = factors.shares.own(factors.count());
  for (std::size_t i = begin; i < end; ++i) {
    for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
      const std::uint32_t j = factors.column[e];
      if (factors.open.share[j] > 0.0) continue;
      factors.black[i] += factors.row_scale[i] * double(factors.hits[e]) * factors.kept[j];
      factors.lost[i] = factors.black[i];
      factors.hits[e] = 0.0F;
    }
  }
  factors.shares.all_gather(factors.black.data());
  factors.shares.all_gather(factors.lost.data());
}

CoveredPatches::CoveredPatches(const Patches& patches, const OpenParts& open) {
  constexpr double step =
      0x1p-23;  // less than half of the smallest cell (radiosity/patches/split.h)
  for (std::uint32_t i = 0; i < open.share.size(); ++i) {
    if (open.share[i] > 0.0) continue;
    const Facet& facet = patches.facets[patches.facet[i]];
    if (facet.is_cluster()) continue;  // no interpolation between a cluster's cells
    const std::uint32_t first = patches.is_back[i] != 0 ? facet.first_back : facet.first_front;
    const Rectangle r = patches.rectangle(i);
    Border border{i, {}};
    for (const double s : {r.s0 - step, 0.5 * (r.s0 + r.s1), r.s1 + step}) {
      for (const double t : {r.t0 - step, 0.5 * (r.t0 + r.t1), r.t1 + step}) {
        if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
        const std::uint32_t other = first + patches.leaf(facet, {s, t});
        if (open.share[other] <= 0.0) continue;
        if (std::find(border.open.begin(), border.open.end(), other) == border.open.end()) {
          border.open.push_back(other);
        }
      }
    }
    if (!border.open.empty()) borders_.push_back(std::move(border));
  }
}

void CoveredPatches::show_neighbours(std::vector<float>& values, std::size_t columns) const {
  for (const Border& border : borders_) {
    for (std::size_t k = 0; k < columns; ++k) {
      double sum = 0.0;
      for (const std::uint32_t i : border.open) sum += double(values[i * columns + k]);
      values[border.patch * columns + k] =
          static_cast<float>(sum / static_cast<double>(border.open.size()));
    }
  }
}

}  // namespace earthshine::radiosity
