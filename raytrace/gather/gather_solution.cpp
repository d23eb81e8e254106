// SPDX-License-Identifier: Apache-2.0
// GatherField's rays that read the radiosity solution.
#include <array>
#include <bit>

#include "base/ranks/ranks.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/gather/gather_tiles.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr std::uint32_t most_rays = 1U << 14U;  // per half
constexpr std::size_t most_factors = 32;        // sets per point; more samples are a power of two

// Rays from some points of a tile that read the solution: their sums per point.
class SolutionRays {
 public:
  SolutionRays(const scenes::RayQuery& query, const IncomingLight& incoming, const GatherRays& rays,
               std::size_t layers, const TilePoints& points)
      : query_(query), incoming_(incoming), rays_(rays), layers_(layers), points_(points) {}

  void run(std::uint64_t seed) {
    sums.assign(points_.count * layers_, Rgb(0.0));
    const std::size_t aimed =
        incoming_.bright().empty()
            ? 0
            : std::max<std::size_t>(1, rays_.rays() / tuning::gather_rays_per_aimed);
    GatherRays::Samples samples;
    for (std::size_t first = 0; first < points_.count; first += rays_.batch()) {
      const std::size_t count = std::min(rays_.batch(), points_.count - first);
      rays_.draw(points_, first, count, seed, samples);
      for (std::size_t j = 0; j < rays_.rays(); ++j) {
        for (std::size_t k = 0; k < count; k += packet_width) {
          cast(first, k, std::min(packet_width, count - k), j, samples, static_cast<double>(aimed));
        }
      }
    }
    for (std::size_t k = 0; k < points_.count; ++k) aim(k, aimed, seed);
    counts.gather += points_.count * (rays_.rays() + aimed);
  }

  std::vector<Rgb> sums;  // point * layers: mean radiance times the rays
  std::array<RayLengths, most_tile_points> lengths{};
  RayCounts counts;

 private:
  void cast(std::size_t first, std::size_t offset, std::size_t count, std::size_t j,
            const GatherRays::Samples& samples, double aimed) {
    RayPacket rays;
    HitPacket hits;
    std::array<float, packet_width> cosine;
    GatherRays::make(points_, first, offset, j, samples, rays, cosine);
    query_.closest(rays, count, hits);
    MisContext share;
    share.cosine_samples = static_cast<double>(rays_.rays());
    share.aimed_rays = aimed;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = first + offset + k;
      const Vec3 direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
      if (aimed > 0.0) {
        const TilePoints::OriginSet& from = points_.set_of(j);
        share.cosine = double(cosine[k]);
        share.from = {from.origin[p], from.normal[p]};
      }
      const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
      const std::span<Rgb> sum(&sums[p * layers_], layers_);
      const double before = luminance_of(sum);
      incoming_.add(hit, direction, share, Rgb(1.0), sum, counts);
      if (!hit.missed()) lengths[p].add(hit.t, luminance_of(sum) - before);
    }
  }

  void aim(std::size_t k, std::size_t count, std::uint64_t seed) {
    base::Rng rng(
        base::Key(seed, base::Stream::FinalGather, points_.pixel[k]).with(rays_.rays()).with(1));
    const auto found = static_cast<double>(rays_.rays());
    for (std::size_t j = 0; j < count; ++j) {
      const double choice = rng.next(), x = rng.next(), y = rng.next();
      const TilePoints::OriginSet& from = points_.set_of(j);
      const auto aimed = incoming_.aim({from.origin[k], from.normal[k]}, choice, x, y, found,
                                       static_cast<double>(count));
      if (aimed.weight <= 0.0) continue;
      const std::span<Rgb> sum(&sums[k * layers_], layers_);
      const double before = luminance_of(sum);
      const scenes::Hit hit = query_.closest(from.origin[k], aimed.direction);
      incoming_.add(hit, aimed.direction, aimed.share, Rgb(aimed.weight * found), sum, counts);
      if (!hit.missed()) lengths[k].add_light(hit.t, luminance_of(sum) - before);
    }
  }

  const scenes::RayQuery& query_;
  const IncomingLight& incoming_;
  const GatherRays& rays_;
  std::size_t layers_;
  const TilePoints& points_;
};

}  // namespace

