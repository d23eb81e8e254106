// SPDX-License-Identifier: Apache-2.0
// GatherField's residual paths, and its rays over lobes.
#include <array>

#include "base/ranks/ranks.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/gather/gather_tiles.h"
#include "scenes/reflect/brdf.h"

namespace earthshine::raytrace {

namespace {
constexpr std::uint32_t paths_between_stops = 256;
}

void GatherField::cast_paths(Gathered kind, const std::vector<std::uint32_t>& more,
                             std::uint32_t round, const std::function<bool()>& stop) {
  Estimate& estimate = estimate_[number(kind)];
  const bool lobe = kind == Gathered::Lobe;
  std::vector<RayCounts> counts_of(tile_count(window_));
  std::vector<Notes> notes_of(counts_of.size());
  const auto cast_tile = [&](std::size_t t) {
    PathWalker walker(world_);
    RayCounts& counts = counts_of[t];
    std::array<std::vector<Rgb>, 2> sums;
    std::vector<float> off;
    for (const std::size_t p : points_of_tile(t)) {
      if (stop && stop()) break;
      const GatherPoint& point = points_[p];
      const std::uint32_t each = more[p] / 2;
      const auto first = static_cast<std::uint64_t>(estimate.samples[p]);
      if (point.reach_m <= 0.0F || each == 0) continue;
      if ((lobe ? point.lobe : point.reflectance) <= 0.0F) continue;
      off.assign(notes(p) ? image_layers_ : 0, 0.0F);
      for (std::uint32_t half = 0; half < 2; ++half) {
        std::vector<Rgb>& sum = sums[half];
        sum.assign(image_layers_, Rgb(0.0));
        const base::Key key =
            base::Key(setting_.seed, lobe ? base::Stream::Lobe : base::Stream::Residual,
                      random_number_of(p))
                .with(2 * std::uint64_t{round} + half);
        const base::SobolOwen4 directions(key);
        const RayOrigins origins = draw_origins(kind, p, 2 * round + half, each, counts);
        for (std::uint32_t k = 0; k < each; ++k) {
          // A stop discards the samples of an unfinished point.
          if (k % paths_between_stops == paths_between_stops - 1 && stop && stop()) {
            counts += walker.rays();
            return;
          }
          base::Rng rng(key.with(k));
          walker.select_sun_stratum(random_number_of(p), first / 2 + k,
                                    half);  // neighbours begin at other strata
          const auto u = directions.point2(k);
          const RayStart& start = origins.start[k % origins.count];
          if (lobe) {
            lobe_sample(point.material, start, u, walker, rng, sum, counts);
            continue;
          }
          const auto found = walker.residual_at(incoming_, start.position, Vec3(start.normal),
                                                double(u[0]), double(u[1]), rng);
          for (std::size_t layer = 0; layer < image_layers_; ++layer) sum[layer] += found[layer];
        }
      }
      for (std::uint32_t half = 0; half < 2; ++half) {
        estimate.add(p, sums[half]);
        note_half(half, sums[half], off);
      }
      estimate.add_luminance(p, static_cast<float>(luminance_of(sums[0])),
                             static_cast<float>(luminance_of(sums[1])));
      notes_of[t].add(p, off);
      estimate.samples[p] += static_cast<float>(2 * each);
    }
    counts += walker.rays();
  };
  base::share_loop(counts_of.size(), cast_tile, [&](std::size_t t, base::Parcel& parcel) {
    parcel.pass(counts_of[t]);
    parcel.pass(notes_of[t].point);
    parcel.pass(notes_of[t].off);
    for (const std::size_t p : points_of_tile(t)) estimate.pass(p, parcel);
  });
  for (const RayCounts& tile : counts_of) rays_of_[number(kind)] += tile;
  add_notes(kind, notes_of);
}

// Incident radiance along one ray drawn from the lobe, for k_s = 1.
void GatherField::lobe_sample(std::uint32_t material, const RayStart& start,
                              const std::array<float, 2>& u, PathWalker& walker, base::Rng& rng,
                              std::vector<Rgb>& sum, RayCounts& counts) const {
  const Vec3 origin = start.position, normal(start.normal), along(start.along);
  const scenes::Brdf brdf{world_.scene.materials[material], Rgb(0.0), normal,
                          glm::reflect(along, normal), -glm::dot(along, normal)};
  const auto [direction, share] =
      brdf.sample(scenes::Brdf::Term::Specular, double(u[0]), double(u[1]));
  if (share <= 0.0) return;
  const Rgb weight(share);
  ++counts.lobe;
  const scenes::Hit hit = world_.query.closest(origin, direction);
  incoming_.add(hit, direction, {}, weight, sum, counts);
  if (!setting_.gathers_residual || hit.missed()) return;
  const auto residual = walker.residual(incoming_, {origin, direction}, hit, {}, rng);
  for (std::size_t layer = 0; layer < image_layers_; ++layer)
    sum[layer] += weight * residual[layer];
}

}  // namespace earthshine::raytrace
