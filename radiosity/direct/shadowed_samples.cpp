// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/shadowed_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numbers/random.h"
#include "radiosity/bodies/closed_bodies.h"

namespace earthshine::radiosity {
namespace {

using scenes::LightSample;
using scenes::RayPacket;

// Per point wanted of a patch that a body covers in part: a sliver left open is not looked for
// longer.
constexpr int most_draws = 64;

// Adds up shadowed samples eight at a time.
class Receiver {
 public:
  Receiver(const scenes::RayQuery& query, int points)
      : query_(query), by_point_(static_cast<std::size_t>(points), 0.0) {}

  void add(int point, const Vec3& origin, const Vec3& normal, const LightSample& sample) {
    const double cosine = glm::dot(sample.direction, normal);
    if (cosine <= 0.0 || base::max_component(sample.normal_illuminance_lx) <= 0.0) return;
    // Stops short of the source, which may be a surface of the scene itself.
    const double reach = sample.distance_m * (1.0 - 1e-5) - 2.0 * query_.surface_offset_m();
    if (reach <= 0.0) return;
    query_.set(packet_, count_, origin, sample.direction, reach);
    mirror_[count_] = sample.mirror;
    point_[count_] = static_cast<std::size_t>(point);
    contribution_[count_++] = sample.normal_illuminance_lx * cosine;
    if (count_ == RayPacket::width) flush();
  }

  void finish() { flush(); }
  [[nodiscard]] const Rgb& sum() const { return sum_; }
  [[nodiscard]] double sum_of_squares() const {  // of the points' luminance-weighted values
    double squares = 0.0;
    for (const double y : by_point_) squares += y * y;
    return squares;
  }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  void flush() {
    if (count_ == 0) return;
    std::array<Rgb, RayPacket::width> shares;
    query_.light_shares(packet_, mirror_, count_, shares.data());
    for (std::size_t k = 0; k < count_; ++k) {
      const Rgb arrives = shares[k] * contribution_[k];
      sum_ += arrives;
      by_point_[point_[k]] += base::luminance(arrives);
    }
    rays_ += count_;
    count_ = 0;
  }

  const scenes::RayQuery& query_;
  RayPacket packet_;
  std::uint32_t mirror_[RayPacket::width];
  Rgb contribution_[RayPacket::width];
  std::size_t count_ = 0;
  Rgb sum_{0.0};
  std::size_t point_[RayPacket::width];
  std::vector<double> by_point_;
  std::uint64_t rays_ = 0;
};

// Near a source the illuminance varies across the patch as 1/r^2, and more points are worth their
// rays.
int points_for(const Source& source, const Patches& patches, std::uint32_t patch) {
  if (!source.distance_m) return source.points;
  const double ratio =
      source.distance_m(patches.point(patch, 0.5, 0.5)) / std::sqrt(patches.area_m2[patch]);
  if (ratio < 2.0) return source.points * source.near_factor;
  return ratio < 6.0 ? source.points * 4 : source.points;
}

void add_samples(const Source& source, const Vec3& point, const Vec3& normal, double u, double v,
                 std::vector<LightSample>& samples) {
  if (source.cluster) {
    source.cluster(point, normal, u, v, samples);
  } else {
    samples.push_back(source.sample(point, u, v));
  }
}

// A flat patch that a Sun is below the horizon of, straight and by mirrors.
bool sees_nothing_of(const Source& source, std::span<const scenes::FlatMirror> mirrors,
                     const Patches& patches, std::uint32_t patch) {
  if (!source.disc || patches.is_several(patch)) return false;
  const Vec3 normal = patches.normal(patch);
  return source.is_below_horizon(normal) &&
         std::all_of(mirrors.begin(), mirrors.end(), [&](const scenes::FlatMirror& mirror) {
           return source.is_below_horizon(mirror.turned(normal));
         });
}

}  // namespace

void take_samples(const Source& source, std::span<const scenes::FlatMirror> mirrors,
                  const Vec3& point, const Vec3& normal, double u, double v,
                  std::vector<LightSample>& samples) {
  samples.clear();
  if (!source.is_below_horizon(normal)) add_samples(source, point, normal, u, v, samples);
  for (std::uint32_t m = 0; m < mirrors.size(); ++m) {
    const scenes::FlatMirror& mirror = mirrors[m];
    if (mirror.height_m(point) <= 0.0) continue;
    const Vec3 turned = mirror.turned(normal);
    if (source.is_below_horizon(turned)) continue;
    std::size_t kept = samples.size();
    add_samples(source, mirror.image(point), turned, u, v, samples);
    for (std::size_t k = kept; k < samples.size(); ++k) {
      const LightSample sample = scenes::thrown(samples[k], mirror, m, point);
      if (base::max_component(sample.normal_illuminance_lx) > 0.0) samples[kept++] = sample;
    }
    samples.resize(kept);
  }
}

Sampled sample_patches(const scenes::RayQuery& query, const Patches& patches, const OpenParts& open,
                       const Source& source, std::uint64_t seed, std::uint64_t& rays,
                       base::Hears hears) {
  Sampled sampled{std::vector<Rgb>(patches.count(), Rgb(0.0)),
                  std::vector<double>(patches.count(), 0.0)};
  constexpr std::size_t chunk = 256;
  std::vector<std::uint64_t> chunk_rays((patches.count() + chunk - 1) / chunk, 0);
  const auto sample = [&](std::size_t begin, std::size_t end) {
    std::vector<LightSample> samples;
    for (std::size_t i = begin; i < end; ++i) {
      const auto patch = static_cast<std::uint32_t>(i);
      const double share = open.share.empty() ? 1.0 : open.share[i];
      if (share <= 0.0) continue;
      if (sees_nothing_of(source, query.ways().mirrors(), patches, patch)) continue;
      std::vector<std::uint32_t> near;
      if (share < 1.0) near = open.bodies->near(patches, patch, 2.0 * query.surface_offset_m());
      const base::SobolOwen4 sobol(base::Key(seed, base::Stream::DirectLight, i).with(source.key));
      const int points = points_for(source, patches, patch);
      Receiver receiver(query, points);
      int taken = 0;
      for (int k = 0; taken < points && k < most_draws * points; ++k) {
        const auto p = sobol.point(static_cast<std::uint32_t>(k));
        const auto [at, normal] = patches.at(patch, p[0], p[1]);
        const Vec3 lift = normal * query.surface_offset_m();
        if (!near.empty() && open.bodies->cover(at + lift - open.bodies->centre(), near)) continue;
        take_samples(source, query.ways().mirrors(), at, normal, p[2], p[3], samples);
        for (const LightSample& one : samples) receiver.add(taken, at + lift, normal, one);
        ++taken;
      }
      receiver.finish();
      if (taken == 0) continue;
      const double n = taken, y = base::luminance(receiver.sum());
      sampled.illuminance_lx[i] = receiver.sum() / n;
      sampled.variance[i] =
          std::max(0.0, receiver.sum_of_squares() - y * y / n) / (n * std::max(1.0, n - 1.0));
      chunk_rays[begin / chunk] += receiver.rays();
    }
  };
  base::share_chunks(
      patches.count(), chunk, sample,
      [&](std::size_t begin, std::size_t end, base::Parcel& parcel) {
        parcel.pass_range(&sampled.illuminance_lx[begin], end - begin);
        parcel.pass_range(&sampled.variance[begin], end - begin);
        parcel.pass(chunk_rays[begin / chunk]);
      },
      hears);
  for (const std::uint64_t count : chunk_rays) rays += count;
  return sampled;
}

}  // namespace earthshine::radiosity
