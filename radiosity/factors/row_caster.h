// SPDX-License-Identifier: Apache-2.0
// Casts the rays of one patch and counts their hits, one row of the form factors at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/factors/hit_targets.h"
#include "radiosity/factors/kept_rows.h"
#include "radiosity/factors/patch_rays.h"

namespace earthshine::radiosity {

// The rows of one chunk of patches.
struct Band {
  std::vector<Row> rows;
  std::vector<double> back_hits;         // per object
  std::vector<std::uint32_t> backs_met;  // of the present row: the objects
  std::vector<std::uint64_t> missed;     // of the present row, as KeptRow::missed
  std::vector<std::uint32_t> column;
  std::vector<float> hits;
  std::vector<Rgb> sky_illuminance;  // for each row and cell of the sky
};

// Thread-safe, with one counter and one band per thread.
class RowCaster {
 public:
  // All arguments must outlive it. kept: a_j per patch; rays: a power of two; runs: per object of
  // the scene, in units of `rays`; empty: one each.
  RowCaster(const scenes::Scene& scene, const scenes::RayQuery& query, const Patches& patches,
            const std::vector<double>& kept, const FormFactorOptions& options, std::uint32_t rays,
            const std::vector<std::uint32_t>& runs, const SkyRadiance& sky);

  // Appends the patch's row to the band.
  void cast(std::uint32_t patch, HitCounter& counter, Band& band) const;

  // Created at the first request, here or by a row.
  [[nodiscard]] std::shared_ptr<const ClosedBodies> bodies() const;

 private:
  bool trace(std::uint32_t patch, PatchRays::Sender sender, bool stop_at_back,
             std::vector<std::uint32_t>& near, Row& row, HitCounter& counter, Band& band) const;
  // Appends the row of an earlier pose, if it is the same in this one.
  bool restore(std::uint32_t patch, const PatchRays::Sender& sender, Band& band) const;
  void keep(std::uint32_t patch, const Row& row, const Band& band) const;
  // Appends the row, with its entries at the end of the band, and counts its backs.
  void close(Row row, std::size_t first_part, Band& band) const;
  [[nodiscard]] bool may_be_covered(std::uint32_t patch) const;
  [[nodiscard]] std::vector<std::uint32_t> bodies_near(std::uint32_t patch) const;
  void count_hits(const scenes::RayPacket& packet, const scenes::HitPacket& hits,
                  std::uint32_t number, std::span<const std::uint32_t> near, Row& row,
                  HitCounter& counter, Band& band) const;
  void follow(const scenes::RayPacket& packet, std::size_t lane, const scenes::Hit& first, Row& row,
              HitCounter& counter, Band& band) const;
  // Adds a ray that hit nothing to the sky light of the last row.
  void escape(const Vec3& direction, double weight, Row& row, Band& band) const;

  const scenes::Scene& scene_;
  const scenes::RayQuery& query_;
  const Patches& patches_;
  const std::vector<double>& kept_;
  const std::vector<std::uint32_t>& runs_;
  const SkyRadiance& sky_;
  const scenes::SkyCells* sky_cells_;
  std::size_t sky_parts_;
  std::uint64_t seed_;
  std::uint32_t replicate_;
  bool leave_out_covered_, dark_sky_;
  KeptRows* kept_rows_;  // null: none are kept
  PatchRays rays_;
  HitTargets targets_;
  // Created on demand: most scenes do not need them.
  mutable std::once_flag bodies_made_;
  mutable std::shared_ptr<const ClosedBodies> bodies_;
};

}  // namespace earthshine::radiosity
