// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/attitude_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"
#include "scenes/time/ccsds_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr double length_slack = 0.01;
constexpr double end_slack_s = 1.0;  // tolerance of STOP_TIME against the last row
constexpr double jump_deg = 10.0, jump_ratio = 10.0;
constexpr double single_ratio = 5.0;  // a row off its two neighbours, which are two steps apart
constexpr double same_deg = 0.01;     // rows of one attitude, which is held over any gap
constexpr const char* types = "allowed are QUATERNION, EULER_ANGLE and SPIN, with rates or without";
constexpr const char* say_scalar =
    "Write quaternion = \"scalar-first\" or \"scalar-last\" beside attitude";

const std::vector<std::string_view> aem_keys = {
    "OBJECT_NAME",         "OBJECT_ID",     "CENTER_NAME",
    "REF_FRAME_A",         "REF_FRAME_B",   "ATTITUDE_DIR",
    "TIME_SYSTEM",         "START_TIME",    "USEABLE_START_TIME",
    "USEABLE_STOP_TIME",   "STOP_TIME",     "ATTITUDE_TYPE",
    "QUATERNION_TYPE",     "EULER_ROT_SEQ", "RATE_FRAME",
    "ANGVEL_FRAME",        "INTERPOLATION", "INTERPOLATION_METHOD",
    "INTERPOLATION_DEGREE"};

glm::dquat about(int axis, double angle_deg) {
  Vec3 unit(0.0);
  unit[axis] = 1.0;
  return glm::angleAxis(base::radians(angle_deg), unit);
}

glm::dquat spin_rotation(const glm::dvec4& spin) {
  return about(2, 90.0 + spin[0]) * about(0, 90.0 - spin[1]) * about(2, spin[2]);
}

bool is_body(const std::string& name) {
  const std::string lower = lower_case(name);
  return lower.starts_with("sc_body") || lower.starts_with("spacecraft_body");
}

double rotation_between_deg(const AttitudeSegment& segment, std::size_t a, std::size_t b) {
  const double cosine = std::abs(glm::dot(segment.rotations[a], segment.rotations[b]));
  return 2.0 * base::degrees(std::acos(std::min(cosine, 1.0)));
}

enum class Kind { Quaternion, Euler, Spin };

// Meaning of the rows by the metadata.
struct Rows {
  Kind kind = Kind::Quaternion;
  std::size_t numbers = 4;  // number of values read per row
  ScalarPlace scalar = ScalarPlace::Last;
  int axis[3] = {0, 0, 0};
  bool body_is_a = false;  // the rows rotate from the body to the frame
};

class AemReader {
 public:
  AemReader(const CcsdsMessage& message, EarthClock clock, std::optional<ScalarPlace> scalar)
      : message_(message), scalar_(scalar) {
    made_.file = message.file;
    made_.clock = clock;
  }

  AttitudeHistory read(std::vector<std::string>& warnings) {
    while (next_ < message_.lines.size()) {
      const CcsdsLine& line = message_.lines[next_++];
      if (line.key == "META_START") {
        read_segment(line);
      } else if (line.key.empty()) {
        throw Error(Blame::Input, line.where, "a row of data before META_START");
      }
    }
    if (made_.segments.empty()) {
      throw Error(Blame::Input, made_.file, "has no META_START: no attitudes",
                  "an AEM has one segment or more");
    }
    if (!unknown_.empty()) {
      warnings.push_back(fmt::format("{}: keywords that an AEM does not have are not read: {}",
                                     made_.file, listed(unknown_)));
    }
    name_jumps(warnings);
    return std::move(made_);
  }

 private:
  void read_segment(const CcsdsLine& begin) {
    const CcsdsMeta meta = read_meta_of(message_, next_, aem_keys, unknown_);
    AttitudeSegment segment;
    segment.line = begin.where.line;
    Rows rows = read_frames(meta, segment);
    read_type(meta, rows);
    read_rows(meta, rows, segment);
    check_span(meta, segment);
    if (!made_.segments.empty() &&
        segment.first_useful - made_.segments.back().last_useful < -1e-6) {
      throw Error(Blame::Input, begin.where,
                  "the segment that begins here starts before the last "
                  "one ends",
                  "segments follow each other; they may share a moment");
    }
    made_.segments.push_back(std::move(segment));
  }

