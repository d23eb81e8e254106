// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/form_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/exact/open_parts.h"
#include "radiosity/patches/patch_offset.h"

namespace earthshine::radiosity {
namespace {

void check(const scenes::Scene& scene, const Patches& patches) {
  for (const Facet& facet : patches.facets) {
    const scenes::Material& material = scene.materials[facet.material];
    if (material.passes_light_on()) {
      throw base::Error(base::Blame::Input, scene.path.string(),
                        "material \"" + material.name + "\" is a mirror or glass",
                        "Exact form factors cannot follow light through mirrors or glass",
                        "Use form factors by rays");
    }
    if (material.has_holes()) {
      throw base::Error(base::Blame::Input, scene.path.string(),
                        "material \"" + material.name + "\" has an opacity mask",
                        "Exact form factors know whole faces", "Use form factors by rays");
    }
  }
  if (patches.count() > most_exact_patches) {
    throw base::Error(base::Blame::Input, scene.path.string(),
                      std::to_string(patches.count()) + " patches",
                      "Exact form factors compare every pair of at most " +
                          std::to_string(most_exact_patches) + " patches",
                      "Raise quality.patch_edge or use form factors by rays");
  }
}

constexpr std::uint32_t gap_rays = 1U << 16;

// Rays of a patch that hit no patch. Rays from covered points are not counted.
struct Open {
  int sky = 0, black = 0, all = 0;
  Rgb radiance{0.0};  // sum over the rays to the sky
};

Open cast_open(const scenes::RayQuery& query, const Patches& patches, std::uint32_t patch,
               std::uint32_t rays, std::uint64_t seed, const SkyRadiance& sky,
               const ClosedBodies* bodies, std::span<const PatchCover> covers) {
  Open open;
  const bool is_whole = covers.empty() || covers[patch].is_whole();
  const base::SobolOwen4 sobol(base::Key(seed, base::Stream::ExactOpening, patch));
  const base::Frame3 frame = base::frame_around(patches.normal(patch));
  // Inset from the patch's edges, where rounding could put the origin behind a neighbour.
  const auto inset = [](float x) { return 1e-4 + (1.0 - 2e-4) * double(x); };
  scenes::RayPacket packet;
  scenes::HitPacket hits;
  Vec3 directions[scenes::RayPacket::width];
  for (std::uint32_t first = 0; first < rays; first += scenes::RayPacket::width) {
    const std::uint32_t count = std::min<std::uint32_t>(scenes::RayPacket::width, rays - first);
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto p = sobol.point(first + k);
      const double r = std::sqrt(double(p[0])), phi = 2.0 * base::pi * double(p[1]);
      directions[k] =
          frame.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - double(p[0]))});
      query.set(packet, k, lifted(patches.at(patch, inset(p[2]), inset(p[3])), query),
                directions[k]);
    }
    query.closest(packet, count, hits);
    for (std::uint32_t k = 0; k < count; ++k) {
      const Vec3 origin(packet.origin_x[k], packet.origin_y[k], packet.origin_z[k]);
      if (!is_whole && bodies->cover(origin, covers[patch].near)) continue;
      ++open.all;
      if (hits.triangle[k] == scenes::no_triangle) {
        ++open.sky;
        if (sky) open.radiance += sky(directions[k]);
        continue;
      }
      const std::uint32_t met =
          patches.find(hits.triangle[k], double(hits.u[k]), double(hits.v[k]), hits.front[k] != 0);
      // A completely covered patch receives nothing.
      if (met == no_patch || (!covers.empty() && covers[met].open <= 0.0)) ++open.black;
    }
  }
  return open;
}

double pair_m2(const PairExchange& pairs, std::size_t i, std::size_t j) {
  if (i == j) return 0.0;
  return pairs.upper_m2[i < j ? pairs.index(i, j) : pairs.index(j, i)];
}

void fill_rows(const PairExchange& pairs, const std::vector<double>& open_m2,
               FormFactors& factors) {
  const std::size_t count = pairs.count;
  const auto factor = [&](std::size_t i, std::size_t j) {
    if (open_m2[i] <= 0.0 || open_m2[j] <= 0.0) return 0.0F;
    return static_cast<float>(std::min(1.0, pair_m2(pairs, i, j) / open_m2[i]));
  };
  std::vector<std::uint64_t> nonzero(count, 0);
  base::parallel_chunks(count, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < count; ++j) nonzero[i] += factor(i, j) > 0.0F ? 1 : 0;
    }
  });
  factors.row_start.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    factors.row_start[i + 1] = factors.row_start[i] + nonzero[i];
  }
  factors.column.resize(factors.row_start[count]);
  factors.hits.resize(factors.row_start[count]);
  base::parallel_chunks(count, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint64_t e = factors.row_start[i];
      for (std::size_t j = 0; j < count; ++j) {
        const float f = factor(i, j);
        if (f <= 0.0F) continue;
        factors.column[e] = static_cast<std::uint32_t>(j);
        factors.hits[e++] = f;
      }
    }
  });
}

double landed_share(const FormFactors& factors, std::size_t i) {
  double landed = 0.0;
  for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
    landed += double(factors.hits[e]);
  }
  return landed;
}

// Largest credible defect of a row sum: rounding to single precision, errors of contour and area
// rules, and estimated errors of partly hidden pairs, which often have one sign (observed: up to a
// dozen times the root of their sum of squares).
double credible_defect(double row_square_error) {
  return 1e-6 + 20.0 * std::sqrt(row_square_error);
}

