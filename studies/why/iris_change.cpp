// SPDX-License-Identifier: Apache-2.0
// Which bright thing the iris closes for: the part of sight_changes.h that looks for it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/units.h"
#include "degrade/parts/iris.h"
#include "degrade/stage/axis_map.h"
#include "raytrace/camera/camera.h"
#include "studies/why/sight_changes.h"

namespace earthshine::studies {
namespace {

constexpr double least_stops = 0.25;

struct BrightThing {
  std::string name;
  std::vector<std::uint32_t> pixels;
  double sum = 0.0, squares = 0.0;  // of luminance

  [[nodiscard]] double mean() const { return sum / static_cast<double>(pixels.size()); }
};

constexpr std::int32_t earth_key = -2, sun_key = -3;

std::string name_of(const scenes::Scene& scene, std::int32_t key) {
  if (key == earth_key) return "the Earth";
  if (key == sun_key) return "the Sun";
  if (key == no_object) return "the sky";
  return scene.objects[static_cast<std::size_t>(key)].name;
}

// What a pixel without an object shows.
class Sky {
 public:
  explicit Sky(const WhyNotInputs& in)
      : in_(in),
        model_(raytrace::make_camera_model(in.camera, in.plan.map.columns, in.plan.map.rows)) {}
  [[nodiscard]] std::int32_t operator()(std::size_t pixel) const {
    if (!in_.earth && !in_.sun) return no_object;
    const std::size_t width = static_cast<std::size_t>(in_.plan.map.columns);
    const Vec3 toward = model_
                            .ray(static_cast<double>(pixel % width) + 0.5,
                                 static_cast<double>(pixel / width) + 0.5, 0.0, 0.0)
                            .direction;
    const auto within = [&](const Vec3& axis, double angle_deg) {
      return glm::dot(toward, axis) >= std::cos(base::radians(angle_deg));
    };
    if (in_.earth && within(in_.earth->direction, in_.earth->half_angle_deg)) return earth_key;
    // A pixel wide, since the Sun's disc may lie between the centres of pixels.
    const double pixel_deg = in_.camera.fov_deg / in_.plan.map.rows;
    if (in_.sun && within(in_.sun->direction, in_.sun->angular_radius_deg + pixel_deg)) {
      return sun_key;
    }
    return no_object;
  }

 private:
  const WhyNotInputs& in_;
  raytrace::CameraModel model_;
};

// Everything but the target, what weighs most in the meter first.
std::vector<BrightThing> bright_things(const WhyNotInputs& in, std::uint32_t target,
                                       const std::vector<float>& luminance) {
  const Sky sky(in);
  std::map<std::int32_t, BrightThing> by_key;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    std::int32_t key = in.plan.map.object[i];
    if (key == static_cast<std::int32_t>(target)) continue;
    if (key == no_object) key = sky(i);
    BrightThing& thing = by_key[key];
    const double value = static_cast<double>(luminance[i]);
    thing.pixels.push_back(static_cast<std::uint32_t>(i));
    thing.sum += value;
    thing.squares += value * value;
  }
  std::vector<BrightThing> things;
  for (auto& [key, thing] : by_key) {
    thing.name = name_of(in.scene, key);
    things.push_back(std::move(thing));
  }
  std::stable_sort(things.begin(), things.end(),
                   [](const auto& a, const auto& b) { return a.squares > b.squares; });
  return things;
}

// Where the iris stands for this luminance.
degrade::Exposure exposure_for(const degrade::Setup& setup, std::vector<float> luminance,
                               const ObjectMap& map) {
  for (float& value : luminance) value = std::max(value, 0.0F);
  const degrade::Grid grid = degrade::picture_grid(map.columns, map.rows, setup.monitor);
  const degrade::Picture picture = apply(
      degrade::Picture{map.columns, map.rows, {std::move(luminance)}},
      degrade::area_average(map.columns, grid.columns), degrade::area_average(map.rows, grid.rows));
  return degrade::expose(setup.camera, degrade::metered_luminance(picture, setup.camera));
}

double stops_between(const degrade::Exposure& closed, const degrade::Exposure& open) {
  const auto light = [](const degrade::Exposure& e) { return e.gain / (e.f_number * e.f_number); };
  return std::log2(light(open) / light(closed));
}

}  // namespace

std::vector<Change> with_iris_opened(const WhyNotInputs& in, std::size_t index, std::size_t most) {
  if (!in.cctv || !in.sight.exposure || in.cctv->camera.iris == degrade::IrisMode::Fixed) return {};
  const std::vector<float> luminance = base::luminance_of(in.radiance);
  const std::vector<BrightThing> things =
      bright_things(in, in.plan.targets[index].view.object, luminance);
  const double count = static_cast<double>(luminance.size());
  const double total = in.sight.mean_luminance * count;
  std::vector<Change> changes;
  // Without these things: their pixels at the mean of the rest.
  const auto add = [&](const std::vector<const BrightThing*>& gone) {
    double sum = total, left = count;
    std::string names;
    for (const BrightThing* thing : gone) {
      sum -= thing->sum;
      left -= static_cast<double>(thing->pixels.size());
    }
    if (!(left > 0.0)) return;
    for (std::size_t k = 0; k < std::min<std::size_t>(3, gone.size()); ++k) {
      names += (k == 0 ? "" : ", ") + gone[k]->name;
    }
    if (gone.size() > 3) names += fmt::format(" and {} more", gone.size() - 3);
    std::vector<float> without = luminance;
    for (const BrightThing* thing : gone) {
      for (const std::uint32_t pixel : thing->pixels)
        without[pixel] = static_cast<float>(sum / left);
    }
    const degrade::Exposure open = exposure_for(*in.cctv, std::move(without), in.plan.map);
    const double stops = stops_between(*in.sight.exposure, open);
    if (!(stops >= least_stops)) return;
    Change change;
    change.cause = Cause::Iris;
    change.by = names;
    change.text = fmt::format("iris closed by {:.1f} stops for {}", stops, names);
    change.apply = [open](Scenario& scenario) {
      degrade::CctvCamera& camera = scenario.cctv->camera;
      camera.iris = degrade::IrisMode::Fixed;
      camera.f_number = open.f_number;
      camera.gain_db = 20.0 * std::log10(open.gain);
    };
    changes.push_back(std::move(change));
  };
  const Sight& sight = in.sight.targets[index];
  const double own = std::max(sight.luminance.value_or(0.0), sight.surround.value_or(0.0));
  std::vector<const BrightThing*> brighter;
  for (std::size_t k = 0; k < std::min(most, things.size()); ++k) {
    add({&things[k]});
    if (things[k].mean() > 2.0 * own) brighter.push_back(&things[k]);
  }
  if (brighter.size() > 1) add(brighter);
  return changes;
}

}  // namespace earthshine::studies
