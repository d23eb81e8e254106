// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/attitude_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/input/input_file.h"
#include "scenes/text/csv_lines.h"
#include "scenes/text/message_text.h"
#include "scenes/text/table_reader.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t max_attitude_bytes = std::size_t{16} << 20;
constexpr double same_deg = 1e-3;      // of angles with six digits
constexpr double length_slack = 0.01;  // quaternions often have three digits
constexpr const char* wanted_columns =
    "a header names time_s or position_deg, and qw, qx, qy, qz or yaw_deg, pitch_deg, roll_deg";

enum Column : std::size_t { TimeS, PositionDeg, Qw, Qx, Qy, Qz, Yaw, Pitch, Roll, ColumnCount };
struct ColumnKind {
  const char* name;
  Range range;
};
constexpr ColumnKind kinds[] = {{"time_s", {-1e9, 1e9}},      {"position_deg", {-1e7, 1e7}},
                                {"qw", {-2.0, 2.0}},          {"qx", {-2.0, 2.0}},
                                {"qy", {-2.0, 2.0}},          {"qz", {-2.0, 2.0}},
                                {"yaw_deg", {-360.0, 360.0}}, {"pitch_deg", {-360.0, 360.0}},
                                {"roll_deg", {-360.0, 360.0}}};
static_assert(std::size(kinds) == ColumnCount);

class AttitudeReader {
 public:
  AttitudeReader(std::string_view text, const std::string& file) : lines_(text, file) {
    table_.file = file;
  }

  AttitudeTable read(std::vector<std::string>& warnings) {
    const bool headed = lines_.next();
    if (headed) read_header(lines_.fields());
    while (lines_.next()) read_row(lines_.fields());
    if (!headed) throw Error(Blame::Input, table_.file, "has no lines", wanted_columns);
    if (table_.at.empty()) {
      throw Error(Blame::Input, table_.file, "has a header and no rows", {},
                  "Give one row for an attitude that is kept, or several");
    }
    name_wide_steps(warnings);
    return std::move(table_);
  }

 private:
  void read_header(const std::vector<CsvField>& fields) {
    std::vector<std::string> names;
    for (const ColumnKind& kind : kinds) names.emplace_back(kind.name);
    for (const CsvField& field : fields) {
      const auto found = std::find(names.begin(), names.end(), field.text);
      if (found == names.end()) {
        const bool number = number_in(field.text).has_value();
        throw Error(
            Blame::Input, field.where,
            number ? fmt::format("the first line holds {} and is no header", in_quotes(field.text))
                   : fmt::format("unknown column {}", in_quotes(field.text)),
            wanted_columns, number ? "Begin with it" : did_you_mean(field.text, names));
      }
      const auto column = static_cast<Column>(found - names.begin());
      if (has(column)) {
        throw Error(Blame::Input, field.where,
                    fmt::format("the column {} is there twice", field.text));
      }
      columns_.push_back(column);
    }
    const base::Location& where = fields.front().where;
    if (has(TimeS) == has(PositionDeg)) {
      throw Error(Blame::Input, where,
                  has(TimeS) ? "both time_s and position_deg are there"
                             : "there is no column time_s or position_deg",
                  wanted_columns);
    }
    table_.by_time = has(TimeS);
    by_quaternion_ = has(Qw) || has(Qx) || has(Qy) || has(Qz);
    if (by_quaternion_ && (has(Yaw) || has(Pitch) || has(Roll))) {
      throw Error(Blame::Input, where, "both a quaternion and angles are there", wanted_columns);
    }
    for (const Column column : rotation_columns()) {
      if (has(column)) continue;
      throw Error(Blame::Input, where, fmt::format("there is no column {}", kinds[column].name),
                  wanted_columns);
    }
  }

