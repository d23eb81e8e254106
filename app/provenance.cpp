// SPDX-License-Identifier: Apache-2.0
#include "app/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace earthshine::app {
namespace {

std::string numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

class HeaderWriter {
 public:
  explicit HeaderWriter(base::ExrHeader& header) : header_(header) {}
  void text(const std::string& name, const std::string& value) {
    header_.text.emplace_back("earthshine:" + name, value);
  }
  template <class Number>
  void number(const std::string& name, Number value) {
    header_.numbers.emplace_back("earthshine:" + name, static_cast<float>(value));
  }

 private:
  base::ExrHeader& header_;
};

void write_camera(HeaderWriter& header, const scenes::Camera& camera, int rows) {
  header.text("camera", camera.name);
  header.text("camera.position_m", numbers(camera.position));
  header.text("camera.look_at_m", numbers(camera.look_at));
  header.text("camera.up", numbers(camera.up));
  header.number("camera.fov_deg", camera.fov_deg);
  header.number("camera.focal_px", 0.5 * rows / std::tan(0.5 * base::radians(camera.fov_deg)));
  if (camera.focus_m > 0.0 && camera.aperture_m > 0.0) {
    header.number("camera.focus_m", camera.focus_m);
    header.number("camera.aperture_m", camera.aperture_m);
  }
  header.text("camera.filter", std::string(scenes::filter_name(camera.filter)));
  header.number("camera.filter_width_px", camera.filter_width_px);
}

}  // namespace

std::string indirect_name(raytrace::Indirect indirect) {
  switch (indirect) {
    case raytrace::Indirect::Radiosity:
      return "radiosity";
    case raytrace::Indirect::Distributed:
      return "distributed";
    case raytrace::Indirect::None:
      return "none";
  }
  return "";
}

base::ExrHeader provenance_header(const Provenance& p) {
  base::ExrHeader result;
  HeaderWriter header(result);
  header.text("version", EARTHSHINE_VERSION);
  header.text("scene", p.scene.path.string());
  header.text("name", p.scene.name);
  header.text("units", "radiance in cd/m^2 (linear Rec. 709), lengths in m");
  header.text("set", fmt::format("{}", fmt::join(p.overrides, "; ")));
  header.text("seed", std::to_string(p.options.seed));
  header.text("indirect", indirect_name(p.options.indirect));
  if (p.options.indirect == raytrace::Indirect::Distributed) {
    header.number("distributed_lights", p.options.distributed_lights);
    header.text("distributed_over", p.options.distributed_over);
  }
  header.text("aov", fmt::format("{}", fmt::join(p.options.aovs, ",")));
  header.text("per_light", p.options.per_light ? "yes" : "no");
  write_camera(header, p.camera, p.options.rows);
  header.number("gather_rays", p.options.gather_rays);
  header.number("camera_samples", p.render.camera_samples);
  header.number("relative_noise", p.render.relative_noise);
  if (p.solution != nullptr) {
    header.text("refined", p.solver.refine.on ? "yes" : "no");
    header.number("patch_edge_m", p.solver.patch_edge_m);
    header.number("form_factor_rays", p.solver.form_factor_rays);
    header.number("solver_tolerance", p.solver.tolerance);
    header.number("patches", p.solution->patches);
    header.number("iterations", p.solution->iterations);
    header.number("residual", p.solution->residual);
  }
  return result;
}

void add_times(base::ExrHeader& header, const StageTimes& times) {
  HeaderWriter writer(header);
  for (auto [stage, seconds] : times.stages()) {
    std::replace(stage.begin(), stage.end(), ' ', '_');
    writer.number("seconds." + stage, seconds);
  }
}

}  // namespace earthshine::app