  Rows read_frames(const CcsdsMeta& meta, AttitudeSegment& segment) {
    const CcsdsLine &a = meta.required("REF_FRAME_A"), &b = meta.required("REF_FRAME_B");
    if (is_body(a.value) == is_body(b.value)) {
      throw Error(
          Blame::Input, b.where,
          fmt::format("the attitude is between {} and {}", in_quotes(a.value), in_quotes(b.value)),
          "one of the two is SC_BODY or SC_BODY_1, the other one of " + frame_names());
    }
    const bool body_is_a = is_body(a.value);
    segment.frame = CcsdsMeta::frame(body_is_a ? b : a);
    made_.frame_name = body_is_a ? b.value : a.value;
    made_.body_name = body_is_a ? a.value : b.value;
    Rows rows;
    bool backward = false;
    if (const CcsdsLine* sense = meta.find("ATTITUDE_DIR")) {
      if (sense->value != "A2B" && sense->value != "B2A") {
        throw Error(Blame::Input, sense->where,
                    fmt::format("ATTITUDE_DIR is {}", in_quotes(sense->value)),
                    "allowed are A2B and B2A");
      }
      backward = sense->value == "B2A";
    } else if (message_.version == "1.0" || message_.mjd) {
      (void)meta.required("ATTITUDE_DIR");
    }
    rows.body_is_a = body_is_a != backward;
    return rows;
  }

  void read_type(const CcsdsMeta& meta, Rows& rows) const {
    const CcsdsLine& type = meta.required("ATTITUDE_TYPE");
    std::string name = type.value;
    std::replace(name.begin(), name.end(), ' ', '_');
    if (name.starts_with("QUATERNION")) {
      read_scalar(meta, rows);
    } else if (name.starts_with("EULER_ANGLE")) {
      rows.kind = Kind::Euler;
      rows.numbers = 3;
      read_sequence(meta.required("EULER_ROT_SEQ"), rows);
    } else if (name == "SPIN") {
      rows.kind = Kind::Spin;
    } else {
      throw Error(Blame::Input, type.where, fmt::format("ATTITUDE_TYPE is {}", in_quotes(name)),
                  types);
    }
  }

  static void read_sequence(const CcsdsLine& line, Rows& rows) {
    bool good = line.value.size() == 3;
    for (std::size_t k = 0; good && k < 3; ++k) {
      const auto axis = std::string_view("123XYZxyz").find(line.value[k]);
      good = axis != std::string_view::npos;
      if (good) rows.axis[k] = static_cast<int>(axis % 3);
      if (k > 0) good = good && rows.axis[k] != rows.axis[k - 1];
    }
    if (good) return;
    throw Error(Blame::Input, line.where, fmt::format("EULER_ROT_SEQ is {}", in_quotes(line.value)),
                "allowed are three axes such as 321 or ZYX, no two neighbours alike");
  }

  void read_scalar(const CcsdsMeta& meta, Rows& rows) const {
    std::optional<ScalarPlace> own;
    const CcsdsLine* type = meta.find("QUATERNION_TYPE");
    if (type != nullptr) {
      if (type->value != "FIRST" && type->value != "LAST") {
        throw Error(Blame::Input, type->where,
                    fmt::format("QUATERNION_TYPE is {}", in_quotes(type->value)),
                    "allowed are FIRST and LAST");
      }
      own = type->value == "FIRST" ? ScalarPlace::First : ScalarPlace::Last;
    } else if (message_.version == "2.0" && !message_.mjd) {
      own = ScalarPlace::Last;  // 504.0-B-2, table 4-4
    }
    if (own && scalar_ && *own != *scalar_) {
      const bool first = *own == ScalarPlace::First;
      throw Error(Blame::Input, type != nullptr ? type->where : meta.where(),
                  fmt::format("the file has the scalar {}, and [orbit] of the scene says the "
                              "other",
                              first ? "first" : "last"),
                  {}, "Remove the key quaternion from [orbit]");
    }
    if (own) {
      rows.scalar = *own;
    } else if (scalar_) {
      rows.scalar = *scalar_;
    } else {
      refuse_to_guess(meta);
    }
  }

  // Shows the body's axes by both readings of the first row.
  [[noreturn]] void refuse_to_guess(const CcsdsMeta& meta) const {
    std::string both;
    for (std::size_t k = next_; k < message_.lines.size() && both.empty(); ++k) {
      if (!message_.lines[k].key.empty()) continue;
      Rows rows;
      const CcsdsRow row = row_of(message_.lines[k], meta.time_system(), rows);
      for (const auto place : {ScalarPlace::First, ScalarPlace::Last}) {
        rows.scalar = place;
        const Vec3 z = rotation_of(row.numbers, rows, message_.lines[k]) * Vec3(0.0, 0.0, 1.0);
        both += fmt::format("{}scalar {}: z at ({:.3f}, {:.3f}, {:.3f})", both.empty() ? "" : "; ",
                            place == ScalarPlace::First ? "first" : "last", z.x, z.y, z.z);
      }
    }
    throw Error(Blame::Input, meta.where(),
                "the metadata that begin here do not say where quaternions have their scalar",
                "the first row turns the axis z, with its " + both, say_scalar);
  }

