// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/row_caster.h"

#include "base/numbers/random.h"
#include "radiosity/patches/parted_cell.h"
#include "radiosity/patches/patch_offset.h"
#include "scenes/light/lamp_light.h"
#include "scenes/reflect/specular.h"

namespace earthshine::radiosity {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

std::vector<bool> materials_that_pass_on(const scenes::Scene& scene) {
  std::vector<bool> passes_on;
  for (const scenes::Material& m : scene.materials) {
    passes_on.push_back(m.passes_light_on() || base::max_component(m.transmit) > 0.0);
  }
  return passes_on;
}

Vec3 origin(const RayPacket& packet, std::size_t k) {
  return {packet.origin_x[k], packet.origin_y[k], packet.origin_z[k]};
}
Vec3 direction(const RayPacket& packet, std::size_t k) {
  return {packet.direction_x[k], packet.direction_y[k], packet.direction_z[k]};
}

}  // namespace

RowCaster::RowCaster(const scenes::Scene& scene, const scenes::RayQuery& query,
                     const Patches& patches, const std::vector<double>& kept,
                     const FormFactorOptions& options, std::uint32_t rays,
                     const std::vector<std::uint32_t>& runs, const SkyRadiance& sky)
    : scene_(scene),
      query_(query),
      patches_(patches),
      kept_(kept),
      runs_(runs),
      sky_(sky),
      sky_cells_(options.sky_cells),
      sky_parts_(!sky                    ? 0
                 : sky_cells_ == nullptr ? 1
                                         : sky_cells_->count()),
      seed_(options.seed),
      replicate_(options.replicate),
      leave_out_covered_(options.leave_out_covered),
      dark_sky_(!scenes::has_light_outside(scene)),
      kept_rows_(options.kept),
      rays_(patches, query, rays),
      targets_(patches, materials_that_pass_on(scene)),
      bodies_(options.bodies) {}

void RowCaster::cast(std::uint32_t patch, HitCounter& counter, Band& band) const {
  Row row;
  base::Key key(seed_, base::Stream::FormFactor, patch);
  if (replicate_ != 0) key = key.with(replicate_);
  const PatchRays::Sender sender = rays_.sender(patch, key);
  if (kept_rows_ != nullptr && restore(patch, sender, band)) return;
  std::vector<std::uint32_t> near;
  const std::size_t first_part = band.sky_illuminance.size();
  band.sky_illuminance.resize(first_part + sky_parts_, Rgb(0.0));
  const bool search_first = leave_out_covered_ && may_be_covered(patch);
  if (search_first) near = bodies_near(patch);
  if (!trace(patch, sender, leave_out_covered_ && !search_first, near, row, counter, band)) {
    counter.clear();
    band.backs_met.clear();
    band.missed.clear();
    row = {};
    std::fill(band.sky_illuminance.end() - static_cast<std::ptrdiff_t>(sky_parts_),
              band.sky_illuminance.end(), Rgb(0.0));
    trace(patch, sender, false, near, row, counter, band);
  }
  const std::size_t before = band.column.size();
  counter.take(band.column, band.hits);
  row.entries = static_cast<std::uint32_t>(band.column.size() - before);
  if (kept_rows_ != nullptr) keep(patch, row, band);
  close(row, first_part, band);
}

void RowCaster::close(Row row, std::size_t first_part, Band& band) const {
  if (row.open > 0 && is_exposed(row.black / row.open)) {
    for (const std::uint32_t object : band.backs_met) band.back_hits[object] += 1.0;
  }
  band.backs_met.clear();
  band.missed.clear();
  for (std::size_t k = first_part; row.open > 0 && k < band.sky_illuminance.size(); ++k) {
    band.sky_illuminance[k] *= base::pi / row.open;
  }
  band.rows.push_back(row);
}

