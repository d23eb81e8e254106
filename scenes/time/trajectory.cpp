// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"
#include "scenes/time/ccsds_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr double span_slack_s = 1.0;  // tolerance of STOP_TIME against the last state
constexpr double farthest_m = 1e9;
constexpr double lowest_unit2 = 0.9996;  // 1 km below the ground: frames differ in their pole
constexpr double least_turning = 1e-6;   // sine of the angle between position and velocity
constexpr int most_degree = 31;

// Newton's interpolating polynomial by divided differences; a double node has value and slope.
class Newton {
 public:
  // Nodes in s relative to the middle of the interval, which keeps their powers small.
  void add(double node, const Vec3& value) { push(node, value, {}, false); }
  void add(double node, const Vec3& value, const Vec3& slope) {
    push(node, value, {}, false);
    push(node, value, slope, true);
  }

  void finish() {
    const std::size_t n = nodes_.size();
    std::vector<Vec3> column = values_;
    differences_ = {column[0]};
    for (std::size_t order = 1; order < n; ++order) {
      for (std::size_t k = 0; k + order < n; ++k) {
        const double span = nodes_[k + order] - nodes_[k];
        column[k] =
            order == 1 && twice_[k + 1] ? slopes_[k + 1] : (column[k + 1] - column[k]) / span;
      }
      differences_.push_back(column[0]);
    }
  }

  // Value and derivative.
  [[nodiscard]] State at(double t) const {
    Vec3 value = differences_.back(), slope(0.0);
    for (std::size_t k = differences_.size() - 1; k-- > 0;) {
      slope = slope * (t - nodes_[k]) + value;
      value = value * (t - nodes_[k]) + differences_[k];
    }
    return {value, slope};
  }

 private:
  void push(double node, const Vec3& value, const Vec3& slope, bool twice) {
    nodes_.push_back(node);
    values_.push_back(value);
    slopes_.push_back(slope);
    twice_.push_back(twice);
  }

  std::vector<double> nodes_;
  std::vector<Vec3> values_, slopes_, differences_;
  std::vector<bool> twice_;
};

std::size_t states_needed(Interpolation how, int degree) {
  const auto d = static_cast<std::size_t>(degree);
  return how == Interpolation::Hermite ? (d + 1) / 2 : d + 1;
}

State interpolate(const TrajectorySegment& segment, std::size_t before, Instant t) {
  const std::size_t total = segment.at.size();
  const std::size_t count = std::min(total, states_needed(segment.interpolation, segment.degree));
  const std::size_t left = (count - 1) / 2;
  const std::size_t first = std::min(before > left ? before - left : 0, total - count);
  const Instant middle = segment.at[before];
  Newton position, velocity;
  for (std::size_t k = first; k < first + count; ++k) {
    const double node = segment.at[k] - middle;
    const State& state = segment.states[k];
    if (segment.interpolation == Interpolation::Hermite) {
      position.add(node, state.position_m, state.velocity_m_s);
    } else {
      position.add(node, state.position_m);
      velocity.add(node, state.velocity_m_s);
    }
  }
  position.finish();
  const State found = position.at(t - middle);
  if (segment.interpolation == Interpolation::Hermite) return found;
  velocity.finish();
  return {found.position_m, velocity.at(t - middle).position_m};
}

bool holds(const TrajectorySegment& segment, Instant t) {
  // Dates have a resolution of a tenth of a microsecond.
  return t - segment.first_useful > -1e-6 && t - segment.last_useful < 1e-6;
}

// The last state at or before t that another one follows.
std::size_t state_before(const TrajectorySegment& segment, Instant t) {
  const auto upper = std::upper_bound(segment.at.begin(), segment.at.end(), t);
  const auto after = static_cast<std::size_t>(upper - segment.at.begin());
  return std::min(after > 0 ? after - 1 : 0, segment.at.size() > 1 ? segment.at.size() - 2 : 0);
}

const std::vector<std::string_view> oem_keys = {
    "OBJECT_NAME",       "OBJECT_ID",   "CENTER_NAME",   "REF_FRAME",
    "REF_FRAME_EPOCH",   "TIME_SYSTEM", "START_TIME",    "USEABLE_START_TIME",
    "USEABLE_STOP_TIME", "STOP_TIME",   "INTERPOLATION", "INTERPOLATION_DEGREE"};

