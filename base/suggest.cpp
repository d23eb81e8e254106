// SPDX-License-Identifier: Apache-2.0
#include "base/suggest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace earthshine::base {
namespace {

char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

// Words of one meaning in scene files and calls of this program and of others. The first that a
// candidate has is suggested.
const std::vector<std::vector<std::string>>& synonyms() {
  static const std::vector<std::vector<std::string>> all = {
      {"flux", "intensity", "power", "lumen", "lumens", "watt", "watts", "brightness", "strength"},
      {"samples", "spp", "sample", "rays", "quality", "accuracy", "precision", "noise", "error"},
      {"position", "origin", "pivot", "location", "translate", "translation", "offset", "place"},
      {"rotate", "rotation", "orientation", "euler", "angle"},
      {"size", "resolution", "dimensions", "width", "height"},
      {"look", "target", "lookat", "aim", "towards", "direction"},
      {"output", "out", "outfile", "file", "save", "write"},
      {"threads", "jobs", "cores", "cpus", "processes"},
      {"fov", "focal", "lens", "zoom"},
      {"reflect", "reflectance", "albedo", "diffuse", "colour", "color", "kd"},
      {"emit", "emission", "emissive", "radiance", "luminance"},
      {"exposure", "iso", "gain", "brightness"},
      {"mesh", "model", "geometry", "obj", "file"},
      {"scale", "unit", "units", "size"},
      {"time", "timeout", "limit", "budget", "seconds"},
      {"camera", "view", "viewpoint", "eye"},
      {"quiet", "silent"},
      {"light", "lamp", "lights", "lamps"},
      {"object", "body", "part", "group"},
      {"space", "sky", "zenith", "stars"},
  };
  return all;
}

// "gather_rays" has "rays", "--time-limit" has "time".
bool has_word(std::string_view candidate, std::string_view word) {
  while (!candidate.empty()) {
    const std::size_t end = std::min(candidate.find_first_of("_-. "), candidate.size());
    if (edit_distance(candidate.substr(0, end), word) == 0) return true;
    candidate.remove_prefix(std::min(end + 1, candidate.size()));
  }
  return false;
}

// Without the dashes of an option.
std::string_view bare(std::string_view word) {
  while (word.starts_with('-')) word.remove_prefix(1);
  return word;
}

// The list that has the word, or one of its parts ("light_power"); nullptr: none has.
const std::vector<std::string>* meaning_of(std::string_view word) {
  for (const bool whole : {true, false}) {
    for (const std::vector<std::string>& alike : synonyms()) {
      const auto means = [&](const std::string& one) {
        return whole ? edit_distance(word, one) == 0 : has_word(word, one);
      };
      if (std::ranges::any_of(alike, means)) return &alike;
    }
  }
  return nullptr;
}

// A slip of the keys is one edit in a short word and two or three in a longer one.
std::size_t most_edits(std::size_t length) { return length < 6 ? 1 : length < 10 ? 2 : 3; }

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const bool same = small(a[i]) == small(b[j]);
      row[j + 1] = std::min({last[j + 1] + 1, row[j] + 1, last[j] + (same ? 0 : 1)});
      const bool exchanged =
          i > 0 && j > 0 && small(a[i]) == small(b[j - 1]) && small(a[i - 1]) == small(b[j]);
      if (exchanged) row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
  }
  return row[b.size()];
}

std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  const std::string_view wrong = bare(word);
  const auto first = [&](const auto& fits) -> std::string {
    const auto found = std::ranges::find_if(candidates, fits);
    return found != candidates.end() ? *found : std::string();
  };
  const auto has = [&](std::string_view one) {
    return first([&](const std::string& candidate) { return has_word(bare(candidate), one); });
  };
  // A word of the table is no misspelling.
  const std::vector<std::string>* const alike = meaning_of(wrong);
  if (alike != nullptr) {
    for (const std::string& one : *alike) {
      std::string found = first(
          [&](const std::string& candidate) { return edit_distance(bare(candidate), one) == 0; });
      if (!found.empty()) return found;
    }
    if (std::string found = has(wrong); !found.empty()) return found;
    for (const std::string& one : *alike) {
      if (std::string found = has(one); !found.empty()) return found;
    }
    return {};
  }
  std::size_t best = most_edits(wrong.size()) + 1;
  std::string found;
  for (const std::string& candidate : candidates) {
    const std::string_view right = bare(candidate);
    const std::size_t distance = edit_distance(wrong, right);
    // Words that have hardly a letter in common are not meant.
    if (distance < best && 2 * distance <= std::max(wrong.size(), right.size()) &&
        distance < right.size()) {
      best = distance;
      found = candidate;
    }
  }
  if (!found.empty()) return found;
  found = first([&](const std::string& candidate) {
    return wrong.size() > 2 && bare(candidate).starts_with(wrong);
  });
  if (found.empty()) found = has(wrong);
  if (!found.empty()) return found;
  // A slip of the keys in a longer word of the table: "positon".
  for (const std::vector<std::string>& words : synonyms()) {
    for (const std::string& one : words) {
      if (one.size() > 5 && edit_distance(wrong, one) == 1) return nearest_word(one, candidates);
    }
  }
  return {};
}

}  // namespace earthshine::base
