// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/patch_rays.h"

#include <cmath>
#include <limits>

#include "base/turn.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t width = scenes::RayPacket::width;
static_assert(width == base::SobolSet4::width);

// Keeps sample points off the patch's edges, where rounding could put them behind a neighbour.
constexpr double inset = 1e-4;

}  // namespace

PatchRays::Sender PatchRays::sender(std::uint32_t patch, base::Key key) const {
  const Facet& facet = patches_.facets[patches_.facet[patch]];
  const base::Frame3 frame = base::frame_around(patches_.normal(patch));
  const Rectangle r = patches_.rectangle(patch);
  const bool flat = facet.parallelogram;
  // A triangle's area grows with s^2: uniform in the trapezoid between s0 and s1.
  const double low = flat ? r.s0 : r.s0 * r.s0, high = flat ? r.s1 : r.s1 * r.s1;
  const double s_inset = inset * (high - low), t_inset = inset * (r.t1 - r.t0);
  return {base::SobolSet4::Scramble(key),
          glm::vec3(facet.corner + frame.normal * query_.surface_offset_m() - query_.centre()),
          glm::vec3(facet.a),
          glm::vec3(flat ? facet.b : facet.b - facet.a),
          glm::vec3(frame.tangent),
          glm::vec3(frame.bitangent),
          glm::vec3(frame.normal),
          static_cast<float>(low + s_inset),
          static_cast<float>(high - low - 2.0 * s_inset),
          static_cast<float>(r.t0 + t_inset),
          static_cast<float>(r.t1 - r.t0 - 2.0 * t_inset),
          flat};
}

void PatchRays::make(const Sender& from, std::uint32_t first, scenes::RayPacket& rays) const {
  base::SobolSet4::Points p;
  samples_.points(first, from.scramble, p);
  alignas(32) float s[width], t[width];
  for (std::uint32_t k = 0; k < width; ++k) s[k] = from.s0 + from.s_span * p.x[2][k];
  for (std::uint32_t k = 0; k < width; ++k) t[k] = from.t0 + from.t_span * p.x[3][k];
  if (!from.parallelogram) {
    for (std::uint32_t k = 0; k < width; ++k) {
      s[k] = std::sqrt(s[k]);
      t[k] *= s[k];
    }
  }
  for (std::uint32_t k = 0; k < width; ++k) {
    rays.origin_x[k] = from.corner.x + s[k] * from.a.x + t[k] * from.b.x;
    rays.origin_y[k] = from.corner.y + s[k] * from.a.y + t[k] * from.b.y;
    rays.origin_z[k] = from.corner.z + s[k] * from.a.z + t[k] * from.b.z;
  }
  for (std::uint32_t k = 0; k < width; ++k) {
    const float radius = std::sqrt(p.x[0][k]), height = std::sqrt(1.0F - p.x[0][k]);
    const base::Turned way = base::turn(p.x[1][k]);
    const float x = radius * way.cosine, y = radius * way.sine;
    rays.direction_x[k] = x * from.tangent.x + y * from.bitangent.x + height * from.normal.x;
    rays.direction_y[k] = x * from.tangent.y + y * from.bitangent.y + height * from.normal.y;
    rays.direction_z[k] = x * from.tangent.z + y * from.bitangent.z + height * from.normal.z;
    rays.t_max[k] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace earthshine::radiosity
