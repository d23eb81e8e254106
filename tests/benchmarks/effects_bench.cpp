// SPDX-License-Identifier: Apache-2.0
// What each effect costs in the payload bay, switched on alone: the Sun by itself with direct light
// only is the base, to which each of the others adds one thing. The whole of solve and picture is
// timed; rays are counted for all of it.
#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "payload_bay.h"
#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/quality.h"

namespace earthshine {
namespace {

struct Setting {
  std::string name;
  std::function<void(scenes::Scene&)> change;
  bool bounces = false;
  std::vector<std::string> layers = {};
};

// The bay under a Sun that is a point, without Earth, highlights, mirrors.
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
  scene.lamps.push_back(light);
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
          {"ambient", [](scenes::Scene& s) { s.ambient_radiance = Rgb(100.0); }},
          {"phong_lobe", materials([](scenes::Material& m) {
             m.specular = Rgb(0.1);
             m.shininess = 20.0;
           })},
          {"mirror", materials([](scenes::Material& m) { m.mirror = Rgb(0.1); })},
          {"depth_of_field",
           [](scenes::Scene& s) {
             for (scenes::Camera& camera : s.cameras) {
               camera.aperture_m = 0.02;
               camera.focus_m = 8.0;
             }
           }},
          {"layers", nothing, false, {"depth", "normal", "crypto_object"}}};
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
  picture.indirect = setting.bounces ? raytrace::Indirect::Radiosity : raytrace::Indirect::None;
  double rays = 0.0;
  for (auto _ : state) {
    radiosity::Solution solution;
    if (effects.solution) solution = radiosity::solve(scene, groups, effects, query, solver);
    const raytrace::Frame frame =
        raytrace::render(scene, groups, effects, query, solution, scene.cameras.front(), picture);
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
