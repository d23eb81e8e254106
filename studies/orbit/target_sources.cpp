// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/target_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scenes/sky/sky.h"

namespace earthshine::studies {
namespace {

using scenes::no_group;

scenes::Scene bare(const SkyPlace& sky) {
  scenes::Scene scene;
  scene.sun = sky.sun;
  scene.earth = sky.earth;
  return scene;
}

// Combines the lamps of one group.
class Collector {
 public:
  explicit Collector(const scenes::Scene& scene, const BasisView::Target& target)
      : scene_(scene), target_(target), lit_(target.points.size(), 0) {}

  SourceOnTarget& source(const std::string& group) {
    const auto found = std::find_if(sources_.begin(), sources_.end(),
                                    [&](const Entry& entry) { return entry.of.group == group; });
    if (found != sources_.end()) return found->of;
    Entry entry;
    entry.of.group = group;
    entry.lit.assign(target_.points.size(), 0);
    entry.facing.assign(target_.points.size(), 0);
    return sources_.emplace_back(std::move(entry)).of;
  }

  // share: of the source's light in this condition, 0 if off. straight: no form factor carries its
  // direct light (which would count as light of its object).
  void add(const std::string& group, const Reach& reach, double share, bool straight = true) {
    SourceOnTarget& of = source(group);
    Entry& entry = *std::find_if(sources_.begin(), sources_.end(),
                                 [&](const Entry& e) { return &e.of == &of; });
    for (std::size_t k = 0; k < lit_.size(); ++k) {
      entry.facing[k] |= reach.facing[k];
      if (share <= 0.0) continue;
      entry.lit[k] |= reach.lit[k];
      lit_[k] |= reach.lit[k];
    }
    of.direct += share * reach.luminance;
    if (straight) of.straight += share * reach.luminance;
    of.unshadowed += reach.unshadowed;
    of.on_back += share * reach.on_back;
    for (const Reach::Shadow& shadow : reach.shadows) entry.shadows[shadow.object] += shadow.rays;
  }

  [[nodiscard]] TargetSources finish() {
    TargetSources all;
    all.lit_fraction = share_of(lit_);
    for (Entry& entry : sources_) {
      entry.of.lit = share_of(entry.lit);
      entry.of.facing = share_of(entry.facing);
      std::vector<std::pair<std::size_t, std::uint32_t>> by_rays;
      for (const auto& [object, rays] : entry.shadows) by_rays.emplace_back(rays, object);
      std::sort(by_rays.rbegin(), by_rays.rend());
      for (const auto& [rays, object] : by_rays) {
        entry.of.shadow_of.push_back(scene_.objects[object].name);
      }
      all.sources.push_back(std::move(entry.of));
    }
    return all;
  }

 private:
  struct Entry {
    SourceOnTarget of;
    std::vector<std::uint8_t> lit, facing;
    std::map<std::uint32_t, std::size_t> shadows;
  };
  const scenes::Scene& scene_;
  const BasisView::Target& target_;
  std::vector<std::uint8_t> lit_;
  std::vector<Entry> sources_;
};

// From the mean position of the points; 0 without points.
double distance_to(const BasisView::Target& target, const Vec3& position) {
  if (target.points.empty()) return 0.0;
  Vec3 middle(0.0);
  for (const SeenPoint& point : target.points) middle += point.position;
  return glm::length(middle / static_cast<double>(target.points.size()) - position);
}

double luminance_of_groups(const BasisView::Target& target, const GroupWeights& weights,
                           std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t g = first; g < first + count; ++g) {
    sum += base::luminance(weights.weight[g] * target.by_group[g]);
  }
  return sum;
}

}  // namespace

double sun_share_of(const SkyPlace& sky) { return scenes::visible_sun_share(bare(sky)); }

namespace {

bool earth_stands_still(const std::vector<SkyPlace>& places) {
  const std::optional<scenes::Earth>& first = places.front().earth;
  return places.size() > 1 && first && std::ranges::all_of(places, [&](const SkyPlace& place) {
           return place.earth && place.earth->direction == first->direction &&
                  place.earth->half_angle_deg == first->half_angle_deg;
         });
}

}  // namespace

