// SPDX-License-Identifier: Apache-2.0
#include "radiosity/direct/direct.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/direct/shadowed_samples.h"
#include "radiosity/direct/sources.h"
#include "scenes/light/lamp_light.h"

namespace earthshine::radiosity {
namespace {

// Suns of an orbit that share a patch's points: rays from a point to neighbouring Suns are
// coherent.
constexpr std::size_t most_suns = 8;

// Where direct light on a patch ends: all on the patch, or the share SpecularPaths::kept.
struct Landing {
  std::vector<double> area_m2;
  const std::vector<Rgb>& kept;  // per patch; empty: all

  [[nodiscard]] Rgb flux(std::size_t patch, const Rgb& lx) const {
    return area_m2[patch] * (kept.empty() ? lx : kept[patch] * lx);
  }
  // Share, in luminance, that ends on the patch.
  [[nodiscard]] double share(std::size_t patch, const Rgb& lx) const {
    const double all = base::luminance(lx);
    return kept.empty() || all <= 0.0 ? 1.0 : base::luminance(kept[patch] * lx) / all;
  }
};

Rgb landed_as_sampled(const Sampled& sampled, const Landing& landing) {
  Rgb landed(0.0);
  for (std::size_t i = 0; i < landing.area_m2.size(); ++i) {
    landed += landing.flux(i, sampled.illuminance_lx[i]);
  }
  return landed;
}

// The landed flux has two estimates: the patches' samples, and the emitted flux minus the escaped
// flux. Their inverse-variance mean sets the scale. In a closed room nothing escapes and the
// emitted flux is exact; for a small plate under an open sky the samples are more accurate.
double landing_scale(const Sampled& sampled, const Landing& landing, double landed,
                     const SourceFlux& flux) {
  double landed_variance = 0.0;
  for (std::size_t i = 0; i < landing.area_m2.size(); ++i) {
    const double area = landing.area_m2[i], share = landing.share(i, sampled.illuminance_lx[i]);
    landed_variance += area * area * sampled.variance[i] * share * share;
  }
  const double all = base::luminance(flux.emitted_lm);
  const double expected = base::luminance(flux.expected_lm());
  if (landed <= 0.0 || expected <= 0.0) return 1.0;
  const double expected_variance = std::pow(flux.expected_error_lm(), 2);
  const double both = landed_variance + expected_variance;
  if (both <= 0.0) return expected / landed;  // both are exact: uses the flux
  const double found = (landed * expected_variance + expected * landed_variance) / both;
  return std::min(found, all) / landed;
}

// If nothing escapes, each channel lands as emitted: randomly selected lamps of different colours
// have no common scale.
Rgb channel_scales(const SourceFlux& flux, const Rgb& landed) {
  Rgb scale(flux.scale);
  if (flux.escaped_share + flux.back_share > 0.0) return scale;
  for (int c = 0; c < 3; ++c) {
    if (landed[c] > 0.0) scale[c] = flux.emitted_lm[c] / landed[c];
  }
  return scale;
}

struct Shares {
  double escaped = 0.0, black = 0.0, all = 0.0;
  Shares& operator+=(const Shares& o) {
    escaped += o.escaped;
    black += o.black;
    all += o.all;
    return *this;
  }
};

// Follows a ray from a source, reverse to shadow rays: straight through glass, and by one
// reflection in a flat mirror. A ray at a second mirror, inside a glass body, or where faces cover
// a patch counts as absorbed by a black back, because it lights no patch. `weight`: the ray's flux
// per channel; a multicoloured source uses its mean colour.
class SourceRays {
 public:
  SourceRays(const scenes::Scene& scene, const scenes::RayQuery& query, const Patches& patches,
             const OpenParts& open)
      : scene_(scene), query_(query), patches_(patches), open_(open) {}

