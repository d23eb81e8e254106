// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/patches/patch_offset.h"
#include "radiosity/patches/split.h"
#include "raytrace/surfaces/patch_sampler.h"
#include "raytrace/surfaces/residual_sums.h"
#include "scenes/reflect/energy.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

constexpr int source_points = 16;  // by radiosity::find_sources() for a small distant source
constexpr std::size_t wide_source_samples = 4;
constexpr std::size_t patches_between_reports = 1024;  // patches between calls of progress
// Candidates per sampled point on a partly covered patch. They give the open share, the weight of
// the patch, accurately.
constexpr std::uint32_t tried_points = 16;
// Independent rays of a point, over the hemisphere and to each source, for its weight if its halves
// disagree.
constexpr std::uint32_t weighing_gather_rays = 16, weighing_shadow_rays = 16;

Rgb sum_of_groups(const std::vector<float>& values, std::size_t patch, std::size_t columns) {
  Rgb sum(0.0);
  for (std::size_t k = 0; k < columns; ++k) {
    sum[static_cast<int>(k % 3)] += double(values[patch * columns + k]);
  }
  return sum;
}

}  // namespace

scenes::Hit hit_at(const radiosity::Patches& patches, std::uint32_t patch, double x, double y) {
  const radiosity::Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.is_cluster() || patches.is_part(patch)) {
    const auto [triangle, u, v] = patches.on_triangle(patch, x, y);
    scenes::Hit hit;
    hit.triangle = triangle;
    hit.u = u;
    hit.v = v;
    hit.front = patches.is_back[patch] == 0;
    return hit;
  }
  const radiosity::Rectangle r = patches.rectangle(patch);
  const double t = r.t0 + y * (r.t1 - r.t0);
  scenes::Hit hit;
  hit.triangle = facet.triangle;
  hit.front = patches.is_back[patch] == 0;
  if (facet.parallelogram) {
    hit.u = r.s0 + x * (r.s1 - r.s0) - t;
    hit.v = t;
    return hit;
  }
  const double s = std::sqrt(r.s0 * r.s0 + x * (r.s1 * r.s1 - r.s0 * r.s0));
  std::array<double, 3> weight{};
  weight[facet.apex] = 1.0 - s;
  weight[(facet.apex + 1U) % 3U] = s * (1.0 - t);
  weight[(facet.apex + 2U) % 3U] = s * t;
  hit.u = weight[1];
  hit.v = weight[2];
  return hit;
}

SurfaceSampler::SurfaceSampler(const scenes::World& scene, std::uint64_t seed)
    : scene_(scene),
      seed_(seed),
      sources_(radiosity::find_sources(scene, source_points)),
      reflectances_(scene.scene),
      is_explicit_(radiosity::emitter_is_explicit(scene.scene)) {
  for (const scenes::Material& m : scene.scene.materials) {
    kept_.push_back(m.passes_light_on()
                        ? std::clamp(1.0 - base::luminance(m.mirror + m.transmit), 0.0, 1.0)
                        : 1.0);
  }
}

void SurfaceSampler::weigh(PatchSampler& sampler, std::span<const SurfaceSpot> places,
                           base::Key key, double mean, ResidualSums& sums, std::size_t points,
                           bool gathers) const {
  const std::size_t gather_key = 6 + 3 * sources_.size();  // after the aims of sample()
  for (std::size_t point = 0; point < points; ++point) {
    if (!sums.is_unsure(point, mean)) continue;
    sampler.start(1);
    if (gathers) {
      sampler.gather(places[point], base::SobolOwen4(key.with(gather_key)),
                     base::SobolOwen4(key.with(gather_key + 1)), point, weighing_gather_rays, 0);
    }
    for (std::size_t k = 0; k < sources_.size(); ++k) {
      const radiosity::Source& source = sources_[k].source;
      const std::size_t rays = source.has_size ? weighing_shadow_rays : 1;
      sampler.sample_source(source, places[point],
                            base::SobolOwen4(key.with(4 + 2 * sources_.size() + k)), point * rays,
                            rays, 0, false);
    }
    sampler.finish_shadows();
    Rgb lamps(0.0), gathered(0.0);
    for (const Rgb& l : sampler.lamps(0)) lamps += l;
    for (const Rgb& l : sampler.gathered(0)) gathered += l;
    sums.weigh_by(point, lamps, gathered);
  }
}

