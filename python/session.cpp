// SPDX-License-Identifier: Apache-2.0
#include "python/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/call/memory.h"
#include "app/call/render_call.h"
#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/provenance.h"
#include "app/render/draw.h"
#include "app/render/effect_table.h"
#include "app/render/error_json.h"
#include "app/render/instants.h"
#include "app/render/light.h"
#include "app/render/warm_scene.h"
#include "app/tools/form_factors.h"
#include "base/error.h"
#include "base/parallel.h"
#include "python/request.h"
#include "raytrace/camera/camera.h"
#include "scenes/health/crossings.h"

namespace earthshine::python {

using app::Json;

void be_a_guest() {
  app::be_silent(true);
  app::Interrupt::leave_signals_to_host();
}

void ask_to_stop(bool stop) { app::Interrupt::ask(stop); }

std::string version() { return EARTHSHINE_VERSION; }

struct Light::Kept {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;
  std::vector<std::uint64_t> parts;  // digests of the scene's parts
};

namespace {

raytrace::Indirect indirect_of(const std::string& word) {
  using raytrace::Indirect;
  for (const Indirect one :
       {Indirect::Radiosity, Indirect::Distributed, Indirect::None, Indirect::Paths}) {
    if (app::indirect_name(one) == word) return one;
  }
  throw base::Error(base::Blame::Input, "indirect",
                    "\"" + word + "\" is not an estimator of indirect light",
                    "allowed: radiosity, distributed, none and paths");
}

app::RenderCall call_of(const Request& request, const std::string& path,
                        const std::vector<std::string>& overrides) {
  app::RenderCall call;
  call.scene.path = path;
  call.scene.overrides = overrides;
  if (const auto error = request.number("error")) {
    call.scene.overrides.push_back(fmt::format("quality.error={}", *error));
  }
  call.cameras = request.words("cameras");
  if (const auto size = request.whole_numbers("size", 2, 1))
    call.size = app::Size{(*size)[0], (*size)[1]};
  if (const auto crop = request.whole_numbers("crop", 4)) {
    if ((*crop)[2] < 1 || (*crop)[3] < 1) {
      throw base::Error(base::Blame::Input, "crop", "has no pixels",
                        "allowed is x, y, width and height, the last two 1 or more");
    }
    call.crop = raytrace::Window{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
  }
  call.time_limit_s = request.number("time_limit").value_or(0.0);
  call.no_error = request.flag("no_error");
  call.indirect = indirect_of(request.word("indirect", "radiosity"));
  if (const auto lights = request.number("distributed_lights")) {
    call.distributed_lights = static_cast<std::uint64_t>(*lights);
  }
  call.distributed_over = request.word("distributed_over", "");
  call.aovs = request.words("layers");
  call.per_light = request.flag("per_light");
  call.no_caustics = request.flag("no_caustics");
  call.all_effects = request.flag("all_effects");
  if (request.flag("cctv")) call.cctv = "asked";
  app::check_picture_options(call, true);
  return call;
}

Json json_of(const scenes::Camera& camera) {
  const raytrace::CameraMatrices matrices =
      raytrace::camera_matrices(raytrace::make_camera_model(camera, camera.columns, camera.rows));
  return {{"name", camera.name},
          {"position_m", app::to_json(camera.position)},
          {"look_at_m", app::to_json(camera.look_at)},
          {"up", app::to_json(camera.up)},
          {"fov_deg", camera.fov_deg},
          {"resolution", {camera.columns, camera.rows}},
          {"focus", camera.focus_m},
          {"aperture", camera.aperture_m},
          {"cctv", camera.cctv},
          {"range_sensor", camera.range_sensor},
          {"filter", scenes::filter_name(camera.filter)},
          {"filter_width", camera.filter_width_px},
          {"K", matrices.k},
          {"to_world", matrices.to_world}};
}

Json json_of(const scenes::Lamp& lamp) {
  return {{"name", lamp.name},
          {"group", lamp.group},
          {"position_m", app::to_json(lamp.position)},
          {"axis", app::to_json(lamp.axis)},
          {"intensity_cd", app::to_json(lamp.intensity_cd)},
          {"exitance_lm_m2", app::to_json(lamp.exitance)},
          {"illuminance_lx", app::to_json(lamp.illuminance_lx)}};
}

Json json_of(const scenes::Material& material) {
  return {{"name", material.name},
          {"diffuse", app::to_json(material.diffuse)},
          {"specular", app::to_json(material.specular)},
          {"shininess", material.shininess},
          {"mirror", app::to_json(material.mirror)},
          {"transmit", app::to_json(material.transmit)},
          {"ior", material.ior},
          {"emit", app::to_json(material.emit)},
          {"light", material.light_group},
          {"two_sided", material.two_sided}};
}

Json json_of(const scenes::Scene& scene, const scenes::Object& object) {
  const auto& [low, high] = scenes::bounds_of(scene, object);
  return {{"name", object.name},
          {"target", object.target},
          {"velocity", app::to_json(object.motion.velocity_m_s)},
          {"triangles", object.triangle_count},
          {"area_m2", object.area_m2},
          {"bounds_m", {app::to_json(low), app::to_json(high)}},
          {"source", object.source}};
}

template <class List, class Entry>
Json list_of(const List& list, Entry entry) {
  Json all = Json::array();
  for (const auto& one : list) all.push_back(entry(one));
  return all;
}

}  // namespace

struct Session::State : app::WarmScene {
  std::size_t solves = 0, pictures = 0;

