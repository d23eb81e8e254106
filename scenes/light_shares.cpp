// SPDX-License-Identifier: Apache-2.0
// RayQuery's shadow rays: through glass that does not bend light, off flat mirrors.
#include "scenes/ray_query.h"

namespace earthshine::scenes {
namespace {

// Goes on along one ray from its first hit, toward the source.
class Way {
 public:
  Way(const RayQuery& query, const Vec3& origin, const Vec3& direction, double reach_m,
      std::uint32_t mirror)
      : query_(query), origin_(origin), direction_(direction), left_m_(reach_m), mirror_(mirror) {}

  Rgb follow(Hit hit) {
    for (int pane = 0; pane < most_panes; ++pane) {
      if (hit.missed() || hit.t >= left_m_) return mirror_ == no_mirror ? share_ : Rgb(0.0);
      const LightWays::Face* face = query_.ways().face(hit.triangle);
      if (face == nullptr) return Rgb(0.0);
      if (mirror_ != no_mirror && face->mirror[hit.front ? 0 : 1] == mirror_) {
        share_ *= face->reflected;
        leave(hit.t, hit.front ? face->normal : -face->normal);
        direction_ = query_.ways().mirrors()[mirror_].turned(direction_);
        mirror_ = no_mirror;
      } else {
        share_ *= face->through;
        leave(hit.t, hit.front ? -face->normal : face->normal);
      }
      if (base::max_component(share_) <= 0.0) return Rgb(0.0);
      hit = query_.closest(origin_, direction_);
    }
    return Rgb(0.0);
  }

 private:
  // Off the surface that was met at the distance t, to the side that the normal shows.
  void leave(double t, const Vec3& normal) {
    origin_ += t * direction_ + query_.surface_offset_m() * normal;
    left_m_ -= t;
  }

  const RayQuery& query_;
  Vec3 origin_, direction_;
  double left_m_;
  std::uint32_t mirror_;
  Rgb share_{1.0};
};

}  // namespace

void RayQuery::light_shares(const RayPacket& rays, const std::uint32_t* mirrors, std::size_t count,
                            Rgb* shares) const {
  if (ways_.empty()) {
    const std::uint32_t hidden = occluded(rays, count);
    for (std::size_t k = 0; k < count; ++k) shares[k] = Rgb(((hidden >> k) & 1U) != 0 ? 0.0 : 1.0);
    return;
  }
  HitPacket hits;
  closest(rays, count, hits);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 origin = centre_ + Vec3(rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]);
    const Vec3 direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    shares[k] =
        Way(*this, origin, direction, double(rays.t_max[k]), mirrors[k])
            .follow({hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0});
  }
}

}  // namespace earthshine::scenes
