// SPDX-License-Identifier: Apache-2.0
#include "degrade/range/range_sensor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/numbers/random.h"
#include "base/parallel.h"
#include "degrade/parts/noise.h"
#include "degrade/stage/read_setting.h"

namespace earthshine::degrade {
namespace {

enum class Reading : std::uint8_t { Returned, Empty, Grazing, Dim, Lost, OutOfRange };

const std::vector<float>& layer(const base::Image& image, std::string_view name) {
  if (const base::Channel* channel = image.find(name)) return channel->values;
  throw base::Error(base::Blame::Work, "range sensor",
                    "the picture has no layer \"" + std::string(name) + "\"",
                    "it needs range, N and P, and albedo for min_signal_per_m2");
}

struct Vectors {
  const std::vector<float>&x, &y, &z;
  Vectors(const base::Image& image, const std::string& name, const char* const (&parts)[3])
      : x(layer(image, name + parts[0])),
        y(layer(image, name + parts[1])),
        z(layer(image, name + parts[2])) {}
  [[nodiscard]] Vec3 at(std::size_t i) const { return Vec3(x[i], y[i], z[i]); }
};
constexpr const char* xyz[3] = {".X", ".Y", ".Z"};
constexpr const char* rgb[3] = {".R", ".G", ".B"};

class Sensing {
 public:
  Sensing(const base::Image& layers, const Vec3& position, const RangeSensor& sensor,
          const RangeKey& key)
      : layers_(layers),
        position_(position),
        sensor_(sensor),
        least_cosine_(std::cos(base::radians(sensor.max_incidence_deg))),
        range_(layer(layers, "range")),
        normal_(layers, "N", xyz),
        place_(layers, "P", xyz),
        key_(base::Key(key.seed, base::Stream::RangeNoise, key.view)) {}

  Reading read(std::size_t i, double& range_m) const {
    const auto exact = static_cast<double>(range_[i]);
    if (!std::isfinite(exact)) return Reading::Empty;
    const double cosine =
        std::abs(glm::dot(normal_.at(i), glm::normalize(place_.at(i) - position_)));
    // 90 degrees accepts all values, also those that rounding moved beyond.
    if (sensor_.max_incidence_deg < 90.0 && cosine < least_cosine_) return Reading::Grazing;
    if (sensor_.min_signal_per_m2 > 0.0 &&
        base::luminance(Vectors(layers_, "albedo", rgb).at(i)) * cosine / (exact * exact) <
            sensor_.min_signal_per_m2) {
      return Reading::Dim;
    }
    // The key consists of the pixel's column and row; two draws per pixel.
    const auto width = static_cast<std::size_t>(layers_.width);
    const base::Key key = key_.with(i / width << 32U | i % width);
    if (base::uniform(key, 0) < sensor_.dropout) return Reading::Lost;
    const double sigma =
        sensor_.noise_m + sensor_.noise_m_per_m * exact + sensor_.noise_m_per_m2 * exact * exact;
    double noisy = exact;
    if (sigma > 0.0) noisy += sigma * normal_quantile(std::max(base::uniform(key, 1), 0x1p-54));
    const bool too_far = sensor_.max_range_m > 0.0 && noisy > sensor_.max_range_m;
    if (noisy < sensor_.min_range_m || too_far) return Reading::OutOfRange;
    if (sensor_.quantum_m > 0.0) noisy = std::round(noisy / sensor_.quantum_m) * sensor_.quantum_m;
    if (!(noisy > 0.0)) return Reading::OutOfRange;
    range_m = noisy;
    return Reading::Returned;
  }

 private:
  const base::Image& layers_;
  Vec3 position_;
  const RangeSensor& sensor_;
  double least_cosine_;
  const std::vector<float>& range_;
  Vectors normal_, place_;
  base::Key key_;
};

RangeReport count(const std::vector<Reading>& readings) {
  RangeReport report;
  for (const Reading reading : readings) {
    switch (reading) {
      case Reading::Returned:
        ++report.returned;
        break;
      case Reading::Empty:
        ++report.empty;
        break;
      case Reading::Grazing:
        ++report.grazing;
        break;
      case Reading::Dim:
        ++report.dim;
        break;
      case Reading::Lost:
        ++report.lost;
        break;
      case Reading::OutOfRange:
        ++report.out_of_range;
        break;
    }
  }
  return report;
}

using base::Blame;
using base::Error;
using scenes::SettingTable;

RangeSensor read_sensor(const SettingTable& table) {
  RangeSensor sensor;
  const auto visit = [](RangeSensor& s, auto&& field) { visit_range_fields(s, field); };
  for (const scenes::Setting& setting : table.settings) {
    read_setting(setting, "[[range_sensor]]", sensor, visit, {"name"});
  }
  if (sensor.max_range_m > 0.0 && sensor.min_range_m >= sensor.max_range_m) {
    throw Error(Blame::Input, place_of(table, "min_range_m"),
                "min_range_m = " + number(sensor.min_range_m) +
                    " is not below max_range_m = " + number(sensor.max_range_m));
  }
  return sensor;
}

}  // namespace

RangeView sense_range(const base::Image& layers, const Vec3& position, const RangeSensor& sensor,
                      const RangeKey& key) {
  const Sensing sensing(layers, position, sensor, key);
  RangeView view{{layers.width, layers.height, {}}, {}};
  view.image.add("range");
  view.image.add("valid");
  std::vector<float>& range = view.image.channels[0].values;
  std::vector<float>& valid = view.image.channels[1].values;
  std::vector<Reading> readings(view.image.pixel_count());
  base::parallel_chunks(readings.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double range_m = 0.0;
      readings[i] = sensing.read(i, range_m);
      if (readings[i] != Reading::Returned) continue;
      range[i] = static_cast<float>(range_m);
      valid[i] = 1.0F;
    }
  });
  view.report = count(readings);
  return view;
}

RangeSensor resolve_range_sensor(const scenes::Scene& scene, const std::string& name,
                                 const std::string& of,
                                 const std::optional<base::Location>& named_at) {
  std::vector<std::string> names;
  for (const SettingTable& table : scene.range_sensors) {
    if (table.name == name) return read_sensor(table);
    names.push_back(table.name);
  }
  throw Error(Blame::Input, named_at.value_or(base::Location{scene.path.string()}),
              (of.empty() ? "" : "camera " + in_quotes(of) + ": ") + "there is no range sensor " +
                  in_quotes(name),
              names.empty() ? "the scene has no [[range_sensor]]" : "known are " + listed(names),
              did_you_mean(name, names));
}

void check_range_sensors(const scenes::Scene& scene) {
  for (const SettingTable& table : scene.range_sensors) static_cast<void>(read_sensor(table));
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.range_sensor.empty()) continue;
    static_cast<void>(
        resolve_range_sensor(scene, camera.range_sensor, camera.name, camera.range_sensor_at));
  }
}

}  // namespace earthshine::degrade
