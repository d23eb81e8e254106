// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/surface_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/free_memory.h"
#include "radiosity/linear_solve.h"
#include "raytrace/surfaces/shared_samples.h"
#include "scenes/reflect/energy.h"
#include "scenes/triangle_point.h"

namespace earthshine::raytrace {
namespace {

constexpr std::uint8_t more_shadow_rays = 8;
constexpr double of_the_error = 1e-3;  // tolerance of the equation of the error

constexpr double spots = 256.0;  // along the scene's diagonal

double spot_m2_of(const scenes::Scene& scene) {
  if (scene.vertices.empty()) return 0.0;
  const double edge_m = scenes::box_around(scene.vertices).diagonal() / spots;
  return edge_m * edge_m;
}

float mixed(float old, double found, double share) {
  return static_cast<float>(double(old) + share * (found - double(old)));
}

}  // namespace

LightOnSurfaces::LightOnSurfaces(const scenes::World& scene, radiosity::Solution coarse,
                                 radiosity::FormFactors factors, double rays)
    : scene_(scene), factors_(std::move(factors)), reflectances_(scene.scene) {
  const radiosity::Patches& patches = coarse.patches;
  const std::size_t count = patches.count(), columns = coarse.columns;
  const std::vector<bool> is_explicit = radiosity::emitter_is_explicit(scene.scene);
  coarse_.resize(count);
  std::iota(coarse_.begin(), coarse_.end(), 0U);
  coarse_reflectance_ = radiosity::reflectances(scene.scene, patches, factors_.shares.own(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    emitted_.push_back(is_explicit[patches.material(i)]
                           ? Rgb(0.0)
                           : radiosity::patch_emit(scene.scene, patches, i));
  }
  if (std::all_of(emitted_.begin(), emitted_.end(), [](const Rgb& m) { return m == Rgb(0.0); })) {
    base::release(emitted_);
  }
  lamp_rays_.assign(count, radiosity::DirectOptions{}.points_per_patch);
  gather_rays_.assign(count, 0.5 * rays);
  light_.shadow_rays.assign(count, 1);
  light_.spot_m2 = spot_m2_of(scene.scene);
  light_.open_share = factors_.open.share;
  escape_ = factors_.escape;
  lost_ = factors_.lost;
  light_.lamps = std::move(coarse.direct_lx);
  light_.gathered = std::move(coarse.indirect_lx);
  if (scene.effects.earth_by_gather) {
    light_.sky = std::move(factors_.sky_illuminance);
    const std::size_t parts = light_.sky.size() / count;
    for (std::size_t i = 0; i < count * parts; ++i) {
      const std::size_t at = (i / parts) * columns + 3 * (scene.groups.earth + i % parts);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto lx = static_cast<float>(light_.sky[i][static_cast<int>(c)]);
        light_.lamps[at + c] = std::max(0.0F, light_.lamps[at + c] - lx);
        light_.gathered[at + c] += lx;
      }
    }
  }
  base::release(coarse.indirect_radiosity);
  light_.solution = std::move(coarse);
  sum_up();
  if (!factors_.shares.is_root()) drop_unread();
}

void LightOnSurfaces::drop_unread() {
  for (std::vector<Rgb>* const unread : {&emitted_, &light_.sky, &factors_.kept_direct}) {
    base::release(*unread);
  }
  for (std::vector<double>* const unread :
       {&lamp_rays_, &gather_rays_, &escape_, &lost_, &factors_.open.share, &factors_.kept,
        &factors_.black, &factors_.escape, &factors_.lost}) {
    base::release(*unread);
  }
  base::release(coarse_);
}

// B = M + rho (lamps + gathered).
void LightOnSurfaces::sum_up() {
  const std::size_t columns = light_.columns();
  std::vector<float>& b = light_.solution.radiosity;
  b.resize(light_.count() * columns);
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const auto patch = static_cast<std::uint32_t>(i);
    const Rgb rho = reflectances_.of(patches(), patch);
    const std::size_t group = scene_.groups.material[patches().material(patch)];
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = i * columns + k;
      const auto c = static_cast<int>(k % 3);
      const double emitted = k / 3 == group && !emitted_.empty() ? emitted_[coarse_[i]][c] : 0.0;
      b[at] = static_cast<float>(emitted +
                                 rho[c] * (double(light_.lamps[at]) + double(light_.gathered[at])));
    }
  }
}

double LightOnSurfaces::mean_radiosity() const {
  const std::size_t columns = light_.columns();
  double sum = 0.0, area = 0.0;
  for (std::size_t i = 0; i < light_.count(); ++i) {
    Rgb b(0.0);
    for (std::size_t k = 0; k < columns; ++k) {
      b[static_cast<int>(k % 3)] += double(light_.solution.radiosity[i * columns + k]);
    }
    const double part = light_.open_m2(i);
    sum += part * base::luminance(b);
    area += part;
  }
  return area > 0.0 ? sum / area : 0.0;
}

