// SPDX-License-Identifier: Apache-2.0
// Illuminance of every patch from a source, or from several sources that share the patch's points:
// shadow rays from points on the patch to points on the source.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "base/ranks/ranks.h"
#include "radiosity/bodies/moved_parts.h"
#include "radiosity/patches/patches.h"
#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// A disc of the sky with its angular radius. lowest_cosine: the cosine between its middle and a
// normal below which it is completely below the horizon.
struct Disc {
  Vec3 direction;
  double angle_rad, lowest_cosine;
};

// A source for the patches.
struct Source {
  std::uint64_t key = 0;  // of its random numbers
  std::size_t group = 0;
  int points = 16;       // receiver points per patch
  int near_factor = 64;  // factor near the source
  bool has_size = true;  // else all of its samples at a point are equal
  std::function<scenes::LightSample(const Vec3& point, double u, double v)> sample;
  // Replaces `sample` for many lamps in one source. Adds the samples that get a shadow ray.
  std::function<void(const Vec3& point, const Vec3& normal, double u, double v,
                     std::vector<scenes::LightSample>& samples)>
      cluster;
  std::function<double(const Vec3& point)> distance_m;  // empty for the sky
  std::optional<Disc> disc;                             // of a Sun
  const scenes::Lamp* lamp = nullptr;                   // a single lamp with a position

  // Whether the disc is completely below the horizon of a surface with this normal.
  [[nodiscard]] bool is_below_horizon(const Vec3& normal) const {
    return disc && glm::dot(disc->direction, normal) < disc->lowest_cosine;
  }
};

struct Sampled {
  std::vector<Rgb> illuminance_lx;  // patch * sources + source
  std::vector<double> variance;     // of its luminance-weighted mean, as for random points
  std::vector<std::uint32_t> rays;  // per patch
};

// Samples of the lamps that one pose of a scene leaves for the next one: the same where neither the
// patch nor the lamp moved and nothing that moved is between them, straight or by a flat mirror.
struct KeptSamples {
  struct OfLamp {
    scenes::Lamp lamp;
    Sampled sampled;
  };
  std::map<std::uint64_t, OfLamp> of_source;  // by key
  std::vector<scenes::FlatMirror> mirrors;
  std::vector<double> open_share;     // OpenParts::share
  const MovedParts* moved = nullptr;  // since then; null: nothing may be kept
};

// Replaces `samples` by the source's samples at a surface, direct and by flat mirrors.
void take_samples(const Source& source, std::span<const scenes::FlatMirror> mirrors,
                  const Vec3& point, const Vec3& normal, double u, double v,
                  std::vector<scenes::LightSample>& samples);

// Owen-Sobol points in four dimensions (on the patch, on the source), keyed by patch and first
// source. Covered points are skipped for the next of the sequence; a completely covered patch gets
// 0. Adds the number of rays to `rays`. sources: several only if all are in the sky, with equal
// numbers of points. receivers: the rank that gets all results. kept: of an earlier pose; its
// samples of a lamp are used, and replaced by this one's.
[[nodiscard]] Sampled sample_patches(const scenes::RayQuery& query, const Patches& patches,
                                     const OpenParts& open, std::span<const Source> sources,
                                     std::uint64_t seed, std::uint64_t& rays,
                                     base::Receivers receivers = base::Receivers::All,
                                     KeptSamples* kept = nullptr);

}  // namespace earthshine::radiosity
