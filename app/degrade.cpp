// SPDX-License-Identifier: Apache-2.0
// earthshine degrade: the CCTV stage alone, on any linear EXR.
#include <fmt/format.h>

#include <memory>

#include "app/camera_argument.h"
#include "app/cctv.h"
#include "app/command.h"
#include "app/console.h"
#include "app/degrade_list.h"
#include "base/error.h"
#include "base/exr_file.h"

namespace earthshine::app {
namespace {

struct DegradeCall {
  std::string input, output, scene, camera, preset, cctv, describe;
  std::uint64_t frame = 0;
  std::vector<std::string> off;
  bool list = false, json = false;
};

[[noreturn]] void refuse(std::string_view where, std::string_view found, std::string_view remedy) {
  throw base::Error(base::Blame::Input, where, found, {}, remedy);
}

void check_call(const DegradeCall& call) {
  if (call.input.empty()) refuse("degrade", "no picture is named", "Name an EXR file");
  if (call.output.empty())
    refuse("degrade", "-o is missing", "Name a PNG file to write: -o OUT.png");
  if (!call.output.ends_with(".png") && !call.output.starts_with("/dev/")) {
    refuse("-o", "\"" + call.output + "\" is not a .png file", "Name a file that ends in .png");
  }
  if (!call.scene.empty() && !call.preset.empty()) {
    refuse("--preset", "stands beside --scene", "Give one of them");
  }
  if (!call.cctv.empty() && !(call.scene.empty() && call.preset.empty())) {
    refuse("--cctv", "stands beside --scene or --preset", "Give one of them");
  }
  if (call.scene.empty() && !call.camera.empty()) {
    refuse("--camera", "needs a scene", "Add --scene SCENE");
  }
  check_outputs({call.output}, {call.input, call.scene, file_of_camera(call.cctv)});
}

// The camera asked for, else the one that the picture says it was rendered with, else the first.
std::string camera_of(const DegradeCall& call, const scenes::Scene& scene,
                      const base::ExrHeader& header) {
  if (!call.camera.empty()) return call.camera;
  for (const auto& [name, value] : header.text) {
    if (name != "earthshine:camera") continue;
    for (const scenes::Camera& camera : scene.cameras) {
      if (camera.name == value) return value;
    }
  }
  return {};
}

CctvSetup setup_for(const DegradeCall& call, const Common& common, const base::ExrHeader& header) {
  if (!call.preset.empty()) return cctv_of_preset(call.preset, common);
  if (!call.cctv.empty()) return cctv_of(camera_of_argument("--cctv", call.cctv), common);
  if (!call.scene.empty()) {
    const LoadedScene loaded = load({call.scene, {}}, common.quiet);
    return cctv_of_camera(
        loaded.scene, choose_camera(loaded.scene, camera_of(call, loaded.scene, header)), common);
  }
  if (!common.quiet)
    note(fmt::format("note: no --preset, --cctv or --scene, taking \"{}\"", default_preset));
  return cctv_of_preset(std::string(default_preset), common);
}

void run(const DegradeCall& call, const Common& common) {
  if (call.list) return list_cameras(call.json);
  if (!call.describe.empty()) {
    return print_camera(camera_of_argument("--describe", call.describe), call.json);
  }
  check_call(call);
  const base::ExrFile file = base::read_exr(call.input);
  CctvSetup setup = setup_for(call, common, file.header);
  setup.chain.options.frame = call.frame;
  setup.chain.options.off = call.off;
  const degrade::Result result = run_chain(setup, file.image);
  write_cctv(call.output, setup, result);
  if (call.json) print(dump(cctv_json(setup, result)));
  if (!common.quiet) note("  " + cctv_summary(setup, result));
}

}  // namespace

Command add_degrade(CLI::App& program) {
  CLI::App* parser =
      program.add_subcommand("degrade", "What a CCTV camera and its monitor make of a linear EXR");
  const auto call = std::make_shared<DegradeCall>();
  parser->add_option("IN", call->input, "Picture in cd/m2 (OpenEXR)")->type_name("");
  parser->add_option("-o,--output", call->output, "Picture to write (PNG)")->type_name("FILE");
  parser->add_option("--scene", call->scene, "Scene whose camera and [monitor] to use")
      ->type_name("SCENE");
  parser
      ->add_option("--camera", call->camera,
                   "Camera of the scene (default: the one in the picture's header, or the first)")
      ->type_name("NAME");
  parser
      ->add_option("--cctv", call->cctv,
                   "CCTV camera: one that ships, FILE.toml with a [[cctv]], or FILE.toml:NAME")
      ->type_name("CAMERA");
  parser->add_option("--preset", call->preset, "CCTV camera that ships (see --list)")
      ->type_name("NAME");
  add_whole_number(*parser, "--frame", call->frame, 0, ~std::uint64_t{0},
                   "Number of the television frame: other noise (default 0)");
  parser->add_option("--off", call->off, "Leave out a stage (see --list; may be repeated)")
      ->type_name("STAGE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  parser->add_flag("--list", call->list, "Show the presets and the stages");
  parser
      ->add_option("--describe", call->describe,
                   "Show a CCTV camera's settings with sources, and its noise in all forms")
      ->type_name("CAMERA");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