// 1 - row sum must agree with the open share found by rays. Otherwise errors of factors would end
// in the sky's share, where no row sum shows them.
void check_row(std::size_t i, double landed, const Open& open, double credible,
               ExactReport& report) {
  constexpr double errors_apart = 6.0;
  if (open.all == 0) return;
  const double share = double(open.sky + open.black) / open.all;
  // Binomial, but at least one ray.
  const double error = std::max(std::sqrt(share * (1.0 - share) / open.all), 1.0 / open.all);
  const double apart = std::abs(1.0 - landed - share);
  if (apart <= errors_apart * error + credible) return;
  report.disagreement[i] = apart;
  ++report.disagreeing_rows;
}

// Sets the shares of sky and black backs, and the scale that closes the row exactly.
void close_row(FormFactors& factors, std::size_t i, const Open& open, double credible,
               ExactReport& report) {
  if (!factors.open.share.empty() && factors.open.share[i] <= 0.0) {
    factors.black[i] = factors.lost[i] = 1.0;
    return;
  }
  const double landed = landed_share(factors, i), defect = std::abs(1.0 - landed);
  const int open_rays = open.sky + open.black;
  check_row(i, landed, open, credible, report);
  double rest = 0.0;
  if (landed == 0.0) {
    rest = 1.0;  // sees no patch; overrides single rays
  } else if (open_rays == 0 && defect <= credible) {
    ++report.closed_rows;
    report.max_closed_defect = std::max(report.max_closed_defect, defect);
  } else if (landed > 1.0) {
    ++report.overfull_rows;
    report.max_overfull = std::max(report.max_overfull, landed - 1.0);
  } else {
    rest = 1.0 - landed;
  }
  // Without an open ray the remainder is a gap between surfaces: to the sky.
  const double to_sky = open_rays > 0 ? double(open.sky) / open_rays : 1.0;
  // Binomial, but at least one ray.
  const double n = std::max(1, open_rays);
  report.split_std_error[i] = rest * std::max(std::sqrt(to_sky * (1.0 - to_sky) / n), 1.0 / n);
  factors.sky[i] = factors.escape[i] = rest * to_sky;
  factors.black[i] = factors.lost[i] = rest - factors.sky[i];
  factors.row_scale[i] = landed > 0.0 ? (1.0 - rest) / landed : 1.0;
  // Uses the known share of the sky, not the number of rays that hit it.
  if (open.sky > 0)
    factors.sky_illuminance[i] = open.radiance * (base::pi * factors.sky[i] / open.sky);
}

// Empty result: nothing is covered.
std::vector<PatchCover> find_cover(const scenes::Scene& scene, const scenes::RayQuery& query,
                                   const Patches& patches, const FacetSides& sides,
                                   OpenParts& parts) {
  const auto bodies = std::make_shared<const ClosedBodies>(scene, query.centre());
  std::vector<PatchCover> covers = find_open_parts(*bodies, query, patches, sides);
  if (std::all_of(covers.begin(), covers.end(), [](const auto& c) { return c.is_whole(); })) {
    return {};
  }
  parts.bodies = bodies;
  for (const PatchCover& cover : covers) parts.share.push_back(cover.open);
  return covers;
}

}  // namespace

ExactFormFactors exact_form_factors(const scenes::Scene& scene, const scenes::RayQuery& query,
                                    const Patches& patches, const ExactOptions& options,
                                    const SkyRadiance& sky) {
  check(scene, patches);
  const std::size_t count = patches.count();
  ExactFormFactors result;
  FormFactors& factors = result.factors;
  const std::uint32_t rays =
      std::bit_ceil(static_cast<std::uint32_t>(std::max(1, options.split_rays)));
  factors.rays_per_patch = static_cast<int>(rays);
  factors.ray_count = std::uint64_t{rays} * count;
  factors.row_scale.assign(count, 1.0);
  factors.column_scale.assign(count, 1.0);
  factors.kept.assign(count, 1.0);
  for (auto* share : {&factors.sky, &factors.black, &factors.escape, &factors.lost}) {
    share->assign(count, 0.0);
  }
  factors.sky_illuminance.assign(count, Rgb(0.0));

  const FacetSides sides(patches);
  const std::vector<PatchCover> covers = find_cover(scene, query, patches, sides, factors.open);
  const PairExchange pairs = exchange_of_pairs(patches, sides, covers, options.tolerance);
  fill_rows(pairs, open_areas(factors.open, patches.area_m2), factors);
  std::vector<Open> open(count);
  std::vector<double> credible(count);
  result.report.open_std_error.assign(count, 0.0);
  base::parallel_chunks(count, 1, [&](std::size_t i, std::size_t) {
    credible[i] = credible_defect(pairs.row_square_error[i]);
    if (!covers.empty() && !covers[i].is_whole()) {
      if (covers[i].open <= 0.0) return;
      result.report.open_std_error[i] = covers[i].std_error;
      credible[i] += 4.0 * covers[i].std_error / covers[i].open;
    }
    const auto cast = [&](std::uint32_t ray_count) {
      open[i] = cast_open(query, patches, static_cast<std::uint32_t>(i), ray_count, options.seed,
                          sky, factors.open.bodies.get(), covers);
    };
    cast(rays);
    // Open by more than the credible error, through a gap that few rays find.
    const bool found_none = open[i].sky + open[i].black == 0;
    if (found_none && 1.0 - landed_share(factors, i) > credible[i] && rays < gap_rays) {
      cast(gap_rays);
    }
  });
  result.report.pairs = count < 2 ? 0 : std::uint64_t{count} * (count - 1) / 2;
  result.report.counts = pairs.counts;
  result.report.split_std_error.assign(count, 0.0);
  result.report.disagreement.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    close_row(factors, i, open[i], credible[i], result.report);
    result.report.estimated_error =
        std::max(result.report.estimated_error, std::sqrt(pairs.row_square_error[i]));
  }
  return result;
}

}  // namespace earthshine::radiosity