class OemReader {
 public:
  OemReader(const CcsdsMessage& message, EarthClock clock) : message_(message) {
    made_.file = message.file;
    made_.clock = clock;
  }

  Trajectory read(std::vector<std::string>& warnings) {
    while (next_ < message_.lines.size()) {
      const CcsdsLine& line = message_.lines[next_++];
      if (line.key == "META_START") {
        read_segment(line);
      } else if (line.key == "COVARIANCE_START") {
        skip_covariance(line);
      } else if (line.key.empty()) {
        throw Error(Blame::Input, line.where, "a row of data before META_START");
      }
    }
    if (made_.segments.empty()) {
      throw Error(Blame::Input, made_.file, "has no META_START: no states",
                  "an OEM has one segment or more");
    }
    for (std::size_t k = 1; k < made_.segments.size(); ++k) check_order(k);
    if (!unknown_.empty()) {
      warnings.push_back(fmt::format("{}: keywords that an OEM does not have are not read: {}",
                                     made_.file, listed(unknown_)));
    }
    return std::move(made_);
  }

 private:
  void read_segment(const CcsdsLine& begin) {
    const CcsdsMeta meta = read_meta_of(message_, next_, oem_keys, unknown_);
    TrajectorySegment segment;
    segment.line = begin.where.line;
    read_meta(meta, segment);
    read_states(meta, segment);
    check_span(meta, segment);
    made_.segments.push_back(std::move(segment));
  }

  void read_meta(const CcsdsMeta& meta, TrajectorySegment& segment) {
    const CcsdsLine& center = meta.required("CENTER_NAME");
    if (lower_case(center.value) != "earth") {
      throw Error(Blame::Input, center.where,
                  fmt::format("CENTER_NAME is {}", in_quotes(center.value)),
                  "allowed is EARTH: the sky about a spacecraft is Sun and Earth");
    }
    const CcsdsLine& frame = meta.required("REF_FRAME");
    const Frame read = CcsdsMeta::frame(frame);
    const CcsdsLine& object = meta.required("OBJECT_NAME");
    if (made_.segments.empty()) {
      made_.frame = read;
      made_.frame_name = frame.value;
      made_.object = object.value;
      made_.time_system = meta.required("TIME_SYSTEM").value;
    }
    if (read != made_.frame) {
      throw Error(Blame::Input, frame.where,
                  fmt::format("REF_FRAME is {} after {}", frame.value, made_.frame_name),
                  "all segments of a file have one frame", "Write a file for each frame");
    }
    if (object.value != made_.object) {
      throw Error(Blame::Input, object.where,
                  fmt::format("OBJECT_NAME is {} after {}", in_quotes(object.value),
                              in_quotes(made_.object)),
                  "all segments of a file are of one object", "Write a file for each object");
    }
    const CcsdsLine* epoch = meta.find("REF_FRAME_EPOCH");
    if (epoch != nullptr && (read == Frame::Teme || read == Frame::Tod)) {
      segment.frame_epoch = meta.instant(*epoch, made_.clock);
    }
    if (const CcsdsLine* how = meta.find("INTERPOLATION")) read_interpolation(meta, *how, segment);
  }

  static void read_interpolation(const CcsdsMeta& meta, const CcsdsLine& how,
                                 TrajectorySegment& segment) {
    const std::string name = lower_case(how.value);
    if (name == "linear") {
      segment.interpolation = Interpolation::Linear;
      segment.degree = 1;
      return;
    }
    if (name != "lagrange" && name != "hermite") {
      throw Error(Blame::Input, how.where, fmt::format("INTERPOLATION is {}", in_quotes(how.value)),
                  "allowed are LINEAR, LAGRANGE and HERMITE");
    }
    const bool hermite = name == "hermite";
    segment.interpolation = hermite ? Interpolation::Hermite : Interpolation::Lagrange;
    const CcsdsLine& degree = meta.required("INTERPOLATION_DEGREE");
    std::int64_t value = 0;
    if (!parse_whole(degree.value, value) || value < 1 || value > most_degree) {
      throw Error(Blame::Input, degree.where,
                  fmt::format("INTERPOLATION_DEGREE is {}", in_quotes(degree.value)),
                  fmt::format("allowed is a whole number from 1 to {}", most_degree));
    }
    // A Hermite polynomial has an odd degree: value and slope at each state.
    segment.degree = static_cast<int>(hermite ? value | 1 : value);
  }

