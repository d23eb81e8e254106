// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/range.h"

#include <fmt/format.h>

#include "app/console.h"
#include "app/provenance.h"
#include "base/files/exr_file.h"
#include "degrade/range/range_sensor.h"
#include "raytrace/frame/first_hit.h"

namespace earthshine::app {
namespace {

std::string sensor_name(const scenes::Camera& camera) {
  return camera.range_sensor.empty() ? "exact" : camera.range_sensor;
}

degrade::RangeSensor sensor_of(const scenes::Scene& scene, const scenes::Camera& camera,
                               bool quiet) {
  if (!camera.range_sensor.empty()) {
    return degrade::resolve_range_sensor(scene, camera.range_sensor);
  }
  if (!quiet) {
    note(
        fmt::format("note: camera \"{}\" names no range_sensor, taking exact ranges", camera.name));
  }
  return {};
}

base::Image exact_layers(const RangeShot& shot, const Size& size) {
  base::Image layers{size.columns, size.rows, {}};
  for (const raytrace::FirstHitLayer& layer : raytrace::first_hit_layers()) {
    for (const std::string& channel : layer.channels) layers.add(channel);
  }
  raytrace::fill_first_hit(shot.scene, shot.query,
                           raytrace::make_camera_model(shot.camera, size.columns, size.rows),
                           {0, 0, size.columns, size.rows}, layers);
  return layers;
}

std::string summary(const std::string& name, const degrade::RangeReport& report, double pixels) {
  const auto share = [pixels](std::uint64_t count) {
    return 100.0 * static_cast<double>(count) / pixels;
  };
  return fmt::format(
      "  range sensor {}: {:.1f} % of the pixels returned; {:.1f} % empty, {:.1f} % grazing, "
      "{:.1f} % dim, {:.1f} % lost, {:.1f} % out of range",
      name, share(report.returned), share(report.empty), share(report.grazing), share(report.dim),
      share(report.lost), share(report.out_of_range));
}

}  // namespace

Json sense_range(const RangeShot& shot, const std::string& path,
                 const std::vector<std::string>& overrides, const Common& common,
                 StageTimes& times) {
  const scenes::Scene& scene = shot.scene;
  const scenes::Camera& camera = shot.camera;
  const Size size = shot.size.value_or(Size{camera.columns, camera.rows});
  const degrade::RangeSensor sensor = sensor_of(scene, camera, common.quiet);
  const auto view = static_cast<std::uint64_t>(&camera - scene.cameras.data());
  const degrade::RangeView sensed = times.measure("range", [&] {
    return degrade::sense_range(exact_layers(shot, size), camera.position, sensor,
                                {common.seed, view});
  });

  base::ExrHeader header;
  add_origin(header, scene, overrides, common.seed);
  add_camera(header, camera, size.columns, size.rows);
  header.text.emplace_back("earthshine:units", "range along the ray in m; 0: no return");
  header.text.emplace_back("earthshine:range_sensor", sensor_name(camera));
  visit_range_fields(
      sensor, [&header](const char* key, double value, degrade::Limits, const char*, const char*) {
        header.numbers.emplace_back(std::string("earthshine:") + key, static_cast<float>(value));
      });
  base::write_exr(path, sensed.image, header);

  const degrade::RangeReport& report = sensed.report;
  if (!common.quiet) {
    note(summary(sensor_name(camera), report, static_cast<double>(sensed.image.pixel_count())));
  }
  return {{"camera", camera.name},
          {"columns", size.columns},
          {"rows", size.rows},
          {"seconds", times.json()},
          {"range",
           {{"sensor", sensor_name(camera)},
            {"returned", report.returned},
            {"empty", report.empty},
            {"grazing", report.grazing},
            {"dim", report.dim},
            {"lost", report.lost},
            {"out_of_range", report.out_of_range}}}};
}

}  // namespace earthshine::app