  [[nodiscard]] CcsdsRow row_of(const CcsdsLine& line, TimeSystem system, const Rows& rows) const {
    static constexpr const char* wanted[] = {
        "four parts of a quaternion", "three angles in degrees",
        "right ascension, declination, spin angle in degrees and its rate in deg/s"};
    // With derivatives: of a quaternion four rates or three, of angles and of a spin three.
    static constexpr std::size_t of_quaternion[] = {4, 7, 8}, of_angles[] = {3, 6},
                                 of_spin[] = {4, 7};
    const std::span<const std::size_t> allowed[] = {of_quaternion, of_angles, of_spin};
    const auto kind = static_cast<std::size_t>(rows.kind);
    return read_row(line, message_.mjd, system, made_.clock, allowed[kind], wanted[kind]);
  }

  [[nodiscard]] static glm::dquat rotation_of(const std::vector<double>& n, const Rows& rows,
                                              const CcsdsLine& line) {
    if (rows.kind == Kind::Euler) {
      return about(rows.axis[0], n[0]) * about(rows.axis[1], n[1]) * about(rows.axis[2], n[2]);
    }
    if (rows.kind == Kind::Spin) return spin_rotation({n[0], n[1], n[2], n[3]});
    const glm::dquat q = rows.scalar == ScalarPlace::First ? glm::dquat(n[0], n[1], n[2], n[3])
                                                           : glm::dquat(n[3], n[0], n[1], n[2]);
    const double length = glm::length(q);
    if (!(std::abs(length - 1.0) <= length_slack)) {
      throw Error(Blame::Input, line.where, fmt::format("the quaternion has length {:.6g}", length),
                  "a turn has length 1, within 1 %");
    }
    return q / length;
  }

  void read_rows(const CcsdsMeta& meta, const Rows& rows, AttitudeSegment& segment) {
    const TimeSystem system = meta.time_system();
    segment.body_is_a = rows.body_is_a;
    const CcsdsLine* open = nullptr;
    for (; next_ < message_.lines.size(); ++next_) {
      const CcsdsLine& line = message_.lines[next_];
      if (line.key == "META_START") break;
      if (line.key == "DATA_START" || line.key == "DATA_STOP") {
        open = line.key == "DATA_START" ? &line : nullptr;
        continue;
      }
      if (!line.key.empty()) {
        throw Error(Blame::Input, line.where, fmt::format("{} among the rows", line.key),
                    "rows, DATA_STOP or META_START stand here");
      }
      const CcsdsRow row = row_of(line, system, rows);
      if (!segment.at.empty() && !(row.at > segment.at.back())) {
        throw Error(Blame::Input, line.where,
                    fmt::format("the row of {} stands after that of {}", utc_text(row.at),
                                utc_text(segment.at.back())),
                    "time rises from row to row");
      }
      const auto& n = row.numbers;
      const glm::dquat rotation = rotation_of(n, rows, line);
      segment.at.push_back(row.at);
      segment.lines.push_back(line.where.line);
      segment.rotations.push_back(rows.body_is_a ? glm::conjugate(rotation) : rotation);
      if (rows.kind == Kind::Spin) segment.spin.emplace_back(n[0], n[1], n[2], n[3]);
    }
    if (open != nullptr) fail_cut_off(*open, "DATA_STOP");
    if (segment.at.empty()) {
      throw Error(Blame::Input, meta.where(), "the segment that begins here has no rows");
    }
  }

  void check_span(const CcsdsMeta& meta, AttitudeSegment& segment) const {
    const auto read = [&](const char* key) -> std::optional<Instant> {
      const CcsdsLine* line = meta.find(key);
      if (line == nullptr) return std::nullopt;
      return meta.instant(*line, made_.clock);
    };
    const auto stop = read("STOP_TIME");
    if (stop && *stop - segment.at.back() > end_slack_s) {
      throw Error(Blame::Input, meta.required("STOP_TIME").where,
                  fmt::format("STOP_TIME is {} and the last row that of {}", utc_text(*stop),
                              utc_text(segment.at.back())),
                  "the rows reach to STOP_TIME; the file may be cut off");
    }
    segment.first_useful =
        std::max(read("USEABLE_START_TIME").value_or(segment.at.front()), segment.at.front());
    segment.last_useful =
        std::min(read("USEABLE_STOP_TIME").value_or(segment.at.back()), segment.at.back());
  }

