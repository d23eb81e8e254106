// SPDX-License-Identifier: Apache-2.0
// Form factors by rays: F_ij, the share of the light that leaves patch i and arrives at patch j.
//
// Each patch casts N rays, or a multiple that depends on its object (know_objects): Owen-Sobol
// points in position x cosine direction. Stored are hit counts n_ij (sparse rows) and two vectors
// of scales, F_ij = row_scale_i n_ij column_scale_j. Misses and hits of black backs have separate
// columns, so that closure holds to rounding:
//   sum_j a_j F_ij + F_i,sky + F_i,black = 1,    a_j = 1 - mirror_j - transmit_j
// A ray that hits a mirror or glass counts there with its weight and continues with weight *
// (mirror + transmit); a_j = 1 everywhere else.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/ranks/shares.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {

struct KeptRows;  // kept_rows.h

struct FormFactorOptions {
  int rays_per_patch = 1024;  // rounded up to a power of two, 8 or more
  std::uint64_t seed = 1;
  std::uint32_t replicate = 0;  // each number gives an independent set of samples
  // Points of a patch inside a body (closed_bodies.h) cast no rays: the row is the mean over the
  // open points, whose share is FormFactors::open. false: they count like other points.
  bool leave_out_covered = false;
  // Patches of objects with few patches cast more rays each (patch_rays.h).
  bool know_objects = false;
  const scenes::SkyCells* sky_cells = nullptr;  // sky light is stored for each cell
  KeptRows* kept = nullptr;                     // rows of an earlier pose, replaced by this one's
  std::shared_ptr<const ClosedBodies> bodies = {};  // of the scene; null: made on demand
};

struct FormFactors {
  int rays_per_patch = 0;                // minimum over patches
  std::uint64_t ray_count = 0;           // all rays, including continuations
  base::Shares shares;                   // which rank has which rows of entries; all else is on all
  std::vector<std::uint64_t> row_start;  // count + 1; rows of other ranks are empty
  std::vector<std::uint32_t> column;     // ascending within a row
  std::vector<float> hits;               // integers except for mirrors and glass
  std::vector<double> row_scale, column_scale;
  std::vector<double> sky, black;    // F_i,sky and F_i,black: shares of patch i's view
  std::vector<double> escape, lost;  // shares of j's light to the sky, to black backs
  std::vector<double> kept;          // a_j per patch
  std::vector<Rgb> kept_direct;      // share of direct light that ends on a patch
                                     // (scenes/specular_paths.h); empty: all
  std::vector<double>
      back_hits;  // per object of the scene: rays of exposed patches that hit its back
  std::vector<Rgb> sky_illuminance;  // per patch, or per patch and cell of the sky, lx: pi times
                                     // the mean over all rays of the sky's radiance; empty: dark
  // The row of a completely covered patch has no entries; black = lost = 1.
  OpenParts open;

  [[nodiscard]] std::size_t count() const { return sky.size(); }
  // Of this rank's entries, including those not yet in place.
  [[nodiscard]] std::size_t entry_bytes() const {
    return row_start.back() * (sizeof column.front() + sizeof hits.front());
  }
};

// A patch that sees mostly black backs is inside a body: its view says nothing about winding.
[[nodiscard]] constexpr bool is_exposed(double back_share) { return back_share <= 0.5; }

// Radiance of the sky in a direction; empty if the sky is dark or sampled separately.
using SkyRadiance = std::function<Rgb(const Vec3& direction)>;

[[nodiscard]] FormFactors cast_form_factors(const scenes::Scene& scene,
                                            const scenes::RayQuery& query, const Patches& patches,
                                            const FormFactorOptions& options,
                                            const SkyRadiance& sky = {});

// Casts the rows of some patches, in the given order; all per-patch vectors except `kept`,
// `kept_direct` and `column_scale` have one entry per row.
[[nodiscard]] FormFactors cast_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                                    const Patches& patches, std::span<const std::uint32_t> rows,
                                    const FormFactorOptions& options, const SkyRadiance& sky = {});

// Energy conservation: scales rows and columns (iterative proportional fitting) until, for every i
// and j,
//   sum_j a_j F_ij + F_i,sky + F_i,black = 1                      closure of i's view
//   sum_i A_i a_i F_ij + A_j (escape_j + lost_j) = A_j            balance of light from j
// By reciprocity escape_j equals F_j,sky; one estimate of it per row and one per column make the
// two sets of sums compatible in open scenes despite noise. Likewise for black backs. Patches that
// no ray reaches borrow the transposed entries of their own row. If the hits have no scaling, as
// may happen with few rays, small hits are added until one exists (filled_hits.h). area_m2: the
// open area of each patch, 0 for excluded patches.
struct BalanceReport {
  int sweeps = 0;
  double before = 0.0;  // sum_j |column defect| / sum_j A_j
  double after = 0.0;
  std::size_t borrowed = 0;  // patches that no ray had reached
  std::size_t filled = 0;    // patches that no ray had hit
  double held = 0.0;         // entries added so that a scaling exists
  bool balanced = false;     // of sum_j A_j: light that patches then send to themselves
  // The patch with the largest column defect; if all are balanced and entries were added, the patch
  // with the largest self-form-factor.
  std::uint32_t worst = no_patch;
};
// enough: defect at which the iteration ends.
inline constexpr double balance_to_rounding = 1e-13;
BalanceReport balance(FormFactors& factors, std::span<const double> area_m2,
                      double enough = balance_to_rounding);

// Patches per partial sum. Partial sums are added in order, so that the result is bit-identical for
// any number of threads and ranks (base::Shares::ordered_sums).
[[nodiscard]] constexpr std::size_t patches_a_sum(std::size_t count) {
  return std::bit_floor(std::clamp<std::size_t>(count / 512, 1, 64));
}

// y = F x for `columns` right-hand sides (row-major, rows x columns), x and y of this rank's rows;
// collective over the ranks that divide the factors.
void multiply(const FormFactors& factors, std::span<const double> x, std::span<double> y,
              std::size_t columns);

}  // namespace earthshine::radiosity
