// SPDX-License-Identifier: Apache-2.0
#include "studies/light/light_basis.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::studies {
namespace {

using base::pi;
using scenes::no_group;

constexpr double same_direction = 1e-9;  // rad
constexpr int cell_side = 12;            // directions across a cell for its mean radiance
constexpr double no_sun = 1e-12;         // factor of a Sun that is off while the Earth reflects its
                                         // light
// Bound of the range of a smooth radiance between two of these directions over its range on them:
// 1 / 12^2 of a parabola's range over the cell, and half as much more for other functions.
constexpr double between_directions = 1.01;

bool same(const Vec3& a, const Vec3& b) { return glm::length(a - b) < same_direction; }

// The widest disc of the Earth, if its direction is fixed and its size nearly so: along a
// trajectory the height changes by kilometres. Rim cells of a narrower disc are dark beyond its
// limb.
const scenes::Earth* same_disc(const std::vector<SkyPlace>& places) {
  constexpr double nearly_one_size_deg = 1.0;
  const scenes::Earth *widest = nullptr, *narrowest = nullptr;
  for (const SkyPlace& place : places) {
    if (!place.earth) continue;
    const scenes::Earth* const earth = &*place.earth;
    if (widest != nullptr && !same(widest->direction, earth->direction)) return nullptr;
    if (widest == nullptr || earth->half_angle_deg > widest->half_angle_deg) widest = earth;
    if (narrowest == nullptr || earth->half_angle_deg < narrowest->half_angle_deg) {
      narrowest = earth;
    }
  }
  const bool alike = widest != nullptr &&
                     widest->half_angle_deg - narrowest->half_angle_deg <= nearly_one_size_deg;
  return alike ? widest : nullptr;
}

// A scene without surfaces, for the functions of the sky.
scenes::Scene bare(const SkyPlace& place) {
  scenes::Scene scene;
  scene.sun = place.sun;
  scene.earth = place.earth;
  return scene;
}

// Moves a direction outside the Earth's disc to its limb.
Vec3 onto_disc(const scenes::Earth& earth, const Vec3& direction) {
  const double h = base::radians(earth.half_angle_deg) * (1.0 - 1e-9);
  const double cosine = glm::dot(direction, earth.direction);
  const Vec3 across = direction - cosine * earth.direction;
  if (cosine >= std::cos(h) || glm::length(across) < same_direction) return direction;
  return std::cos(h) * earth.direction + std::sin(h) * glm::normalize(across);
}

// Mean illuminance by the lamps: flux over surface area, plus the distant lamps'
// illuminance; 1000 lx without lamps.
double lamp_level_lx(const scenes::Scene& scene) {
  double flux = 0.0, area = 0.0;
  double distant_lx = 0.0;
  for (const scenes::Lamp& lamp : scene.lamps) {
    flux += base::luminance(scenes::lamp_flux_lm(lamp));
    distant_lx += base::luminance(lamp.illuminance_lx);
  }
  for (const scenes::Object& object : scene.objects) area += object.area_m2;
  const double level_lx = distant_lx + (area > 0.0 ? flux / area : 0.0);
  return level_lx > 0.0 ? level_lx : 1000.0;
}

}  // namespace

SkyPlace sky_of(const scenes::Scene& scene) { return {scene.sun, scene.earth}; }

LightBasis::LightBasis(const scenes::Scene& scene, std::vector<SkyPlace> places,
                       std::vector<LampSetting> settings, const BasisOptions& options)
    : original_(scene),
      scene_(scene),
      places_(std::move(places)),
      settings_(std::move(settings)),
      sun_of_place_(places_.size(), no_group) {
  for (const scenes::Lamp& lamp : scene.lamps) group_of_lamp_.push_back(lamp.group);
  check_settings();
  split_lamps();
  if (places_.size() == 1) {
    scene_.sun = places_.front().sun;
    scene_.earth = places_.front().earth;
  } else {
    split_sky(options);
  }
  groups_ = scenes::find_light_groups(scene_);
}

void LightBasis::split_sky(const BasisOptions& options) {
  const double level = lamp_level_lx(scene_);
  scenes::SkyParts parts;
  bool earth_lit = false;
  double largest_sun = 0.0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const scenes::Scene sky = bare(places_[k]);
    earth_lit = earth_lit || scenes::earth_is_lit(sky);
    if (scenes::visible_sun_share(sky) <= 0.0) continue;
    const scenes::Sun& sun = *places_[k].sun;
    largest_sun = std::max(largest_sun, base::luminance(sun.illuminance_lx));
    const auto found = std::find_if(
        parts.suns.begin(), parts.suns.end(),
        [&](const scenes::Sun& known) { return same(known.direction, sun.direction); });
    sun_of_place_[k] = static_cast<std::size_t>(found - parts.suns.begin());
    if (found == parts.suns.end()) parts.suns.push_back(sun);
  }
  if (largest_sun > 0.0) {
    sun_scale_ = level / (largest_sun * static_cast<double>(parts.suns.size()));
    for (scenes::Sun& sun : parts.suns) sun.illuminance_lx *= sun_scale_;
  }
  scene_.sun.reset();
  scene_.earth.reset();
  if (earth_lit) {
    scenes::Earth earth;
    earth.model = scenes::EarthModel::Uniform;
    if (const scenes::Earth* const disc = same_disc(places_)) {
      earth.direction = disc->direction;
      earth.half_angle_deg = disc->half_angle_deg;
      parts.cells = scenes::cells_of_disc(earth.direction, base::radians(earth.half_angle_deg),
                                          options.disc_cells);
    } else {
      earth.half_angle_deg = 180.0;
      parts.cells = scenes::cells_of_sphere(options.sphere_cells);
    }
    earth_unit_ = level / pi;
    earth.radiance = Rgb(earth_unit_);
    scene_.earth = earth;
  }
  scene_.sky_parts = std::make_shared<const scenes::SkyParts>(std::move(parts));
}

