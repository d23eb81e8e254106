// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/shadowed_samples.h"

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/patches/patch_offset.h"
#include "scenes/light/photometry.h"
#include "scenes/light/shadow_queue.h"

namespace earthshine::radiosity {
namespace {

using scenes::LightSample;

// Limit of draws per wanted point of a partly covered patch, for patches with only a sliver open.
constexpr int most_draws = 64;

// Sums shadowed samples of some sources.
class Receiver {
 public:
  Receiver(const scenes::RayQuery& query, std::size_t sources, int points)
      : query_(query),
        shadows_(query),
        sources_(sources),
        sum_(sources, Rgb(0.0)),
        by_point_(static_cast<std::size_t>(points) * sources, 0.0) {}

  void add(std::size_t source, int point, const SurfacePoint& from, const LightSample& sample) {
    const double cosine = glm::dot(sample.direction, from.normal);
    if (cosine <= 0.0 || base::max_component(sample.normal_illuminance_lx) <= 0.0) return;
    shadows_.add(sample, from.position, lifted(from, query_),
                 {source, static_cast<std::size_t>(point), sample.normal_illuminance_lx * cosine},
                 [this](const Arriving& light, const Rgb& share) { take(light, share); });
  }

  void finish() {
    shadows_.trace([this](const Arriving& light, const Rgb& share) { take(light, share); });
  }
  [[nodiscard]] const Rgb& sum(std::size_t source) const { return sum_[source]; }
  // Sum over points of squared luminance-weighted values.
  [[nodiscard]] double sum_of_squares(std::size_t source) const {
    double squares = 0.0;
    for (std::size_t k = source; k < by_point_.size(); k += sources_) {
      squares += by_point_[k] * by_point_[k];
    }
    return squares;
  }
  [[nodiscard]] std::uint64_t rays() const { return shadows_.rays(); }

 private:
  struct Arriving {
    std::size_t source, point;
    Rgb illuminance_lx;
  };
  void take(const Arriving& light, const Rgb& share) {
    const Rgb arrives = share * light.illuminance_lx;
    sum_[light.source] += arrives;
    by_point_[light.point * sources_ + light.source] += base::luminance(arrives);
  }

