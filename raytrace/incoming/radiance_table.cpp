// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/radiance_table.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/incoming/knots.h"

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
                             bool per_light, const LeakMask& sight)
    : patches_(&solution.patches), sight_(&sight) {
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
  fill_knots();
}

void RadianceTable::fill_knots() {
  const std::vector<radiosity::Facet>& facets = patches_->facets;
  std::size_t size = 0;
  side_knots_.assign(facets.size(), {0, 0});
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (facets[f].tree == radiosity::no_tree || facets[f].is_cluster()) continue;
    const std::size_t one_side = facets[f].leaves * knots_per_cell * layers_;
    side_knots_[f][1] = size;
    size += one_side;
    if (facets[f].first_back == radiosity::no_patch) continue;
    side_knots_[f][0] = size;
    size += one_side;
  }
  knots_.assign(size, glm::vec4(0.0F));
  base::parallel_chunks(facets.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<KnotTerm> terms;
    for (std::size_t f = begin; f < end; ++f) {
      const radiosity::Facet& facet = facets[f];
      if (facet.tree == radiosity::no_tree || facet.is_cluster()) continue;
      for (std::uint32_t k = 0; k < facet.leaves * knots_per_cell; ++k) {
        const auto leaf = static_cast<std::uint32_t>(k / knots_per_cell);
        const auto knot = static_cast<std::uint32_t>(k % knots_per_cell);
        terms.clear();
        add_knot_terms(*patches_, facet, leaf, knot / 3, knot % 3, terms);
        for (const bool front : {false, true}) {
          const std::uint32_t first = front ? facet.first_front : facet.first_back;
          if (first == radiosity::no_patch) continue;
          glm::vec4* values = &knots_[side_knots_[f][front ? 1 : 0] + k * layers_];
          for (const KnotTerm& term : terms) {
            const bool other_room = sight_->parted(first + leaf, first + term.leaf);
            const std::uint32_t read = first + (other_room ? leaf : term.leaf);
            const glm::vec4* from = &radiance_[read * layers_];
            for (std::size_t layer = 0; layer < layers_; ++layer) {
              values[layer] += term.weight * from[layer];
            }
          }
        }
      }
    }
  });
}

void RadianceTable::add_uneven(const radiosity::Facet& facet, bool front,
                               const radiosity::Parameters& where, const Rgb& weight,
                               std::span<Rgb> out) const {
  const radiosity::Patches::Place at = patches_->place(facet, where);
  // The quarter of the cell, and where in the quarter.
  const std::size_t i = at.x < 0.5 ? 0 : 1, j = at.y < 0.5 ? 0 : 1;
  const auto s = static_cast<float>(2.0 * at.x - static_cast<double>(i));
  const auto t = static_cast<float>(2.0 * at.y - static_cast<double>(j));
  const auto f = static_cast<std::size_t>(&facet - patches_->facets.data());
  const std::size_t corner = at.leaf * knots_per_cell + 3 * i + j;
  const glm::vec4* a = &knots_[side_knots_[f][front ? 1 : 0] + corner * layers_];
  const glm::vec4 *b = a + layers_, *c = a + 3 * layers_, *d = a + 4 * layers_;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const glm::vec4 low = a[layer] + t * (b[layer] - a[layer]);
    const glm::vec4 high = c[layer] + t * (d[layer] - c[layer]);
    out[layer] += weight * Rgb(low + s * (high - low));
  }
}

void RadianceTable::add(const scenes::Hit& hit, const Rgb& weight, std::span<Rgb> out) const {
  const radiosity::Facet& facet = patches_->facets[patches_->of_triangle[hit.triangle]];
  const std::uint32_t first = hit.front ? facet.first_front : facet.first_back;
  if (first == radiosity::no_patch) return;
  if (facet.is_cluster()) {
    const std::uint32_t patch = patches_->find(hit.triangle, hit.u, hit.v, hit.front);
    const glm::vec4* own = &radiance_[patch * layers_];
    for (std::size_t layer = 0; layer < layers_; ++layer) out[layer] += weight * Rgb(own[layer]);
    return;
  }
  const radiosity::Parameters p = patches_->parameters(hit.triangle, hit.u, hit.v);
  if (facet.tree != radiosity::no_tree) return add_uneven(facet, hit.front, p, weight, out);
  const Neighbours s = neighbours(p.s, facet.s_count);
  const Neighbours t = neighbours(p.t, facet.t_count);
  const auto patch = [&](std::uint32_t row, std::uint32_t column) {
    return first + row * facet.t_count + column;
  };
  const std::uint32_t own =
      patch(s.weight < 0.5F ? s.low : s.high, t.weight < 0.5F ? t.low : t.high);
  const bool at_wall = sight_->at_wall(own);
  const auto cell = [&](std::uint32_t row, std::uint32_t column) {
    const std::uint32_t other = patch(row, column);
    return &radiance_[(at_wall && sight_->parted(own, other) ? own : other) * layers_];
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
