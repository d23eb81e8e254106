// SPDX-License-Identifier: Apache-2.0
// Rays of patches: points uniform over the patch, directions cosine-distributed about its normal,
// Owen-Sobol in all four dimensions, in packets of neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/numbers/random.h"
#include "base/numbers/sobol_set.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// All patches share the set of samples; each scrambles it with its own key. Thread-safe.
class PatchRays {
 public:
  // rays: a power of two, at least RayPacket::width.
  PatchRays(const Patches& patches, const scenes::RayQuery& query, std::uint32_t rays)
      : patches_(patches), query_(query), samples_(rays) {}

  [[nodiscard]] std::uint32_t count() const { return samples_.count(); }

  // A patch in the ray query's single-precision frame.
  struct Sender {
    base::SobolSet4::Scramble scramble;
    glm::vec3 corner, a, b;  // p = corner + s (a + t b), for parallelograms corner + s a + t b
    glm::vec3 tangent, bitangent, normal;
    float s0, s_span, t0, t_span;  // of s for parallelograms, of s^2 for triangles
    bool parallelogram;
    std::uint32_t several;  // the patch, if it has several triangles; then only `scramble` is used
  };
  [[nodiscard]] Sender sender(std::uint32_t patch, base::Key key) const;

  // Selects run `run` of `count` rays instead of the first one (base::SobolSet4::go_to_run).
  void go_to_run(std::uint32_t run, Sender& sender) const {
    samples_.go_to_run(run, sender.scramble);
  }

  // Makes rays first .. first + width - 1 of the patch.
  void make(const Sender& sender, std::uint32_t first, scenes::RayPacket& rays) const;

 private:
  void make_of_several(std::uint32_t patch, const base::SobolSet4::Points& points,
                       scenes::RayPacket& rays) const;

  const Patches& patches_;
  const scenes::RayQuery& query_;
  base::SobolSet4 samples_;
};

// Numbers of rays for the patches of small objects. The mean illuminance of an object averages over
// all rays of its patches: a wall of 500 patches has 500 times the rays of an instrument of one
// patch. To make stated means equally accurate, the patches of an object with fewer than 64 patches
// together cast as many rays as 64 patches.

// Minimum number of patches' rays for an object, within the limits below.
inline constexpr std::size_t patches_known_by = 64;
// Total extra rays: at most those of a quarter of the scene's patches, or of 2048 patches,
// whichever is more. With many small objects, all get fewer.
inline constexpr std::size_t most_extra_share = 4, most_extra_runs = 2048;
// Limit per row.
inline constexpr std::uint32_t most_rays_of_a_row = std::uint32_t{1} << 20;

// Per object of the scene: number of runs of rays_per_patch rays for each of its patches, a power
// of two, 1 for objects of at least patches_known_by patches. Except for the last limit it depends
// only on the patches, so that solves with different ray numbers distribute them in the same
// proportion.
[[nodiscard]] std::vector<std::uint32_t> object_runs(const scenes::Scene& scene,
                                                     const Patches& patches, int rays_per_patch);

}  // namespace earthshine::radiosity
