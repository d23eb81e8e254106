// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/surface_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/linear_solve.h"
#include "scenes/reflect/energy.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::studies {
namespace {

constexpr double of_the_error = 1e-3;  // to which the error's own equation is solved
// Halves of a cell share what their parent gathered, which is not all that they need.
constexpr double inherited_rays = 0.5;

float mixed(float old, double found, double share) {
  return static_cast<float>(double(old) + share * (found - double(old)));
}

}  // namespace

LightOnSurfaces::LightOnSurfaces(const StudyScene& scene, radiosity::Solution coarse,
                                 radiosity::FormFactors factors, double rays)
    : scene_(scene), factors_(std::move(factors)), reflectances_(scene.scene) {
  const radiosity::Patches& patches = coarse.patches;
  const std::size_t count = patches.count(), columns = coarse.columns;
  emitted_ = radiosity::exitances(scene.scene, scene.groups, patches);
  coarse_open_m2_ = radiosity::open_areas(factors_.open, patches.area_m2);
  coarse_.resize(count);
  std::iota(coarse_.begin(), coarse_.end(), 0U);
  for (std::uint32_t i = 0; i < count; ++i)
    coarse_reflectance_.push_back(reflectances_.of(patches, i));
  lamp_points_.assign(count, radiosity::DirectOptions{}.points_per_patch);
  gather_rays_.assign(count, 0.5 * rays);
  open_share_ = factors_.open.share;
  escape_ = factors_.escape;
  lost_ = factors_.lost;
  light_.lamps = coarse.direct_lx;
  light_.gathered = coarse.indirect_lx;
  if (scene.effects.earth_by_gather) {
    light_.sky = factors_.sky_illuminance;
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
  light_.solution = std::move(coarse);
  sum_up();
}

// B = M + rho (lamps + gathered).
void LightOnSurfaces::sum_up() {
  const std::size_t columns = light_.columns();
  std::vector<float>& b = light_.solution.radiosity;
  b.resize(light_.count() * columns);
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const Rgb rho = reflectances_.of(patches(), static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = i * columns + k;
      b[at] = static_cast<float>(emitted_[coarse_[i] * columns + k] +
                                 rho[static_cast<int>(k % 3)] *
                                     (double(light_.lamps[at]) + double(light_.gathered[at])));
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
    const double part = patches().area_m2[i] * (open_share_.empty() ? 1.0 : open_share_[i]);
    sum += part * base::luminance(b);
    area += part;
  }
  return area > 0.0 ? sum / area : 0.0;
}

std::vector<double> LightOnSurfaces::brought(const std::vector<double>& residual,
                                             std::size_t columns) const {
  const std::size_t coarse = coarse_reflectance_.size();
  std::vector<double> source(coarse * columns, 0.0), area(coarse, 0.0), rho(coarse * columns);
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const double part = patches().area_m2[i] * (open_share_.empty() ? 1.0 : open_share_[i]);
    area[coarse_[i]] += part;
    for (std::size_t k = 0; k < columns; ++k) {
      source[coarse_[i] * columns + k] += part * residual[i * columns + k];
    }
  }
  for (std::size_t j = 0; j < coarse; ++j) {
    for (std::size_t k = 0; k < columns; ++k) {
      source[j * columns + k] = area[j] > 0.0 ? source[j * columns + k] / area[j] : 0.0;
      rho[j * columns + k] = coarse_reflectance_[j][static_cast<int>(k % 3)];
    }
  }
  const radiosity::LinearSolve error =
      radiosity::solve_linear(factors_, std::move(source), rho, columns, of_the_error);
  std::vector<double> light(error.x.size());
  radiosity::multiply(factors_, error.x, light, columns);
  return light;
}

