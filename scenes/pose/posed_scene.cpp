// SPDX-License-Identifier: Apache-2.0
#include "scenes/pose/posed_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "scenes/health/coincident.h"
#include "scenes/text/message_text.h"
#include "scenes/text/table_reader.h"
#include "scenes/time/linkage.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Rigid motion from the old pose to the new one: P' shift P^-1, P and P' the poses of the joint.
class Motions {
 public:
  Motions(const Scene& scene, const PoseChange& change) : scene_(scene), change_(change) {
    if (scene.linkage == nullptr) return;
    before_ = after_ = joints_now(scene);
    if (change.joints.empty()) return;
    Scene moved;  // with what joints depend on
    moved.orbit = scene.orbit;
    moved.sun = scene.sun;
    Linkage linkage = *scene.linkage;
    for (const auto& [joint, angle_deg] : change.joints) linkage.joints[joint].motion = angle_deg;
    moved.linkage = linkage_ = std::make_shared<const Linkage>(std::move(linkage));
    after_ = joints_now(moved);
  }

  [[nodiscard]] const std::shared_ptr<const Linkage>& linkage() const { return linkage_; }

  // The new pose of what hangs on the joint; empty: on none.
  [[nodiscard]] Pose pose_of(const std::string& joint) const {
    return joint.empty() ? Pose{} : after_[joint_index(*scene_.linkage, joint)].pose;
  }

  [[nodiscard]] Pose of_joint(const std::string& joint, const Vec3& shift_m) const {
    if (joint.empty()) return {glm::dmat3(1.0), shift_m};
    const Pose &before = before_[joint_index(*scene_.linkage, joint)].pose,
               &after = after_[joint_index(*scene_.linkage, joint)].pose;
    if (before == after) return {glm::dmat3(1.0), after.rotation * shift_m};
    return after * Pose{glm::dmat3(1.0), shift_m} * inverse(before);
  }

  [[nodiscard]] Pose of_object(std::size_t object) const {
    const auto moved = std::ranges::find(change_.objects, object, &PoseChange::ObjectShift::object);
    return of_joint(scene_.objects[object].joint,
                    moved == change_.objects.end() ? Vec3(0.0) : moved->shift_m);
  }
  [[nodiscard]] Pose of_object(const std::string& name) const {
    const auto found = std::ranges::find(scene_.objects, name, &Object::name);
    return of_object(static_cast<std::size_t>(found - scene_.objects.begin()));
  }

 private:
  const Scene& scene_;
  const PoseChange& change_;
  std::shared_ptr<const Linkage> linkage_;
  std::vector<JointState> before_, after_;
};

void check_range(const Vec3& p, const std::string& name) {
  for (int c = 0; c < 3; ++c) {
    if (std::abs(p[c]) <= largest_length) continue;
    throw base::Error(base::Blame::Input, in_quotes(name), "is moved too far",
                      fmt::format("coordinates are at most {} m", largest_length));
  }
}

void move_object(Scene& scene, const Object& object, const Pose& motion) {
  const auto [first, count] = vertices_of(scene, object);
  for (std::uint32_t v = first; v < first + count; ++v) {
    scene.vertices[v] = motion.point(scene.vertices[v]);
    check_range(scene.vertices[v], object.name);
  }
}

}  // namespace

Scene posed_scene(const Scene& scene, const PoseChange& change) {
  const Motions motions(scene, change);
  Scene posed = scene;
  if (motions.linkage()) posed.linkage = motions.linkage();
  std::vector<Pose> of_object;
  std::vector<bool> is_moved(scene.objects.size(), false);
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    of_object.push_back(motions.of_object(k));
    if (of_object[k] == Pose{}) continue;
    is_moved[k] = true;
    move_object(posed, posed.objects[k], of_object[k]);
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    if (!scene.objects[k].instance) continue;
    Instance& instance = *posed.objects[k].instance;
    const Pose &own = of_object[k], &original = of_object[instance.object];
    if (own == Pose{} && original == Pose{}) continue;
    const Pose relation = own * Pose{instance.linear, instance.offset_m} * inverse(original);
    instance.linear = relation.rotation;
    instance.offset_m = relation.offset_m;
  }
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    Lamp& lamp = posed.lamps[k];
    const auto moved = std::ranges::find(change.lamps, k, &PoseChange::LampShift::lamp);
    const bool shifts = moved != change.lamps.end();
    const Pose motion = lamp.object.empty()
                            ? motions.of_joint(lamp.joint, shifts ? moved->shift_m : Vec3(0.0))
                            : motions.of_object(lamp.object);
    if (!lamp.is_distant()) lamp.position = motion.point(lamp.position);
    check_range(lamp.position, lamp.name);
    for (Vec3* direction : {&lamp.axis, &lamp.edge_u, &lamp.edge_v, &lamp.c0}) {
      *direction = motion.rotation * *direction;
    }
    if (shifts && moved->axis) lamp.axis = motions.pose_of(lamp.joint).rotation * *moved->axis;
  }
  for (Camera& camera : posed.cameras) {
    const Pose motion = camera.object.empty() ? motions.of_joint(camera.joint, Vec3(0.0))
                                              : motions.of_object(camera.object);
    camera.position = motion.point(camera.position);
    camera.look_at = motion.point(camera.look_at);
    camera.up = motion.rotation * camera.up;
  }
  find_coincident_faces_again(posed, is_moved);
  return posed;
}

}  // namespace earthshine::scenes