void RowCaster::keep(std::uint32_t patch, const Row& row, const Band& band) const {
  KeptRow& kept = kept_rows_->rows[patch];
  const auto last = [&](const auto& all) { return all.end() - std::ptrdiff_t(row.entries); };
  kept = {row,
          {last(band.column), band.column.end()},
          {last(band.hits), band.hits.end()},
          band.backs_met,
          band.missed,
          row.rays == row.sent};
}

bool RowCaster::restore(std::uint32_t patch, const PatchRays::Sender& first, Band& band) const {
  const KeptRow& kept = kept_rows_->rows[patch];
  if (kept_rows_->moved == nullptr || !kept_rows_->moved->is_unmoved(patch) || !kept.is_plain) {
    return false;
  }
  const std::size_t first_part = band.sky_illuminance.size();
  band.sky_illuminance.resize(first_part + sky_parts_, Rgb(0.0));
  PatchRays::Sender sender = first;
  RayPacket packet;
  Row row;
  const auto run = static_cast<std::uint32_t>(rays_.count() / RayPacket::width);
  for (std::uint32_t n = 0; n < kept.row.sent / RayPacket::width; ++n) {
    if (n > 0 && n % run == 0) rays_.go_to_run(n / run, sender);
    rays_.make(sender, n % run * RayPacket::width, packet);
    for (std::uint32_t k = 0; k < RayPacket::width; ++k) {
      if (kept_rows_->moved->on_ray(origin(packet, k) + query_.centre(), direction(packet, k))) {
        band.sky_illuminance.resize(first_part);
        return false;
      }
      const std::size_t ray = n * RayPacket::width + k;
      if (sky_ && ray / 64 < kept.missed.size() && (kept.missed[ray / 64] >> ray % 64 & 1U) != 0) {
        escape(direction(packet, k), 1.0, row, band);
      }
    }
  }
  band.column.insert(band.column.end(), kept.column.begin(), kept.column.end());
  band.hits.insert(band.hits.end(), kept.hits.begin(), kept.hits.end());
  band.backs_met = kept.backs;
  close(kept.row, first_part, band);
  return true;
}

// Counts the patch's rays, except from points covered by the bodies `near`. stop_at_back: stops at
// the first black back and returns false if bodies near the patch may be the cause, and lists them.
// A patch that sees no back is not covered and costs nothing extra.
bool RowCaster::trace(std::uint32_t patch, PatchRays::Sender sender, bool stop_at_back,
                      std::vector<std::uint32_t>& near, Row& row, HitCounter& counter,
                      Band& band) const {
  // A packet's hits are counted after the next packet was traced: by then their data has arrived
  // from memory.
  RayPacket packets[2];
  HitPacket hits[2];
  const auto run = static_cast<std::uint32_t>(rays_.count() / RayPacket::width);
  const std::uint32_t count = run * (runs_.empty() ? 1 : runs_[patches_.object(patch)]);
  row.sent = count * RayPacket::width;
  row.rays = row.sent;
  for (std::uint32_t n = 0; n <= count; ++n) {
    if (n < count) {
      if (n > 0 && n % run == 0) rays_.go_to_run(n / run, sender);
      rays_.make(sender, n % run * RayPacket::width, packets[n % 2]);
      query_.closest(packets[n % 2], RayPacket::width, hits[n % 2]);
      for (const std::uint32_t triangle : hits[n % 2].triangle) targets_.prefetch(triangle);
    }
    if (n == 0) continue;
    count_hits(packets[(n - 1) % 2], hits[(n - 1) % 2], n - 1, near, row, counter, band);
    if (!stop_at_back || !(row.black > 0.0 || (row.sky > 0.0 && dark_sky_))) continue;
    stop_at_back = false;
    near = bodies_near(patch);
    if (!near.empty()) return false;
  }
  return true;
}

// Whether it may be covered independent of its rays: it has holes, or others lie on it.
bool RowCaster::may_be_covered(std::uint32_t patch) const {
  if (scene_.materials[patches_.material(patch)].has_holes()) return true;
  return is_covered_by_faces(query_.coincident(), patches_, patch);
}

