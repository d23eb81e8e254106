// SPDX-License-Identifier: Apache-2.0
// The rays of one patch of surface_samples.h.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/numbers/random.h"
#include "radiosity/direct/sources.h"
#include "raytrace/incoming/incoming_light.h"
#include "scenes/light/shadow_queue.h"

namespace earthshine::raytrace {

// Where rays start: `lift` above the surface.
struct SurfaceSpot {
  Vec3 at, normal, lift;
};

// Rays of one patch, and what they bring to its points: per point, half and group.
class PatchSampler {
 public:
  // All must outlive it. kept: per material, 1 - mirror - transmit; table: what rays read, some of
  // which are aimed at the bright patches.
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
  // Of all sampler, in sampler.
  [[nodiscard]] double escaped() const { return escaped_; }
  [[nodiscard]] double lost() const { return lost_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_ + shadows_.rays(); }

  // Shadow rays to the source, straight and by mirrors, by so many points of a sequence from the
  // first on. twice: the next look's are the same.
  void sample_source(const radiosity::Source& source, const SurfaceSpot& from,
                     const base::SobolOwen4& sequence, std::size_t first, std::size_t rays,
                     std::size_t entry, bool twice);
  void finish_shadows();

  // So many cosine rays by points of a sequence from the `point`-th time as many on, a multiple of
  // the packet's width, and fewer aimed at bright patches by another sequence. Both ways of finding
  // these are combined as IncomingLight does.
  void gather(const SurfaceSpot& from, const base::SobolOwen4& sequence,
              const base::SobolOwen4& aims, std::size_t point, std::size_t rays, std::size_t entry);

 private:
  struct Arriving {
    Rgb lx;
    std::size_t to;  // of the sums by look and group
    bool twice;      // and to the next look
  };
  void take(const Arriving& light, const Rgb& share);
  void add_shadow_ray(const SurfaceSpot& from, const scenes::LightSample& sample, const Rgb& lx,
                      std::size_t entry, std::size_t group, bool twice);
  void aim(const SurfaceSpot& from, const std::array<float, 4>& u, const MisContext& all,
           std::size_t entry);
  void follow(const scenes::Hit& first, const Vec3& along, const MisContext& share,
              std::size_t entry);
  void escape(const Vec3& way, double weight, std::size_t entry);

  const scenes::World& scene_;
  const std::vector<double>& kept_;
  const RadianceTable& table_;
  IncomingLight incoming_;
  scenes::ShadowQueue<Arriving> shadows_;
  std::size_t groups_, sky_parts_;
  std::vector<Rgb> lamps_, gathered_, sky_;
  std::vector<scenes::LightSample> taken_;
  double escaped_ = 0.0, lost_ = 0.0;
  std::uint64_t rays_ = 0;  // but shadow rays
};

}  // namespace earthshine::raytrace
