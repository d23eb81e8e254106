// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/linkage.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/time/mission.h"

namespace earthshine::scenes {
namespace {

// The row at or before t and the share of the way to the next one.
struct RowPlace {
  std::size_t row;
  double share;
};

constexpr double slack_s = 1e-3;  // dates are written to 1 ms

template <class Value>
RowPlace place_in(const MotionTable<Value>& table, Instant t) {
  if (t + slack_s < table.at.front() || table.at.back() + slack_s < t) {
    const bool late = table.at.back() < t;
    throw base::Error(
        base::Blame::Input, {table.file, late ? table.last_line : table.first_line, 0},
        fmt::format("the table {} at {}, and {} is asked for", late ? "ends" : "begins",
                    utc_text(late ? table.at.back() : table.at.front()), utc_text(t)),
        fmt::format("allowed are moments from {} to {}", utc_text(table.at.front()),
                    utc_text(table.at.back())),
        "Add rows, or change [time]");
  }
  t = std::clamp(t, table.at.front(), table.at.back());
  const auto after = std::upper_bound(table.at.begin(), table.at.end(), t);
  const auto row = static_cast<std::size_t>(after - table.at.begin()) - 1;
  if (after == table.at.end()) return {row, 0.0};
  return {row, (t - table.at[row]) / (table.at[row + 1] - table.at[row])};
}

double angle_at(const AngleTable& table, Instant t) {
  const auto [row, share] = place_in(table, t);
  if (share == 0.0) return table.values[row];
  return table.values[row] + share * (table.values[row + 1] - table.values[row]);
}

Pose pose_at(const PoseTable& table, Instant t) {
  const auto [row, share] = place_in(table, t);
  const TablePose& from = table.values[row];
  if (share == 0.0) return {glm::mat3_cast(from.rotation), from.offset_m};
  const TablePose& to = table.values[row + 1];
  return {glm::mat3_cast(glm::slerp(from.rotation, to.rotation, share)),
          from.offset_m + share * (to.offset_m - from.offset_m)};
}

Pose pose_at(const Visitor& visitor, const Mission& mission, Instant t) {
  const glm::dmat3 to_scene = scene_axes(mission, t);
  const Vec3 away = visitor.trajectory.at(t).position_m - mission.trajectory->at(t).position_m;
  Pose pose{glm::dmat3(1.0), visitor.origin_m + to_scene * away};
  if (visitor.attitude) {
    pose.rotation = to_scene *
                    glm::mat3_cast(visitor.attitude->at(t, visitor.trajectory.longest_gap_s(t))) *
                    glm::transpose(visitor.body_axes);
  }
  return pose;
}

}  // namespace

Pose rotation_about(const Vec3& pivot_m, const Vec3& axis, double angle_deg) {
  const glm::dmat3 rotation = glm::mat3_cast(glm::angleAxis(base::radians(angle_deg), axis));
  return {rotation, pivot_m - rotation * pivot_m};
}

bool Linkage::moves() const {
  return std::any_of(joints.begin(), joints.end(), [](const Joint& j) { return j.moves(); });
}

double SunFollower::angle_deg(const Vec3& axis, const Vec3& sun) const {
  const Vec3 side = glm::cross(axis, normal);
  const Vec3 across = glm::cross(side, axis);  // the normal's part across the axis, unnormalised
  const double x = glm::dot(sun, across), y = glm::dot(sun, side);
  constexpr double rounding = 1e-12;
  const double best =
      std::hypot(x, y) > rounding * glm::length(side) ? base::degrees(std::atan2(y, x)) : 0.0;
  // The cosine falls with the angle's distance from the best one, to the nearer limit.
  double found = lowest_deg;
  double off = std::numeric_limits<double>::infinity();
  for (int rotation = -2; rotation <= 2; ++rotation) {
    const double angle = std::clamp(best + 360.0 * rotation, lowest_deg, highest_deg);
    const double distance = std::abs(std::remainder(angle - best, 360.0));
    // Of equal angles the one nearest to 0.
    const bool nearer = distance < off - 1e-9;
    if (!nearer && !(distance < off + 1e-9 && std::abs(angle) < std::abs(found))) continue;
    found = angle;
    off = std::min(off, distance);
  }
  return found;
}

std::vector<JointState> Linkage::at(const Mission* mission, Instant t, const Vec3& sun) const {
  std::vector<JointState> states(joints.size()), found(joints.size());
  std::vector<char> done(joints.size(), 0);
  // A parent may come after its child.
  const auto place = [&](const auto& self, std::size_t k) -> void {
    if (done[k] != 0) return;
    done[k] = 1;
    const Joint& joint = joints[k];
    JointState& state = states[k];
    Pose parent;
    if (joint.parent) {
      self(self, *joint.parent);
      parent = found[*joint.parent].pose;
    }
    if (const auto* poses = std::get_if<PoseTable>(&joint.motion)) {
      state.pose = pose_at(*poses, t);
    } else if (const auto* visitor = std::get_if<Visitor>(&joint.motion)) {
      state.pose = pose_at(*visitor, *mission, t);
    } else {
      if (const auto* follower = std::get_if<SunFollower>(&joint.motion)) {
        state.angle_deg = follower->angle_deg(joint.axis, glm::transpose(parent.rotation) * sun);
      } else {
        const auto* angles = std::get_if<AngleTable>(&joint.motion);
        state.angle_deg = angles != nullptr ? angle_at(*angles, t) : std::get<double>(joint.motion);
      }
      // Exactly nothing where nothing turns.
      if (*state.angle_deg != 0.0)
        state.pose = rotation_about(joint.pivot_m, joint.axis, *state.angle_deg);
    }
    found[k] = state;
    if (joint.parent) found[k].pose = parent * state.pose;
  };
  for (std::size_t k = 0; k < joints.size(); ++k) place(place, k);
  return found;
}

std::size_t joint_index(const Linkage& linkage, std::string_view name) {
  const auto found = std::ranges::find(linkage.joints, name, &Joint::name);
  return static_cast<std::size_t>(found - linkage.joints.begin());
}

std::vector<JointState> joints_now(const Scene& scene) {
  const Mission* const mission = mission_of(scene);
  return scene.linkage->at(mission, mission != nullptr ? mission->moment : Instant(),
                           scene.sun ? scene.sun->direction : Vec3(0.0, 0.0, 1.0));
}

std::string pose_text(const Scene& scene) {
  std::string text;
  const std::vector<JointState> states = joints_now(scene);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const auto& [angle_deg, pose] = states[k];
    const Vec3& p = pose.offset_m;
    text += (text.empty() ? "" : ", ") + scene.linkage->joints[k].name;
    text += angle_deg ? fmt::format(" {:.4g} deg", *angle_deg)
                      : fmt::format(" at ({:.3f}, {:.3f}, {:.3f}) m", p.x, p.y, p.z);
  }
  return text;
}

}  // namespace earthshine::scenes
