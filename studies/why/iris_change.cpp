// SPDX-License-Identifier: Apache-2.0
// Changes of sight_changes.h for bright things, by the iris and by stray light.
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
// over the brighter of target and surround; less stray light has no effect
constexpr double least_veil = 0.1;
// All bright things together count only if they close the iris by so much more.
constexpr double more_stops = 0.5;
// Brighter than any sunlit surface, cd/m^2: a pixel of an object with a part of the Sun's disc.
constexpr float sun_in_pixel = 1e6F;

struct BrightThing {
  std::string name;
  bool is_sun = false;
  std::vector<std::uint32_t> pixels;
  double sum = 0.0, squares = 0.0, peak = 0.0;  // of luminance

  [[nodiscard]] double mean() const { return sum / static_cast<double>(pixels.size()); }
};

constexpr std::int32_t earth_key = -2, sun_key = -3;

std::string name_of(const scenes::Scene& scene, std::int32_t key) {
  if (key == earth_key) return "the Earth";
  if (key == sun_key) return "the Sun";
  if (key == no_object) return "the sky";
  return scene.objects[static_cast<std::size_t>(key)].name;
}

// The object key of a pixel without an object.
class Sky {
 public:
  explicit Sky(const WhyNotInputs& in)
      : in_(in),
        model_(raytrace::make_camera_model(in.camera, in.plan.map.columns, in.plan.map.rows)) {}
  [[nodiscard]] std::int32_t operator()(std::size_t pixel) const {
    if (shows_sun(pixel)) return sun_key;
    if (in_.earth && within(pixel, in_.earth->direction, in_.earth->half_angle_deg)) {
      return earth_key;
    }
    return no_object;
  }
  // Within the reach of the pixel filter around the Sun's disc.
  [[nodiscard]] bool shows_sun(std::size_t pixel) const {
    if (!in_.sun) return false;
    const double pixel_deg = in_.camera.fov_deg / in_.plan.map.rows;
    return within(
        pixel, in_.sun->direction,
        in_.sun->angular_radius_deg + (0.5 + 0.71 * in_.camera.filter_width_px) * pixel_deg);
  }

 private:
  [[nodiscard]] bool within(std::size_t pixel, const Vec3& axis, double angle_deg) const {
    const std::size_t width = static_cast<std::size_t>(in_.plan.map.columns);
    const Vec3 toward = model_
                            .ray(static_cast<double>(pixel % width) + 0.5,
                                 static_cast<double>(pixel / width) + 0.5, 0.0, 0.0)
                            .direction;
    return glm::dot(toward, axis) >= std::cos(base::radians(angle_deg));
  }

  const WhyNotInputs& in_;
  raytrace::CameraModel model_;
};

// Everything but the target, by falling weight in the meter.
std::vector<BrightThing> bright_things(const WhyNotInputs& in, std::uint32_t target,
                                       const std::vector<float>& luminance) {
  const Sky sky(in);
  std::map<std::int32_t, BrightThing> by_key;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    std::int32_t key = in.plan.map.object[i];
    if (key == static_cast<std::int32_t>(target)) continue;
    if (key == no_object) {
      key = sky(i);
    } else if (luminance[i] > sun_in_pixel && sky.shows_sun(i)) {
      key = sun_key;
    }
    BrightThing& thing = by_key[key];
    const double value = static_cast<double>(luminance[i]);
    thing.pixels.push_back(static_cast<std::uint32_t>(i));
    thing.sum += value;
    thing.squares += value * value;
    thing.peak = std::max(thing.peak, value);
  }
  std::vector<BrightThing> things;
  for (auto& [key, thing] : by_key) {
    thing.name = name_of(in.scene, key);
    thing.is_sun = key == sun_key;
    things.push_back(std::move(thing));
  }
  std::stable_sort(things.begin(), things.end(),
                   [](const auto& a, const auto& b) { return a.squares > b.squares; });
  return things;
}

// The exposure for this luminance.
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

using Gone = std::vector<const BrightThing*>;

std::vector<std::uint32_t> pixels_of(const Gone& gone) {
  std::vector<std::uint32_t> pixels;
  for (const BrightThing* thing : gone) {
    pixels.insert(pixels.end(), thing->pixels.begin(), thing->pixels.end());
  }
  return pixels;
}

// Sets these pixels to the mean of the others, except `keep` (sorted).
void take_away(std::vector<float>& values, const std::vector<std::uint32_t>& pixels,
               const std::vector<std::uint32_t>& keep = {}) {
  double rest = 0.0;
  for (const float value : values) rest += static_cast<double>(value);
  for (const std::uint32_t pixel : pixels) rest -= static_cast<double>(values[pixel]);
  const double left = static_cast<double>(values.size() - pixels.size());
  for (const std::uint32_t pixel : pixels) {
    if (std::binary_search(keep.begin(), keep.end(), pixel)) continue;
    values[pixel] = static_cast<float>(std::max(0.0, rest / left));
  }
}

// The exposure without these pixels' light.
degrade::Exposure exposure_without(const degrade::Setup& setup, std::vector<float> luminance,
                                   const std::vector<std::uint32_t>& pixels, const ObjectMap& map) {
  take_away(luminance, pixels);
  return exposure_for(setup, std::move(luminance), map);
}

