// SPDX-License-Identifier: Apache-2.0
// Trajectory of a spacecraft: an Orbit Ephemeris Message (CCSDS 502.0-B, versions 1 to 3).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/time/astronomy.h"

namespace earthshine::scenes {

// Linear and Lagrange interpolate position and velocity separately. Hermite interpolates the
// position from both; the velocity is its derivative.
enum class Interpolation { Linear, Lagrange, Hermite };

struct TrajectorySegment {
  Instant first_useful, last_useful;  // valid interval
  Interpolation interpolation = Interpolation::Hermite;
  int degree = 7;
  std::optional<Instant> frame_epoch;  // epoch of TEME and TOD; none: each state's time
  std::vector<Instant> at;             // ascending
  std::vector<State> states;           // in the file's frame
  std::vector<int> lines;              // of the states
  int line = 0;                        // of the metadata
};

struct Trajectory {
  std::string file, object;
  std::string frame_name, time_system;  // as in the file
  Frame frame = Frame::Gcrf;
  EarthClock clock;
  std::vector<TrajectorySegment> segments;  // in order of time

  // State in GCRS. At a common time of two segments the later segment is used. Throws base::Error
  // (Input) with the segments' intervals outside all of them. Also throws in gaps, where the
  // spacecraft moves more than 36 deg around the Earth between two states: there a cubic of two
  // states has an error of 3 km in low orbit (R theta^4 / 384).
  [[nodiscard]] State at(Instant t) const;
  // t, or in a gap the gap's end: the next state, or the next segment's start. t: up to last().
  [[nodiscard]] Instant next_state(Instant t) const;
  // Time in which the spacecraft moves 36 deg around the Earth from its state at t.
  [[nodiscard]] double longest_gap_s(Instant t) const;
  [[nodiscard]] Instant first() const { return segments.front().first_useful; }
  [[nodiscard]] Instant last() const { return segments.back().last_useful; }
};

// asked_at: the place that names the file. Throws base::Error (Input) at file and line if it is not
// an OEM about the Earth, for unknown frames and time systems, frames that differ between segments,
// times that do not rise, positions below the ground or beyond 10^6 km, segments with fewer states
// than their interpolation needs, and states that end before STOP_TIME.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& path, EarthClock clock,
                                         const base::Location& asked_at,
                                         std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