double LightOnSurfaces::mean_on_all_ranks() const {
  double mean = factors_.shares.is_root() ? mean_radiosity() : 0.0;
  factors_.shares.broadcast(&mean, 1);
  return mean;
}

std::vector<double> LightOnSurfaces::brought(std::vector<double> residual,
                                             std::size_t columns) const {
  const base::Shares& shares = factors_.shares;
  const auto [begin, end] = shares.own(factors_.count());
  std::vector<double> source(shares.is_root() ? 0 : (end - begin) * columns);
  if (shares.is_root()) source = means_of(residual, columns);
  base::release(residual);
  shares.scatter(source.data(), columns);
  source.resize((end - begin) * columns);
  source.shrink_to_fit();
  std::vector<double> found = radiosity::solve_linear(factors_, std::move(source),
                                                      coarse_reflectance_, columns, of_the_error)
                                  .fx;
  if (shares.is_root()) found.resize(factors_.count() * columns);
  shares.gather(found.data(), columns);
  return found;
}

// Means of a residual, per coarse patch and column.
std::vector<double> LightOnSurfaces::means_of(const std::vector<double>& residual,
                                              std::size_t columns) const {
  const std::size_t coarse = factors_.count();
  std::vector<double> area(coarse, 0.0), mean(coarse * columns, 0.0);
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const double part = light_.open_m2(i);
    area[coarse_[i]] += part;
    for (std::size_t k = 0; k < columns; ++k) {
      mean[coarse_[i] * columns + k] += part * residual[i * columns + k];
    }
  }
  for (std::size_t j = 0; j < coarse; ++j) {
    for (std::size_t k = 0; k < columns; ++k) {
      mean[j * columns + k] = area[j] > 0.0 ? mean[j * columns + k] / area[j] : 0.0;
    }
  }
  return mean;
}

void LightOnSurfaces::correct(const SurfaceSamples& samples, std::span<const std::uint32_t> which,
                              std::span<const SampleBudget> budget) {
  const std::size_t columns = light_.columns();
  const bool gathers =
      std::any_of(budget.begin(), budget.end(), [](const SampleBudget& e) { return e.rays > 0; });
  const bool is_root = factors_.shares.is_root();
  std::vector<double> more, residual;
  if (gathers) {
    if (is_root) residual.assign(light_.count() * columns, 0.0);
    for (const std::uint32_t i : is_root ? which : std::span<const std::uint32_t>()) {
      if (samples.residual[i].taken == 0) continue;
      const Rgb rho = reflectances_.of(patches(), i);
      for (std::size_t k = i * columns; k < (i + 1) * columns; ++k) {
        residual[k] =
            rho[static_cast<int>(k % 3)] * (samples.lamps[k] + samples.gathered[k] -
                                            double(light_.lamps[k]) - double(light_.gathered[k]));
      }
    }
    more = brought(std::move(residual), columns);
  }
  if (is_root && gathers)
    take_gathered(samples, SharedSamples(light_, reflectances_, samples, which, budget, coarse_),
                  which, more);
  for (std::size_t n = 0; is_root && n < which.size(); ++n) {
    const std::uint32_t i = which[n];
    const PatchResidual& seen = samples.residual[i];
    if (base::max_component(reflectances_.of(patches(), i)) <= 0.0) continue;  // not sampled
    if (seen.taken == 0) {  // completely covered: no light
      std::fill_n(&light_.lamps[i * columns], columns, 0.0F);
      std::fill_n(&light_.gathered[i * columns], columns, 0.0F);
      if (!light_.open_share.empty()) light_.open_share[i] = 0.0;
      continue;
    }
    const double rays = double(seen.taken) * light_.shadow_rays[i];
    const double by_lamps = rays / (lamp_rays_[i] + rays);
    for (std::size_t k = i * columns; k < (i + 1) * columns; ++k) {
      light_.lamps[k] = mixed(light_.lamps[k], samples.lamps[k], by_lamps);
    }
    lamp_rays_[i] += rays;
    if (seen.wants_shadow_rays) light_.shadow_rays[i] = more_shadow_rays;
    if (!light_.open_share.empty()) light_.open_share[i] = double(seen.open);
  }
  if (is_root) sum_up();
  for (std::vector<float>* const values :
       {&light_.lamps, &light_.gathered, &light_.solution.radiosity}) {
    factors_.shares.broadcast(values->data(), values->size());
  }
  factors_.shares.broadcast(light_.open_share.data(), light_.open_share.size());
  factors_.shares.broadcast(light_.shadow_rays.data(), light_.shadow_rays.size());
}

