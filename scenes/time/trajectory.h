// SPDX-License-Identifier: Apache-2.0
// Where a spacecraft is: an Orbit Ephemeris Message (CCSDS 502.0-B, versions 1 to 3).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/time/astronomy.h"

namespace earthshine::scenes {

// Linear and Lagrange take position and velocity each by itself, Hermite the position from both and
// the velocity as its derivative.
enum class Interpolation { Linear, Lagrange, Hermite };

struct TrajectorySegment {
  Instant first_useful, last_useful;  // asked for within these alone
  Interpolation interpolation = Interpolation::Hermite;
  int degree = 7;
  std::optional<Instant> frame_epoch;  // of TEME and TOD: of this date; none: of each state's
  std::vector<Instant> at;             // rising
  std::vector<State> states;           // in the file's frame
  int line = 0;                        // of its metadata
};

struct Trajectory {
  std::string file, object;
  std::string frame_name, time_system;  // as the file has them
  Frame frame = Frame::Gcrf;
  EarthClock clock;
  std::vector<TrajectorySegment> segments;  // rising in time

  // In GCRS. Of two segments that share a moment the later one. Throws base::Error (Input) with the
  // spans of the segments outside all of them, and in a gap: between two states in whose time the
  // spacecraft goes more than 36 deg around the Earth, where a cubic of two states is 3 km off in a
  // low orbit (R theta^4 / 384).
  [[nodiscard]] State at(Instant t) const;
  [[nodiscard]] Instant first() const { return segments.front().first_useful; }
  [[nodiscard]] Instant last() const { return segments.back().last_useful; }
};

// asked_at is the place that names the file. Throws base::Error (Input) at file and line for
// what is no OEM about the Earth, unknown frames and time systems, frames that differ between
// segments, times that do not rise, positions below the ground or beyond 10^6 km, segments with
// fewer states than their interpolation needs, and states that end before STOP_TIME.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& path, EarthClock clock,
                                         const base::Location& asked_at,
                                         std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