void GatherField::cast_solution(const std::vector<std::uint32_t>& more, std::uint32_t round,
                                const std::function<bool()>& stop) {
  Estimate& estimate = estimate_[number(Gathered::Solution)];
  const auto rays_for = [&](std::size_t p) {
    const bool wanted = points_[p].reach_m > 0.0F && points_[p].reflectance > 0.0F;
    if (!wanted || more[p] < fewest_samples(Gathered::Solution)) return 0U;
    return std::min(most_rays, std::bit_floor(more[p] / 2));
  };
  std::uint32_t classes = 0;  // every power of two that some point requests
  for (std::size_t p = 0; p < points_.size(); ++p) classes |= rays_for(p);
  for (std::size_t factor = 0; factor < most_factors; ++factor) {
    const std::uint32_t of_class = 1U << factor;
    if ((classes & of_class) == 0) continue;
    const GatherRays rays(of_class);
    std::vector<RayCounts> counts(tile_count(window_));
    std::vector<Notes> notes_of(counts.size());
    const auto cast_tile = [&](std::size_t t) {
      if (stop && stop()) return;
      const auto cast = [&](std::span<const std::size_t> some, std::size_t origins) {
        std::vector<std::vector<float>> off(some.size());
        std::vector<std::array<float, 2>> luminance(some.size());
        for (std::size_t k = 0; k < some.size(); ++k) {
          off[k].assign(notes(some[k]) ? image_layers_ : 0, 0.0F);
        }
        for (std::uint32_t half = 0; half < 2; ++half) {
          TilePoints points(std::min<std::size_t>(origins, of_class));
          for (const std::size_t p : some) {
            points.add(p, random_number_of(p),
                       draw_origins(Gathered::Solution, p, 2 * round + half, of_class, counts[t]),
                       world_.query.centre());
          }
          SolutionRays found(world_.query, incoming_, rays, layers_, points);
          found.run(base::mix64(setting_.seed ^ base::mix64(2 * std::uint64_t{round} + half)));
          for (std::size_t k = 0; k < points.count; ++k) {
            const std::size_t p = points.index[k];
            lengths_[p] += found.lengths[k];
            estimate.add(p, {&found.sums[k * layers_], layers_});
            luminance[k][half] =
                static_cast<float>(luminance_of({&found.sums[k * layers_], image_layers_}));
            estimate.samples[p] += static_cast<float>(of_class);
            note_half(half, {&found.sums[k * layers_], image_layers_}, off[k]);
          }
          counts[t] += found.counts;
        }
        for (std::size_t k = 0; k < some.size(); ++k) {
          estimate.add_luminance(some[k], luminance[k][0], luminance[k][1]);
          notes_of[t].add(some[k], off[k]);
        }
      };
      for (const std::size_t origins : {std::size_t{1}, RayOrigins::most}) {
        std::vector<std::size_t> some;
        for (const std::size_t p : points_of_tile(t)) {
          if (rays_for(p) == of_class && origins_at(p) == origins) some.push_back(p);
        }
        for (std::size_t first = 0; first < some.size(); first += most_tile_points) {
          cast(std::span(some).subspan(first, std::min(most_tile_points, some.size() - first)),
               origins);
        }
      }
    };
    base::share_loop(counts.size(), cast_tile, [&](std::size_t t, base::Parcel& parcel) {
      parcel.pass(counts[t]);
      parcel.pass(notes_of[t].point);
      parcel.pass(notes_of[t].off);
      for (const std::size_t p : points_of_tile(t)) {
        parcel.pass(lengths_[p]);
        estimate.pass(p, parcel);
      }
    });
    for (const RayCounts& tile : counts) rays_of_[number(Gathered::Solution)] += tile;
    add_notes(Gathered::Solution, notes_of);
  }
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (lengths_[p].count > 0.0) {
      points_[p].reach_m = static_cast<float>(lengths_[p].harmonic_mean());
    }
  }
}

}  // namespace earthshine::raytrace