  void read_states(const CcsdsMeta& meta, TrajectorySegment& segment) {
    const TimeSystem system = meta.time_system();
    for (; next_ < message_.lines.size(); ++next_) {
      const CcsdsLine& line = message_.lines[next_];
      if (line.key == "COVARIANCE_START") {
        ++next_;
        skip_covariance(line);
        --next_;
        continue;
      }
      if (line.key == "META_START") break;
      if (!line.key.empty()) {
        throw Error(Blame::Input, line.where, fmt::format("{} among the states", line.key),
                    "rows, COVARIANCE_START or META_START stand here");
      }
      read_state(line, system, segment);
    }
    if (segment.at.empty()) {
      throw Error(Blame::Input, meta.where(), "the segment that begins here has no states");
    }
    if (meta.find("INTERPOLATION") != nullptr &&
        segment.at.size() < states_needed(segment.interpolation, segment.degree)) {
      throw Error(Blame::Input, meta.where(),
                  fmt::format("the segment that begins here has {} states", segment.at.size()),
                  fmt::format("its interpolation of degree {} needs {}", segment.degree,
                              states_needed(segment.interpolation, segment.degree)));
    }
  }

  void read_state(const CcsdsLine& line, TimeSystem system, TrajectorySegment& segment) {
    static constexpr std::size_t allowed[] = {6, 9};
    const CcsdsRow row =
        read_row(line, message_.mjd, system, made_.clock, allowed,
                 "X Y Z in km and X_DOT Y_DOT Z_DOT in km/s, with or without accelerations");
    if (!segment.at.empty() && !(row.at > segment.at.back())) {
      throw Error(Blame::Input, line.where,
                  fmt::format("the state of {} stands after that of {}", utc_text(row.at),
                              utc_text(segment.at.back())),
                  "time rises from row to row");
    }
    const auto& n = row.numbers;
    const State state{1e3 * Vec3(n[0], n[1], n[2]), 1e3 * Vec3(n[3], n[4], n[5])};
    const double distance_m = glm::length(state.position_m);
    // z is the pole to a fraction of a degree in all frames.
    const Vec3 unit = state.position_m / earth_equator_m / Vec3(1.0, 1.0, 1.0 - earth_flattening);
    if (!(glm::dot(unit, unit) > lowest_unit2 && distance_m < farthest_m)) {
      throw Error(Blame::Input, line.where,
                  fmt::format("a state {:.6g} km from the Earth's centre", distance_m / 1e3),
                  "allowed is from the ground to 1000000 km: an OEM is in km and km/s");
    }
    const double turning = glm::length(glm::cross(state.position_m, state.velocity_m_s));
    if (!(turning > least_turning * distance_m * glm::length(state.velocity_m_s))) {
      throw Error(Blame::Input, line.where, "the velocity has no part across the position",
                  "an orbit goes around the Earth");
    }
    segment.at.push_back(row.at);
    segment.lines.push_back(line.where.line);
    segment.states.push_back(state);
  }

  void check_span(const CcsdsMeta& meta, TrajectorySegment& segment) const {
    const auto read = [&](const char* key) -> std::optional<Instant> {
      const CcsdsLine* line = meta.find(key);
      if (line == nullptr) return std::nullopt;
      return meta.instant(*line, made_.clock);
    };
    const auto start = read("START_TIME"), stop = read("STOP_TIME");
    if (!message_.mjd) (void)meta.required("START_TIME"), (void)meta.required("STOP_TIME");
    if (stop && *stop - segment.at.back() > span_slack_s) {
      throw Error(Blame::Input, meta.required("STOP_TIME").where,
                  fmt::format("STOP_TIME is {} and the last state that of {}", utc_text(*stop),
                              utc_text(segment.at.back())),
                  "the states reach from START_TIME to STOP_TIME; the file may be cut off");
    }
    if (start && segment.at.front() - *start > span_slack_s) {
      throw Error(Blame::Input, meta.required("START_TIME").where,
                  fmt::format("START_TIME is {} and the first state that of {}", utc_text(*start),
                              utc_text(segment.at.front())),
                  "the states reach from START_TIME to STOP_TIME");
    }
    segment.first_useful = read("USEABLE_START_TIME").value_or(start.value_or(segment.at.front()));
    segment.last_useful = read("USEABLE_STOP_TIME").value_or(stop.value_or(segment.at.back()));
    segment.first_useful = std::max(segment.first_useful, segment.at.front());
    segment.last_useful = std::min(segment.last_useful, segment.at.back());
    if (segment.last_useful < segment.first_useful) {
      throw Error(Blame::Input, meta.where(), "the segment that begins here ends before it begins");
    }
  }