scenes::Scene LightBasis::scene_at(std::size_t place, std::size_t setting) const {
  scenes::Scene scene = original_;
  scene.sun = places_[place].sun;
  scene.earth = places_[place].earth;
  const Rgb sun = glm::max(sky_factor(settings_[setting], "sun"), Rgb(no_sun));
  const Rgb earth = sky_factor(settings_[setting], "earth");
  if (scene.sun) scene.sun->illuminance_lx *= sun;
  // The Earth reflects the Sun's light: its albedo cancels the Sun's factor.
  if (scene.earth) {
    scene.earth->albedo *= earth / sun;
    scene.earth->radiance *= earth;
  }
  for (scenes::Lamp& lamp : scene.lamps) {
    const Rgb times = factor(settings_[setting], lamp.name, lamp.group);
    lamp.dim(times);
  }
  for (scenes::Material& material : scene.materials) {
    if (!material.emits()) continue;
    material.emit *= factor(settings_[setting], material.light_group, material.light_group);
  }
  return scene;
}

std::size_t LightBasis::sun_parts() const {
  if (in_parts()) return scene_.sky_parts->suns.size();
  return groups_.sun == no_group ? 0 : 1;
}

std::size_t LightBasis::earth_parts() const {
  return groups_.earth == no_group ? 0 : scenes::earth_parts(scene_);
}

GroupWeights LightBasis::weights(std::size_t place, std::size_t setting, double lamps) const {
  return weigh(place, settings_[setting], lamps);
}

GroupWeights LightBasis::weights_with(std::size_t place, std::size_t setting,
                                      const std::string& light) const {
  const auto group = std::find(groups_.names.begin(), groups_.names.end(), light);
  if (group != groups_.names.end()) {
    GroupWeights weights = weigh(place, settings_[setting], 1.0);
    weights.weight[static_cast<std::size_t>(group - groups_.names.begin())] = Rgb(1.0);
    return weights;
  }
  LampSetting changed = settings_[setting];
  changed.factors[light] = Rgb(1.0);
  return weigh(place, changed, 1.0);
}

GroupWeights LightBasis::weigh(std::size_t place, const LampSetting& setting, double lamps) const {
  GroupWeights weights{std::vector<Rgb>(groups_.count(), Rgb(0.0)),
                       std::vector<double>(groups_.count(), 0.0),
                       std::vector<double>(groups_.count(), 0.0)};
  const auto set = [&weights](std::size_t group, const Rgb& value) {
    if (group != no_group) weights.weight[group] = value;
  };
  for (std::size_t k = 0; k < scene_.lamps.size(); ++k) {
    set(groups_.lamp[k], lamps * factor(setting, scene_.lamps[k].name, group_of_lamp_[k]));
  }
  for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
    const std::string& group = original_.materials[m].light_group;
    set(groups_.material[m], lamps * factor(setting, group, group));
  }
  set(groups_.ambient, Rgb(1.0));
  const Rgb sun = sky_factor(setting, "sun");
  const Rgb earth = sky_factor(setting, "earth");
  if (!in_parts()) {
    set(groups_.sun, sun);
    set(groups_.earth, earth);
    return weights;
  }
  if (sun_of_place_[place] != no_group) {
    const std::size_t part = sun_of_place_[place];
    const double share = scenes::visible_sun_share(bare(places_[place]));
    const Rgb& unit = scene_.sky_parts->suns[part].illuminance_lx;
    for (int c = 0; c < 3; ++c) {
      const double wanted = places_[place].sun->illuminance_lx[c];
      weights.weight[groups_.sun_parts + part][c] =
          unit[c] > 0.0 ? sun[c] * share * wanted / unit[c] : 0.0;
    }
  }
  if (groups_.earth != no_group && places_[place].earth) {
    weigh_earth(places_[place], earth, weights);
  }
  return weights;
}

void LightBasis::weigh_earth(const SkyPlace& place, const Rgb& factor,
                             GroupWeights& weights) const {
  const scenes::Scene sky = bare(place);
  if (!scenes::earth_is_lit(sky) || base::max_component(factor) <= 0.0) return;
  const scenes::SkyCells& cells = *scene_.sky_parts->cells;
  const scenes::EarthRadiance radiance(sky);
  base::parallel_chunks(cells.count(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      std::vector<Rgb> seen;
      Rgb mean(0.0);
      cells.visit(cell, cell_side, [&](const Vec3& direction) {
        seen.push_back(factor * radiance(direction) / earth_unit_);
        mean += seen.back();
      });
      mean /= static_cast<double>(seen.size());
      double largest = 0.0, squares = 0.0;
      for (const Rgb& value : seen) {
        squares += std::pow(base::luminance(value) - base::luminance(mean), 2);
      }
      // The extremes are at edges and at the limb.
      const auto add_extreme = [&](const Vec3& direction) {
        const Rgb value = factor * radiance(direction) / earth_unit_;
        largest = std::max(largest, std::abs(base::luminance(value) - base::luminance(mean)));
      };
      cells.visit_lattice(cell, cell_side, [&](const Vec3& direction) {
        add_extreme(direction);
        const Vec3 seen_ground = onto_disc(*sky.earth, direction);
        if (cells.cell_of(seen_ground) == cell) add_extreme(seen_ground);
      });
      const std::size_t group = groups_.earth + cell;
      weights.weight[group] = mean;
      weights.largest[group] = between_directions * largest;
      weights.scatter[group] = std::sqrt(squares / static_cast<double>(seen.size()));
    }
  });
}

}  // namespace earthshine::studies
