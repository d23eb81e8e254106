// SPDX-License-Identifier: Apache-2.0
#include "app/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "raytrace/camera/camera.h"
#include "raytrace/frame/cryptomatte.h"

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

// Names may come from mesh files with invalid UTF-8.
std::string compact(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_matrices(base::ExrHeader& header, const raytrace::CameraMatrices& matrices) {
  HeaderWriter own(header);
  own.text("camera.K", fmt::format("{}", fmt::join(matrices.k, " ")));
  own.text("camera.to_world", fmt::format("{}", fmt::join(matrices.to_world, " ")));
  own.text("camera.axes",
           "x right, y down, z forward; pixels from the top left corner, centres at +0.5");
  const auto standard = [&header](const char* name, const std::array<double, 16>& matrix) {
    base::ExrMatrix single{};
    std::transform(matrix.begin(), matrix.end(), single.begin(),
                   [](double value) { return static_cast<float>(value); });
    header.matrices.emplace_back(name, single);
  };
  standard("worldToCamera", matrices.world_to_camera);
  standard("worldToNDC", matrices.world_to_ndc);
  header.numbers.emplace_back("screenWindowWidth",
                              static_cast<float>(matrices.screen_window_width));
}

void write_cryptomatte(base::ExrHeader& header, const scenes::Scene& scene,
                       const raytrace::CryptomatteType& type) {
  const auto hex = [](const std::string& name) {
    return raytrace::eight_hex_digits(raytrace::cryptomatte_id(name));
  };
  Json manifest = Json::object();
  for (const std::string& name : raytrace::cryptomatte_names(scene, type.of)) {
    manifest[name] = hex(name);
  }
  const std::string prefix = "cryptomatte/" + hex(type.name).substr(0, 7) + "/";
  header.text.emplace_back(prefix + "name", type.name);
  header.text.emplace_back(prefix + "hash", "MurmurHash3_32");
  header.text.emplace_back(prefix + "conversion", "uint32_to_float32");
  header.text.emplace_back(prefix + "manifest", compact(manifest));
}

}  // namespace

void add_camera(base::ExrHeader& result, const scenes::Camera& camera, int columns, int rows) {
  HeaderWriter header(result);
  const raytrace::CameraMatrices matrices =
      raytrace::camera_matrices(raytrace::make_camera_model(camera, columns, rows));
  header.text("camera", camera.name);
  header.text("camera.position_m", numbers(camera.position));
  header.text("camera.look_at_m", numbers(camera.look_at));
  header.text("camera.up", numbers(camera.up));
  header.number("camera.fov_deg", camera.fov_deg);
  header.number("camera.focal_px", matrices.k[4]);
  if (camera.focus_m > 0.0 && camera.aperture_m > 0.0) {
    header.number("camera.focus_m", camera.focus_m);
    header.number("camera.aperture_m", camera.aperture_m);
    result.numbers.emplace_back("focus", static_cast<float>(camera.focus_m));
  }
  if (camera.exposure_s > 0.0 || camera.line_s > 0.0) {
    header.number("camera.exposure_s", camera.exposure_s);
    header.number("camera.line_s", camera.from_below ? -camera.line_s : camera.line_s);
    header.text("camera.velocity_m_s", numbers(camera.motion.velocity_m_s));
    header.text("camera.spin_deg_s", numbers(camera.motion.spin_deg_s));
  }
  header.text("camera.filter", std::string(scenes::filter_name(camera.filter)));
  header.number("camera.filter_width_px", camera.filter_width_px);
  write_matrices(result, matrices);
  if (camera.distortion != scenes::Distortion::None) {
    const bool is_fisheye = camera.distortion == scenes::Distortion::Fisheye;
    header.text(
        is_fisheye ? "camera.fisheye" : "camera.distortion",
        fmt::format("{}",
                    fmt::join(std::span(camera.distortion_k).first(is_fisheye ? 4 : 5), " ")));
  }
}

void add_names(base::ExrHeader& header, const scenes::Scene& scene,
               const std::vector<std::string>& aovs) {
  const auto asked = [&aovs](const char* aov) {
    return std::find(aovs.begin(), aovs.end(), aov) != aovs.end();
  };
  using raytrace::CryptomatteOf;
  const auto list = [&](const char* name, CryptomatteOf of) {
    HeaderWriter(header).text(name, compact(Json(raytrace::cryptomatte_names(scene, of))));
  };
  if (asked("object")) list("objects", CryptomatteOf::Object);
  if (asked("material")) list("materials", CryptomatteOf::Material);
  for (const raytrace::CryptomatteType& type : raytrace::cryptomatte_types) {
    if (asked(type.aov)) write_cryptomatte(header, scene, type);
  }
}

std::string indirect_name(raytrace::Indirect indirect) {
  switch (indirect) {
    case raytrace::Indirect::Radiosity:
      return "radiosity";
    case raytrace::Indirect::Distributed:
      return "distributed";
    case raytrace::Indirect::None:
      return "none";
    case raytrace::Indirect::Paths:
      return "paths";
  }
  return "";
}

void add_origin(base::ExrHeader& result, const scenes::Scene& scene,
                const std::vector<std::string>& overrides, std::uint64_t seed) {
  HeaderWriter header(result);
  header.text("version", EARTHSHINE_VERSION);
  header.text("scene", scene.path.string());
  header.text("name", scene.name);
  header.text("set", fmt::format("{}", fmt::join(overrides, "; ")));
  header.text("seed", std::to_string(seed));
}

HeaderTexts partial_mark(const base::ExrHeader& header) {
  const std::pair<std::string, std::string> mark{"earthshine:partial", "yes"};
  return std::ranges::find(header.text, mark) != header.text.end() ? HeaderTexts{mark}
                                                                   : HeaderTexts{};
}

base::ExrHeader provenance_header(const Provenance& p) {
  base::ExrHeader result;
  HeaderWriter header(result);
  add_origin(result, p.scene, p.overrides, p.options.seed);
  header.text("units", "radiance in cd/m^2 (linear Rec. 709), lengths in m");
  header.text("indirect", indirect_name(p.options.indirect));
  if (p.options.indirect == raytrace::Indirect::Distributed) {
    header.number("distributed_lights", p.options.distributed_lights);
    header.text("distributed_over", p.options.distributed_over);
  }
  if (p.options.paths == raytrace::PathSet::NoCaustics) header.text("caustics", "no");
  header.text("aov", fmt::format("{}", fmt::join(p.options.aovs, ",")));
  header.text("per_light", p.options.per_light ? "yes" : "no");
  add_camera(result, p.camera, p.options.columns, p.options.rows);
  add_names(result, p.scene, p.options.aovs);
  header.number("gather_rays", p.options.gather_rays);
  header.number("camera_samples", p.render.camera_samples);
  header.number("relative_noise", p.render.relative_noise);
  if (p.render.stopped) header.number("finished_share", p.render.finished_share);
  header.text("partial", p.render.stopped ? "yes" : "no");
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