  const scenes::RayQuery& query_;
  scenes::ShadowQueue<Arriving> shadows_;
  std::size_t sources_;
  std::vector<Rgb> sum_;
  std::vector<double> by_point_;  // point * sources + source
};

// Near a source the illuminance varies over the patch as 1/r^2 and needs more points.
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

// Whether a Sun is below the horizon of a flat patch, directly and in all mirrors.
bool sees_nothing_of(const Source& source, std::span<const scenes::FlatMirror> mirrors,
                     const Patches& patches, std::uint32_t patch) {
  if (!source.disc || patches.is_several(patch)) return false;
  const Vec3 normal = patches.normal(patch);
  return source.is_below_horizon(normal) &&
         std::all_of(mirrors.begin(), mirrors.end(), [&](const scenes::FlatMirror& mirror) {
           return source.is_below_horizon(mirror.reflected(normal));
         });
}

bool is_same(const scenes::Lamp& a, const scenes::Lamp& b) {
  return a.kind == b.kind && a.position == b.position && a.axis == b.axis &&
         a.intensity_cd == b.intensity_cd && a.beam_deg == b.beam_deg &&
         a.field_deg == b.field_deg && a.edge_u == b.edge_u && a.edge_v == b.edge_v &&
         a.radius_m == b.radius_m && a.exitance == b.exitance && a.c0 == b.c0 &&
         (a.photometry == b.photometry ||
          (a.photometry && b.photometry && *a.photometry == *b.photometry));
}

bool are_same(std::span<const scenes::FlatMirror> a, std::span<const scenes::FlatMirror> b) {
  return std::ranges::equal(a, b, [](const scenes::FlatMirror& x, const scenes::FlatMirror& y) {
    return x.point == y.point && x.normal == y.normal && x.centre == y.centre &&
           x.radius_m == y.radius_m;
  });
}

double radius_of(const scenes::Lamp& lamp) {
  return lamp.radius_m + 0.5 * (glm::length(lamp.edge_u) + glm::length(lamp.edge_v));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - a - t * along);
}

// Whether nothing that moved is on any path of light from the lamp to the patch.
bool is_clear(const MovedParts& moved, const scenes::Lamp& lamp,
              std::span<const scenes::FlatMirror> mirrors, const Patches& patches,
              std::uint32_t patch) {
  const auto [low, high] = patches.box(patch);
  const Vec3 middle = 0.5 * (low + high);
  const double radius = 0.5 * glm::length(high - low), lamp_radius = radius_of(lamp);
  if (moved.between(middle, radius, lamp.position, lamp_radius)) return false;
  return std::ranges::none_of(mirrors, [&](const scenes::FlatMirror& mirror) {
    if (mirror.height_m(middle) < -radius || mirror.height_m(lamp.position) < -lamp_radius) {
      return false;
    }
    const Vec3 image = mirror.image(lamp.position);
    // Light of this mirror passes its ball.
    if (distance_to_segment(mirror.centre, middle, image) >
        mirror.radius_m + std::max(radius, lamp_radius)) {
      return false;
    }
    return moved.between(middle, radius, image, lamp_radius) ||
           moved.between(mirror.image(middle), radius, lamp.position, lamp_radius);
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
    const Vec3 reflected = mirror.reflected(normal);
    if (source.is_below_horizon(reflected)) continue;
    const auto& disc = source.disc;
    if (disc && !scenes::disc_may_be_thrown(disc->direction, disc->angle_rad, mirror, point)) {
      continue;
    }
    std::size_t kept = samples.size();
    add_samples(source, mirror.image(point), reflected, u, v, samples);
    for (std::size_t k = kept; k < samples.size(); ++k) {
      const LightSample sample = scenes::thrown(samples[k], mirror, m, point);
      if (base::max_component(sample.normal_illuminance_lx) > 0.0) samples[kept++] = sample;
    }
    samples.resize(kept);
  }
}

Sampled sample_patches(const scenes::RayQuery& query, const Patches& patches, const OpenParts& open,
                       std::span<const Source> sources, std::uint64_t seed, std::uint64_t& rays,
                       base::Receivers receivers, KeptSamples* kept) {
  const std::size_t each = sources.size();
  const std::span<const scenes::FlatMirror> mirrors = query.specular_paths().mirrors();
  Sampled sampled{std::vector<Rgb>(patches.count() * each, Rgb(0.0)),
                  std::vector<double>(patches.count() * each, 0.0),
                  std::vector<std::uint32_t>(patches.count(), 0)};
  const scenes::Lamp* const lamp = sources.front().lamp;
  const Sampled* known = nullptr;  // of the earlier pose
  if (kept != nullptr && kept->moved != nullptr && lamp != nullptr) {
    const auto found = kept->of_source.find(sources.front().key);
    if (found != kept->of_source.end() && is_same(found->second.lamp, *lamp) &&
        are_same(kept->mirrors, mirrors)) {
      known = &found->second.sampled;
    }
  }
  const auto open_then = [&](std::size_t i) {
    return kept->open_share.empty() ? 1.0 : kept->open_share[i];
  };
  constexpr std::size_t chunk = 256;
  std::vector<std::uint64_t> chunk_rays((patches.count() + chunk - 1) / chunk, 0);
  const auto sample = [&](std::size_t begin, std::size_t end) {
    std::vector<LightSample> samples;
    std::vector<std::size_t> shining;
    for (std::size_t i = begin; i < end; ++i) {
      const auto patch = static_cast<std::uint32_t>(i);
      const double share = open.share.empty() ? 1.0 : open.share[i];
      if (share <= 0.0) continue;
      if (known != nullptr && kept->moved->is_unmoved(i) && open_then(i) == share &&
          is_clear(*kept->moved, *lamp, mirrors, patches, patch)) {
        sampled.illuminance_lx[i] = known->illuminance_lx[i];
        sampled.variance[i] = known->variance[i];
        sampled.rays[i] = known->rays[i];
        chunk_rays[begin / chunk] += known->rays[i];
        continue;
      }
      shining.clear();
      for (std::size_t s = 0; s < each; ++s) {
        if (!sees_nothing_of(sources[s], mirrors, patches, patch)) shining.push_back(s);
      }
      if (shining.empty()) continue;
      std::vector<std::uint32_t> near;
      if (share < 1.0)
        near = open.bodies->near(patches, patch, 2.0 * patch_offset_m(patches, query, patch));
      const base::SobolOwen4 sobol(
          base::Key(seed, base::Stream::DirectLight, i).with(sources.front().key));
      const int points = points_for(sources.front(), patches, patch);
      Receiver receiver(query, each, points);
      int taken = 0;
      for (int k = 0; taken < points && k < most_draws * points; ++k) {
        const auto p = sobol.point(static_cast<std::uint32_t>(k));
        const SurfacePoint from = patches.at(patch, p[0], p[1]);
        if (!near.empty() &&
            open.bodies->cover(lifted(from, query) - open.bodies->centre(), near)) {
          continue;
        }
        for (const std::size_t s : shining) {
          take_samples(sources[s], mirrors, from.position, from.normal, p[2], p[3], samples);
          for (const LightSample& one : samples) receiver.add(s, taken, from, one);
        }
        ++taken;
      }
      receiver.finish();
      if (taken == 0) continue;
      const double n = taken;
      for (const std::size_t s : shining) {
        const double y = base::luminance(receiver.sum(s));
        sampled.illuminance_lx[i * each + s] = receiver.sum(s) / n;
        sampled.variance[i * each + s] =
            std::max(0.0, receiver.sum_of_squares(s) - y * y / n) / (n * std::max(1.0, n - 1.0));
      }
      sampled.rays[i] = static_cast<std::uint32_t>(receiver.rays());
      chunk_rays[begin / chunk] += receiver.rays();
    }
  };
  base::share_chunks(
      patches.count(), chunk, sample,
      [&](std::size_t begin, std::size_t end, base::Parcel& parcel) {
        parcel.pass_range(&sampled.illuminance_lx[begin * each], (end - begin) * each);
        parcel.pass_range(&sampled.variance[begin * each], (end - begin) * each);
        parcel.pass(chunk_rays[begin / chunk]);
      },
      receivers);
  for (const std::uint64_t count : chunk_rays) rays += count;
  if (kept != nullptr && lamp != nullptr) {
    kept->of_source[sources.front().key] = {*lamp, sampled};
  }
  return sampled;
}

}  // namespace earthshine::radiosity