  void check_order(std::size_t k) const {
    const TrajectorySegment &before = made_.segments[k - 1], &after = made_.segments[k];
    if (after.first_useful - before.last_useful > -1e-6) return;
    throw Error(
        Blame::Input, base::Location{made_.file, after.line, 0},
        fmt::format("the segment that begins here starts at {}, before {}, where that of "
                    "line {} ends",
                    utc_text(after.first_useful), utc_text(before.last_useful), before.line),
        "segments follow each other; they may share a moment");
  }

  void skip_covariance(const CcsdsLine& begin) {
    while (next_ < message_.lines.size()) {
      if (message_.lines[next_++].key == "COVARIANCE_STOP") return;
    }
    fail_cut_off(begin, "COVARIANCE_STOP");
  }

  const CcsdsMessage& message_;
  Trajectory made_;
  std::size_t next_ = 0;
  std::vector<std::string> unknown_;
};

double gap_of(const State& state) {
  return largest_gap_rad * glm::dot(state.position_m, state.position_m) /
         glm::length(glm::cross(state.position_m, state.velocity_m_s));
}

// By the rate at either state, and by the angle between them, which on an ellipse the rates of two
// states beside the perigee do not show.
bool in_gap(const TrajectorySegment& segment, std::size_t before, Instant t) {
  if (segment.at.size() < 2 || t <= segment.at[before] || t >= segment.at[before + 1]) return false;
  const State &a = segment.states[before], &b = segment.states[before + 1];
  const double angle = std::atan2(glm::length(glm::cross(a.position_m, b.position_m)),
                                  glm::dot(a.position_m, b.position_m));
  return segment.at[before + 1] - segment.at[before] > std::min(gap_of(a), gap_of(b)) ||
         angle > largest_gap_rad;
}

}  // namespace

double Trajectory::longest_gap_s(Instant t) const { return gap_of(at(t)); }

Instant Trajectory::next_state(Instant t) const {
  const auto found = std::find_if(
      segments.rbegin(), segments.rend(),
      [&](const TrajectorySegment& segment) { return t - segment.first_useful > -1e-6; });
  if (found == segments.rend()) return first();
  if (!holds(*found, t)) return found == segments.rbegin() ? t : std::prev(found)->first_useful;
  const std::size_t before = state_before(*found, t);
  return in_gap(*found, before, t) ? found->at[before + 1] : t;
}

State Trajectory::at(Instant t) const {
  const auto found =
      std::find_if(segments.rbegin(), segments.rend(),
                   [&](const TrajectorySegment& segment) { return holds(segment, t); });
  if (found == segments.rend()) {
    std::vector<std::string> spans;
    for (const TrajectorySegment& segment : segments) {
      spans.push_back(utc_text(segment.first_useful) + " to " + utc_text(segment.last_useful));
    }
    throw Error(Blame::Input, file, fmt::format("has no state at {}", utc_text(t)),
                fmt::format("its {}: {}",
                            segments.size() == 1 ? "states reach from"
                                                 : "segments, between which nothing "
                                                   "is interpolated, reach from",
                            listed(spans)));
  }
  const std::size_t before = state_before(*found, t);
  if (in_gap(*found, before, t)) {
    fail_gap({file, found->lines[before + 1], 0}, found->at[before], found->at[before + 1],
             "Give states more often, or begin a new segment");
  }
  const State state =
      found->at.size() == 1 ? found->states[before] : interpolate(*found, before, t);
  return to_gcrs(state, frame, found->frame_epoch.value_or(t), clock);
}

Trajectory read_trajectory(const std::filesystem::path& path, EarthClock clock,
                           const base::Location& asked_at, std::vector<std::string>& warnings) {
  const CcsdsMessage message = read_ccsds(path, "OEM", asked_at);
  return OemReader(message, clock).read(warnings);
}

}  // namespace earthshine::scenes