  void follow(const Vec3& origin, const Vec3& direction, const Rgb& weight, int panes, bool thrown,
              Shares& part) const {
    const scenes::Hit hit = query_.closest(origin, direction);
    if (hit.missed()) {
      part.escaped += base::luminance(weight);
      return;
    }
    const scenes::SpecularPaths::Face* face = query_.specular_paths().face(hit.triangle);
    const bool is_back =
        !hit.front && !scene_.materials[scene_.triangles[hit.triangle].material].two_sided;
    const Rgb through = face != nullptr ? weight * face->through : Rgb(0.0);
    const std::uint32_t mirror =
        face != nullptr ? face->mirror[hit.front ? 0 : 1] : scenes::no_mirror;
    const Rgb reflected = mirror != scenes::no_mirror ? weight * face->reflected : Rgb(0.0);
    if (is_back || is_covered(hit)) part.black += base::luminance(weight - through - reflected);
    if (face == nullptr) return;
    if (panes == scenes::most_panes) {
      part.black += base::luminance(through + reflected);
      return;
    }
    const Vec3 at = scenes::hit_position(scene_, hit);
    const Vec3 lift = (hit.front ? 1.0 : -1.0) * query_.offset_m(hit.triangle) * face->normal;
    if (base::max_component(through) > 0.0) {
      follow(at - lift, direction, through, panes + 1, thrown, part);
    }
    if (mirror == scenes::no_mirror) return;
    if (thrown) {
      part.black += base::luminance(reflected);
    } else {
      follow(at + lift, query_.specular_paths().mirrors()[mirror].reflected(direction), reflected,
             panes + 1, true, part);
    }
  }

 private:
  [[nodiscard]] bool is_covered(const scenes::Hit& hit) const {
    if (open_.share.empty()) return false;
    const std::uint32_t patch = patches_.find(hit.triangle, hit.u, hit.v, hit.front);
    if (patch == no_patch || open_.share[patch] >= 1.0) return false;
    const double offset_m = query_.offset_m(hit.triangle);
    const Vec3 lift = offset_m * patches_.normal(patch);
    return open_.bodies->cover(scenes::hit_position(scene_, hit) + lift - open_.bodies->centre(),
                               open_.bodies->near(patches_, patch, 2.0 * offset_m));
  }

  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const Patches& patches_;
  const OpenParts& open_;
};

// Shoots rays from a source of known flux to estimate the escaped and black-back shares.
void find_shares(const scenes::RayQuery& query, const SourceRays& source_rays, const Emit& emit,
                 std::uint64_t key, int rays, std::uint64_t seed, SourceFlux& flux) {
  const double emitted = base::luminance(flux.emitted_lm);
  if (emitted <= 0.0) return;
  const Rgb colour = flux.emitted_lm / emitted;
  const base::SobolOwen4 sobol(base::Key(seed, base::Stream::LampFlux, key));
  const Shares shares = base::ordered_sum(
      static_cast<std::size_t>(rays), 4096, Shares{}, [&](std::size_t begin, std::size_t end) {
        Shares part;
        for (std::size_t k = begin; k < end; ++k) {
          const auto p = sobol.point(static_cast<std::uint32_t>(k));
          const scenes::EmittedRay ray = emit(p[0], p[1], p[2], p[3]);
          if (ray.weight <= 0.0) continue;
          part.all += ray.weight;
          const Vec3 origin =
              ray.origin + ray.lift_m + ray.direction * query.offset_at_m(ray.origin);
          source_rays.follow(origin, ray.direction, ray.weight * colour, 0, false, part);
        }
        return part;
      });
  if (shares.all <= 0.0) return;
  flux.escaped_share = shares.escaped / shares.all;
  flux.back_share = shares.black / shares.all;
  const double p = std::min(1.0, flux.escaped_share + flux.back_share);
  flux.share_std_error = std::sqrt(p * (1.0 - p) / rays);
}

class DirectStage {
 public:
  DirectStage(const scenes::Scene& scene, const scenes::RayQuery& query, const Patches& patches,
              const FormFactors& factors, const DirectOptions& options, DirectLight& light)
      : scene_(scene),
        query_(query),
        patches_(patches),
        factors_(factors),
        own_(factors.shares.own(patches.count())),
        landing_{factors.shares.is_root() ? open_areas(factors.open, patches.area_m2)
                                          : std::vector<double>(),
                 factors.kept_direct},
        options_(options),
        light_(light) {
    light_.illuminance_lx.assign((own_.end - own_.begin) * light_.columns, 0.0);
  }

  // Sources of unknown flux (the sky): as sampled.
  void add(std::span<const Source> sources) { store(sample(sources), sources, Rgb(1.0)); }

  void add(const Source& source, SourceFlux flux, const Emit& emit) {
    Sampled sampled = sample({&source, 1});
    Rgb scale(0.0);
    if (factors_.shares.is_root()) {
      find_shares(query_, {scene_, query_, patches_, factors_.open}, emit, source.key,
                  options_.flux_rays, options_.seed, flux);
      light_.shadow_rays += static_cast<std::uint64_t>(options_.flux_rays);
      const Rgb landed = landed_as_sampled(sampled, landing_);
      flux.scale = landing_scale(sampled, landing_, base::luminance(landed), flux);
      scale = channel_scales(flux, landed);
      flux.landed_lm = scale * landed;
      light_.sources.push_back(std::move(flux));
    }
    factors_.shares.broadcast(&scale, 1);
    store(std::move(sampled), {&source, 1}, scale);
  }