  void name_jumps(std::vector<std::string>& warnings) const {
    for (const AttitudeSegment& segment : made_.segments) {
      if (!segment.spin.empty()) continue;
      const auto rotation_deg = [&](std::size_t k) {
        return rotation_between_deg(segment, k, k + 1);
      };
      for (std::size_t k = 0; k + 1 < segment.rotations.size(); ++k) {
        const double rotation = rotation_deg(k);
        const double before = k > 0 ? rotation_deg(k - 1) : 0.0;
        const double after = k + 2 < segment.rotations.size() ? rotation_deg(k + 1) : 0.0;
        const bool single = k + 2 < segment.rotations.size() && rotation >= jump_ratio * before &&
                            rotation >= single_ratio * rotation_between_deg(segment, k, k + 2);
        if (rotation < jump_deg || !(single || rotation >= jump_ratio * std::max(before, after)))
          continue;
        warnings.push_back(fmt::format(
            "{}: the attitude jumps by {:.4g} deg from {} to {}; is the scalar of each quaternion "
            "where the file says?",
            made_.file, rotation, utc_text(segment.at[k]), utc_text(segment.at[k + 1])));
        return;
      }
    }
  }

  const CcsdsMessage& message_;
  std::optional<ScalarPlace> scalar_;
  AttitudeHistory made_;
  std::size_t next_ = 0;
  std::vector<std::string> unknown_;
};

// Whether the body, or the axis of its spin, has one attitude from row to row.
bool is_held(const AttitudeSegment& segment, std::size_t before) {
  if (segment.spin.empty()) return rotation_between_deg(segment, before, before + 1) < same_deg;
  const glm::dvec4 &from = segment.spin[before], &to = segment.spin[before + 1];
  return std::abs(std::remainder(to[0] - from[0], 360.0)) < same_deg &&
         std::abs(to[1] - from[1]) < same_deg;
}

glm::dquat between(const AttitudeSegment& segment, std::size_t before, Instant t) {
  const double span_s = segment.at[before + 1] - segment.at[before];
  const double share = (t - segment.at[before]) / span_s;
  if (segment.spin.empty()) {
    return glm::normalize(
        glm::slerp(segment.rotations[before], segment.rotations[before + 1], share));
  }
  // The rate determines the full revolutions between rows.
  const glm::dvec4 &from = segment.spin[before], &to = segment.spin[before + 1];
  const double expected = 0.5 * (from[3] + to[3]) * span_s;
  const double gone = expected + std::remainder(to[2] - from[2] - expected, 360.0);
  const double ascension = std::remainder(to[0] - from[0], 360.0);
  const glm::dquat rotation =
      spin_rotation({from[0] + share * ascension, from[1] + share * (to[1] - from[1]),
                     from[2] + share * gone, from[3]});
  return segment.body_is_a ? glm::conjugate(rotation) : rotation;
}

}  // namespace

glm::dquat AttitudeHistory::at(Instant t, double longest_gap_s) const {
  const auto found =
      std::find_if(segments.rbegin(), segments.rend(), [&](const AttitudeSegment& segment) {
        return t - segment.first_useful > -1e-6 && t - segment.last_useful < 1e-6;
      });
  if (found == segments.rend()) {
    std::vector<std::string> spans;
    for (const AttitudeSegment& segment : segments) {
      spans.push_back(utc_text(segment.first_useful) + " to " + utc_text(segment.last_useful));
    }
    throw Error(Blame::Input, file, fmt::format("has no attitude at {}", utc_text(t)),
                "its rows reach from " + listed(spans));
  }
  const auto upper = std::upper_bound(found->at.begin(), found->at.end(), t);
  const auto after = static_cast<std::size_t>(upper - found->at.begin());
  glm::dquat rotation = found->rotations.front();
  if (found->at.size() > 1) {
    const std::size_t before = std::min(after > 0 ? after - 1 : 0, found->at.size() - 2);
    if (t > found->at[before] && t < found->at[before + 1] &&
        found->at[before + 1] - found->at[before] > longest_gap_s && !is_held(*found, before)) {
      fail_gap({file, found->lines[before + 1], 0}, found->at[before], found->at[before + 1],
               "Give rows more often, begin a new segment, or give both rows the same attitude");
    }
    rotation = between(*found, before, t);
  }
  return glm::normalize(glm::quat_cast(to_gcrs(found->frame, t, clock)) * rotation);
}

AttitudeHistory read_attitude_history(const std::filesystem::path& path, EarthClock clock,
                                      std::optional<ScalarPlace> scalar,
                                      const base::Location& asked_at,
                                      std::vector<std::string>& warnings) {
  const CcsdsMessage message = read_ccsds(path, "AEM", asked_at);
  return AemReader(message, clock, scalar).read(warnings);
}

}  // namespace earthshine::scenes
