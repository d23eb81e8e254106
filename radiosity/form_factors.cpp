// SPDX-License-Identifier: Apache-2.0
#include "radiosity/form_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "radiosity/hit_counter.h"
#include "radiosity/hit_targets.h"
#include "radiosity/patch_rays.h"
#include "scenes/specular.h"

namespace earthshine::radiosity {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr int most_specular_steps = 64;

// What one row found beside its hits.
struct Row {
  std::uint32_t entries = 0;
  double black = 0.0, sky = 0.0;  // in rays
  Rgb sky_illuminance{0.0};
  std::uint64_t rays = 0;
};

// The rows of one chunk of patches, side by side.
struct Band {
  std::vector<Row> rows;
  std::vector<double> back_hits;         // per object
  std::vector<std::uint32_t> backs_met;  // of the row in progress: the objects
  std::vector<std::uint32_t> column;
  std::vector<float> hits;
};

std::vector<bool> materials_that_pass_on(const scenes::Scene& scene) {
  std::vector<bool> passes_on;
  for (const scenes::Material& m : scene.materials) {
    passes_on.push_back(m.passes_light_on() || base::max_component(m.transmit) > 0.0);
  }
  return passes_on;
}

class Caster {
 public:
  Caster(const scenes::Scene& scene, const scenes::RayQuery& query, const Patches& patches,
         const std::vector<double>& kept, const FormFactorOptions& options, std::uint32_t rays,
         const SkyRadiance& sky)
      : scene_(scene),
        query_(query),
        patches_(patches),
        kept_(kept),
        sky_(sky),
        seed_(options.seed),
        replicate_(options.replicate),
        rays_(patches, query, rays),
        targets_(patches, materials_that_pass_on(scene)) {}

  void cast(std::uint32_t patch, HitCounter& counter, Band& band) const {
    Row row;
    base::Key key(seed_, base::Stream::FormFactor, patch);
    if (replicate_ != 0) key = key.with(replicate_);
    const PatchRays::Sender sender = rays_.sender(patch, key);
    // A packet's hits are counted after the next packet was traced: by then what they need has come
    // from memory.
    RayPacket packets[2];
    HitPacket hits[2];
    const std::uint32_t count = rays_.count() / RayPacket::width;
    for (std::uint32_t n = 0; n <= count; ++n) {
      if (n < count) {
        rays_.make(sender, n * RayPacket::width, packets[n % 2]);
        query_.closest(packets[n % 2], RayPacket::width, hits[n % 2]);
        for (const std::uint32_t triangle : hits[n % 2].triangle) targets_.prefetch(triangle);
      }
      if (n > 0) count_hits(packets[(n - 1) % 2], hits[(n - 1) % 2], row, counter, band);
    }
    row.rays += rays_.count();
    if (is_exposed(row.black / rays_.count())) {
      for (const std::uint32_t object : band.backs_met) band.back_hits[object] += 1.0;
    }
    band.backs_met.clear();
    const std::size_t before = band.column.size();
    counter.take(band.column, band.hits);
    row.entries = static_cast<std::uint32_t>(band.column.size() - before);
    row.sky_illuminance *= base::pi / rays_.count();
    band.rows.push_back(row);
  }

 private:
  void count_hits(const RayPacket& packet, const HitPacket& hits, Row& row, HitCounter& counter,
                  Band& band) const {
    for (std::size_t k = 0; k < RayPacket::width; ++k) {
      const std::uint32_t triangle = hits.triangle[k];
      if (triangle == scenes::no_triangle) {
        row.sky += 1.0;
        if (sky_) row.sky_illuminance += sky_(direction(packet, k));
        continue;
      }
      if (targets_.passes_on(triangle)) {
        follow(packet, k, {triangle, hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0}, row,
               counter);
        continue;
      }
      const std::uint32_t to = targets_.find(triangle, hits.u[k], hits.v[k], hits.front[k] != 0);
      if (to == no_patch) {
        row.black += 1.0;
        band.backs_met.push_back(scene_.triangles[triangle].object);
      } else {
        counter.add(to, 1.0F);
      }
    }
  }

  static Vec3 direction(const RayPacket& packet, std::size_t k) {
    return {packet.direction_x[k], packet.direction_y[k], packet.direction_z[k]};
  }

