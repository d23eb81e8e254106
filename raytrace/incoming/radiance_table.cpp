// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/radiance_table.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

// The two cells around a parameter and the weight of the second; at the ends both are the end cell.
struct Neighbours {
  std::uint32_t low, high;
  float weight;
};

Neighbours neighbours(double parameter, std::uint32_t count) {
  const double x = std::clamp(parameter * count - 0.5, 0.0, static_cast<double>(count - 1));
  const auto low = static_cast<std::uint32_t>(x);
  return {low, std::min(low + 1, count - 1), static_cast<float>(x - low)};
}

using radiosity::Facet;
using radiosity::Parameters;
using radiosity::Patches;
using radiosity::Rectangle;

// Up to four cells around a point.
struct Around {
  std::array<std::uint32_t, 4> leaf;
  std::array<Rectangle, 4> at;
  std::size_t count = 0;
};

Around cells_around(const Patches& patches, const Facet& facet, const Parameters& p) {
  constexpr double step =
      0x1p-23;  // less than half of the smallest cell (radiosity/patches/split.h)
  Around around;
  for (const double s : {p.s - step, p.s + step}) {
    for (const double t : {p.t - step, p.t + step}) {
      if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
      const std::uint32_t leaf = patches.leaf(facet, {s, t});
      const auto end = around.leaf.begin() + static_cast<std::ptrdiff_t>(around.count);
      if (std::find(around.leaf.begin(), end, leaf) != end) continue;
      around.leaf[around.count] = leaf;
      around.at[around.count++] = patches.rectangle(facet.first_front + leaf);
    }
  }
  return around;
}

// Quotients of integers below 2^21: they are equal, or differ by far more than rounding.
bool is_knot(double low, double high, double x) {
  constexpr double rounding = 1e-12;
  return std::min({std::abs(x - low), std::abs(x - high), std::abs(x - 0.5 * (low + high))}) <=
         rounding;
}

using Four = std::array<double, 4>;

// Subtracts from v its projection on u.
void remove_part(Four& v, const Four& u) {
  double dot = 0.0, norm = 0.0;
  for (std::size_t q = 0; q < 4; ++q) {
    dot += v[q] * u[q];
    norm += u[q] * u[q];
  }
  if (norm <= 0.0) return;
  for (std::size_t q = 0; q < 4; ++q) v[q] -= dot / norm * u[q];
}

// Weights with sum 1 for which the mean of the cells' centres is the point, along the axes that
// have cells on both sides. Of all such weights they have the least norm: the part of (1, 1, ...)
// orthogonal to the offsets, scaled. Equal weights if one would be negative.
Four linear_weights(const Around& around, const Parameters& p) {
  std::array<Four, 2> offset{};
  Four even{};
  for (std::size_t q = 0; q < around.count; ++q) {
    const Rectangle& r = around.at[q];
    offset[0][q] = 0.5 * (r.s0 + r.s1) - p.s;
    offset[1][q] = 0.5 * (r.t0 + r.t1) - p.t;
    even[q] = 1.0 / static_cast<double>(around.count);
  }
  for (Four& axis : offset) {
    const auto [low, high] = std::minmax_element(axis.begin(), axis.end());
    // Cells on one side only, or centred: the other entries are zero or rounding errors.
    if (*low > -1e-12 || *high < 1e-12) axis.fill(0.0);
  }
  remove_part(offset[1], offset[0]);
  Four w = even;
  for (const Four& axis : offset) remove_part(w, axis);
  const double sum = w[0] + w[1] + w[2] + w[3];
  if (sum <= 0.0 || *std::min_element(w.begin(), w.end()) < 0.0) return even;
  for (double& x : w) x /= sum;
  return w;
}

void add_terms(const Patches& patches, const Facet& facet, const Parameters& p, double weight,
               std::vector<KnotTerm>& terms) {
  const Around around = cells_around(patches, facet, p);
  for (std::size_t q = 0; q < around.count; ++q) {
    const Rectangle& r = around.at[q];
    const bool in_s = is_knot(r.s0, r.s1, p.s), in_t = is_knot(r.t0, r.t1, p.t);
    if (in_s && in_t) continue;
    // On the side of this larger cell, between two of its knots.
    double low = in_s ? r.t0 : r.s0, high = in_s ? r.t1 : r.s1;
    const double x = in_s ? p.t : p.s, middle = 0.5 * (low + high);
    (x < middle ? high : low) = middle;
    const double share = (x - low) / (high - low);
    const auto at = [&](double y) { return in_s ? Parameters{p.s, y} : Parameters{y, p.t}; };
    add_terms(patches, facet, at(low), weight * (1.0 - share), terms);
    add_terms(patches, facet, at(high), weight * share, terms);
    return;
  }
  const std::array<double, 4> w = linear_weights(around, p);
  for (std::size_t q = 0; q < around.count; ++q) {
    if (w[q] != 0.0) terms.push_back({around.leaf[q], static_cast<float>(weight * w[q])});
  }
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
  // The quarter of the cell, and the position in the quarter.
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

void add_knot_terms(const Patches& patches, const Facet& facet, std::uint32_t leaf, std::uint32_t i,
                    std::uint32_t j, std::vector<KnotTerm>& terms) {
  if (i == 1 && j == 1) {
    terms.push_back({leaf, 1.0F});
    return;
  }
  const Rectangle r = patches.rectangle(facet.first_front + leaf);
  const std::array<double, 3> s{r.s0, 0.5 * (r.s0 + r.s1), r.s1};
  const std::array<double, 3> t{r.t0, 0.5 * (r.t0 + r.t1), r.t1};
  add_terms(patches, facet, {s[i], t[j]}, 1.0, terms);
}

}  // namespace earthshine::raytrace
