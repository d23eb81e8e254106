// SPDX-License-Identifier: Apache-2.0
#include "radiosity/variation.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numbers/random.h"
#include "base/ranks/ranks.h"
#include "radiosity/patches/patch_offset.h"
#include "radiosity/patches/split.h"
#include "scenes/light/shadow_queue.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::radiosity {
namespace {

using scenes::RayPacket;

constexpr double fewest_points = 16.0, most_points = 4096.0;  // per patch, of direct light
constexpr std::size_t indirect_points = 4;                    // one per quarter
constexpr std::size_t wide_source_points = 4;  // per point and set; 1 for the Sun and small lamps

// Sums per point, set and group.
class PointSums {
 public:
  PointSums(std::size_t points, std::size_t groups)
      : groups_(groups), where_(points), sum_(points * 2 * groups, 0.0) {}

  // Sets the point's position in the patch: x along s, y along t, from 0 to 1.
  void place(std::size_t point, double x, double y) { where_[point] = {x, y}; }
  double& at(std::size_t point, std::size_t set, std::size_t group) {
    return sum_[(point * 2 + set) * groups_ + group];
  }

  [[nodiscard]] std::size_t points() const { return where_.size(); }

  // Adds a group's variance between the points, and between the halves; 0 unless the variance
  // exceeds its own noise.
  void add_to(Unevenness& sum, std::size_t group) {
    const auto n = static_cast<double>(where_.size());
    std::array<double, 2> mean{}, s_step{}, t_step{};  // half the difference between halves
    for (std::size_t k = 0; k < where_.size(); ++k) {
      for (std::size_t set = 0; set < 2; ++set) {
        const double value = at(k, set, group) / n;
        mean[set] += value;
        s_step[set] += where_[k][0] < 0.5 ? -value : value;
        t_step[set] += where_[k][1] < 0.5 ? -value : value;
      }
    }
    double both = 0.0, apart = 0.0;
    for (std::size_t k = 0; k < where_.size(); ++k) {
      const double a = at(k, 0, group) - mean[0], b = at(k, 1, group) - mean[1];
      both += a * b;
      apart += 0.25 * (a - b) * (a - b);
    }
    if (both <= apart) return;
    sum.error += both / (n - 1.0);
    sum.along_s += std::max(0.0, s_step[0] * s_step[1]);
    sum.along_t += std::max(0.0, t_step[0] * t_step[1]);
  }

 private:
  std::size_t groups_;
  std::vector<std::array<double, 2>> where_;
  std::vector<double> sum_;
};

}  // namespace

RelativeLight relative_light(const Solution& solution) {
  RelativeLight light;
  light.patches = &solution.patches;
  light.groups = solution.columns / 3;
  light.scale.assign(light.groups, 0.0);
  light.brightness.resize(solution.patches.count() * light.groups);
  for (std::size_t i = 0; i < solution.patches.count(); ++i) {
    const double area = solution.patches.area_m2[i];
    light.area_m2 += area;
    for (std::size_t g = 0; g < light.groups; ++g) {
      const float* b = &solution.radiosity[i * solution.columns + 3 * g];
      const double y = base::luminance({b[0], b[1], b[2]});
      light.brightness[i * light.groups + g] = static_cast<float>(y);
      light.scale[g] += area * y * y;
    }
  }
  for (double& scale : light.scale) scale = scale > 0.0 ? std::sqrt(light.area_m2 / scale) : 0.0;
  for (std::size_t k = 0; k < light.brightness.size(); ++k) {
    light.brightness[k] *= static_cast<float>(light.scale[k % light.groups]);
  }
  return light;
}

Variation::Variation(const scenes::World& world, const VariationOptions& options)
    : world_(world),
      sources_(find_sources(world, 16)),
      groups_(world.groups.count()),
      earth_group_(world.groups.earth),
      reflectances_(world.scene),
      options_(options) {}

