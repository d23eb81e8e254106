// SPDX-License-Identifier: Apache-2.0
// Moving parts: a tree of joints and tracks that objects, lamps and cameras hang on.
//
// A scene file has everything where it is while all angles are 0. A joint turns what hangs on it
// about an axis through its pivot, both as they are then; its parent moves the result. This is the
// product of exponentials (Brockett, "Robotic manipulators and the product of exponentials
// formula", 1984): T = T_parent turn(pivot, axis, angle). A track has its motion from a file.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/scene.h"
#include "scenes/time/attitude_history.h"
#include "scenes/time/trajectory.h"

namespace earthshine::scenes {

struct Mission;  // mission.h

// A rigid motion, p -> rotation p + offset_m.
struct Pose {
  glm::dmat3 rotation{1.0};
  Vec3 offset_m{0.0};

  [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation * p + offset_m; }
  [[nodiscard]] bool operator==(const Pose&) const = default;
};
// First b, then a.
[[nodiscard]] inline Pose operator*(const Pose& a, const Pose& b) {
  return {a.rotation * b.rotation, a.point(b.offset_m)};
}
[[nodiscard]] inline Pose inverse(const Pose& pose) {
  const glm::dmat3 back = glm::transpose(pose.rotation);
  return {back, -(back * pose.offset_m)};
}
// By the right-hand rule; axis: unit.
[[nodiscard]] Pose rotation_about(const Vec3& pivot_m, const Vec3& axis, double angle_deg);

// Rows of a file against time. Angles and positions between rows are linear, turns even (slerp,
// the shorter way).
template <class Value>
struct MotionTable {
  std::string file;
  std::vector<Instant> at;  // rising, one or more
  std::vector<Value> values;
  int first_line = 0, last_line = 0;
};
using AngleTable = MotionTable<double>;  // deg
struct TablePose {
  Vec3 offset_m{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
};
using PoseTable = MotionTable<TablePose>;

// Another spacecraft, by its own trajectory. Its objects are in axes of its own, their origin
// where its trajectory runs.
struct Visitor {
  Trajectory trajectory;
  std::optional<AttitudeHistory> attitude;  // none: its axes are the scene's
  glm::dmat3 body_axes{1.0};  // the columns are the attitude's body axes along its own
  Vec3 origin_m{0.0};         // where the scene's own trajectory runs, in the scene
};

// Turns `normal`, of the angle 0, as far toward the Sun as the axis and the limits allow: to the
// largest cosine.
struct SunFollower {
  Vec3 normal{0.0, 0.0, 1.0};                       // unit, not along the axis
  double lowest_deg = -180.0, highest_deg = 180.0;  // at most 360 deg apart

  // sun: unit, in the axes that the joint's parent moves. Along the axis all angles are equal: 0,
  // or the nearest within the limits.
  [[nodiscard]] double angle_deg(const Vec3& axis, const Vec3& sun) const;
};

struct Joint {
  std::string name;
  std::optional<std::size_t> parent;  // in Linkage::joints
  Vec3 pivot_m{0.0}, axis{0.0, 0.0, 1.0};
  // Joint: a fixed angle in deg, a table of angles over time, or following the Sun. Track: a table
  // of poses over time, or another spacecraft.
  std::variant<double, AngleTable, PoseTable, Visitor, SunFollower> motion = 0.0;

  [[nodiscard]] bool moves() const { return motion.index() > 0; }
};

struct JointState {
  std::optional<double> angle_deg;  // of a joint
  Pose pose;                        // of what hangs on it
};

struct Linkage {
  std::vector<Joint> joints;  // and tracks; none is its own ancestor

  [[nodiscard]] bool moves() const;
  // Of each joint at that moment of the mission; without a mission nothing moves but what follows
  // the Sun. sun: unit, in the scene; only for followers. Throws base::Error (Input) at the file
  // and its line for a moment outside a table.
  [[nodiscard]] std::vector<JointState> at(const Mission* mission, Instant t,
                                           const Vec3& sun) const;
};

// Index of the joint or track of that name, which the linkage has.
[[nodiscard]] std::size_t joint_index(const Linkage& linkage, std::string_view name);
// Of a scene with a linkage, at its own moment.
[[nodiscard]] std::vector<JointState> joints_now(const Scene& scene);
// For people: "elbow 30 deg, cargo at (1.5, 0, 20) m".
[[nodiscard]] std::string pose_text(const Scene& scene);

}  // namespace earthshine::scenes