  // Counts a hit on a mirror or glass and the hits behind it.
  void follow(const RayPacket& packet, std::size_t lane, scenes::Hit hit, Row& row,
              HitCounter& counter) const {
    Vec3 way = direction(packet, lane);
    float weight = 1.0F;
    for (int step = 0;; ++step) {
      if (hit.missed()) {
        row.sky += weight;
        if (sky_) row.sky_illuminance += double(weight) * sky_(way);
        return;
      }
      const std::uint32_t to = patches_.find(hit.triangle, hit.u, hit.v, hit.front);
      const scenes::Material& material = scene_.materials[scene_.triangles[hit.triangle].material];
      const bool glass = base::max_component(material.transmit) > 0.0;
      if (to == no_patch && !glass) {
        row.black += weight;
        return;
      }
      // The inside of a glass body passes light on as its outside does, and is no patch of its own.
      const double passed_on = to == no_patch ? 1.0 : 1.0 - kept_[to];
      if (to != no_patch) counter.add(to, weight);
      weight *= static_cast<float>(passed_on);
      if (weight <= 0.0F) return;
      if (step == most_specular_steps) {
        // What is left of the weight stays where it is: no light may end that nothing absorbs.
        if (to != no_patch && kept_[to] > 0.0) {
          counter.add(to, weight / static_cast<float>(kept_[to]));
        } else {
          row.black += weight;
        }
        return;
      }
      const scenes::SpecularStep on =
          scenes::specular_step(scene_, hit, way, query_.surface_offset_m());
      way = on.direction;
      hit = query_.closest(on.origin, way);
      ++row.rays;
    }
  }

  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const Patches& patches_;
  const std::vector<double>& kept_;
  const SkyRadiance& sky_;
  std::uint64_t seed_;
  std::uint32_t replicate_;
  PatchRays rays_;
  HitTargets targets_;
};

// a = 1 - mirror - transmit, as luminance: one matrix serves the three channels.
std::vector<double> kept_shares(const scenes::Scene& scene, const Patches& patches) {
  std::vector<double> kept(patches.count());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const scenes::Material& m = scene.materials[patches.material(static_cast<std::uint32_t>(i))];
    kept[i] = m.passes_light_on()
                  ? std::clamp(1.0 - base::luminance(m.mirror + m.transmit), 0.0, 1.0)
                  : 1.0;
  }
  return kept;
}

// Joins the bands and leaves them empty.
void assemble(std::vector<Band>& bands, FormFactors& factors) {
  std::size_t i = 0;
  factors.row_start[0] = 0;
  for (const Band& band : bands) {
    for (const Row& row : band.rows) {
      factors.row_start[i + 1] = factors.row_start[i] + row.entries;
      factors.sky_illuminance[i] = row.sky_illuminance;
      factors.ray_count += row.rays;
      ++i;
    }
    for (std::size_t o = 0; o < band.back_hits.size(); ++o) {
      factors.back_hits[o] += band.back_hits[o];
    }
  }
  factors.column.resize(factors.row_start[i]);
  factors.hits.resize(factors.row_start[i]);
  std::ptrdiff_t at = 0;
  for (Band& band : bands) {
    std::copy(band.column.begin(), band.column.end(), factors.column.begin() + at);
    std::copy(band.hits.begin(), band.hits.end(), factors.hits.begin() + at);
    at += static_cast<std::ptrdiff_t>(band.column.size());
    band.column = {};
    band.hits = {};
  }
}

// The shares of sky and black backs, and the row scale that makes the row close to the last digit.
void close_row(FormFactors& factors, std::size_t i, double sky_rays, double black_rays) {
  double landed = 0.0;  // rays that end on patches, mirrors' shares left out
  for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
    landed += double(factors.hits[e]) * factors.kept[factors.column[e]];
  }
  // Equal to the number of rays but for the rounding of mirrors' weights.
  const double all = landed + sky_rays + black_rays;
  factors.row_scale[i] = 1.0 / all;
  factors.sky[i] = factors.escape[i] = sky_rays / all;
  factors.black[i] = factors.lost[i] = black_rays / all;
}

}  // namespace

FormFactors cast_form_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                              const Patches& patches, const FormFactorOptions& options,
                              const SkyRadiance& sky) {
  std::vector<std::uint32_t> rows(patches.count());
  std::iota(rows.begin(), rows.end(), 0U);
  return cast_rows(scene, query, patches, rows, options, sky);
}

FormFactors cast_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                      const Patches& patches, std::span<const std::uint32_t> rows,
                      const FormFactorOptions& options, const SkyRadiance& sky) {
  const std::size_t count = rows.size();
  FormFactors factors;
  factors.rays_per_patch = static_cast<int>(
      std::bit_ceil(std::max(static_cast<std::uint32_t>(std::max(1, options.rays_per_patch)),
                             static_cast<std::uint32_t>(RayPacket::width))));
  factors.kept = kept_shares(scene, patches);
  factors.sky.assign(count, 0.0);
  factors.black.assign(count, 0.0);
  factors.escape.assign(count, 0.0);
  factors.lost.assign(count, 0.0);
  factors.row_scale.assign(count, 0.0);
  factors.column_scale.assign(patches.count(), 1.0);
  factors.sky_illuminance.assign(count, Rgb(0.0));

  factors.row_start.assign(count + 1, 0);
  factors.back_hits.assign(scene.objects.size(), 0.0);

  constexpr std::size_t band_rows = 64;
  std::vector<Band> bands((count + band_rows - 1) / band_rows);
  const Caster caster(scene, query, patches, factors.kept, options,
                      static_cast<std::uint32_t>(factors.rays_per_patch), sky);
  base::parallel_chunks(bands.size(), 1, [&](std::size_t begin, std::size_t end) {
    thread_local HitCounter counter(0);
    if (counter.patches() < patches.count()) counter = HitCounter(patches.count());
    for (std::size_t band = begin; band < end; ++band) {
      bands[band].back_hits.assign(scene.objects.size(), 0.0);
      for (std::size_t i = band * band_rows; i < std::min(count, (band + 1) * band_rows); ++i) {
        caster.cast(rows[i], counter, bands[band]);
      }
    }
  });
  assemble(bands, factors);
  std::size_t i = 0;
  for (const Band& band : bands) {
    for (const Row& row : band.rows) close_row(factors, i++, row.sky, row.black);
  }
  return factors;
}

}  // namespace earthshine::radiosity