std::string names_of(const Gone& gone) {
  std::string names;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, gone.size()); ++k) {
    names += (k == 0 ? "" : ", ") + gone[k]->name;
  }
  if (gone.size() > 3) names += fmt::format(" and {} more", gone.size() - 3);
  return names;
}

// Whether their light reaches the target by the lens' glare or the tube's bloom and smear or,
// without a CCTV, changes the eye's adaptation.
bool strays(const WhyNotInputs& in, const Gone& gone, double own) {
  const double count = static_cast<double>(in.plan.map.object.size());
  double sum = 0.0, peak = 0.0, pixels = 0.0;
  for (const BrightThing* thing : gone) {
    sum += thing->sum;
    pixels += static_cast<double>(thing->pixels.size());
    peak = std::max(peak, thing->peak);
  }
  if (!in.cctv) {
    const double rest = (in.sight.mean_luminance * count - sum) / std::max(1.0, count - pixels);
    return in.sight.mean_luminance > std::exp2(least_stops) * rest;
  }
  const degrade::CctvCamera& camera = in.cctv->camera;
  if (camera.glare * sum / count > least_veil * own) return true;
  const double signal = peak * signal_per_luminance(camera, *in.sight.exposure);
  return (camera.smear_db > 0.0 && signal > 1.0) ||
         (camera.saturation > 0.0 && camera.bloom > 0.0 && signal > camera.saturation);
}

// luminance: of the picture.
BrightThings bright_changes(const WhyNotInputs& in, std::size_t index, const Gone& gone, double own,
                            const std::vector<float>& luminance) {
  BrightThings found;
  found.names = names_of(gone);
  std::vector<std::uint32_t> pixels = pixels_of(gone);
  if (pixels.size() == in.plan.map.object.size()) return found;
  const bool by_iris = in.cctv && in.cctv->camera.iris != degrade::IrisMode::Fixed;
  if (by_iris) {
    found.stops = stops_between(*in.sight.exposure,
                                exposure_without(*in.cctv, luminance, pixels, in.plan.map));
  }
  const bool sun = gone.size() == 1 && gone.front()->is_sun;
  const std::string in_view = sun ? "the Sun is in the picture: " : "";
  const std::string closed =
      in_view + (sun ? fmt::format("iris closed by {:.1f} stops", found.stops)
                     : fmt::format("iris closed by {:.1f} stops for {}", found.stops, found.names));
  const bool closes = by_iris && found.stops >= least_stops, stray = strays(in, gone, own);
  // The target's surround remains, except for the Sun, which is no surface.
  const std::vector<std::uint32_t> keep =
      sun ? std::vector<std::uint32_t>() : in.plan.targets[index].view.surround;
  const auto add = [&](Cause cause, std::string text, bool opens, bool clears) {
    Change change;
    change.cause = cause;
    change.by = found.names;
    change.text = std::move(text);
    change.apply = [&in, pixels, keep, opens, clears](Scenario& s) {
      if (s.cctv) {
        hold_exposure(
            s, opens
                   ? exposure_without(*in.cctv, base::luminance_of(s.radiance), pixels, in.plan.map)
                   : exposure_for(*in.cctv, base::luminance_of(s.radiance), in.plan.map));
      }
      if (!clears) return;
      for_light(s.radiance, [&](std::vector<float>& values) { take_away(values, pixels, keep); });
    };
    found.changes.push_back(std::move(change));
  };
  const char* veil = in.cctv ? "stray light of " : "the eye is dazzled by ";
  if (closes) add(Cause::Iris, closed, true, false);
  if (stray) {
    add(Cause::Glare,
        sun ? in_view + (in.cctv ? "its stray light" : "the eye is dazzled") : veil + found.names,
        false, true);
  }
  if (closes && stray) add(Cause::Iris, closed + ", and its stray light", true, true);
  return found;
}

}  // namespace

std::vector<BrightThings> without_bright_things(const WhyNotInputs& in, std::size_t index,
                                                std::size_t most) {
  const std::vector<float> luminance = base::luminance_of(in.radiance);
  const std::vector<BrightThing> things =
      bright_things(in, in.plan.targets[index].view.object, luminance);
  const Sight& sight = in.sight.targets[index];
  const double own = std::max(sight.luminance.value_or(0.0), sight.surround.value_or(0.0));
  std::vector<BrightThings> found;
  Gone brighter;
  double most_stops = 0.0;
  for (std::size_t k = 0; k < std::min(most, things.size()); ++k) {
    BrightThings one = bright_changes(in, index, {&things[k]}, own, luminance);
    most_stops = std::max(most_stops, one.stops);
    if (!one.changes.empty()) found.push_back(std::move(one));
    if (things[k].mean() > 2.0 * own) brighter.push_back(&things[k]);
  }
  if (brighter.size() < 2) return found;
  BrightThings all = bright_changes(in, index, brighter, own, luminance);
  if (!all.changes.empty() && all.stops > most_stops + more_stops) found.push_back(std::move(all));
  return found;
}

}  // namespace earthshine::studies
