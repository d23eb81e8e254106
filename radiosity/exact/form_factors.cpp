// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/form_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "radiosity/exact/open_share.h"
#include "radiosity/patches/patch_offset.h"
#include "scenes/light/lamp_light.h"

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

// Where the rays of a patch end that meet no patch. Those from covered points do not count.
struct Open {
  int sky = 0, black = 0;
  Rgb radiance{0.0};  // sum over the rays to the sky
};

Open cast_open(const scenes::RayQuery& query, const Patches& patches, std::uint32_t patch,
               std::uint32_t rays, std::uint64_t seed, const SkyRadiance& sky,
               const ClosedBodies* bodies = nullptr, std::span<const std::uint32_t> near = {}) {
  Open open;
  const base::SobolOwen4 sobol(base::Key(seed, base::Stream::ExactOpening, patch));
  const base::Frame3 frame = base::frame_around(patches.normal(patch));
  // Off the patch's edges, where rounding could put the origin behind a neighbour.
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
      if (bodies != nullptr && bodies->cover(origin, near)) continue;
      if (hits.triangle[k] == scenes::no_triangle) {
        ++open.sky;
        if (sky) open.radiance += sky(directions[k]);
      } else if (patches.find(hits.triangle[k], double(hits.u[k]), double(hits.v[k]),
                              hits.front[k] != 0) == no_patch) {
        ++open.black;
      }
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

// How far the sum of a row may be from 1 by errors alone: rounding to single precision and the
// contours' and area rules', and what was estimated for partly hidden pairs, whose errors often
// have one sign (found: up to a dozen times the root of their squares' sum).
double credible_defect(double row_square_error) {
  return 1e-6 + 20.0 * std::sqrt(row_square_error);
}

// Shares of sky and black backs, and the scale that makes the row close to the last digit.
void close_row(FormFactors& factors, std::size_t i, const Open& open, double credible,
               ExactReport& report) {
  if (!factors.open.share.empty() && factors.open.share[i] <= 0.0) {
    factors.black[i] = factors.lost[i] = 1.0;
    return;
  }
  const double landed = landed_share(factors, i), defect = std::abs(1.0 - landed);
  const int open_rays = open.sky + open.black;
  double rest = 0.0;
  if (landed == 0.0) {
    rest = 1.0;  // sees no patch, whatever single rays say
  } else if (open_rays == 0 && defect <= credible) {
    ++report.closed_rows;
    report.max_closed_defect = std::max(report.max_closed_defect, defect);
  } else if (landed > 1.0) {
    ++report.overfull_rows;
    report.max_overfull = std::max(report.max_overfull, landed - 1.0);
  } else {
    rest = 1.0 - landed;
  }
  // Where no ray found the way out, it is a gap between surfaces: to the sky.
  const double to_sky = open_rays > 0 ? double(open.sky) / open_rays : 1.0;
  // Binomial, and never less than one ray gone the other way.
  const double n = std::max(1, open_rays);
  report.split_std_error[i] = rest * std::max(std::sqrt(to_sky * (1.0 - to_sky) / n), 1.0 / n);
  factors.sky[i] = factors.escape[i] = rest * to_sky;
  factors.black[i] = factors.lost[i] = rest - factors.sky[i];
  factors.row_scale[i] = landed > 0.0 ? (1.0 - rest) / landed : 1.0;
  // Of the share of the sky, which is known, and not of the rays that happened to find it.
  if (open.sky > 0)
    factors.sky_illuminance[i] = open.radiance * (base::pi * factors.sky[i] / open.sky);
}

// Covered points lie behind black backs, look past everything where no sky shines, or have another
// face on them: only such patches are asked about. None: nothing is covered.
std::vector<PatchCover> find_cover(const scenes::Scene& scene, const scenes::RayQuery& query,
                                   const Patches& patches, const std::vector<Open>& open,
                                   std::uint64_t seed, OpenParts& parts) {
  const bool dark_sky = !scenes::has_light_outside(scene);
  std::vector<std::uint32_t> maybe;
  for (std::uint32_t i = 0; i < open.size(); ++i) {
    if (open[i].black > 0 || (open[i].sky > 0 && dark_sky) ||
        is_covered_by_faces(query.coincident(), patches, i)) {
      maybe.push_back(i);
    }
  }
  if (maybe.empty()) return {};
  const auto bodies = std::make_shared<const ClosedBodies>(scene, query.centre());
  std::vector<PatchCover> covers = measure_cover(*bodies, query, patches, maybe, seed);
  if (std::all_of(covers.begin(), covers.end(), [](const auto& c) { return c.open == 1.0; })) {
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

  std::vector<PatchCover> covers;
  std::vector<Open> open(count);
  std::vector<double> credible(count);
  const auto look_out = [&](std::size_t i, std::uint32_t ray_count) {
    const auto patch = static_cast<std::uint32_t>(i);
    const bool whole = covers.empty() || covers[i].open == 1.0;
    open[i] = cast_open(query, patches, patch, ray_count, options.seed, sky,
                        whole ? nullptr : factors.open.bodies.get(),
                        whole ? std::span<const std::uint32_t>() : covers[i].near);
  };
  base::parallel_chunks(count, 1, [&](std::size_t i, std::size_t) { look_out(i, rays); });
  covers = find_cover(scene, query, patches, open, options.seed, factors.open);

  const PairExchange pairs = exchange_of_pairs(patches, options.tolerance);
  fill_rows(pairs, open_areas(factors.open, patches.area_m2), factors);
  result.report.open_std_error.assign(count, 0.0);
  base::parallel_chunks(count, 1, [&](std::size_t i, std::size_t) {
    credible[i] = credible_defect(pairs.row_square_error[i]);
    if (!covers.empty() && covers[i].open < 1.0) {
      look_out(i, rays);
      result.report.open_std_error[i] = covers[i].std_error;
      credible[i] += 4.0 * covers[i].std_error / std::max(covers[i].open, covers[i].std_error);
    }
    // Open by more than errors can be, through a gap that few rays find.
    const bool found_none = open[i].sky + open[i].black == 0;
    if (found_none && 1.0 - landed_share(factors, i) > credible[i] && rays < gap_rays) {
      look_out(i, gap_rays);
    }
  });
  result.report.pairs = count < 2 ? 0 : std::uint64_t{count} * (count - 1) / 2;
  result.report.counts = pairs.counts;
  result.report.split_std_error.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    close_row(factors, i, open[i], credible[i], result.report);
    result.report.estimated_error =
        std::max(result.report.estimated_error, std::sqrt(pairs.row_square_error[i]));
  }
  return result;
}

}  // namespace earthshine::radiosity
