// SPDX-License-Identifier: Apache-2.0
// Casts the rays of one patch for surface_samples.h.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/numbers/random.h"
#include "radiosity/direct/sources.h"
#include "raytrace/incoming/incoming_light.h"
#include "scenes/light/shadow_queue.h"

namespace earthshine::raytrace {

// Start of rays: `lift` is the offset from the surface.
struct SurfaceSpot {
  Vec3 at, normal, lift;
};

// The rays of one patch and the light that they bring to its points: sums per point, half and
// group. An entry is 2 * point + half.
class PatchSampler {
 public:
  // The arguments must outlive the sampler. kept: per material, 1 - mirror - transmit; table:
  // radiance that rays read; bright: patches that some rays are aimed at.
  PatchSampler(const scenes::World& scene, const std::vector<double>& kept,
               const RadianceTable& table, const BrightPatches& bright, std::size_t groups,
               std::size_t sky_parts)
      : scene_(scene),
        kept_(kept),
        table_(table),
        incoming_(scene, table, bright, groups, 0, false),
        shadows_(scene.query),
        groups_(groups),
        sky_parts_(sky_parts) {}

  void start(std::size_t points);
  std::span<Rgb> lamps(std::size_t entry) { return {&lamps_[entry * groups_], groups_}; }
  std::span<Rgb> gathered(std::size_t entry) { return {&gathered_[entry * groups_], groups_}; }
  std::span<Rgb> sky(std::size_t entry) { return {&sky_[entry * sky_parts_], sky_parts_}; }
  // Sums over all rays of the patch, in units of one entry.
  [[nodiscard]] double escaped() const { return escaped_; }
  [[nodiscard]] double lost() const { return lost_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_ + shadows_.rays(); }

  // Shadow rays to the source, direct and by mirrors, for `rays` points of a sequence from `first`
  // on. twice: the samples count for the next entry, too.
  void sample_source(const radiosity::Source& source, const SurfaceSpot& from,
                     const base::SobolOwen4& sequence, std::size_t first, std::size_t rays,
                     std::size_t entry, bool twice);
  void finish_shadows();

  // Cosine-distributed rays, a multiple of the packet's width, by points point * rays and following
  // of a sequence, and fewer rays aimed at bright patches by another sequence. Combined by MIS as
  // in IncomingLight.
  void gather(const SurfaceSpot& from, const base::SobolOwen4& sequence,
              const base::SobolOwen4& aims, std::size_t point, std::size_t rays, std::size_t entry);

 private:
  struct Arriving {
    Rgb lx;
    std::size_t to;  // index of the sum of an entry and a group
    bool twice;      // also adds to the next entry
  };
  void take(const Arriving& light, const Rgb& share);
  void add_shadow_ray(const SurfaceSpot& from, const scenes::LightSample& sample, const Rgb& lx,
                      std::size_t entry, std::size_t group, bool twice);
  void aim(const SurfaceSpot& from, const std::array<float, 4>& u, const MisContext& all,
           std::size_t entry);
  void follow(const scenes::Hit& first, const Vec3& along, const MisContext& share,
              std::size_t entry);
  void escape(const Vec3& direction, double weight, std::size_t entry);

  const scenes::World& scene_;
  const std::vector<double>& kept_;
  const RadianceTable& table_;
  IncomingLight incoming_;
  scenes::ShadowQueue<Arriving> shadows_;
  std::size_t groups_, sky_parts_;
  std::vector<Rgb> lamps_, gathered_, sky_;
  std::vector<scenes::LightSample> taken_;
  double escaped_ = 0.0, lost_ = 0.0;
  std::uint64_t rays_ = 0;  // without shadow rays
};

}  // namespace earthshine::raytrace