void LightOnSurfaces::correct(const SurfaceSamples& samples, std::span<const std::uint32_t> which,
                              std::span<const Effort> effort) {
  const std::size_t columns = light_.columns();
  const std::size_t parts = light_.count() > 0 ? light_.sky.size() / light_.count() : 0;
  const bool gathers =
      std::any_of(effort.begin(), effort.end(), [](const Effort& e) { return e.rays > 0; });
  std::vector<double> more;
  if (gathers) {
    std::vector<double> residual(light_.count() * columns, 0.0);
    for (const std::uint32_t i : which) {
      if (samples.residual[i].taken == 0) continue;
      const Rgb rho = reflectances_.of(patches(), i);
      for (std::size_t k = i * columns; k < (i + 1) * columns; ++k) {
        residual[k] =
            rho[static_cast<int>(k % 3)] * (samples.lamps[k] + samples.gathered[k] -
                                            double(light_.lamps[k]) - double(light_.gathered[k]));
      }
    }
    more = brought(residual, columns);
  }
  for (std::size_t n = 0; n < which.size(); ++n) {
    const std::uint32_t i = which[n];
    const PatchResidual& seen = samples.residual[i];
    if (base::max_component(reflectances_.of(patches(), i)) <= 0.0) continue;  // not sampled
    if (seen.taken == 0) {  // wholly covered: no light reaches it
      std::fill_n(&light_.lamps[i * columns], columns, 0.0F);
      std::fill_n(&light_.gathered[i * columns], columns, 0.0F);
      if (!open_share_.empty()) open_share_[i] = 0.0;
      continue;
    }
    const double points = seen.taken, rays = 2.0 * seen.taken * effort[n].rays;
    const double by_lamps = points / (lamp_points_[i] + points);
    const double by_rays = rays > 0.0 ? rays / (gather_rays_[i] + rays) : 0.0;
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = i * columns + k;
      light_.lamps[at] = mixed(light_.lamps[at], samples.lamps[at], by_lamps);
      if (rays <= 0.0) continue;
      light_.gathered[at] = mixed(light_.gathered[at],
                                  samples.gathered[at] + more[coarse_[i] * columns + k], by_rays);
    }
    for (std::size_t s = i * parts; rays > 0.0 && s < (i + 1) * parts; ++s) {
      light_.sky[s] += by_rays * (samples.sky[s] - light_.sky[s]);
    }
    escape_[i] += by_rays * (samples.escaped[i] - escape_[i]);
    lost_[i] += by_rays * (samples.lost[i] - lost_[i]);
    lamp_points_[i] += points;
    gather_rays_[i] += rays;
    if (!open_share_.empty()) open_share_[i] = double(seen.taken) / seen.tried;
  }
  sum_up();
}

std::vector<std::uint32_t> LightOnSurfaces::cut(const std::vector<radiosity::Cut>& wanted) {
  const std::size_t columns = light_.columns(), groups = columns / 3;
  const std::size_t parts = light_.count() > 0 ? light_.sky.size() / light_.count() : 0;
  radiosity::Split made = radiosity::split(patches(), wanted);
  const raytrace::LeakMask sight(scene_.query, patches());
  const raytrace::RadianceTable table(light_.solution, light_.gathered, true, sight);
  const std::size_t count = made.patches.count();
  SurfaceLight finer;
  finer.lamps.resize(count * columns);
  finer.gathered.resize(count * columns);
  finer.sky.resize(count * parts);
  std::vector<std::uint32_t> coarse(count);
  std::vector<double> points(count), rays(count), escape(count), lost(count),
      open(open_share_.empty() ? 0 : count);
  std::vector<Rgb> between(groups);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t parent = made.parent[i];
    const bool whole = made.patches.area_m2[i] >= patches().area_m2[parent];
    coarse[i] = coarse_[parent];
    points[i] = whole ? lamp_points_[parent] : 0.0;
    rays[i] = (whole ? 1.0 : inherited_rays) * gather_rays_[parent];
    escape[i] = escape_[parent];
    lost[i] = lost_[parent];
    if (!open.empty()) open[i] = open_share_[parent];
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
  lamp_points_ = std::move(points);
  gather_rays_ = std::move(rays);
  open_share_ = std::move(open);
  escape_ = std::move(escape);
  lost_ = std::move(lost);
  sum_up();
  return std::move(made.parent);
}

