// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/patch_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/azimuth.h"
#include "radiosity/patches/cluster_members.h"
#include "radiosity/patches/patch_offset.h"

namespace earthshine::radiosity {
namespace {

constexpr std::uint32_t width = scenes::RayPacket::width;
static_assert(width == base::SobolSet4::width);

// Inset of sample points from the patch's edges, where rounding could put them behind a neighbour.
constexpr double inset = 1e-4;

// Runs per patch for an object of `patches` patches, so that it is as accurate as one of `wanted`.
std::uint32_t runs_of(std::size_t patches, std::size_t wanted, int rays_per_patch) {
  if (patches == 0) return 1;
  const std::size_t needed = std::bit_ceil((wanted + patches - 1) / patches);
  const std::uint32_t most =
      std::bit_floor(std::max(1U, most_rays_of_a_row / static_cast<std::uint32_t>(rays_per_patch)));
  return std::min(static_cast<std::uint32_t>(needed), most);
}

}  // namespace

PatchRays::Sender PatchRays::sender(std::uint32_t patch, base::Key key) const {
  const Facet& owner = patches_.facets[patches_.facet[patch]];
  if (patches_.is_several(patch) || patches_.is_part(patch)) {
    const glm::vec3 unused(0.0F);
    return {base::SobolSet4::Scramble(key),
            unused,
            unused,
            unused,
            unused,
            unused,
            unused,
            0.0F,
            0.0F,
            0.0F,
            0.0F,
            false,
            patch};
  }
  const ClusterSpan alone =
      owner.is_cluster() ? span_of(owner, patches_.cell[patch]) : ClusterSpan{};
  const Facet& facet = owner.is_cluster() ? patches_.clustered->facet(alone.first) : owner;
  const Rectangle r = owner.is_cluster() ? alone.part : patches_.rectangle(patch);
  const Vec3 normal = patches_.is_back[patch] != 0 ? -facet.normal : facet.normal;
  const base::Frame3 frame = base::frame_around(normal);
  const bool flat = facet.parallelogram;
  // A triangle's area grows with s^2: uniform in the trapezoid between s0 and s1.
  const double low = flat ? r.s0 : r.s0 * r.s0, high = flat ? r.s1 : r.s1 * r.s1;
  const double s_inset = inset * (high - low), t_inset = inset * (r.t1 - r.t0);
  return {base::SobolSet4::Scramble(key),
          glm::vec3(facet.corner + frame.normal * patch_offset_m(patches_, query_, patch) -
                    query_.centre()),
          glm::vec3(facet.a),
          glm::vec3(flat ? facet.b : facet.b - facet.a),
          glm::vec3(frame.tangent),
          glm::vec3(frame.bitangent),
          glm::vec3(frame.normal),
          static_cast<float>(low + s_inset),
          static_cast<float>(high - low - 2.0 * s_inset),
          static_cast<float>(r.t0 + t_inset),
          static_cast<float>(r.t1 - r.t0 - 2.0 * t_inset),
          flat,
          no_patch};
}

void PatchRays::make_of_several(std::uint32_t patch, const base::SobolSet4::Points& p,
                                scenes::RayPacket& rays) const {
  const auto off_edges = [](float x) { return inset + (1.0 - 2.0 * inset) * double(x); };
  for (std::uint32_t k = 0; k < width; ++k) {
    const SurfacePoint at = patches_.at(patch, off_edges(p.x[2][k]), off_edges(p.x[3][k]));
    const base::Azimuth azimuth = base::azimuth_of(p.x[1][k]);
    const float radius = std::sqrt(p.x[0][k]), height = std::sqrt(1.0F - p.x[0][k]);
    const Vec3 direction = base::frame_around(at.normal).to_world(
        {radius * azimuth.cosine, radius * azimuth.sine, height});
    query_.set(rays, k, lifted(at, query_), direction);
  }
}

void PatchRays::make(const Sender& from, std::uint32_t first, scenes::RayPacket& rays) const {
  base::SobolSet4::Points p;
  samples_.points(first, from.scramble, p);
  if (from.several != no_patch) return make_of_several(from.several, p, rays);
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
    const base::Azimuth azimuth = base::azimuth_of(p.x[1][k]);
    const float x = radius * azimuth.cosine, y = radius * azimuth.sine;
    rays.direction_x[k] = x * from.tangent.x + y * from.bitangent.x + height * from.normal.x;
    rays.direction_y[k] = x * from.tangent.y + y * from.bitangent.y + height * from.normal.y;
    rays.direction_z[k] = x * from.tangent.z + y * from.bitangent.z + height * from.normal.z;
    rays.t_max[k] = std::numeric_limits<float>::infinity();
  }
}

std::vector<std::uint32_t> object_runs(const scenes::Scene& scene, const Patches& patches,
                                       int rays_per_patch) {
  std::vector<std::size_t> of_object(scene.objects.size(), 0);
  for (std::uint32_t i = 0; i < patches.count(); ++i) ++of_object[patches.object(i)];
  const std::size_t most_extra = std::max(patches.count() / most_extra_share, most_extra_runs);
  std::vector<std::uint32_t> runs(of_object.size(), 1);
  for (std::size_t wanted = patches_known_by; wanted > 1; wanted /= 2) {
    std::size_t extra = 0;
    for (std::size_t o = 0; o < runs.size(); ++o) {
      runs[o] = runs_of(of_object[o], wanted, rays_per_patch);
      extra += of_object[o] * (runs[o] - 1);
    }
    if (extra <= most_extra) return runs;
  }
  std::fill(runs.begin(), runs.end(), 1U);
  return runs;
}

}  // namespace earthshine::radiosity
