// SPDX-License-Identifier: Apache-2.0
// The rays that patches send out: points uniform over the patch, directions cosine-distributed
// about its normal, Owen-Sobol in the four dimensions together, in packets of neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/numbers/random.h"
#include "base/numbers/sobol_set.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// The set of samples is shared by all patches; each scrambles it with a key of its own. Safe on
// many threads.
class PatchRays {
 public:
  // rays: a power of two, at least RayPacket::width.
  PatchRays(const Patches& patches, const scenes::RayQuery& query, std::uint32_t rays)
      : patches_(patches), query_(query), samples_(rays) {}

  [[nodiscard]] std::uint32_t count() const { return samples_.count(); }

  // One patch, in the ray query's single-precision frame.
  struct Sender {
    base::SobolSet4::Scramble scramble;
    glm::vec3 corner, a, b;  // p = corner + s (a + t b), for parallelograms corner + s a + t b
    glm::vec3 tangent, bitangent, normal;
    float s0, s_span, t0, t_span;  // of s for parallelograms, of s^2 for triangles
    bool parallelogram;
    std::uint32_t several;  // the patch, if it is several triangles; then only `scramble` is used
  };
  [[nodiscard]] Sender sender(std::uint32_t patch, base::Key key) const;

  // The patch's next `count` rays, in place of the first ones (base::SobolSet4::go_to_run).
  void go_to_run(std::uint32_t run, Sender& sender) const {
    samples_.go_to_run(run, sender.scramble);
  }

  // Rays first .. first + width - 1 of the patch.
  void make(const Sender& sender, std::uint32_t first, scenes::RayPacket& rays) const;

 private:
  void make_of_several(std::uint32_t patch, const base::SobolSet4::Points& points,
                       scenes::RayPacket& rays) const;

  const Patches& patches_;
  const scenes::RayQuery& query_;
  base::SobolSet4 samples_;
};

// How many rays the patches of small objects send. The mean illuminance of an object is a mean over
// all of its patches' rays: a wall of 500 patches is known by 500 times the rays of a gauge that is
// a single patch. What a solve states of an object shall not depend on that, so the patches of an
// object that has fewer than 64 send as many rays together as 64 would.

// As many patches' rays an object has at least, while that is within the bounds below.
inline constexpr std::size_t patches_known_by = 64;
// What all of them cost is bounded: by a quarter of the scene's patches or by 2048 of them,
// whichever is more. Where many objects are small, all get less.
inline constexpr std::size_t most_extra_share = 4, most_extra_runs = 2048;
// No row is longer for it.
inline constexpr std::uint32_t most_rays_of_a_row = std::uint32_t{1} << 20;

// Per object of the scene: the runs of rays_per_patch rays that each of its patches sends, a power
// of two, 1 for objects of patches_known_by patches and more. Up to the last bound it depends on
// the cut alone, so that solves with other numbers of rays share them in the same proportion.
[[nodiscard]] std::vector<std::uint32_t> object_runs(const scenes::Scene& scene,
                                                     const Patches& patches, int rays_per_patch);

}  // namespace earthshine::radiosity