std::vector<Unevenness> Variation::find(const Patches& patches,
                                        std::span<const std::uint32_t> which,
                                        const RelativeLight& light) {
  std::vector<Unevenness> found(which.size());
  constexpr std::size_t chunk = 64;
  std::vector<std::uint64_t> rays_of((which.size() + chunk - 1) / chunk, 0);
  const auto gather_directions = static_cast<std::size_t>(options_.gather_directions);
  const auto lit_groups = static_cast<double>(
      std::max<std::ptrdiff_t>(1, std::count_if(light.scale.begin(), light.scale.end(),
                                                [](double scale) { return scale > 0.0; })));
  const auto points_on = [&](double area_m2) {
    const double wanted = fewest_points + area_m2 / (options_.spacing_m * options_.spacing_m);
    return std::bit_floor(static_cast<std::size_t>(std::min(wanted, most_points)));
  };
  const auto direct = [&](std::uint32_t patch, const Rgb& rho, PointSums& sums) {
    const base::Key key(options_.seed, base::Stream::Refinement, identity(patches, patch));
    const base::SobolOwen4 where(key);
    struct Arriving {
      Rgb value;
      std::size_t point, set, group;
    };
    scenes::ShadowQueue<Arriving> shadows(world_.query);
    const auto take = [&](const Arriving& to, const Rgb& share) {
      sums.at(to.point, to.set, to.group) += base::luminance(to.value * share);
    };
    std::vector<scenes::LightSample> taken;
    for (std::size_t point = 0; point < sums.points(); ++point) {
      const auto p = where.point2(static_cast<std::uint32_t>(point));
      const SurfacePoint from = patches.at(patch, p[0], p[1]);
      sums.place(point, p[0], p[1]);
      for (std::size_t k = 0; k < sources_.size(); ++k) {
        const Source& source = sources_[k].source;
        const std::size_t samples = source.points > 16 ? wide_source_points : 1;
        for (std::size_t set = 0; set < 2; ++set) {
          const base::SobolOwen4 toward(key.with(2 * k + set));
          for (std::size_t m = 0; m < samples; ++m) {
            const auto u = toward.point2(static_cast<std::uint32_t>(m));
            take_samples(source, world_.query.specular_paths().mirrors(), from.position,
                         from.normal, u[0], u[1], taken);
            for (const scenes::LightSample& sample : taken) {
              const double cosine = glm::dot(sample.direction, from.normal);
              const double weight =
                  cosine * light.scale[source.group] / static_cast<double>(samples);
              const Rgb value = weight * rho * sample.normal_illuminance_lx;
              if (base::luminance(value) <= 0.0) continue;
              shadows.add(sample, from.position, lifted(from, world_.query),
                          {value, point, set, source.group}, take);
            }
          }
        }
      }
    }
    shadows.trace(take);
    return shadows.rays();
  };
  const auto indirect = [&](std::uint32_t patch, double rho, PointSums& sums) {
    const base::Key key(options_.seed, base::Stream::Refinement, identity(patches, patch));
    RayPacket packet;
    scenes::HitPacket hits;
    std::array<Vec3, RayPacket::width> local;  // equal at all points
    const double weight = rho / static_cast<double>(gather_directions);
    for (std::size_t set = 0; set < 2; ++set) {
      const base::SobolOwen4 toward(key.with(0xFFFF0000ULL + set));
      for (std::size_t first = 0; first < gather_directions; first += RayPacket::width) {
        for (std::size_t k = 0; k < RayPacket::width; ++k) {
          const auto u = toward.point2(static_cast<std::uint32_t>(first + k));
          const float r = std::sqrt(u[0]), phi = 2.0F * static_cast<float>(base::pi) * u[1];
          local[k] = {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0F - u[0])};
        }
        for (std::size_t point = 0; point < indirect_points; ++point) {
          const double x = point < 2 ? 0.25 : 0.75, y = point % 2 == 0 ? 0.25 : 0.75;
          const SurfacePoint from = patches.at(patch, x, y);
          const base::Frame3 frame = base::frame_around(from.normal);
          const Vec3 origin = lifted(from, world_.query);
          std::array<Vec3, RayPacket::width> directions;
          sums.place(point, x, y);
          for (std::size_t k = 0; k < RayPacket::width; ++k) {
            directions[k] = frame.to_world(local[k]);
            world_.query.set(packet, k, origin, directions[k]);
          }
          world_.query.closest(packet, RayPacket::width, hits);
          for (std::size_t k = 0; k < RayPacket::width; ++k) {
            if (hits.triangle[k] == scenes::no_triangle) {
              if (!world_.effects.earth_by_gather) continue;
              const Rgb sky = scenes::earth_radiance(world_.scene, directions[k]);
              const std::size_t group =
                  earth_group_ + scenes::earth_part(world_.scene, directions[k]);
              sums.at(point, set, group) +=
                  weight * light.scale[group] * base::pi * base::luminance(sky);
              continue;
            }
            const std::uint32_t to = light.patches->find(hits.triangle[k], double(hits.u[k]),
                                                         double(hits.v[k]), hits.front[k] != 0);
            if (to == no_patch) continue;
            for (std::size_t g = 0; g < groups_; ++g) {
              sums.at(point, set, g) += weight * double(light.brightness[to * groups_ + g]);
            }
          }
        }
      }
    }
    return std::uint64_t{2 * indirect_points * gather_directions};
  };
  const auto sample = [&](std::size_t begin, std::size_t end) {
    std::uint64_t& rays = rays_of[begin / chunk];
    for (std::size_t k = begin; k < end; ++k) {
      const Rgb rho = reflectances_.of(patches, which[k]);
      if (base::max_component(rho) <= 0.0) continue;
      PointSums sharp(points_on(patches.area_m2[which[k]]), groups_),
          soft(indirect_points, groups_);
      rays += direct(which[k], rho, sharp);
      rays += indirect(which[k], base::luminance(rho), soft);
      const double weight = patches.area_m2[which[k]] / (light.area_m2 * lit_groups);
      Unevenness& sum = found[k];
      for (std::size_t g = 0; g < groups_; ++g) {
        sharp.add_to(sum, g);
        soft.add_to(sum, g);
      }
      sum = {weight * sum.error, weight * sum.along_s, weight * sum.along_t};
    }
  };
  base::share_chunks(which.size(), chunk, sample,
                     [&](std::size_t begin, std::size_t end, base::Parcel& parcel) {
                       parcel.pass_range(&found[begin], end - begin);
                       parcel.pass(rays_of[begin / chunk]);
                     });
  for (const std::uint64_t rays : rays_of) rays_ += rays;
  return found;
}

}  // namespace earthshine::radiosity
