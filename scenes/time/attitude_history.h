// SPDX-License-Identifier: Apache-2.0
// Attitude history of a spacecraft: an Attitude Ephemeris Message (CCSDS 504.0-B, versions 1 and 2,
// KVN), or CIC's form of it.
//
// A quaternion (q, scalar qc) from frame A to frame B rotates the axes of A to the axes of B. A
// vector with components v_A along A's axes and v_B along B's satisfies v_A = q v_B q*, which is
// the standard's matrix v_B = M(q) v_A. Euler angles are rotations about the axis that the sequence
// names first, then about the new second one, then about the new third one: q = q1 q2 q3, with the
// angles in the order of the sequence. Spin is the sequence Z (90 deg + right ascension), X (90 deg
// - declination), Z (spin angle): the spin axis is the body's z.
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
  std::vector<Instant> at;            // ascending
  std::vector<glm::dquat> rotations;  // v_frame = q v_body q*
  std::vector<int> lines;             // of the rows
  // For spin, deg and deg/s: right ascension, declination, spin angle, rate. Else empty.
  std::vector<glm::dvec4> spin;
  bool body_is_a = false;  // } for spin: direction of its angles
  int line = 0;
};

struct AttitudeHistory {
  std::string file, frame_name, body_name;
  EarthClock clock;
  std::vector<AttitudeSegment> segments;

  // v_GCRS = q v_body q*. Between rows the rotation is uniform, by the shorter way (slerp, Shoemake
  // 1985); spin continues at its rate. Throws base::Error (Input) outside the segments, and between
  // rows of different attitude that are farther apart than `longest_gap_s`
  // (Trajectory::longest_gap_s).
  [[nodiscard]] glm::dquat at(Instant t, double longest_gap_s) const;
};

// scalar: position of a quaternion's scalar, if the scene specifies it. AEM version 1 specifies it
// by QUATERNION_TYPE; in version 2 it is last by the standard. Throws base::Error (Input) at file
// and line for quaternions without either, with both readings of the first row; for a position that
// differs from the file's own; unless exactly one frame is the spacecraft's body; for times that do
// not rise, lengths more than 1 % from 1, and rows that end before STOP_TIME. warnings: gets a line
// for the first jump, a rotation between rows that exceeds 10 deg and ten times the rotations
// before and after, and for a single row off by that much.
[[nodiscard]] AttitudeHistory read_attitude_history(const std::filesystem::path& path,
                                                    EarthClock clock,
                                                    std::optional<ScalarPlace> scalar,
                                                    const base::Location& asked_at,
                                                    std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