SurfaceSamples SurfaceSampler::sample(const SurfaceLight& light,
                                      std::span<const std::uint32_t> which,
                                      std::span<const SampleBudget> budget, std::uint32_t pass,
                                      double mean, const radiosity::ClosedBodies* bodies,
                                      const Progress& progress, SamplesOf of,
                                      base::Receivers receivers) const {
  const radiosity::Patches& patches = light.solution.patches;
  const std::size_t groups = light.columns() / 3, columns = light.columns();
  const std::size_t sky_parts =
      scene_.effects.earth_by_gather ? scenes::earth_parts(scene_.scene) : 0;
  const bool gathers =
      std::any_of(budget.begin(), budget.end(), [](const SampleBudget& e) { return e.rays > 0; });
  const LeakMask sight(scene_.query, patches);
  RadianceTable table;
  BrightPatches bright;
  if (gathers) {
    table = {light.solution, light.solution.radiosity, true, sight};
    bright = BrightPatches(light.solution);
  }
  // Without groups: both parts of L~ at a point.
  const RadianceTable lamps_table(light.solution, light.lamps, false, sight),
      gathered_table(light.solution, light.gathered, false, sight);

  const std::size_t aims_key = 4 + 3 * sources_.size();  // after the keys of shadow rays in weigh()
  const bool of_light = of == SamplesOf::Light;
  const bool is_root =
      receivers == base::Receivers::All || base::ranks() == nullptr || base::ranks()->number() == 0;
  SurfaceSamples found;
  if (of_light) {
    found.lamps.assign(light.count() * columns, 0.0);
    found.gathered.assign(light.count() * columns, 0.0);
    found.sky.assign(light.count() * sky_parts, Rgb(0.0));
    found.escaped.assign(light.count(), 0.0);
    found.lost.assign(light.count(), 0.0);
  }
  if (is_root) found.residual.resize(light.count());
  found.rays = sight.rays();
  constexpr std::size_t chunk = 32;  // patches; patches_between_reports is a multiple of it
  std::vector<std::uint64_t> rays_of((which.size() + chunk - 1) / chunk, 0);
  // Ranks wait for each other at the end of a batch: few batches if there are ranks.
  const std::size_t batch = base::ranks() == nullptr ? patches_between_reports
                                                     : std::max(patches_between_reports,
                                                                which.size() / (8 * chunk) * chunk);
  std::vector<PatchResidual> seen(std::min(batch, which.size()));  // of a batch
  const auto sample_chunk = [&](std::size_t begin, std::size_t end) {
    PatchSampler sampler(scene_, kept_, table, bright, groups, sky_parts);
    std::vector<std::uint32_t> near;
    std::vector<SurfaceSpot> places;
    ResidualSums sums;
    for (std::size_t n = begin; n < end; ++n) {
      const std::uint32_t patch = which[n];
      const SampleBudget& work = budget[n];
      const std::uint32_t material = patches.material(patch);
      const Rgb rho = reflectances_.of(patches, patch),
                emitted = is_explicit_[material]
                              ? Rgb(0.0)
                              : radiosity::patch_emit(scene_.scene, patches, patch);
      PatchResidual& residual = seen[n % batch];
      residual.taken = work.points;
      if (base::max_component(rho) <= 0.0) continue;  // B = M, whatever its illuminance
      const base::Key key =
          base::Key(seed_, base::Stream::ErrorBudget, radiosity::identity(patches, patch))
              .with(pass);
      // For the product of their means, both halves of a spot's points are independent.
      const std::array<base::SobolOwen4, 2> where = {base::SobolOwen4(key),
                                                     base::SobolOwen4(key.with(1))};
      const bool is_spot = light.is_spot(patch);
      std::array<std::uint32_t, 2> next{};
      near.clear();
      if (bodies != nullptr) {
        near = bodies->near(patches, patch,
                            2.0 * radiosity::patch_offset_m(patches, scene_.query, patch));
      }
      sampler.start(work.points);
      sums.start(work.points);
      places.resize(work.points);
      residual.taken = 0;
      const double known = light.open_share.empty() ? 1.0 : light.open_share[patch];
      const std::uint32_t tries = (known > 0.0 && known < 1.0 ? tried_points : 1) * work.points;
      std::uint32_t open = 0;
      for (std::uint32_t n_try = 0; n_try < tries; ++n_try) {
        const std::size_t set = is_spot ? residual.taken % 2 : 0;
        const auto p = where[set].point2(next[set]++);
        const auto [at, normal, triangle] = patches.at(patch, double(p[0]), double(p[1]));
        const Vec3 lift = scene_.query.offset_m(triangle) * normal;
        if (!near.empty() && bodies->cover(at + lift - bodies->centre(), near)) continue;
        ++open;
        if (residual.taken == work.points) continue;
        const std::size_t point = residual.taken++;
        places[point] = {at, normal, lift};
        for (std::size_t k = 0; k < sources_.size(); ++k) {
          const radiosity::Source& source = sources_[k].source;
          const std::size_t wide = source.points > source_points ? wide_source_samples : 1;
          const std::size_t samples =
              source.has_size ? std::max<std::size_t>(light.shadow_rays[patch], wide) : 1;
          for (std::size_t half = 0; half < (source.has_size ? 2U : 1U); ++half) {
            sampler.sample_source(source, places[point],
                                  base::SobolOwen4(key.with(4 + 2 * k + half)), point * samples,
                                  samples, 2 * point + half, !source.has_size);
          }
        }
        for (std::size_t half = 0; half < 2; ++half) {
          if (work.rays == 0) break;
          sampler.gather(places[point], base::SobolOwen4(key.with(2 + half)),
                         base::SobolOwen4(key.with(aims_key + half)), point, work.rays,
                         2 * point + half);
        }
        std::array<Rgb, 1> lamps{Rgb(0.0)}, gathered{Rgb(0.0)};
        if (is_spot) {
          lamps[0] = sum_of_groups(light.lamps, patch, columns);
          gathered[0] = sum_of_groups(light.gathered, patch, columns);
        } else {
          const scenes::Hit here = hit_at(patches, patch, double(p[0]), double(p[1]));
          lamps_table.add(here, Rgb(base::pi), lamps);
          gathered_table.add(here, Rgb(base::pi), gathered);
        }
        sums.place(point, double(p[0]), double(p[1]), rho, emitted + rho * (lamps[0] + gathered[0]),
                   lamps[0], work.rays > 0 ? gathered[0] : Rgb(0.0));
      }
      sampler.finish_shadows();
      residual.open = static_cast<float>(open) / static_cast<float>(tries);
      if (residual.taken == 0) continue;
      const double share = 0.5 / residual.taken;
      if (of_light) {
        found.escaped[patch] = share * sampler.escaped();
        found.lost[patch] = share * sampler.lost();
      }
      for (std::size_t point = 0; point < residual.taken; ++point) {
        for (std::size_t half = 0; half < 2; ++half) {
          const std::size_t entry = 2 * point + half;
          Rgb lamps(0.0), gathered(0.0);
          for (std::size_t g = 0; g < groups; ++g) {
            const Rgb &l = sampler.lamps(entry)[g], &t = sampler.gathered(entry)[g];
            lamps += l;
            gathered += t;
            for (int c = 0; of_light && c < 3; ++c) {
              const std::size_t at = patch * columns + 3 * g + static_cast<std::size_t>(c);
              found.lamps[at] += share * l[c];
              found.gathered[at] += share * t[c];
            }
          }
          for (std::size_t s = 0; of_light && s < sky_parts; ++s) {
            found.sky[patch * sky_parts + s] += share * sampler.sky(entry)[s];
          }
          sums.set(point, half, lamps, gathered);
        }
      }
      weigh(sampler, places, key, mean, sums, residual.taken, work.rays > 0);
      sums.finish(mean, residual);
    }
    rays_of[begin / chunk] += sampler.rays();
  };
  const auto transfer = [&](std::size_t begin, std::size_t end, base::Parcel& parcel) {
    parcel.pass_range(&seen[begin % batch], end - begin);
    for (std::size_t k = begin; of_light && k < end; ++k) {
      const std::size_t patch = which[k];
      parcel.pass_range(&found.lamps[patch * columns], columns);
      parcel.pass_range(&found.gathered[patch * columns], columns);
      parcel.pass_range(&found.sky[patch * sky_parts], sky_parts);
      parcel.pass(found.escaped[patch]);
      parcel.pass(found.lost[patch]);
    }
    parcel.pass(rays_of[begin / chunk]);
  };
  for (std::size_t first = 0; first < which.size(); first += batch) {
    const std::size_t count = std::min(batch, which.size() - first);
    const auto begin_of = [&](std::size_t k) { return first + std::min(count, k * chunk); };
    std::fill(seen.begin(), seen.end(), PatchResidual());
    base::share_loop((count + chunk - 1) / chunk,
                     [&](std::size_t k) { sample_chunk(begin_of(k), begin_of(k + 1)); },
                     [&](std::size_t k, base::Parcel& parcel) {
                       transfer(begin_of(k), begin_of(k + 1), parcel);
                     },
                     receivers);
    for (std::size_t k = 0; is_root && k < count; ++k) found.residual[which[first + k]] = seen[k];
    if (progress) progress(first + count, which.size());
  }
  for (const std::uint64_t rays : rays_of) found.rays += rays;
  if (receivers == base::Receivers::Root)
    base::ranks()->broadcast(&found.rays, sizeof found.rays, 0);
  return found;
}

}  // namespace earthshine::raytrace
