// SPDX-License-Identifier: Apache-2.0
#include "app/study/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace earthshine::app {
namespace {

using studies::Verdict;

double wrapped_deg(double angle_deg) { return angle_deg - 360.0 * std::floor(angle_deg / 360.0); }

std::string angle_text(double angle_deg) {
  const double rounded = std::round(wrapped_deg(angle_deg));
  return fmt::format("{:.0f}", rounded >= 360.0 ? 0.0 : rounded);
}

// Enough digits to distinguish the value from its threshold.
std::string beside(const char* what, double value, const char* threshold_is, double threshold) {
  int digits = 2;
  const auto text = [&digits](double x) { return fmt::format("{:.{}g}", x, digits); };
  while (digits < 4 && text(value) == text(threshold)) ++digits;
  return fmt::format("{} {}, {} {}", what, text(value), threshold_is, text(threshold));
}

}  // namespace

std::string scene_title(const StudyResults& study, std::size_t scene) {
  const SceneEntry& entry = study.scenes[scene];
  const std::string file = std::filesystem::path(entry.path).filename().string();
  if (entry.name.empty()) return file.empty() ? entry.id : file;
  const auto same =
      std::count_if(study.scenes.begin(), study.scenes.end(),
                    [&](const SceneEntry& other) { return other.name == entry.name; });
  return same > 1 ? fmt::format("{} ({})", entry.name, file.empty() ? entry.id : file) : entry.name;
}

std::string arcs_text(const std::vector<studies::Arc>& arcs) {
  std::string text;
  for (const auto& [from, to] : arcs) {
    if (to - from >= 360.0) return "the whole orbit";
    text += (text.empty() ? "" : ", ") + angle_text(from);
    if (to > from) text += " to " + angle_text(to);
    text += " deg";
  }
  return text;
}

std::string deciding_figure(const TargetFindings& found) {
  const studies::Sight& sight = found.sight;
  const studies::SightOptions options;
  if (sight.verdict == Verdict::Hidden) {
    return fmt::format("{:.2g} % of it visible, {:g} % needed",
                       100.0 * sight.visible_fraction.value_or(0.0),
                       100.0 * options.hidden_fraction);
  }
  if (sight.black_back >= options.most_black_back) {
    return fmt::format("{:.0f} % of what is seen is a black back, doubtful from {:.0f} %",
                       100.0 * *sight.black_back, 100.0 * options.most_black_back);
  }
  if (sight.verdict == Verdict::Identified || sight.verdict == Verdict::OutOfView) return "";
  const bool screen = sight.monitor.has_value();
  const bool unseen = sight.verdict >= Verdict::Doubtful;
  double weber = NAN, threshold = NAN, snr_d = NAN, cycles = NAN;
  if (screen) {
    weber = std::abs(sight.monitor->weber.value_or(NAN));
    threshold = sight.monitor->threshold.value_or(NAN);
    if (sight.signal) snr_d = sight.signal->snr_d.value_or(NAN);
    cycles = sight.johnson_cycles.value_or(NAN);
  } else if (sight.eye) {
    weber = std::abs(sight.eye->weber.value_or(NAN));
    threshold = sight.eye->threshold.value_or(NAN);
    cycles = sight.eye->cycles;
  }
  const double needed = unseen                               ? options.cycles.detect
                        : sight.verdict == Verdict::Detected ? options.cycles.recognise
                                                             : options.cycles.identify;
  const bool small = cycles < needed, faint = weber < threshold,
             noisy = snr_d < options.even_chance_snr;
  // If the screen resolves a cycle, its contrast exceeds the threshold in parts of the picture.
  const bool seen_in_parts = screen && cycles > 0.0;
  if ((faint || noisy) && !(small && seen_in_parts)) {
    if (noisy && !(faint && weber / threshold < snr_d / options.even_chance_snr)) {
      return beside("signal to noise", snr_d, "threshold", options.even_chance_snr);
    }
    return beside(screen ? "contrast on the monitor" : "contrast to the eye", weber, "threshold",
                  threshold);
  }
  return small ? beside("cycles across it", cycles, "needed", needed) : "";
}

}  // namespace earthshine::app
