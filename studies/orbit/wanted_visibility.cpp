// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/wanted_visibility.h"

#include <cmath>

namespace earthshine::studies {

std::vector<double> detections(const LightBasis& basis, const BasisView& view, std::size_t place,
                               std::size_t setting, double lamps,
                               const std::optional<degrade::Setup>& cctv,
                               const SightOptions& options) {
  const GroupWeights weights = basis.weights(place, setting, lamps);
  const base::Image radiance = weighted_sum(view.layers, basis.groups().names, weights);
  const CameraSight sight = measure_sight(view.plan, radiance, cctv, options);
  std::vector<double> found;
  for (const Sight& target : sight.targets) {
    const bool is_judged = target.probability && target.verdict != Verdict::Hidden &&
                           !(target.black_back >= options.most_black_back);
    found.push_back(is_judged ? target.probability->detect : 0.0);
  }
  return found;
}

std::optional<double> least_factor(const std::function<double(double)>& probability,
                                   double wanted) {
  if (probability(0.0) >= wanted) return 0.0;
  double high = least_lamp_factor;
  while (probability(high) < wanted) {
    if (high >= most_lamp_factor) return std::nullopt;
    high *= lamp_factor_step;
  }
  if (high <= least_lamp_factor) return high;
  double low = high / lamp_factor_step;
  while (high - low > 0.01 * high) {
    const double middle = std::sqrt(low * high);
    (probability(middle) >= wanted ? high : low) = middle;
  }
  return high;
}

std::vector<Arc> arcs_above(const std::vector<double>& positions_deg,
                            const std::vector<double>& probability, double wanted, bool closed) {
  const std::size_t count = positions_deg.size();
  std::vector<Arc> arcs;
  if (count == 0) return arcs;
  // Where the straight line between two neighbours crosses `wanted`.
  const auto crossing = [&](std::size_t a, std::size_t b, double to_b) {
    const double share = (wanted - probability[a]) / (probability[b] - probability[a]);
    return positions_deg[a] + share * (to_b - positions_deg[a]);
  };
  bool inside = false;
  double begin = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const bool in = probability[k] >= wanted;
    if (in && !inside) {
      inside = true;
      const bool before = k > 0 && probability[k - 1] < wanted;
      begin = before ? crossing(k - 1, k, positions_deg[k]) : positions_deg[k];
    }
    if (inside && !in) {
      inside = false;
      arcs.emplace_back(begin, crossing(k - 1, k, positions_deg[k]));
    }
  }
  const double around = positions_deg.front() + 360.0;
  const bool first_in = probability.front() >= wanted;
  if (inside) {
    const bool leaves = closed && !first_in;
    const double end = leaves   ? crossing(count - 1, 0, around)
                       : closed ? around
                                : positions_deg.back();
    arcs.emplace_back(begin, end);
  } else if (closed && first_in && count > 1) {
    arcs.front().first = crossing(count - 1, 0, around) - 360.0;
  }
  if (closed && inside && first_in && arcs.size() > 1) {  // one arc across the start
    arcs.front().first = arcs.back().first - 360.0;
    arcs.pop_back();
  }
  return arcs;
}

double total_deg(const std::vector<Arc>& arcs) {
  double sum = 0.0;
  for (const Arc& arc : arcs) sum += arc.second - arc.first;
  return sum;
}

}  // namespace earthshine::studies
