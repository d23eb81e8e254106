// SPDX-License-Identifier: Apache-2.0
// earthshine console: the lighting console of a scene as one page.
#include "app/console.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/command.h"
#include "app/console/layers.h"
#include "app/console/page.h"
#include "app/options.h"
#include "app/output.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/output_file.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

struct ConsoleCall {
  StudyCall study;
  std::string output = "console.html", layers;
  std::uint64_t positions = 0;
  bool json = false;
};

// Folder of finished pictures, so that a second call with other controls draws nothing.
std::string store_beside(const std::string& output) {
  fs::path path(output);
  return path.replace_extension(".layers").string();
}

void write_layers(const ConsoleCall& call, const StudyPart& part, const ConsoleView& view) {
  const scenes::Camera& camera = *view.camera->camera;
  base::ExrHeader header;
  header.text = {{"Software", "earthshine " EARTHSHINE_VERSION},
                 {"earthshine:camera", camera.name}};
  header.numbers = {{"earthshine:camera.fov_deg", static_cast<float>(camera.fov_deg)}};
  base::write_exr(
      (fs::path(call.layers) / (file_stem(part.loaded.scene, camera) + ".exr")).string(),
      view.image, header);
}

void run(const ConsoleCall& call, const Common& common) {
  if (!call.layers.empty() && call.positions > 0) {
    throw base::Error(base::Blame::Input, "--layers", "does not go with --positions", {},
                      "The layers of an orbit are not those of one picture: leave one of them out");
  }
  std::vector<double> positions;
  if (call.positions > 0) positions = studies::even_positions(static_cast<int>(call.positions));
  const studies::StudyFile study = console_study(call.study, std::move(positions));
  // Of a scene whose joints move: its first pose with a camera outside all bodies.
  StudyParts poses = prepare_parts(study, 0, common);
  const std::unique_ptr<StudyPart> part = std::move(
      *std::ranges::find_if(poses, [](const auto& pose) { return !pose->cameras.empty(); }));
  check_outputs({call.output}, part->loaded.scene.files);
  refuse_other_kind("-o", call.output, {".html"});
  if (!call.layers.empty()) {
    make_folder(call.layers);
    refuse_inputs_in(call.layers, part->loaded.scene.files);
  }
  const std::string store = store_beside(call.output);
  make_folder(store);
  ConsolePage page(*part, call.study, call.layers, common);
  Json cameras = Json::array();
  {
    const Interrupt interrupt;
    draw_views(*part, store, common, [&](const ConsoleView& view) {
      if (!call.layers.empty()) write_layers(call, *part, view);
      page.add(view);
      cameras.push_back({{"camera", view.camera->camera->name},
                         {"columns", view.camera->columns},
                         {"rows", view.camera->rows},
                         {"layers", view.layers.size()},
                         {"relative_noise", view.relative_noise},
                         {"seconds", view.seconds}});
      if (common.quiet) return;
      note(fmt::format("  camera {}: {} layers, noise {:.2g} of the mean, {}",
                       view.camera->camera->name, view.layers.size(), view.relative_noise,
                       duration(view.seconds)));
    });
  }
  const std::string html = page.html();
  base::write_text(call.output, html);
  const double megabytes = static_cast<double>(html.size()) / 1e6;
  if (html.size() > most_page_bytes && !common.quiet) {
    note(
        fmt::format("note: {} has {:.1f} MB, more than 30: browsers open it slowly. A smaller "
                    "--size, fewer --camera or --positions make it smaller",
                    call.output, megabytes));
  } else if (!common.quiet) {
    note(fmt::format("  {}: {:.1f} MB", call.output, megabytes));
  }
  if (call.json) {
    print(dump({{"output", call.output}, {"bytes", html.size()}, {"cameras", cameras}}));
  }
  std::vector<std::string> skipped;
  for (const scenes::Camera* camera : part->skipped) skipped.push_back(camera->name);
  check_skipped(skipped);
}

}  // namespace

Command add_console(CLI::App& program) {
  CLI::App* parser = program.add_subcommand(
      "console", "A page on which to turn the lamps, the Sun and the cameras of a scene");
  const auto call = std::make_shared<ConsoleCall>();
  add_scene_options(*parser, call->study.scene);
  parser->add_option("-o,--output", call->output, "Page to write (default console.html)")
      ->type_name("FILE.html");
  add_cameras_option(*parser, call->study);
  add_size_option(*parser, call->study.size);
  add_whole_number(*parser, "--positions", call->positions, 2, 360,
                   "Places along the orbit, evenly spaced (default: the scene's own)");
  parser
      ->add_option("--layers", call->layers, "Folder for each camera's layers as EXR, for relight")
      ->type_name("DIR");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
