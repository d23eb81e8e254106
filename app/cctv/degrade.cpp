// SPDX-License-Identifier: Apache-2.0
// earthshine degrade: the CCTV stage alone, on any linear EXR.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <sstream>

#include "app/cctv/cctv.h"
#include "app/cctv/degrade_list.h"
#include "app/cctv/tape.h"
#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/provenance.h"
#include "base/error.h"
#include "base/files/exr_reader.h"
#include "degrade/settings/radiance_file.h"
#include "scenes/plausible/plausible.h"

namespace earthshine::app {
namespace {

constexpr std::uint64_t default_target_resels = 5;
constexpr std::uint64_t most_frames = 1'000'000'000;

struct DegradeCall {
  TapeCall tape;
  std::string output, twin, stages, scene, camera, preset, cctv, describe;
  std::uint64_t target_resels = default_target_resels;
  std::optional<double> fov_deg, f_number;
  std::vector<std::string> off;
  bool list = false, json = false;
};

[[noreturn]] void refuse(std::string_view where, std::string_view found, std::string_view remedy) {
  throw base::Error(base::Blame::Input, where, found, {}, remedy);
}

bool is_picture_name(const std::string& path) {
  return path.ends_with(".png") || path.ends_with(".exr") || path.starts_with("/dev/");
}

void check_call(const DegradeCall& call) {
  if (call.tape.inputs.empty()) refuse("degrade", "no picture is named", "Name an EXR file");
  if (call.output.empty())
    refuse("degrade", "-o is missing", "Name a file to write: -o OUT.png or OUT.exr");
  if (!is_picture_name(call.output)) {
    refuse("-o", "\"" + call.output + "\" is neither a .png nor an .exr file",
           "Name a file that ends in .png or .exr");
  }
  if (!call.twin.empty() && !call.twin.ends_with(".exr") && !call.twin.starts_with("/dev/")) {
    refuse("--twin", "\"" + call.twin + "\" is not an .exr file", "Name a file that ends in .exr");
  }
  if (!call.twin.empty() && call.tape.fields) {
    refuse("--twin", "cannot be combined with --fields",
           "A twin belongs to a scene that stands still");
  }
  if (call.twin.empty() && call.target_resels != default_target_resels) {
    refuse("--target-resels", "has no effect without --twin", "Add --twin FILE.exr");
  }
  if (call.target_resels % 2 == 0) {
    refuse("--target-resels", "is even", "Give an odd number, so that a target has a middle");
  }
  if (!call.scene.empty() && !call.preset.empty()) {
    refuse("--preset", "cannot be combined with --scene", "Give one of them");
  }
  if (!call.cctv.empty() && !(call.scene.empty() && call.preset.empty())) {
    refuse("--cctv", "cannot be combined with --scene or --preset", "Give one of them");
  }
  if (call.scene.empty() && !call.camera.empty()) {
    refuse("--camera", "needs a scene", "Add --scene SCENE");
  }
}

Files inputs_of(const DegradeCall& call) {
  Files inputs(call.tape.inputs.begin(), call.tape.inputs.end());
  inputs.insert(inputs.end(), {call.scene, file_of_camera(call.cctv)});
  return inputs;
}

// Checks every file that the frames will be written to.
void check_files(const DegradeCall& call, const std::vector<TapeFrame>& tape, const Files& inputs) {
  check_numbered("-o", call.output, tape.size());
  check_numbered("--twin", call.twin, tape.size());
  check_numbered("--stages", call.stages, tape.size());
  std::vector<std::string> outputs;
  for (const TapeFrame& frame : tape) {
    outputs.push_back(numbered(call.output, frame.number));
    outputs.push_back(numbered(call.twin, frame.number));
  }
  check_outputs(outputs, inputs);
}

// The requested camera, else the camera named in the picture's header, else the first one.
const scenes::Camera& camera_of(const DegradeCall& call, const scenes::Scene& scene,
                                const base::ExrHeader& header) {
  if (!call.camera.empty()) return choose_camera(scene, call.camera, {"--camera"});
  for (const auto& [name, value] : header.text) {
    if (name != "earthshine:camera") continue;
    for (const scenes::Camera& camera : scene.cameras) {
      if (camera.name == value) return camera;
    }
  }
  return first_camera(scene);
}

CctvSetup setup_for(const DegradeCall& call, const Common& common, const base::ExrHeader& header,
                    const std::vector<TapeFrame>& tape) {
  if (!call.preset.empty()) return cctv_of_preset(call.preset, common);
  if (!call.cctv.empty()) return cctv_of(camera_of_argument("--cctv", call.cctv), common);
  if (!call.scene.empty()) {
    const LoadedScene loaded = load({call.scene, {}}, common.quiet);
    check_files(call, tape, loaded.scene.files);
    return cctv_of_camera(loaded.scene, camera_of(call, loaded.scene, header), common);
  }
  if (!common.quiet)
    note(fmt::format("note: no --preset, --cctv or --scene, taking \"{}\"", default_preset));
  return cctv_of_preset(std::string(default_preset), common);
}

// Caches the last picture, so that a still is read once.
struct Reader {
  bool quiet = false;
  bool noted_crop = false;
  std::string path;
  degrade::RadianceFile file;
  base::ExrHeader::Whole whole;
  const base::Image& read(const std::string& wanted, const degrade::Setup& setup) {
    if (wanted != path) {
      base::ExrReader reader(wanted);
      file = degrade::read_radiance(reader, setup);
      whole = reader.header().whole;
      if (whole.columns > 0 && !quiet && !noted_crop) {
        note("note: " + wanted + " is a crop: iris and glare see only this part of the view");
        noted_crop = true;
      }
    }
    path = wanted;
    return file.image;
  }
};

void note_non_square_pixels(const std::string& path, const base::ExrHeader& header) {
  for (const auto& [name, value] : header.text) {
    if (name != "earthshine:camera.K") continue;
    double fx = 1.0, zero = 0.0, fy = 1.0;
    std::istringstream words(value);
    if (!(words >> fx >> zero >> zero >> zero >> fy)) continue;
    if (const auto text = scenes::non_square_pixels_warning(fx, fy)) {
      note("warning: " + path + " " + *text);
    }
  }
}

// Vertical field of view: of the option, else of the scene's camera, else of the picture's header.
double field_of_view(const DegradeCall& call, double of_scene, const base::ExrHeader& header) {
  if (call.fov_deg) return *call.fov_deg;
  if (of_scene > 0.0) return of_scene;
  for (const auto& [name, value] : header.numbers) {
    if (name == "earthshine:camera.fov_deg") return static_cast<double>(value);
  }
  return 0.0;
}

// The picture's size, and its position if it is a crop.
Json picture_json(const degrade::RadianceFile& file, const base::ExrHeader::Whole& whole) {
  Json json = {{"columns", file.columns}, {"rows", file.rows}, {"read_in_strips", file.averaged}};
  if (whole.columns > 0) {
    json["crop_of"] = {
        {"columns", whole.columns}, {"rows", whole.rows}, {"x", whole.x}, {"y", whole.y}};
  }
  return json;
}

void run(const DegradeCall& call, const Common& common) {
  check_call(call);
  const std::vector<TapeFrame> tape = lay_out(call.tape);
  const Files inputs = inputs_of(call);
  check_files(call, tape, inputs);
  Reader reader;
  reader.quiet = common.quiet;
  const base::ExrHeader header = base::ExrReader(tape.front().inputs.front()).header();
  if (!common.quiet) note_non_square_pixels(tape.front().inputs.front(), header);
  CctvSetup setup = setup_for(call, common, header, tape);
  degrade::Options& options = setup.chain.options;
  options.off = call.off;
  options.fov_deg = field_of_view(call, options.fov_deg, header);
  if (call.f_number && setup.chain.camera.iris_rate == 1.0 && setup.chain.camera.iris_slew == 0.0) {
    refuse("--f-number", "has no effect: the iris of \"" + setup.name + "\" moves at once",
           "Leave it out, or give the camera an iris_rate or iris_slew");
  }
  if (call.fov_deg && setup.chain.camera.fall_off == 0.0 && !common.quiet)
    note("note: --fov has no effect: \"" + setup.name + "\" has no fall_off");
  degrade::Memory memory, twin_memory;
  memory.f_number = twin_memory.f_number = call.f_number;
  Json reports = Json::array();
  const HeaderTexts mark = partial_mark(header);
  for (const TapeFrame& frame : tape) {
    options.frame = frame.number;
    StagePictures stages(numbered(call.stages, frame.number), inputs, options);
    degrade::Result result;
    if (frame.inputs.size() == 2) {
      const base::Image first = reader.read(frame.inputs[0], setup.chain);
      result = degrade::degrade_fields(first, reader.read(frame.inputs[1], setup.chain),
                                       setup.chain.camera, setup.chain.monitor, options, memory);
    } else {
      result = degrade::degrade(reader.read(frame.inputs[0], setup.chain), setup.chain.camera,
                                setup.chain.monitor, options, memory);
    }
    memory = result.memory;
    result.report.negative_pixels += reader.file.negative_pixels;
    write_cctv(numbered(call.output, frame.number), setup, result, mark);
    Json report = cctv_json(setup, result);
    report["picture"] = picture_json(reader.file, reader.whole);
    if (!call.twin.empty()) {
      const degrade::Twin twin = degrade::twin(reader.read(frame.inputs[0], setup.chain),
                                               setup.chain.camera, setup.chain.monitor, options,
                                               {static_cast<int>(call.target_resels)}, twin_memory);
      twin_memory = twin.memory;
      write_twin(numbered(call.twin, frame.number), setup, twin, result, mark);
      report["twin"] = twin_json(twin);
    }
    reports.push_back(std::move(report));
    if (!common.quiet) note("  " + cctv_summary(setup, result));
  }
  if (!call.json) return;
  print(dump(tape.size() == 1 ? reports.front() : Json{{"frames", reports}}));
}

}  // namespace

std::vector<Command> add_degrade(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "degrade", "Shows a linear EXR as a CCTV camera and its monitor do");
  const auto call = std::make_shared<DegradeCall>();
  parser
      ->add_option("IN", call->tape.inputs,
                   "Picture in cd/m2 (OpenEXR); several are the frames of a sequence")
      ->type_name("");
  parser
      ->add_option("-o,--output", call->output,
                   "Picture to write: PNG, or EXR in cd/m2; # is the frame's number")
      ->type_name("FILE");
  parser->add_option("--scene", call->scene, "Scene whose camera and [monitor] to use")
      ->type_name("SCENE");
  parser
      ->add_option("--camera", call->camera,
                   "Camera of the scene (default: the one in the picture's header, or the first)")
      ->type_name("NAME");
  parser
      ->add_option("--cctv", call->cctv,
                   "CCTV camera: one that ships, FILE.toml with a [[cctv]], or FILE.toml:NAME")
      ->group("Input")
      ->type_name("CAMERA");
  parser->add_option("--preset", call->preset, "CCTV camera that ships (see --list)")
      ->type_name("NAME");
  add_whole_number(*parser, "--frame", call->tape.first, 0, most_frames,
                   "Number of the (first) television frame: other noise (default 0)");
  add_whole_number(*parser, "--frames", call->tape.frames, 1, most_frames,
                   "How many frames one picture is shown (default 1)");
  parser->add_flag("--fields", call->tape.fields,
                   "The pictures are fields: two make a frame of an interlaced camera");
  add_number(*parser, "--f-number", call->f_number, 0.5, 1e6,
             "Where the iris stood before the first frame (default: where it ends)");
  add_number(*parser, "--fov", call->fov_deg, 0.001, 179.0,
             "Vertical field of view in degrees, for fall_off (default: what the scene or the "
             "picture says)");
  parser
      ->add_option("--twin", call->twin,
                   "The picture's analytic twin: noise-free, mean, variance, SNR, probability of "
                   "detection, masks (EXR)")
      ->type_name("FILE.exr");
  add_whole_number(*parser, "--target-resels", call->target_resels, 1, 199,
                   "Size of the details whose detection --twin maps, odd (default 5)");
  parser
      ->add_option("--stages", call->stages,
                   "Folder for the picture after each stage (EXR, in the stage's unit)")
      ->type_name("DIR");
  may_repeat(
      parser->add_option("--off", call->off, "Leave out a stage (see --list; may be repeated)"))
      ->type_name("STAGE");
  parser->add_flag("--list", call->list, "Show the presets and the stages");
  parser
      ->add_option("--describe", call->describe,
                   "Show a CCTV camera's settings with sources, and its noise in all forms")
      ->type_name("CAMERA");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  const Command certify = add_certify(*parser);
  const auto picture = [parser, call, certify](const Common& common) {
    if (certify.parser->parsed()) return refuse_beside("certify", *parser, {});
    if (!call->list && call->describe.empty()) return run(*call, common);
    const std::string asked = call->list ? "--list" : "--describe";
    refuse_beside(asked, *parser, {asked, "--json"});
    if (call->list) return list_cameras(call->json);
    print_camera(camera_of_argument(asked, call->describe), call->json);
  };
  return {{parser, picture}, certify};
}

}  // namespace earthshine::app
