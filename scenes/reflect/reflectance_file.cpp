// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/reflectance_file.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/input/input_file.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t max_reflectance_bytes = std::size_t{16} << 20;

// A number within [least, most] at `column` of the line.
double checked_number(std::string_view field, const base::Location& where, const char* what,
                      double least, double most) {
  const auto value = number_in(field);
  if (value && std::isfinite(*value) && *value >= least && *value <= most) return *value;
  throw Error(Blame::Input, where, fmt::format("\"{}\" is no {}", trimmed(field), what),
              fmt::format("it must be a number from {:g} to {:g}", least, most));
}

}  // namespace

std::vector<ReflectancePoint> read_reflectance(const std::filesystem::path& path) {
  std::istringstream file(base::read_input_file(path, max_reflectance_bytes, {path.string()}));
  std::vector<ReflectancePoint> points;
  std::string line;
  bool heading_possible = true;
  for (int number = 1; std::getline(file, line); ++number) {
    std::string_view row(line);
    if (number == 1 && row.starts_with("\xEF\xBB\xBF")) row.remove_prefix(3);
    const auto skipped = static_cast<std::size_t>(row.data() - line.data());
    row = row.substr(0, row.find('#'));
    if (trimmed(row).empty()) continue;
    const auto comma = row.find(',');
    if (comma == std::string_view::npos || row.find(',', comma + 1) != std::string_view::npos) {
      throw Error(Blame::Input, base::Location{path.string(), number, 0},
                  fmt::format("\"{}\" does not have two columns", trimmed(row)),
                  "each row is an angle in degrees, a comma and a reflectance factor");
    }
    const std::string_view angle = row.substr(0, comma), reflectance = row.substr(comma + 1);
    if (heading_possible && !number_in(angle) && !number_in(reflectance)) {
      heading_possible = false;
      continue;
    }
    heading_possible = false;
    const auto column_of = [&](std::string_view field) {
      const std::string_view text = trimmed(field);
      const char* start = text.empty() ? field.data() : text.data();
      return static_cast<int>(static_cast<std::size_t>(start - row.data()) + skipped + 1);
    };
    const base::Location at_angle{path.string(), number, column_of(angle)};
    const base::Location at_reflectance{path.string(), number, column_of(reflectance)};
    points.push_back({checked_number(angle, at_angle, "angle in degrees", -180.0, 180.0),
                      checked_number(reflectance, at_reflectance, "reflectance factor", 0.0, 1e6)});
  }
  return points;
}

}  // namespace earthshine::scenes
