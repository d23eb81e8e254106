// SPDX-License-Identifier: Apache-2.0
// Illuminance of every patch from a source, or from several that share the patch's points, by
// shadow rays from points on the patch to points on the source.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/ranks/ranks.h"
#include "radiosity/patches/patches.h"
#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// A disc of the sky and its angular radius; the cosine between its middle and a normal below which
// none of it is above the horizon.
struct Disc {
  Vec3 direction;
  double angle_rad, lowest_cosine;
};

// A source as the patches see it.
struct Source {
  std::uint64_t key = 0;  // of its random numbers
  std::size_t group = 0;
  int points = 16;       // receiver points per patch
  int near_factor = 64;  // how many times as many near the source
  bool has_size = true;  // else all of its samples at a point are the same
  std::function<scenes::LightSample(const Vec3& point, double u, double v)> sample;
  // In place of `sample`: many lamps as one. Adds those that get a shadow ray from a surface.
  std::function<void(const Vec3& point, const Vec3& normal, double u, double v,
                     std::vector<scenes::LightSample>& samples)>
      cluster;
  std::function<double(const Vec3& point)> distance_m;  // empty for the sky
  std::optional<Disc> disc;                             // of a Sun

  // Whether a surface of that normal cannot get any of it straight.
  [[nodiscard]] bool is_below_horizon(const Vec3& normal) const {
    return disc && glm::dot(disc->direction, normal) < disc->lowest_cosine;
  }
};

struct Sampled {
  std::vector<Rgb> illuminance_lx;  // patch * sources + source
  std::vector<double> variance;     // of its luminance-weighted value, as if the points were random
};

// The source's samples at a surface, straight and by flat mirrors, in place of what `samples` held.
void take_samples(const Source& source, std::span<const scenes::FlatMirror> mirrors,
                  const Vec3& point, const Vec3& normal, double u, double v,
                  std::vector<scenes::LightSample>& samples);

// Owen-Sobol in four dimensions (point of the patch, point of the source), keyed by patch and
// first source. Points that bodies cover are left out, and the next of the sequence taken; a wholly
// covered patch gets nothing. Adds the rays cast to `rays`. sources: of several, each in the sky,
// so that they want equally many points. hears: the rank that has them all.
[[nodiscard]] Sampled sample_patches(const scenes::RayQuery& query, const Patches& patches,
                                     const OpenParts& open, std::span<const Source> sources,
                                     std::uint64_t seed, std::uint64_t& rays,
                                     base::Hears hears = base::Hears::All);

}  // namespace earthshine::radiosity