std::shared_ptr<const ClosedBodies> RowCaster::bodies() const {
  std::call_once(bodies_made_, [this] {
    if (bodies_) return;
    bodies_ = std::make_shared<const ClosedBodies>(scene_, query_.centre());
  });
  return bodies_;
}

std::vector<std::uint32_t> RowCaster::bodies_near(std::uint32_t patch) const {
  return bodies()->near(patches_, patch, 2.0 * patch_offset_m(patches_, query_, patch));
}

void RowCaster::count_hits(const RayPacket& packet, const HitPacket& hits, std::uint32_t number,
                           std::span<const std::uint32_t> near, Row& row, HitCounter& counter,
                           Band& band) const {
  for (std::size_t k = 0; k < RayPacket::width; ++k) {
    if (!near.empty() && bodies_->cover(origin(packet, k), near)) continue;
    ++row.open;
    const std::uint32_t triangle = hits.triangle[k];
    if (triangle == scenes::no_triangle) {
      escape(direction(packet, k), 1.0, row, band);
      if (kept_rows_ != nullptr) {
        const std::size_t ray = number * RayPacket::width + k;
        if (band.missed.size() <= ray / 64) band.missed.resize(ray / 64 + 1, 0);
        band.missed[ray / 64] |= std::uint64_t{1} << ray % 64;
      }
      continue;
    }
    if (targets_.passes_on(triangle)) {
      follow(packet, k, {triangle, hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0}, row,
             counter, band);
      continue;
    }
    const bool front = hits.front[k] != 0;
    std::uint32_t to = targets_.find(triangle, hits.u[k], hits.v[k], front);
    if (to != no_patch && patches_.is_part(to)) {
      to = find_before(patches_, {triangle, double(hits.u[k]), double(hits.v[k])}, front,
                       direction(packet, k), query_.offset_m(triangle));
    }
    if (to == no_patch) {
      row.black += 1.0;
      band.backs_met.push_back(scene_.triangles[triangle].object);
    } else {
      counter.add(to, 1.0F);
    }
  }
}

void RowCaster::escape(const Vec3& direction, double weight, Row& row, Band& band) const {
  row.sky += weight;
  if (!sky_) return;
  const std::size_t part = sky_cells_ == nullptr ? 0 : sky_cells_->cell_of(direction);
  band.sky_illuminance[band.sky_illuminance.size() - sky_parts_ + part] += weight * sky_(direction);
}

// Counts a hit on a mirror or glass, and the hits after it.
void RowCaster::follow(const RayPacket& packet, std::size_t lane, const scenes::Hit& first,
                       Row& row, HitCounter& counter, Band& band) const {
  float weight = 1.0F;
  const auto visit = [&](const scenes::Hit& hit, const Vec3& direction, int step) {
    if (step > 0) ++row.rays;
    if (hit.missed()) {
      escape(direction, double(weight), row, band);
      return false;
    }
    const std::uint32_t to = patches_.find(hit.triangle, hit.u, hit.v, hit.front);
    const scenes::Material& material = scene_.materials[scene_.triangles[hit.triangle].material];
    const bool glass = base::max_component(material.transmit) > 0.0;
    if (to == no_patch && !glass) {
      row.black += weight;
      return false;
    }
    // The inside of a glass body transmits like its outside, and is no patch.
    const double passed_on = to == no_patch ? 1.0 : 1.0 - kept_[to];
    if (to != no_patch) counter.add(to, weight);
    weight *= static_cast<float>(passed_on);
    if (weight <= 0.0F) return false;
    if (step < scenes::most_specular_steps) return true;
    // The remaining weight ends here: light must not vanish.
    if (to != no_patch && kept_[to] > 0.0) {
      counter.add(to, weight / static_cast<float>(kept_[to]));
    } else {
      row.black += weight;
    }
    return false;
  };
  scenes::follow_specular(scene_, query_, first, direction(packet, lane), false, visit);
}

}  // namespace earthshine::radiosity
