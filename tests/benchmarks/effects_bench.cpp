// SPDX-License-Identifier: Apache-2.0
// Cost of each effect in the payload bay. The base is the Sun alone with direct light only; each
// other case adds one effect. Times and ray counts are of solve and picture together.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>

#include "degrade/chain.h"
#include "degrade/settings/presets.h"
#include "payload_bay.h"
#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/effects/quality.h"
#include "scenes/light/photometry.h"

namespace earthshine {
namespace {

struct Setting {
  std::string name;
  std::function<void(scenes::Scene&)> change;
  bool bounces = false;
  std::vector<std::string> layers = {};
  bool per_light = false, cctv = false;
};

// The bay under a point-like Sun, without Earth, highlights and mirrors.
scenes::Scene plain_bay() {
  scenes::Scene scene = payload_bay().scene;
  scene.sun = scenes::Sun{glm::normalize(Vec3(0.2, 0.3, 1.0)), Rgb(133100.0), 0.0};
  scene.earth.reset();
  for (scenes::Material& material : scene.materials) {
    material.specular = material.mirror = material.transmit = material.emit = Rgb(0.0);
  }
  scene.quality.error = 0.1;
  return scene;
}

void earth(scenes::Scene& scene, double half_angle_deg) {
  scene.earth = scenes::Earth{};
  scene.earth->direction = {0.0, -0.8, 0.6};
  scene.earth->half_angle_deg = half_angle_deg;
  scene.earth->model = scenes::EarthModel::Uniform;
  scene.earth->radiance = Rgb(8000.0);
}

void lamp(scenes::Scene& scene, scenes::LampKind kind) {
  scenes::Lamp light;
  light.name = light.group = "lamp";
  light.kind = kind;
  light.position = {0.0, 0.0, 4.0};
  light.axis = {0.0, 0.0, -1.0};
  light.intensity_cd = Rgb(1000.0);
  light.beam_deg = 60.0;
  light.field_deg = 120.0;
  light.radius_m = 0.3;
  light.edge_u = {0.5, 0.0, 0.0};
  light.edge_v = {0.0, -0.5, 0.0};
  light.exitance = Rgb(1000.0);
  if (kind == scenes::LampKind::Measured) {
    light.photometry = std::make_shared<const scenes::Photometry>(
        std::vector<double>{0.0, 45.0, 90.0}, std::vector<double>{0.0, 360.0},
        std::vector<double>{2.0, 1.0, 0.0, 2.0, 1.0, 0.0});
  }
  scene.lamps.push_back(light);
}

// An emitting panel of one square metre over the bay.
void panel(scenes::Scene& scene) {
  scenes::Material shining;
  shining.name = shining.light_group = "panel";
  shining.emit = Rgb(1000.0);
  scene.materials.push_back(shining);
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  const auto m = static_cast<std::uint32_t>(scene.materials.size() - 1);
  const auto o = static_cast<std::uint32_t>(scene.objects.size());
  for (const Vec3& corner :
       {Vec3(-0.5, -0.5, 4.0), Vec3(-0.5, 0.5, 4.0), Vec3(0.5, 0.5, 4.0), Vec3(0.5, -0.5, 4.0)}) {
    scene.vertices.push_back(corner);
  }
  scenes::Object object;
  object.name = "panel";
  object.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  object.triangle_count = 2;
  object.polygon_count = 1;
  object.area_m2 = 1.0;
  scene.objects.push_back(object);
  const std::uint32_t polygon = scene.triangles.back().polygon + 1;
  scene.triangles.push_back({{v, v + 1, v + 2}, o, m, polygon});
  scene.triangles.push_back({{v, v + 2, v + 3}, o, m, polygon});
}

void shine(scenes::Material& material) {
  material.specular = Rgb(0.1);
  material.shininess = 20.0;
}

template <class Change>
std::function<void(scenes::Scene&)> materials(Change change) {
  return [change](scenes::Scene& scene) {
    for (scenes::Material& material : scene.materials) change(material);
  };
}

std::vector<Setting> settings() {
  using scenes::LampKind;
  const auto nothing = [](scenes::Scene&) {};
  const auto adds = [](LampKind kind) { return [kind](scenes::Scene& s) { lamp(s, kind); }; };
  return {{"base", nothing},
          {"interreflection", nothing, true},
          {"penumbra", [](scenes::Scene& s) { s.sun->angular_radius_deg = 0.2666; }},
          {"earth_narrow", [](scenes::Scene& s) { earth(s, 10.0); }},
          {"earth_wide", [](scenes::Scene& s) { earth(s, 60.0); }},
          {"point_lamp", adds(LampKind::Point)},
          {"spot_lamp", adds(LampKind::Spot)},
          {"rectangle_lamp", adds(LampKind::Rectangle)},
          {"disk_lamp", adds(LampKind::Disk)},
          {"measured_lamp", adds(LampKind::Measured)},
          {"emitting_surface", panel},
          {"ambient", [](scenes::Scene& s) { s.ambient_radiance = Rgb(100.0); }},
          {"phong_lobe", materials(shine)},
          {"interreflection_and_glossy", materials(shine), true},
          {"mirror", materials([](scenes::Material& m) { m.mirror = Rgb(0.1); })},
          {"refraction", materials([](scenes::Material& m) {
             m.transmit = Rgb(0.1);
             m.ior = 1.5;
           })},
          {"depth_of_field",
           [](scenes::Scene& s) {
             for (scenes::Camera& camera : s.cameras) {
               camera.aperture_m = 0.02;
               camera.focus_m = 8.0;
             }
           }},
          {"layers", nothing, false, {"depth", "normal", "crypto_object"}},
          {"layers_for_a_range_sensor", nothing, false, {"range", "normal", "position", "albedo"}},
          {"point_lamp_per_light", adds(LampKind::Point), false, {}, true},
          {"cctv", nothing, false, {}, false, true}};
}

void run(benchmark::State& state, const Setting& setting) {
  scenes::Scene scene = plain_bay();
  setting.change(scene);
  scenes::Asked asked;
  asked.paths = setting.bounces ? scenes::LightPaths::All : scenes::LightPaths::Straight;
  const scenes::LightGroups groups = scenes::find_light_groups(scene);
  const scenes::Effects effects = scenes::find_effects(scene, groups, asked);
  const scenes::RayQuery query(scene);
  const scenes::QualityKnobs knobs = scenes::resolve_quality(scene);
  radiosity::SolveOptions solver;
  solver.patch_edge_m = knobs.patch_edge_m;
  solver.form_factor_rays = knobs.form_factor_rays;
  raytrace::RenderOptions picture = raytrace::render_options(knobs);
  picture.columns = picture.rows = 128;
  picture.aovs = setting.layers;
  picture.per_light = setting.per_light;
  picture.indirect = setting.bounces ? raytrace::Indirect::Radiosity : raytrace::Indirect::None;
  double rays = 0.0;
  for (auto _ : state) {
    radiosity::Solution solution;
    if (effects.solution) solution = radiosity::solve({scene, groups, effects, query}, solver);
    const raytrace::Frame frame =
        raytrace::render({scene, groups, effects, query}, solution, scene.cameras.front(), picture);
    if (setting.cctv) {
      const degrade::Preset& preset = *degrade::find_preset("sit-monochrome");
      degrade::Options options;
      options.fov_deg = scene.cameras.front().fov_deg;
      const degrade::Result seen =
          degrade::degrade(frame.image, preset.camera, preset.monitor, options);
      benchmark::DoNotOptimize(seen.pixels.data());
    }
    rays = static_cast<double>(frame.report.rays.total() + solution.report.form_factor_rays +
                               solution.report.shadow_rays);
  }
  state.counters["rays"] = rays;
}

}  // namespace
}  // namespace earthshine

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto& setting : earthshine::settings()) {
    benchmark::RegisterBenchmark(("effects/bay/px:128/" + setting.name).c_str(), earthshine::run,
                                 setting)
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