void reach_of_lamps(const LightBasis& basis, const scenes::RayQuery& query,
                    BasisView::Target& target) {
  const scenes::Scene& scene = basis.scene();
  target.lamps.resize(scene.lamps.size());
  target.emitters.resize(scene.materials.size());
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    if (basis.groups().lamp[k] == no_group) continue;
    target.lamps[k] = reach_of_lamp(scene, query, target.points, scene.lamps[k]);
  }
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (basis.groups().material[m] == no_group) continue;
    const scenes::EmitterSet emitters(scene, m);
    target.emitters[m] = reach_of_emitters(scene, query, target.points, emitters);
  }
  if (!earth_stands_still(basis.places())) return;
  target.earth = blockers_of_earth(scene, query, target.points, *basis.places().front().earth,
                                   earth_directions);
}

TargetSources sources_on(const LightBasis& basis, const scenes::RayQuery& query,
                         const BasisView::Target& target,
                         const std::vector<bool>& straight_emitters, const GroupWeights& weights,
                         const SkyPlace& sky) {
  const scenes::Scene& scene = basis.scene();
  const scenes::LightGroups& groups = basis.groups();
  Collector all(scene, target);
  const auto weighed = [&weights](std::size_t first, std::size_t count) {
    double sum = 0.0;
    for (std::size_t g = first; g < first + count; ++g) sum += base::luminance(weights.weight[g]);
    return sum > 0.0;
  };
  if (sky.sun) {
    const bool parts = basis.in_parts() && groups.sun_parts != no_group;
    const std::size_t first = parts ? groups.sun_parts : groups.sun;
    const std::size_t count = basis.sun_parts();
    const bool shines = sun_share_of(sky) > 0.0;
    const bool on = first != no_group && weighed(first, count);
    const double share = on ? sun_share_of(sky) : 0.0;
    all.add("sun",
            reach_of_direction(scene, query, target.points, sky.sun->direction,
                               base::luminance(sky.sun->illuminance_lx)),
            share);
    SourceOnTarget& sun = all.source("sun");
    if (!on) sun.off = shines ? switched_off : "in the Earth's shadow";
    if (first != no_group) sun.luminance = luminance_of_groups(target, weights, first, count);
  }
  if (sky.earth) {
    const bool lit = scenes::earth_is_lit(bare(sky));
    const bool on = groups.earth != no_group && weighed(groups.earth, basis.earth_parts());
    (void)all.source("earth");
    const auto reach_by = [&](const std::optional<scenes::Sun>& sun) {
      return reach_of_earth(scene, query, target.points, *sky.earth, sun, earth_directions,
                            target.earth ? &*target.earth : nullptr);
    };
    if (lit) all.add("earth", reach_by(sky.sun), on ? 1.0 : 0.0);
    if (!on) all.source("earth").off = lit ? switched_off : "has its night side below";
    if (!lit && sky.sun) {
      // The Earth's light at its noon side, to state its reach by day.
      scenes::Sun noon = *sky.sun;
      noon.direction = -sky.earth->direction;
      all.add("earth", reach_by(noon), 0.0);
    }
    if (groups.earth != no_group) {
      all.source("earth").luminance =
          luminance_of_groups(target, weights, groups.earth, basis.earth_parts());
    }
  }
  const auto add_group = [&](std::size_t group, const Reach& reach, bool straight) {
    const double share = base::luminance(weights.weight[group]);
    all.add(groups.names[group], reach, share, straight);
    SourceOnTarget& source = all.source(groups.names[group]);
    source.luminance = luminance_of_groups(target, weights, group, 1);
    if (share <= 0.0) {
      source.off = switched_off;
    } else if (share < dimmed_share) {
      source.off = fmt::format("{}{:.2g}", dimmed_to, share);
    }
  };
  for (std::size_t k = 0; k < target.lamps.size(); ++k) {
    if (!target.lamps[k]) continue;
    add_group(groups.lamp[k], *target.lamps[k], true);
    double& nearest = all.source(groups.names[groups.lamp[k]]).distance_m;
    const double distance = distance_to(target, scene.lamps[k].position);
    nearest = nearest > 0.0 ? std::min(nearest, distance) : distance;
  }
  for (std::size_t m = 0; m < target.emitters.size(); ++m) {
    if (target.emitters[m]) {
      add_group(groups.material[m], *target.emitters[m], straight_emitters[m]);
    }
  }
  return all.finish();
}

}  // namespace earthshine::studies
