// SPDX-License-Identifier: Apache-2.0
// Values that study files and the command line share.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "studies/orbit/study_file.h"

namespace earthshine::studies {

bool stands_among(const std::vector<double>& positions_deg, double position_deg) {
  return std::any_of(positions_deg.begin(), positions_deg.end(), [&](double known) {
    return std::abs(std::remainder(known - position_deg, 360.0)) < 1e-9;
  });
}

WantedTarget read_wanted(const std::string& text, const base::Location& where) {
  const std::size_t at = text.rfind(">=");
  WantedTarget wanted;
  wanted.text = text;
  bool good = at != std::string::npos && at > 0;
  if (good) {
    const char* const first = text.data() + at + 2;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(first, end, wanted.probability);
    good = read.ec == std::errc() && read.ptr == end && wanted.probability > 0.0 &&
           wanted.probability < 1.0;
  }
  if (!good) {
    throw base::Error(
        base::Blame::Input, where, fmt::format("\"{}\" is no target and its probability", text),
        "allowed is TARGET>=P, with P between 0 and 1", "Write for instance \"tss>=0.9\"");
  }
  wanted.target = text.substr(0, at);
  return wanted;
}

base::Location StudyFile::place(const std::string& key) const {
  const auto found = where.find(key);
  return found == where.end() ? base::Location{key} : found->second;
}

std::vector<double> even_positions(int count) {
  std::vector<double> positions;
  for (int k = 0; k < count; ++k) positions.push_back(360.0 * k / count);
  return positions;
}

LampSetting lamps_as_they_are() { return {"as they are", false, {}}; }

}  // namespace earthshine::studies
