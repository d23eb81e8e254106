// SPDX-License-Identifier: Apache-2.0
#include "studies/settings_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace earthshine::studies {
namespace {

constexpr double most_patches_times = 4.0;
constexpr int most_rays_times = 4, most_rays = 1 << 18;
constexpr double least_picture_share = 0.3;  // of the wanted squared error
// A solve that is good enough is done again only if that saves a third of all that is left.
constexpr double worth_another = 2.0 / 3.0;
// What looking at a solve again takes (radiosity/second_looks.h), over its own rays.
constexpr double second_looks = 0.4;

double squared(double x) { return x * x; }

// Steps of half an octave in the number of patches.
std::vector<double> patch_steps(const ChoiceRules& rules) {
  std::vector<double> times = {1.0};
  if (!rules.may_cut) return times;
  while (times.back() < most_patches_times) times.push_back(times.back() * std::sqrt(2.0));
  return times;
}

std::vector<int> ray_steps(const SolveState& state, const ChoiceRules& rules) {
  std::vector<int> times = {1};
  if (!rules.may_cast) return times;
  while (times.back() < most_rays_times && 2 * times.back() * state.rays <= most_rays) {
    times.push_back(2 * times.back());
  }
  return times;
}

}  // namespace

SettingsChoice choose_settings(const SolveState& state, const ChoiceRules& rules) {
  SettingsChoice best, as_it_is;
  double best_left = -1e300;
  bool any = false;
  for (const double more_patches : patch_steps(rules)) {
    for (const int more_rays : ray_steps(state, rules)) {
      SettingsChoice choice;
      choice.keeps = more_patches == 1.0 && more_rays == 1;
      choice.patches = state.patches * more_patches;
      choice.rays = state.rays * more_rays;
      if (!choice.keeps && rules.fits && !rules.fits(choice.patches, choice.rays)) continue;
      choice.refine_error = state.refine_error / std::sqrt(more_patches);
      const double left = squared(rules.wanted) - squared(state.other_error) -
                          squared(state.patch_error / more_patches) -
                          squared(state.ray_error) / (more_patches * more_rays);
      const double for_picture = least_picture_share * squared(rules.wanted);
      const bool draws = rules.picture_rays > 0.0;
      choice.reached = left >= (draws ? for_picture : 0.0);
      choice.picture_noise = std::sqrt(std::max(left, for_picture));
      if (!choice.keeps) {
        choice.cost =
            choice.patches * ((1.0 + second_looks) * choice.rays + rules.rays_per_patch_cut);
      }
      if (draws) {
        choice.cost += rules.picture_rays * squared(rules.picture_noise / choice.picture_noise);
      }
      if (choice.keeps) as_it_is = choice;
      const bool better = !any || (choice.reached != best.reached ? choice.reached
                                   : choice.reached               ? choice.cost < best.cost
                                                                  : left > best_left);
      if (!better) continue;
      best = choice;
      best_left = left;
      any = true;
    }
  }
  const bool enough = as_it_is.reached && best.cost > worth_another * as_it_is.cost;
  return enough ? as_it_is : best;
}

NoiseSetting next_setting(const NoiseSetting& setting, const NoiseFound& found, double wanted) {
  constexpr double most_change = 8.0;
  const double gather = std::sqrt(found.gather_rays) * found.gather;
  const double samples = std::sqrt(found.sample_rays) * found.samples;
  const auto change = [&](double noise, double weight) {
    if (noise <= 0.0 || weight <= 0.0) return most_change;
    const double target = wanted * std::sqrt(weight / (gather + samples));
    return std::clamp(target / noise, 1.0 / most_change, most_change);
  };
  return {setting.gather * change(found.gather, gather),
          setting.samples * change(found.samples, samples)};
}

}  // namespace earthshine::studies
