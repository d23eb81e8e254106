// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/ies_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input/input_file.h"
#include "scenes/light/ies_numbers.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

using Numbers = IesNumbers;

constexpr std::size_t most_angles = 4096;                  // per direction
constexpr std::size_t most_values = std::size_t{1} << 20;  // in the file's table
constexpr double same_angle_deg = 1e-6;

std::string upper_case(std::string_view text) {
  std::string upper;
  for (const char c : text) upper += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return upper;
}

std::string_view whole_line(const TextLines& lines) {
  const Word& first = lines.words().front();
  const Word& last = lines.words().back();
  return {first.text.data(),
          static_cast<std::size_t>(last.text.data() + last.text.size() - first.text.data())};
}

// Until 1991 the number after the ballast factor was a factor too; since 1995 it is reserved, and
// since 2019 it describes how the file was made.
bool second_factor_counts(const TextLines& lines, const std::string& version) {
  if (!version.starts_with("IESNA") && !version.starts_with("IES:")) return true;
  for (const std::string_view year : {"1986", "1991", "86", "91"}) {
    if (version.ends_with(year)) return true;
  }
  for (const std::string_view year : {"1995", "2002", "2019"}) {
    if (version.ends_with("LM-63-" + std::string(year))) return false;
  }
  throw Error(Blame::Input, lines.where(), fmt::format("the format {}", in_quotes(version)),
              "known are IESNA91 and IES LM-63 of 1986, 1991, 1995, 2002 and 2019");
}

struct Head {
  bool second_factor = true;
  std::string description;
  std::string tilt;  // text after TILT=
};

// Everything up to the TILT line.
Head read_head(TextLines& lines, const std::string& file) {
  Head head;
  std::string first_text;
  bool first = true;
  while (lines.next()) {
    const std::string line = upper_case(whole_line(lines));
    if (line.starts_with("TILT") && line.find('=') != std::string::npos) {
      const std::string_view text = whole_line(lines);
      std::string_view value = text.substr(text.find('=') + 1);
      value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
      head.tilt = value;
      if (head.description.empty()) head.description = first_text;
      head.description = printable(head.description, 80);
      return head;
    }
    if (first && line.starts_with("IES")) {
      head.second_factor = second_factor_counts(lines, line);
    } else if (line.starts_with("[LUMINAIRE]") ||
               (line.starts_with("[LUMCAT]") && head.description.empty())) {
      head.description = lines.argument();
    } else if (!line.starts_with("[") && first_text.empty()) {
      first_text = whole_line(lines);
    }
    first = false;
  }
  throw Error(Blame::Input, base::Location{file},
              "there is no line TILT=", "a file of IES LM-63 has one before its numbers",
              "The file is cut off or not IES");
}

std::optional<TiltTable> read_tilt(const TextLines& lines, const Head& head, Numbers& numbers) {
  const std::string tilt = upper_case(head.tilt);
  if (tilt == "NONE") return std::nullopt;
  if (tilt != "INCLUDE") {
    throw Error(Blame::Input, lines.where(), fmt::format("TILT={}", in_quotes(head.tilt)),
                "read are TILT=NONE and TILT=INCLUDE",
                "Put the tilt table into this file, with TILT=INCLUDE");
  }
  numbers.skip("the lamp-to-luminaire geometry");
  const std::size_t pairs = numbers.count("the number of tilt angles", 1, most_angles);
  TiltTable table;
  table.angle_deg = numbers.angles(pairs, "tilt angle");
  for (std::size_t k = 0; k < pairs; ++k) {
    table.factor.push_back(numbers.not_negative("a tilt factor"));
  }
  return table;
}

bool same(double a, double b) { return std::abs(a - b) < same_angle_deg; }

void check_vertical(const std::vector<double>& angles, const Numbers& numbers) {
  const bool starts = same(angles.front(), 0.0) || same(angles.front(), 90.0);
  const bool ends = same(angles.back(), 90.0) || same(angles.back(), 180.0);
  if (starts && ends) return;
  numbers.fail(fmt::format("the vertical angles run from {} to {}", angles.front(), angles.back()),
               "photometry of type C runs from 0 or 90 to 90 or 180",
               "Where the luminaire was not measured and is dark, add angles with 0 cd");
}

// Reflects a table over part of the circle to double its range.
void mirror_planes(std::vector<double>& angles, std::vector<double>& candela, std::size_t rows) {
  const double edge = angles.back();
  for (std::size_t k = angles.size() - 1; k-- > 0;) {
    angles.push_back(2.0 * edge - angles[k]);
    const std::size_t from = k * rows;
    for (std::size_t row = 0; row < rows; ++row) candela.push_back(candela[from + row]);
  }
}

