// SPDX-License-Identifier: Apache-2.0
// Form factors by rays: F_ij, the share of what leaves patch i that arrives at patch j.
//
// Each patch sends N rays, or as many times that as its object needs (know_objects), Owen-Sobol in
// position x cosine direction. Stored are hit counts n_ij
// (sparse rows) and two scale vectors, F_ij = row_scale_i n_ij column_scale_j; misses and hits of
// black backs have columns of their own, so that closure holds in arithmetic:
//   sum_j a_j F_ij + F_i,sky + F_i,black = 1,    a_j = 1 - mirror_j - transmit_j
// A ray that meets a mirror or glass counts there with its weight and goes on with weight * (mirror
// + transmit); a_j = 1 everywhere else.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/ranks/shares.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {

struct FormFactorOptions {
  int rays_per_patch = 1024;  // rounded up to a power of two, 8 or more
  std::uint64_t seed = 1;
  std::uint32_t replicate = 0;  // each number is an independent set of samples of the same seed
  // Points of a patch that lie in a body (closed_bodies.h) send nothing: its row is the mean over
  // the others, FormFactors::open says how many they are. Else they are as good as any.
  bool leave_out_covered = false;
  // Patches of objects that have few of them send more rays each (patch_rays.h).
  bool know_objects = false;
  const scenes::SkyCells* sky_cells = nullptr;  // the sky's light is wanted for each of them
};

struct FormFactors {
  int rays_per_patch = 0;                // at least
  std::uint64_t ray_count = 0;           // all rays, continuations included
  base::Shares shares;                   // which rank has the entries of which rows; all else is
                                         // with every rank
  std::vector<std::uint64_t> row_start;  // count + 1; rows of other ranks are empty
  std::vector<std::uint32_t> column;     // ascending within a row
  std::vector<float> hits;               // integers unless a mirror or glass is met
  std::vector<double> row_scale, column_scale;
  std::vector<double> sky, black;    // F_i,sky and F_i,black: what patch i sees
  std::vector<double> escape, lost;  // shares of what leaves j that reach the sky, black backs
  std::vector<double> kept;          // a_j per patch
  std::vector<Rgb> kept_direct;  // of light straight from sources, the share that ends on a patch
                                 // (scenes/specular_paths.h); empty: all
  std::vector<double>
      back_hits;  // per object of the scene: rays of exposed patches that met its back
  std::vector<Rgb> sky_illuminance;  // per patch, or per patch and cell of the sky, lx: pi times
                                     // the mean over all rays of the sky's radiance; empty: dark
  // A row of a wholly covered patch has no entries; black = lost = 1.
  OpenParts open;

  [[nodiscard]] std::size_t count() const { return sky.size(); }
  // Of the entries here, as many as there will be once all are in place.
  [[nodiscard]] std::size_t entry_bytes() const {
    return row_start.back() * (sizeof column.front() + sizeof hits.front());
  }
};

// A patch that sees mostly black backs is buried in a body: what it sees says nothing about
// winding.
[[nodiscard]] constexpr bool is_exposed(double back_share) { return back_share <= 0.5; }

// Radiance of the sky in a direction; empty when the sky is dark or is sampled otherwise.
using SkyRadiance = std::function<Rgb(const Vec3& direction)>;

[[nodiscard]] FormFactors cast_form_factors(const scenes::Scene& scene,
                                            const scenes::RayQuery& query, const Patches& patches,
                                            const FormFactorOptions& options,
                                            const SkyRadiance& sky = {});

// The rows of some patches only, in the order given; all per-patch vectors but `kept`,
// `kept_direct` and `column_scale` then have an entry per row.
[[nodiscard]] FormFactors cast_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                                    const Patches& patches, std::span<const std::uint32_t> rows,
                                    const FormFactorOptions& options, const SkyRadiance& sky = {});

// Conservation: scales rows and columns (iterative proportional fitting) until, for every i and j,
//   sum_j a_j F_ij + F_i,sky + F_i,black = 1                      what i sees
//   sum_i A_i a_i F_ij + A_j (escape_j + lost_j) = A_j            where what leaves j goes
// The sky and the black backs take part: escape_j is F_j,sky by reciprocity, but keeping one
// estimate of it per row and one per column makes the two sets of sums agree in open scenes too,
// whatever the rays' noise. Energy is then neither made nor lost. Patches that no ray reaches
// borrow the transposed entries of their own row. Where no scaling of the hits fits both sums,
// which happens when rays are few, hits are added in small amounts until one does (filled_hits.h).
// area_m2 is what takes part of each patch: the open part where points were left out, 0 for those
// that take none.
struct BalanceReport {
  int sweeps = 0;
  double before = 0.0;  // sum_j |column defect| / sum_j A_j
  double after = 0.0;
  std::size_t borrowed = 0;  // patches that no ray had reached
  std::size_t filled = 0;    // entries added for a scaling to exist
  double held = 0.0;         // of sum_j A_j: what patches then send to themselves
  bool balanced = false;     // after <= 1e-12
  // The patch whose column is furthest from its sum; where all are balanced and entries were added,
  // the one that keeps most.
  std::uint32_t worst = no_patch;
};
// enough: the defect at which it ends.
inline constexpr double balance_to_rounding = 1e-13;
BalanceReport balance(FormFactors& factors, std::span<const double> area_m2,
                      double enough = balance_to_rounding);

// Sums over patches are taken in chunks of so many, one after the other, so that neither threads
// nor ranks change a bit of them (base::Shares::ordered_sums).
[[nodiscard]] constexpr std::size_t patches_a_sum(std::size_t count) {
  return std::bit_floor(std::clamp<std::size_t>(count / 512, 1, 64));
}

// y = F x for `columns` right-hand sides side by side (row-major, rows x columns), both of this
// rank's own rows; all ranks that divide the factors call it.
void multiply(const FormFactors& factors, std::span<const double> x, std::span<double> y,
              std::size_t columns);

}  // namespace earthshine::radiosity
