// SPDX-License-Identifier: Apache-2.0
#include "scenes/shadow_path.h"

#include <cmath>

#include "scenes/specular_paths.h"

namespace earthshine::scenes {

Rgb ShadowPath::follow(Hit hit) {
  for (int pane = 0; pane < most_panes; ++pane) {
    if (hit.missed() || hit.t >= left_m_) return mirror_ == no_mirror ? share_ : Rgb(0.0);
    const SpecularPaths::Face* face = query_.specular_paths().face(hit.triangle);
    if (face == nullptr) return Rgb(0.0);
    if (mirror_ != no_mirror && face->mirror[hit.front ? 0 : 1] == mirror_) {
      share_ *= face->reflected;
      leave(hit, *face, hit.front);
      const FlatMirror& mirror = query_.specular_paths().mirrors()[mirror_];
      direction_ = mirror.reflected(direction_);
      end_ = mirror.image(end_);
      mirror_ = no_mirror;
    } else {
      share_ *= face->through;
      leave(hit, *face, !hit.front);
    }
    if (base::max_component(share_) <= 0.0) return Rgb(0.0);
    aim_again();
    hit = query_.closest(origin_, direction_);
  }
  return Rgb(0.0);
}

// Restarts off the surface that was hit, on its front or back.
void ShadowPath::leave(const Hit& hit, const SpecularPaths::Face& face, bool on_front) {
  origin_ += hit.t * direction_;
  const double off_m = (on_front ? 1.0 : -1.0) * query_.offset_m(hit.triangle);
  origin_ += (off_m - face.height_m(origin_)) * face.normal;
}

// At the end of the path: a ray beside the exact line would hit a slanted source too early.
void ShadowPath::aim_again() {
  if (!std::isfinite(left_m_)) return;
  const Vec3 offset = end_ - origin_;
  left_m_ = glm::dot(offset, direction_) > 0.0 ? glm::length(offset) : 0.0;
  if (left_m_ > 0.0) direction_ = offset / left_m_;
}

}  // namespace earthshine::scenes
