// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/condition_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/text/message_text.h"

namespace earthshine::studies {
namespace {

using Value = std::optional<double> ConditionNoise::*;

// Indices of the elements that have the value, in ascending order of the value.
std::vector<std::size_t> ranked(std::span<const ConditionNoise> noise, Value value) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < noise.size(); ++k) {
    if (noise[k].*value) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return *(noise[a].*value) < *(noise[b].*value);
  });
  return order;
}

}  // namespace

std::string_view word_of(FinishedBy finished) {
  constexpr std::array<std::string_view, 3> words = {"error", "verdicts", "nothing"};
  return words[static_cast<std::size_t>(finished)];
}

namespace {

// "" if all conditions have the wanted error.
std::string text_of_finished(std::span<const ConditionNoise> noise,
                             std::span<const std::string> names) {
  std::size_t by_verdicts = 0, open = 0, first_open = 0;
  for (std::size_t k = 0; k < noise.size(); ++k) {
    if (noise[k].finished_by == FinishedBy::Verdicts) ++by_verdicts;
    if (noise[k].finished_by == FinishedBy::Nothing && open++ == 0) first_open = k;
  }
  std::string text;
  if (by_verdicts > 0) {
    text = fmt::format("; {} of {} noisier than asked, but their verdicts cannot change",
                       by_verdicts, noise.size());
  }
  if (open > 0) {
    text += fmt::format(
        "; {} of {} noisier than asked, where a verdict may change (the first is {}): ask for a "
        "smaller --error",
        open, noise.size(), names[first_open]);
  }
  return text;
}

}  // namespace

ConditionNoise noise_of_condition(double rms, double mean) {
  ConditionNoise noise;
  noise.cd_m2 = rms;
  if (rms <= mean && mean > 0.0) noise.relative = rms / mean;
  return noise;
}

std::string noise_text(std::span<const ConditionNoise> noise, std::span<const std::string> names) {
  std::vector<ConditionNoise> dark(noise.begin(), noise.end());
  for (ConditionNoise& one : dark) {
    if (one.relative) one.cd_m2.reset();
  }
  const std::vector<std::size_t> lit = ranked(noise, &ConditionNoise::relative);
  const std::vector<std::size_t> unlit = ranked(dark, &ConditionNoise::cd_m2);
  std::string text;
  if (!lit.empty()) {
    const std::string least = scenes::two_digits(100.0 * *noise[lit.front()].relative);
    const std::string most = scenes::percent(*noise[lit.back()].relative);
    text = fmt::format("noise of {}{} of the mean in the conditions' pictures, most in {}",
                       least + " %" == most ? "" : least + " to ", most, names[lit.back()]);
  }
  const std::string finished = text_of_finished(noise, names);
  if (unlit.empty()) return text + finished;
  const std::string most = scenes::two_digits(*dark[unlit.back()].cd_m2) + " cd/m²";
  if (unlit.size() == 1) {
    return text +
           fmt::format("{}noise of {}, more than its light, in {}", text.empty() ? "" : "; ", most,
                       names[unlit.back()]) +
           finished;
  }
  return text +
         fmt::format("{}noise of up to {}, more than their light, in {} dark ones, most in {}",
                     text.empty() ? "" : "; ", most, unlit.size(), names[unlit.back()]) +
         finished;
}

}  // namespace earthshine::studies
