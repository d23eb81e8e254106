// SPDX-License-Identifier: Apache-2.0
// Collects shadow rays and traces them in packets.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"

namespace earthshine::scenes {

// Item: the caller's data of a ray. One object per thread.
template <class Item>
class ShadowQueue {
 public:
  // most: capacity. Above one packet, rays are sorted by `order`, since rays to one light are
  // coherent.
  explicit ShadowQueue(const RayQuery& query, std::size_t most = RayPacket::width)
      : query_(query), most_(most) {
    waiting_.reserve(most);
  }

  // Adds a ray from `origin`, which lies off the surface at `point`, to a source's sample. Adds
  // none if the source is at the point (ShadowSegment::reach_m is 0). take: see trace().
  template <class Take>
  void add(const LightSample& sample, const Vec3& point, const Vec3& origin, const Item& item,
           const Take& take, std::size_t order = 0) {
    const ShadowSegment segment = shadow_segment(sample, point, origin);
    if (segment.reach_m <= 0.0) return;
    waiting_.push_back({origin, segment, sample.mirror, order, item});
    if (waiting_.size() == most_) trace(take);
  }

  // Traces all queued rays. Calls take(item, share of the light that arrives) for each.
  template <class Take>
  void trace(const Take& take) {
    constexpr std::size_t width = RayPacket::width;
    if (most_ > width) {
      std::stable_sort(waiting_.begin(), waiting_.end(),
                       [](const Ray& a, const Ray& b) { return a.order < b.order; });
    }
    RayPacket packet;
    std::array<std::uint32_t, width> mirrors;
    std::array<Rgb, width> shares;
    for (std::size_t first = 0; first < waiting_.size(); first += width) {
      const std::size_t count = std::min(width, waiting_.size() - first);
      for (std::size_t k = 0; k < count; ++k) {
        const Ray& ray = waiting_[first + k];
        query_.set(packet, k, ray.origin, ray.segment.direction, ray.segment.reach_m);
        mirrors[k] = ray.mirror;
      }
      query_.light_shares(packet, mirrors.data(), count, shares.data());
      for (std::size_t k = 0; k < count; ++k) take(waiting_[first + k].item, shares[k]);
    }
    rays_ += waiting_.size();
    waiting_.clear();
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }  // number of rays traced so far

 private:
  struct Ray {
    Vec3 origin;
    ShadowSegment segment;
    std::uint32_t mirror;
    std::size_t order;
    Item item;
  };

  const RayQuery& query_;
  std::size_t most_;
  std::vector<Ray> waiting_;
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::scenes
