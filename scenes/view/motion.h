// SPDX-License-Identifier: Apache-2.0
// Rigid motion during an exposure: cameras, objects and lamps at a time t after the scene's moment,
// which is the middle of the exposure of the middle row.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// p -> about + R(t) (p - about) + t velocity, R by the spin.
class MovedBy {
 public:
  MovedBy(const Motion& motion, const Vec3& about, double t_s);
  [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation_ * (p - about_) + to_; }
  [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation_ * d; }

 private:
  glm::dmat3 rotation_;
  Vec3 about_, to_;
};

// The point about which an object turns.
[[nodiscard]] Vec3 spin_centre(const Scene& scene, const Object& object);

// Whether any object or lamp moves.
[[nodiscard]] bool surfaces_or_lamps_move(const Scene& scene);

// Moves objects and lamps; cameras stay. Moving copies of an object become objects of their own.
void move_surfaces_and_lamps(Scene& scene, double t_s);

// Cameras expose no motion: for studies, which measure still pictures.
void hold_still(Scene& scene);

// When the rows of a picture of any size take light.
struct Shutter {
  double exposure_s = 0.0;
  double readout_s = 0.0;  // from the first row's exposure to the last one's, and a line

  explicit Shutter(const Camera& camera);
  [[nodiscard]] bool is_open() const { return exposure_s > 0.0 || readout_s != 0.0; }
  // Middle of the exposure at a height of the picture, 0 at its top and 1 at its bottom.
  [[nodiscard]] double middle_s(double height) const { return (height - 0.5) * readout_s; }
  // From the beginning of the first exposure to the end of the last one.
  [[nodiscard]] double all_s() const;
};

}  // namespace earthshine::scenes
