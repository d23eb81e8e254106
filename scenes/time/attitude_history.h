// SPDX-License-Identifier: Apache-2.0
// Which way a spacecraft points: an Attitude Ephemeris Message (CCSDS 504.0-B, versions 1 and 2,
// KVN), or CIC's form of it.
//
// A quaternion (q, scalar qc) takes the axes of the frame that it leads from to those of the frame
// that it leads to: a vector of components v_A along A's axes and v_B along B's has
// v_A = q v_B q* for one from A to B, which is the standard's matrix v_B = M(q) v_A. Euler angles
// turn about the axis that the sequence names first, then about the new second one, then about the
// new third one: q = q1 q2 q3, angles in the order of the sequence. Spin is the sequence
// Z (90 deg + right ascension), X (90 deg - declination), Z (spin angle): the body's z is the axis.
#pragma once

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/time/astronomy.h"

namespace earthshine::scenes {

enum class ScalarPlace { First, Last };

struct AttitudeSegment {
  Frame frame = Frame::Gcrf;
  Instant first_useful, last_useful;
  std::vector<Instant> at;        // rising
  std::vector<glm::dquat> turns;  // v_frame = q v_body q*
  // Of spin, deg and deg/s: right ascension, declination, spin angle, rate. Else empty.
  std::vector<glm::dvec4> spin;
  bool body_is_a = false;  // } of spin: which way its angles lead
  int line = 0;
};

struct AttitudeHistory {
  std::string file, frame_name, body_name;
  EarthClock clock;
  std::vector<AttitudeSegment> segments;

  // v_GCRS = q v_body q*. Between rows the turn is even, the shorter way (slerp, Shoemake 1985);
  // spin goes on at its rate. Throws base::Error (Input) outside the segments.
  [[nodiscard]] glm::dquat at(Instant t) const;
};

// scalar: where a quaternion of the file has its scalar, if the scene says so. An AEM of version 1
// says it by QUATERNION_TYPE, one of version 2 has it last by the standard. Throws base::Error
// (Input) at file and line: for quaternions without either, with both readings of the first row;
// for a place that differs from the file's own; for frames of which not exactly one is the
// spacecraft's body; for times that do not rise, lengths more than 1 % from 1, and rows that end
// before STOP_TIME. warnings: gets a line for the first jump, a turn from row to row that is more
// than 10 deg and ten times the turns before and after.
[[nodiscard]] AttitudeHistory read_attitude_history(const std::filesystem::path& path,
                                                    EarthClock clock,
                                                    std::optional<ScalarPlace> scalar,
                                                    const base::Location& asked_at,
                                                    std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
