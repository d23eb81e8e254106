// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/knots.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace earthshine::raytrace {
namespace {

using radiosity::Facet;
using radiosity::Parameters;
using radiosity::Patches;
using radiosity::Rectangle;

// Up to four cells about a point.
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

// Quotients of whole numbers below 2^21: they are equal, or differ by far more than rounding.
bool is_knot(double low, double high, double x) {
  constexpr double rounding = 1e-12;
  return std::min({std::abs(x - low), std::abs(x - high), std::abs(x - 0.5 * (low + high))}) <=
         rounding;
}

using Four = std::array<double, 4>;

// Takes from v what lies along u.
void remove_part(Four& v, const Four& u) {
  double dot = 0.0, norm = 0.0;
  for (std::size_t q = 0; q < 4; ++q) {
    dot += v[q] * u[q];
    norm += u[q] * u[q];
  }
  if (norm <= 0.0) return;
  for (std::size_t q = 0; q < 4; ++q) v[q] -= dot / norm * u[q];
}

// Of all weights with sum 1 that put the mean of the cells' centres at the point, along those axes
// that have cells on both sides, the ones of least norm: what is left of (1, 1, ...) at right
// angles to the offsets, scaled. Equal weights where that would make one negative.
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
    // Cells on one side only, or one that is centred: the other entries are zero or rounding.
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
    // On this larger cell's side, between two of its knots.
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