// more: indirect correction by bounces, per coarse patch and column.
void LightOnSurfaces::take_gathered(const SurfaceSamples& samples, const SharedSamples& sharing,
                                    std::span<const std::uint32_t> which,
                                    const std::vector<double>& more) {
  const std::size_t columns = light_.columns();
  const std::size_t parts = light_.count() > 0 ? light_.sky.size() / light_.count() : 0;
  const std::vector<double> gathered = sharing.share(columns, [&](std::uint32_t i, std::size_t k) {
    const std::size_t at = i * columns + k;
    return samples.gathered[at] + more[coarse_[i] * columns + k] - double(light_.gathered[at]);
  });
  const std::vector<double> sky = sharing.share(3 * parts, [&](std::uint32_t i, std::size_t k) {
    const std::size_t at = i * parts + k / 3;
    return samples.sky[at][static_cast<int>(k % 3)] - light_.sky[at][static_cast<int>(k % 3)];
  });
  const std::vector<double> ends = sharing.share(2, [&](std::uint32_t i, std::size_t k) {
    return k == 0 ? samples.escaped[i] - escape_[i] : samples.lost[i] - lost_[i];
  });
  for (const std::uint32_t i : which) {
    const double rays = sharing.rays(i);
    if (rays <= 0.0) continue;
    gather_rays_[i] = sharing.still_counting(i, gather_rays_[i]);
    const double by_rays = rays / (gather_rays_[i] + rays);
    for (std::size_t k = i * columns; k < (i + 1) * columns; ++k) {
      light_.gathered[k] = static_cast<float>(double(light_.gathered[k]) + by_rays * gathered[k]);
    }
    for (std::size_t k = 3 * i * parts; k < 3 * (i + 1) * parts; ++k) {
      light_.sky[k / 3][static_cast<int>(k % 3)] += by_rays * sky[k];
    }
    escape_[i] += by_rays * ends[2 * i];
    lost_[i] += by_rays * ends[2 * i + 1];
    gather_rays_[i] += rays;
  }
}

std::vector<std::uint32_t> LightOnSurfaces::cut(const std::vector<radiosity::Cut>& wanted,
                                                std::span<const float> kept_rays) {
  const std::size_t columns = light_.columns(), groups = columns / 3;
  const std::size_t parts = light_.count() > 0 ? light_.sky.size() / light_.count() : 0;
  radiosity::Split made = radiosity::split(patches(), wanted);
  const LeakMask sight(scene_.query, patches());
  const RadianceTable table(light_.solution, light_.gathered, true, sight);
  const std::size_t count = made.patches.count();
  SurfaceLight finer;
  finer.spot_m2 = light_.spot_m2;
  finer.lamps.resize(count * columns);
  finer.gathered.resize(count * columns);
  finer.sky.resize(count * parts);
  finer.open_share.resize(light_.open_share.empty() ? 0 : count);
  finer.shadow_rays.resize(count);
  const bool is_root = factors_.shares.is_root();
  const std::size_t kept = is_root ? count : 0;
  std::vector<std::uint32_t> coarse(kept);
  std::vector<double> points(kept), rays(kept), escape(kept), lost(kept);
  std::vector<Rgb> between(groups);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t parent = made.parent[i];
    const bool whole = made.patches.area_m2[i] >= patches().area_m2[parent];
    if (is_root) {
      coarse[i] = coarse_[parent];
      points[i] = whole ? lamp_rays_[parent] : 0.0;
      rays[i] = (whole ? 1.0 : double(kept_rays[parent])) * gather_rays_[parent];
      escape[i] = escape_[parent];
      lost[i] = lost_[parent];
    }
    finer.shadow_rays[i] = light_.shadow_rays[parent];
    if (!finer.open_share.empty()) finer.open_share[i] = light_.open_share[parent];
    std::copy_n(&light_.lamps[parent * columns], columns, &finer.lamps[i * columns]);
    std::copy_n(&light_.gathered[parent * columns], columns, &finer.gathered[i * columns]);
    std::copy_n(light_.sky.begin() + static_cast<std::ptrdiff_t>(parent * parts), parts,
                finer.sky.begin() + static_cast<std::ptrdiff_t>(i * parts));
    if (whole) continue;
    std::fill(between.begin(), between.end(), Rgb(0.0));
    table.add(hit_at(made.patches, i, 0.5, 0.5), Rgb(base::pi), between);
    for (std::size_t k = 0; k < columns; ++k) {
      finer.gathered[i * columns + k] = static_cast<float>(between[k / 3][static_cast<int>(k % 3)]);
    }
  }
  finer.solution.report = std::move(light_.solution.report);
  finer.solution.columns = columns;
  finer.solution.patches = std::move(made.patches);
  light_ = std::move(finer);
  coarse_ = std::move(coarse);
  lamp_rays_ = std::move(points);
  gather_rays_ = std::move(rays);
  escape_ = std::move(escape);
  lost_ = std::move(lost);
  if (is_root) sum_up();
  light_.solution.radiosity.resize(count * columns);
  factors_.shares.broadcast(light_.solution.radiosity.data(), count * columns);
  return std::move(made.parent);
}

}  // namespace earthshine::raytrace