  // Stores one of the `parts` values of each patch.
  void store_part(const std::vector<Rgb>& illuminance, std::size_t parts, std::size_t part,
                  std::size_t group) {
    for (std::size_t row = 0; row < own_.end - own_.begin; ++row) {
      add(row, group, illuminance[(own_.begin + row) * parts + part]);
    }
  }

 private:
  [[nodiscard]] Sampled sample(std::span<const Source> sources) const {
    return sample_patches(query_, patches_, factors_.open, sources, options_.seed,
                          light_.shadow_rays, factors_.shares.receivers(), options_.kept);
  }

  // Stores the samples that the first rank has.
  void store(Sampled sampled, std::span<const Source> sources, const Rgb& scale) {
    factors_.shares.scatter(sampled.illuminance_lx.data(), sources.size());
    for (std::size_t row = 0; row < own_.end - own_.begin; ++row) {
      for (std::size_t s = 0; s < sources.size(); ++s) {
        add(row, sources[s].group, scale * sampled.illuminance_lx[row * sources.size() + s]);
      }
    }
  }

  void add(std::size_t row, std::size_t group, const Rgb& illuminance) {
    for (int c = 0; c < 3; ++c) {
      light_.illuminance_lx[row * light_.columns + 3 * group + static_cast<std::size_t>(c)] +=
          illuminance[c];
    }
  }

  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const Patches& patches_;
  const FormFactors& factors_;
  base::Shares::Range own_;
  Landing landing_;
  const DirectOptions& options_;
  DirectLight& light_;
};

}  // namespace

bool SourceFlux::is_accounted_for() const {
  constexpr double errors_apart = 6.0, rounding = 1e-9;
  const double off = std::abs(base::luminance(landed_lm - expected_lm()));
  return off <= errors_apart * expected_error_lm() + rounding * base::luminance(emitted_lm);
}

Rgb SourceFlux::escaped_lm() const {
  const double ended = escaped_share + back_share;
  if (ended <= 0.0) return Rgb(0.0);
  return is_accounted_for() ? (escaped_share / ended) * (emitted_lm - landed_lm)
                            : escaped_share * emitted_lm;
}

Rgb SourceFlux::lost_lm() const {
  const double ended = escaped_share + back_share;
  if (ended <= 0.0) return Rgb(0.0);
  return is_accounted_for() ? (back_share / ended) * (emitted_lm - landed_lm)
                            : back_share * emitted_lm;
}

DirectLight direct_light(const scenes::World& world, const Patches& patches,
                         const FormFactors& factors, const DirectOptions& options) {
  DirectLight light;
  light.columns = 3 * world.groups.count();
  DirectStage stage(world.scene, world.query, patches, factors, options, light);
  if (world.effects.earth_by_gather) {
    const std::size_t parts = factors.sky_illuminance.size() / patches.count();
    for (std::size_t part = 0; part < parts; ++part) {
      stage.store_part(factors.sky_illuminance, parts, part, world.groups.earth + part);
    }
  }
  std::vector<Source> suns;  // that share points
  std::vector<LightSource> sources = find_sources(world, options.points_per_patch);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    LightSource& light_source = sources[k];
    const auto start = std::chrono::steady_clock::now();
    const std::uint64_t before = light.shadow_rays;
    if (light_source.emit) {
      SourceFlux flux;
      flux.name = std::move(light_source.name);
      flux.group = light_source.source.group;
      flux.emitted_lm = light_source.flux_lm;
      stage.add(light_source.source, std::move(flux), light_source.emit);
    } else if (light_source.source.disc) {
      suns.push_back(std::move(light_source.source));
      const bool more = k + 1 < sources.size() && sources[k + 1].source.disc;
      if (more && suns.size() < most_suns) continue;
      stage.add(suns);
      suns.clear();
    } else {
      stage.add({&light_source.source, 1});
    }
    SourceCost& cost = light.cost[static_cast<std::size_t>(light_source.kind)];
    cost.rays += light.shadow_rays - before;
    cost.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return light;
}

}  // namespace earthshine::radiosity
