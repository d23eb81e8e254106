// SPDX-License-Identifier: Apache-2.0
#include "raytrace/radiance_table.h"

#include <algorithm>
#include <cmath>

namespace earthshine::raytrace {
namespace {

// The two cells around a parameter and the weight of the second; at the ends both are the last
// cell.
struct Neighbours {
  std::uint32_t low, high;
  float weight;
};

Neighbours neighbours(double parameter, std::uint32_t count) {
  const double x = std::clamp(parameter * count - 0.5, 0.0, static_cast<double>(count - 1));
  const auto low = static_cast<std::uint32_t>(x);
  return {low, std::min(low + 1, count - 1), static_cast<float>(x - low)};
}

}  // namespace

RadianceTable::RadianceTable(const radiosity::Solution& solution, std::span<const float> values,
                             bool per_light)
    : patches_(&solution.patches) {
  const std::size_t groups = solution.columns / 3;
  layers_ = per_light ? groups : 1;
  const std::size_t patches = solution.patches.count();
  if (values.empty() || layers_ == 0) return;
  radiance_.assign(patches * layers_, glm::vec4(0.0F));
  for (std::size_t i = 0; i < patches; ++i) {
    for (std::size_t g = 0; g < groups; ++g) {
      const float* b = &values[i * solution.columns + 3 * g];
      radiance_[i * layers_ + (per_light ? g : 0)] +=
          glm::vec4(b[0], b[1], b[2], 0.0F) / static_cast<float>(base::pi);
    }
  }
}

void RadianceTable::add(const scenes::Hit& hit, const Rgb& weight, std::span<Rgb> out) const {
  const radiosity::Facet& facet = patches_->facets[patches_->of_triangle[hit.triangle]];
  const std::uint32_t first = hit.front ? facet.first_front : facet.first_back;
  if (first == radiosity::no_patch) return;
  const radiosity::Parameters p = patches_->parameters(hit.triangle, hit.u, hit.v);
  const Neighbours s = neighbours(p.s, facet.s_count);
  const Neighbours t = neighbours(p.t, facet.t_count);
  const auto cell = [&](std::uint32_t row, std::uint32_t column) {
    return &radiance_[(first + row * facet.t_count + column) * layers_];
  };
  const glm::vec4* a = cell(s.low, t.low);
  const glm::vec4* b = cell(s.low, t.high);
  const glm::vec4* c = cell(s.high, t.low);
  const glm::vec4* d = cell(s.high, t.high);
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const glm::vec4 low = a[layer] + t.weight * (b[layer] - a[layer]);
    const glm::vec4 high = c[layer] + t.weight * (d[layer] - c[layer]);
    const glm::vec4 value = low + s.weight * (high - low);
    out[layer] += weight * Rgb(value);
  }
}

}  // namespace earthshine::raytrace