void check_horizontal(const std::vector<double>& angles, const Numbers& numbers) {
  const double first = angles.front(), last = angles.back();
  const bool good = same(first, 0.0) ? angles.size() == 1 || same(last, 90.0) ||
                                           same(last, 180.0) || same(last, 360.0)
                    : same(first, 90.0) ? same(last, 270.0)
                                        : false;
  if (good) return;
  numbers.fail(
      fmt::format("the horizontal angles run from {} to {}", first, last),
      "photometry of type C has 0 alone, or runs from 0 to 90, 180 or 360, or from 90 to 270",
      "Where planes are missing, add them; the plane at 360 is that at 0");
}

// Extends to the full circle from the first angle.
void unfold(std::vector<double>& angles, std::vector<double>& candela, std::size_t rows) {
  if (angles.size() == 1) {
    angles = {0.0, 360.0};
    candela.resize(2 * rows);
    std::copy_n(candela.begin(), rows, candela.begin() + static_cast<std::ptrdiff_t>(rows));
    return;
  }
  while (!same(angles.back() - angles.front(), 360.0)) mirror_planes(angles, candela, rows);
}

}  // namespace

double TiltTable::factor_at(double tilt_deg) const {
  const auto above = std::lower_bound(angle_deg.begin(), angle_deg.end(), tilt_deg);
  if (above == angle_deg.begin()) return factor.front();
  if (above == angle_deg.end()) return factor.back();
  const auto k = static_cast<std::size_t>(above - angle_deg.begin());
  const double x = (tilt_deg - angle_deg[k - 1]) / (angle_deg[k] - angle_deg[k - 1]);
  return (1.0 - x) * factor[k - 1] + x * factor[k];
}

Luminaire parse_ies(std::string_view bytes, const std::string& file) {
  TextLines lines(bytes, file, TextLines::Style::Plain);
  const Head head = read_head(lines, file);
  Numbers numbers(lines, file);
  Luminaire luminaire;
  luminaire.description = head.description;
  luminaire.tilt = read_tilt(lines, head, numbers);

  numbers.skip("the number of lamps");
  numbers.skip("the flux of a lamp");
  double factor = numbers.above_zero("the candela multiplier");
  const std::size_t rows = numbers.count("the number of vertical angles", 2, most_angles);
  const std::size_t planes = numbers.count("the number of horizontal angles", 1, most_angles);
  if (rows * planes > most_values) {
    numbers.fail(fmt::format("{} x {} candela values", rows, planes),
                 fmt::format("at most {} are read", most_values));
  }
  const std::size_t type = numbers.count("the photometric type", 1, 3);
  if (type != 1) {
    numbers.fail(fmt::format("photometry of type {}", type == 2 ? "B" : "A"), "type C, 1, is read",
                 "Convert the file to type C");
  }
  const double unit_m = numbers.count("the type of units", 1, 2) == 1 ? 0.3048 : 1.0;
  for (const char* side : {"the opening's width", "the opening's length", "the opening's height"}) {
    // Negative sizes mean round openings.
    luminaire.opening_m = std::max(luminaire.opening_m, unit_m * std::abs(numbers.next(side)));
  }
  factor *= numbers.above_zero("the ballast factor");
  if (head.second_factor) {
    factor *= numbers.above_zero("the ballast-lamp photometric factor");
  } else {
    numbers.skip("the number after the ballast factor");
  }
  numbers.skip("the input power");

  std::vector<double> vertical = numbers.angles(rows, "vertical angle");
  check_vertical(vertical, numbers);
  std::vector<double> horizontal = numbers.angles(planes, "horizontal angle");
  check_horizontal(horizontal, numbers);
  const base::Location here{file, lines.line()};
  std::vector<double> candela;
  for (std::size_t k = 0; k < rows * planes; ++k) {
    candela.push_back(
        factor * numbers.not_negative(fmt::format("candela value {} of {}", k + 1, rows * planes)));
  }
  luminaire.warning = numbers.rest();
  const double peak = *std::max_element(candela.begin(), candela.end());
  if (!(peak > 0.0) || !std::isfinite(peak)) {
    throw Error(Blame::Input, here,
                peak > 0.0 ? "candela values that overflow" : "every candela value is 0",
                "a luminaire gives light");
  }
  unfold(horizontal, candela, rows);
  luminaire.light = std::make_shared<const Photometry>(std::move(vertical), std::move(horizontal),
                                                       std::move(candela));
  return luminaire;
}

Luminaire read_ies(const std::filesystem::path& path, const base::Location& asked_at) {
  return parse_ies(base::read_input_file(path, max_ies_bytes, asked_at), path.string());
}

}  // namespace earthshine::scenes