  void read_row(const std::vector<CsvField>& fields) {
    if (fields.size() != columns_.size()) {
      throw Error(Blame::Input, {table_.file, fields[0].where.line, 0},
                  fmt::format("a row of {} columns", fields.size()),
                  fmt::format("the header names {}", columns_.size()));
    }
    std::array<double, ColumnCount> value{};
    base::Location at_place;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const ColumnKind& kind = kinds[columns_[k]];
      const auto number = number_in(fields[k].text);
      if (!number || !std::isfinite(*number) || !kind.range.holds(*number)) {
        throw Error(Blame::Input, fields[k].where,
                    fmt::format("{} is {}", kind.name, in_quotes(fields[k].text)),
                    fmt::format("allowed is a number {}", to_string(kind.range)));
      }
      value[columns_[k]] = *number;
      if (columns_[k] == TimeS || columns_[k] == PositionDeg) at_place = fields[k].where;
    }
    const double at = value[table_.by_time ? TimeS : PositionDeg];
    if (!table_.at.empty() && !(at > table_.at.back())) {
      throw Error(
          Blame::Input, at_place,
          fmt::format("{} is {:.10g} after {:.10g}",
                      kinds[table_.by_time ? TimeS : PositionDeg].name, at, table_.at.back()),
          "it rises from row to row", "Sort the rows, and keep one of those at one time");
    }
    rows_.push_back({{value[Yaw], value[Pitch], value[Roll]}, fields[0].where.line});
    table_.at.push_back(at);
    table_.rotations.push_back(by_quaternion_ ? quaternion(value, fields[0].where.line)
                                              : rotation_by_angles(value));
  }

  [[nodiscard]] glm::dquat quaternion(const std::array<double, ColumnCount>& value,
                                      int line) const {
    const glm::dquat q(value[Qw], value[Qx], value[Qy], value[Qz]);
    const double length = glm::length(q);
    if (!(std::abs(length - 1.0) <= length_slack)) {
      throw Error(Blame::Input, {table_.file, line, 0},
                  fmt::format("the quaternion has length {:.6g}", length),
                  "a turn has length 1, within 1 %; qw is the scalar");
    }
    return q / length;
  }

  static glm::dquat rotation_by_angles(const std::array<double, ColumnCount>& value) {
    const auto about = [](const Vec3& axis, double angle_deg) {
      return glm::angleAxis(base::radians(angle_deg), axis);
    };
    return about({0, 0, 1}, value[Yaw]) * about({0, 1, 0}, value[Pitch]) *
           about({1, 0, 0}, value[Roll]);
  }

  // Yaw, pitch and roll of a row, deg.
  struct Row {
    std::array<double, 3> angle_deg;
    int line;
  };

  // Rotation angle from one row to the next, by the shorter way, deg.
  [[nodiscard]] double rotation_deg(std::size_t row) const {
    const double cosine = std::abs(glm::dot(table_.rotations[row], table_.rotations[row + 1]));
    return 2.0 * base::degrees(std::acos(std::min(cosine, 1.0)));
  }

  // Difference of an angle as written, and by the shorter way.
  [[nodiscard]] double step_deg(std::size_t row, std::size_t angle) const {
    return rows_[row + 1].angle_deg[angle] - rows_[row].angle_deg[angle];
  }
  [[nodiscard]] double short_step_deg(std::size_t row, std::size_t angle) const {
    return std::remainder(step_deg(row, angle), 360.0);
  }

  // Whether the step before or after continues this one, by the shorter way: then the angle only
  // wraps from 360 to 0, or from 180 to -180.
  [[nodiscard]] bool only_wraps(std::size_t row, std::size_t angle) const {
    constexpr double jitter_deg = 5.0, alike = 3.0;
    const double step = short_step_deg(row, angle);
    if (std::abs(step) < same_deg) return false;
    const auto goes_on = [&](std::size_t other) {
      const double next = short_step_deg(other, angle);
      return (next * step > 0.0 && std::abs(step) <= alike * std::abs(next)) ||
             (std::abs(step) <= jitter_deg && std::abs(next) <= jitter_deg);
    };
    return (row > 0 && goes_on(row - 1)) || (row + 2 < rows_.size() && goes_on(row + 1));
  }

  // Yaw and roll both jump where the nose passes the zenith, although the rotation is small.
  [[nodiscard]] bool passes_zenith(std::size_t row) const {
    const auto over = [](double step) { return std::abs(step) >= 90.0 && std::abs(step) <= 270.0; };
    return rotation_deg(row) < 90.0 && over(step_deg(row, 0)) && over(step_deg(row, 2));
  }

  // The angle with a step of half a turn or more; if none, the number of angles.
  [[nodiscard]] std::size_t wide_angle(std::size_t row) const {
    std::size_t angle = 0;
    while (angle < 3 && (std::abs(step_deg(row, angle)) < 180.0 - same_deg ||
                         only_wraps(row, angle) || passes_zenith(row))) {
      ++angle;
    }
    return angle;
  }

  void name_wide_steps(std::vector<std::string>& warnings) const {
    std::size_t first = 0, count = 0;
    for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
      const bool wide =
          rotation_deg(row) > 180.0 - same_deg || (!by_quaternion_ && wide_angle(row) < 3);
      if (wide && count++ == 0) first = row;
    }
    if (count == 0) return;
    const std::size_t angle = by_quaternion_ ? 3 : wide_angle(first);
    const std::string step =
        angle < 3 ? fmt::format("{} goes from {:g} to {:g}", kinds[Yaw + angle].name,
                                rows_[first].angle_deg[angle], rows_[first + 1].angle_deg[angle])
                  : "they are half a turn apart";
    const double taken = rotation_deg(first);
    const std::string taken_text = taken < same_deg ? "none at all"
                                   : taken > 180.0 - same_deg
                                       ? "either way round"
                                       : fmt::format("the shorter one, of {:.4g} deg", taken);
    warnings.push_back(fmt::format(
        "{}: lines {} and {}: {}, and the turn that is taken between rows is {}{}; give rows less "
        "than 180 deg apart, as every 120 deg",
        table_.file, rows_[first].line, rows_[first + 1].line, step, taken_text,
        count > 1 ? fmt::format(" ({} more such)", count - 1) : std::string()));
  }

  [[nodiscard]] bool has(Column column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
  }

  [[nodiscard]] std::vector<Column> rotation_columns() const {
    return by_quaternion_ ? std::vector{Qw, Qx, Qy, Qz} : std::vector{Yaw, Pitch, Roll};
  }

  CsvLines lines_;
  AttitudeTable table_;
  std::vector<Row> rows_;
  std::vector<Column> columns_;
  bool by_quaternion_ = false;
};

}  // namespace

AttitudeTable read_attitudes(const std::filesystem::path& path, const base::Location& asked_at,
                             std::vector<std::string>& warnings) {
  const std::string text = base::read_input_file(path, max_attitude_bytes, asked_at);
  return AttitudeReader(text, path.string()).read(warnings);
}

}  // namespace earthshine::scenes