  const app::Solved& light(const app::RenderCall& call, const app::Common& common,
                           app::StageTimes& times) {
    const app::Solved& found = light_for(call, common, times);
    leave_if_asked();
    return found;
  }
};

Session::Session(std::string path, std::optional<std::string> text)
    : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  state_->text = std::move(text);
}
Session::~Session() = default;

void Session::set(std::vector<std::string> overrides) {
  const CallLock call_lock;
  state_->set(std::move(overrides));
}

std::string Session::describe() {
  const CallLock call_lock;
  state_->read();
  const scenes::Scene& scene = state_->loaded.scene;
  const auto own = [](const auto& one) { return json_of(one); };
  Json json = {{"name", scene.name},
               {"cameras", list_of(scene.cameras, own)},
               {"lights", list_of(scene.lamps, own)},
               {"materials", list_of(scene.materials, own)},
               {"objects",
                list_of(scene.objects, [&](const auto& object) { return json_of(scene, object); })},
               {"light_groups", scenes::find_light_groups(scene).names},
               {"triangles", scene.triangles.size()},
               {"warnings", state_->warnings}};
  if (scene.sun) {
    json["sun"] = {{"direction", app::to_json(scene.sun->direction)},
                   {"illuminance", app::to_json(scene.sun->illuminance_lx)},
                   {"angular_radius_deg", scene.sun->angular_radius_deg}};
  }
  if (scene.earth) {
    json["earth"] = {{"direction", app::to_json(scene.earth->direction)},
                     {"half_angle_deg", scene.earth->half_angle_deg},
                     {"altitude_km", scene.earth->altitude_m / 1000.0},
                     {"albedo", app::to_json(scene.earth->albedo)}};
  }
  return app::dump(json);
}

std::string Session::work() const {
  const State& s = *state_;
  return app::dump({{"read", s.reads},
                    {"structured", s.structures},
                    {"solved", s.solves + s.lights.solves()},
                    {"drawn", s.pictures}});
}

std::shared_ptr<Frame> Session::render(const std::string& request_text,
                                       const std::shared_ptr<const Light>& light) {
  const Request request(request_text);
  const CallLock call_lock(request);
  State& s = *state_;
  app::StageTimes times;
  times.measure("read", [&] { s.read(); });
  app::RenderCall call = call_of(request, s.path, s.overrides);
  if (light) call.solution = "solution";  // as if read from a file
  const app::Common common = request.common();
  const auto cameras = app::wanted_cameras(call.cameras, s.loaded.scene);
  const scenes::Camera& camera = *cameras.front();
  s.prepare(call, cameras, true, request.number("error"));
  app::want_usual_error(call, s.loaded.scene);
  const raytrace::RenderOptions options = app::picture_options(call, common, s.loaded, camera);
  app::check_instants(call, s.loaded.scene, camera, options);
  app::check_memory(s.loaded, *s.query, app::solve_options(s.loaded.scene, common), &options,
                    !light);
  app::Solved given;
  if (light) {
    if (light->kept->parts != app::KeptLights::digests_of(s.loaded)) {
      throw base::Error(base::Blame::Input, "solution",
                        "is of another scene, or of this one before "
                        "geometry, materials or lights changed",
                        {}, "Solve again");
    }
    given.solution = light->kept->solution;
    given.solver = light->kept->solver;
    given.solved = true;
  }
  const app::Solved& solved = light ? given : s.light(call, common, times);
  app::RenderContext context{call, common, s.loaded, *s.query, solved};
  if (call.time_limit_s > 0.0) {
    context.time_limit_s = std::max(1e-3, call.time_limit_s - times.total());
  }
  app::Drawn drawn = app::draw_picture(context, camera, times);
  leave_if_asked();
  ++s.pictures;
  auto frame = std::make_shared<Frame>();
  frame->fov_deg = camera.fov_deg;
  Json report = app::frame_json(context, camera, drawn.frame, times);
  report["error"] =
      app::error_json(drawn, call.no_error ? std::nullopt : s.loaded.scene.quality.error);
  report["groups"] = s.loaded.groups.names;
  report["objects"] = list_of(s.loaded.scene.objects, [](const auto& o) { return o.name; });
  report["materials"] = list_of(s.loaded.scene.materials, [](const auto& m) { return m.name; });
  frame->report = app::dump(report);
  frame->file.header = app::picture_header(context, camera, drawn);
  frame->file.image = std::move(drawn.frame.image);
  try {
    app::CctvSetup cctv = app::cctv_of_camera(s.loaded.scene, camera, common);
    frame->cctv = CctvView{std::move(cctv.name), std::move(cctv.chain)};
  } catch (const base::Error& error) {
    frame->error = error.what();
  }
  return frame;
}

std::shared_ptr<Light> Session::solve(const std::string& request_text) {
  const Request request(request_text);
  const CallLock call_lock(request);
  State& s = *state_;
  app::StageTimes times;
  times.measure("read", [&] { s.read(); });
  app::RenderCall call;
  call.all_effects = true;  // as in `solve`, which has no camera
  const app::Common common = request.common();
  s.prepare(call, {}, false, request.number("error"));
  const base::StopInForce stop([] { return app::Interrupt::asked(); });
  app::Solved solved = app::solve_alone(
      {s.loaded, common, *s.query, request.number("time_limit").value_or(0.0)}, "", times);
  leave_if_asked();
  ++s.solves;
  auto light = std::make_shared<Light>();
  Json report = app::solve_json(s.loaded, solved.solution.report, times);
  report["error"] = app::error_json(solved, s.loaded.scene.quality.error);
  light->report = app::dump(report);
  light->groups = s.loaded.groups.names;
  const radiosity::Solution& solution = solved.solution;
  const radiosity::Patches& patches = solution.patches;
  light->count = patches.count();
  light->radiosity = solution.radiosity;
  light->direct_lx = solution.direct_lx;
  light->indirect_lx = solution.indirect_lx;
  light->area_m2 = patches.area_m2;
  for (std::uint32_t p = 0; p < patches.count(); ++p) {
    const Vec3 centre = patches.point(p, 0.5, 0.5), normal = patches.normal(p);
    light->centre_m.insert(light->centre_m.end(), {centre.x, centre.y, centre.z});
    light->normal.insert(light->normal.end(), {normal.x, normal.y, normal.z});
    light->object.push_back(patches.object(p));
  }
  light->kept = std::make_shared<Light::Kept>(
      Light::Kept{std::move(solved.solution), app::solve_options(s.loaded.scene, common),
                  app::KeptLights::digests_of(s.loaded)});
  return light;
}

void Session::write_light(const Light& light, const std::string& path) {
  const CallLock call_lock;
  state_->read();
  app::write_solution(path, light.kept->solution, state_->loaded, light.kept->solver);
}

std::string Session::plan(const std::string& request_text) {
  const Request request(request_text);
  const CallLock call_lock(request);
  State& s = *state_;
  s.read();
  const app::RenderCall call = call_of(request, s.path, s.overrides);
  std::vector<const scenes::Camera*> cameras;
  if (!call.cameras.empty()) {
    cameras = app::each_once(app::wanted_cameras(call.cameras, s.loaded.scene));
  } else {
    for (const scenes::Camera& camera : s.loaded.scene.cameras) cameras.push_back(&camera);
  }
  s.prepare(call, cameras, false, request.number("error"));
  const base::StopInForce stop([] { return app::Interrupt::asked(); });
  const Json plan = app::plan_json(s.loaded, call, request.common(),
                                   static_cast<int>(request.number("ranks").value_or(0.0)));
  leave_if_asked();
  return app::dump(plan);
}

std::string Session::form_factors(const std::string& request_text) {
  const Request request(request_text);
  const CallLock call_lock(request);
  State& s = *state_;
  s.read();
  s.loaded.scene.quality = s.quality;
  s.loaded.scene.warnings = s.warnings;
  app::decide_effects(s.loaded, {});
  const base::StopInForce stop([] { return app::Interrupt::asked(); });
  const Json found =
      app::form_factors_json(s.loaded, app::factor_method("method", request.word("method", "auto")),
                             request.flag("raw"), request.common());
  return app::dump(found);
}

}  // namespace earthshine::python