// B = M + rho (E0 + k I), per column the one k with which all light ends somewhere:
//   sum A ((a - rho) k I + B (escape + lost)) = sum A (M + rho E0)
// What samples leave of that sum is their noise and no light. Where rows were not balanced there is
// no such k to be known.
void LightOnSurfaces::close_energy(radiosity::PatchLight& found) const {
  constexpr double most = 0.2;  // off 1
  const std::size_t columns = light_.columns();
  std::vector<double> lit(columns, 0.0), ended(columns, 0.0);
  const auto known = [&](std::size_t at) {
    return found.emitted[at] + found.reflectance[at] * found.direct[at];
  };
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const double area = patches().area_m2[i] * (open_share_.empty() ? 1.0 : open_share_[i]);
    const double gone = escape_[i] + lost_[i], kept = factors_.kept[coarse_[i]];
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = i * columns + k;
      const double rho = found.reflectance[at];
      lit[k] += area * known(at) * (1.0 - gone);
      ended[k] += area * found.indirect[at] * (kept - rho + rho * gone);
    }
  }
  found.radiosity.resize(found.direct.size());
  for (std::size_t at = 0; at < found.radiosity.size(); ++at) {
    const std::size_t k = at % columns;
    const double scale = ended[k] > 0.0 ? lit[k] / ended[k] : 1.0;
    if (light_.solution.report.balance.balanced && std::abs(scale - 1.0) < most) {
      found.indirect[at] *= scale;
    }
    found.radiosity[at] = known(at) + found.reflectance[at] * found.indirect[at];
  }
}

radiosity::Solution LightOnSurfaces::finished() const {
  radiosity::Solution solution;
  solution.patches = patches();
  solution.columns = light_.columns();
  solution.report = light_.solution.report;
  solution.report.patches = light_.count();
  const std::size_t columns = light_.columns(), count = light_.count();
  const std::size_t parts = count > 0 ? light_.sky.size() / count : 0;
  radiosity::PatchLight found;
  found.reflectance = radiosity::reflectances(scene_.scene, patches(), scene_.groups.count());
  found.emitted = radiosity::exitances(scene_.scene, scene_.groups, patches());
  found.direct.assign(light_.lamps.begin(), light_.lamps.end());
  found.indirect.assign(light_.gathered.begin(), light_.gathered.end());
  for (std::size_t i = 0; i < count * parts; ++i) {
    const std::size_t at = (i / parts) * columns + 3 * (scene_.groups.earth + i % parts);
    for (std::size_t c = 0; c < 3; ++c) {
      found.direct[at + c] += light_.sky[i][static_cast<int>(c)];
      found.indirect[at + c] =
          std::max(0.0, found.indirect[at + c] - light_.sky[i][static_cast<int>(c)]);
    }
  }
  close_energy(found);
  found.sky = light_.sky;
  radiosity::FormFactors ends;  // where light ends, of each patch as of its coarse one
  for (const std::uint32_t j : coarse_) {
    ends.kept.push_back(factors_.kept[j]);
    if (!factors_.kept_direct.empty()) ends.kept_direct.push_back(factors_.kept_direct[j]);
  }
  ends.escape = escape_;
  ends.lost = lost_;
  ends.open = {open_share_, factors_.open.bodies};
  std::vector<double> backs;
  for (const auto& object : solution.report.objects) backs.push_back(object.back_share);
  radiosity::fill_solution(scene_.scene, scene_.groups, scene_.effects, ends,
                           solution.report.balance.balanced, found, solution);
  for (std::size_t o = 0; o < backs.size(); ++o) solution.report.objects[o].back_share = backs[o];
  return solution;
}

}  // namespace earthshine::studies
