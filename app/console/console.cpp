// SPDX-License-Identifier: Apache-2.0
// earthshine console: the lighting console of a scene as one page.
#include "app/console.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/command.h"
#include "app/console/layers.h"
#include "app/console/page.h"
#include "app/console/serve.h"
#include "app/console/study_folder.h"
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
  std::uint64_t positions = 0, port = 0;
  bool json = false, serve = false;
};

// Folder of finished pictures, which a second call reuses.
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

// Study of the page: made for it, or finished.
struct Source {
  studies::StudyFile study;
  std::optional<FinishedStudy> finished;
};

Source source_of(const ConsoleCall& call) {
  if (!is_study_folder(call.study.scene.path)) {
    std::vector<double> positions;
    if (call.positions > 0) positions = studies::even_positions(static_cast<int>(call.positions));
    return {console_study(call.study, std::move(positions)), {}};
  }
  for (const auto& [given, option] : {std::pair(!call.study.scene.overrides.empty(), "--set"),
                                      std::pair(call.study.size.has_value(), "--size"),
                                      std::pair(call.positions > 0, "--positions")}) {
    if (!given) continue;
    throw base::Error(base::Blame::Input, option, "does not go with a study's folder", {},
                      "The study has decided it: leave it out, or name the scene");
  }
  FinishedStudy finished = finished_study(call.study.scene.path, call.study.cameras);
  studies::StudyFile study = finished.study;
  return {std::move(study), std::move(finished)};
}

// The first scene of the source, in its first pose.
std::unique_ptr<StudyPart> part_of(const Source& source, const Common& common) {
  StudyParts parts = prepare_parts(source.study, 0, common);
  const bool moves = source.finished && parts.size() > 1;
  if (!common.quiet && (moves || source.study.scenes.size() > 1)) {
    note(fmt::format("note: the study has several {}; the page shows the first",
                     moves ? "poses" : "scenes"));
  }
  // Of a scene whose joints move: its first pose with a camera outside all bodies.
  std::unique_ptr<StudyPart>& first =
      *std::ranges::find_if(parts, [](const auto& pose) { return !pose->cameras.empty(); });
  if (source.finished) check_unchanged(*source.finished, *first);
  return std::move(first);
}

// Options for the contents of a page are errors with a server, which writes no page.
void serve_scene(const ConsoleCall& call, const CLI::App& parser, const Common& common) {
  for (const char* option :
       {"--output", "--camera", "--size", "--positions", "--layers", "--json"}) {
    if (parser.count(option) == 0) continue;
    throw base::Error(base::Blame::Input, option, "does not go with --serve", {},
                      "Leave it out: the live preview writes no file");
  }
  serve(call.study.scene, static_cast<int>(call.port), common);
}

void run(const ConsoleCall& call, const Common& given) {
  if (!call.layers.empty() && call.positions > 0) {
    throw base::Error(base::Blame::Input, "--layers", "does not go with --positions", {},
                      "The layers of an orbit are not those of one picture: leave one of them out");
  }
  const Source source = source_of(call);
  Common common = given;
  if (source.finished) common.seed = source.finished->seed;
  const std::unique_ptr<StudyPart> part = part_of(source, common);
  check_outputs({call.output}, part->loaded.scene.files);
  refuse_other_kind("-o", call.output, {".html"});
  if (!call.layers.empty() && part->basis->places().size() > 1) {
    throw base::Error(base::Blame::Input, "--layers", "does not go with several places", {},
                      "The layers of an orbit are not those of one picture: leave it out");
  }
  if (!call.layers.empty()) {
    make_folder(call.layers);
    refuse_inputs_in(call.layers, part->loaded.scene.files);
  }
  const std::string store = store_beside(call.output);
  ConsolePage page(*part, source.study.overrides, call.layers, common);
  if (source.finished) page.add_study(study_json(*source.finished, *part));
  const std::string finished =
      source.finished ? (fs::path(source.finished->folder) / points_folder).string() : "";
  Json cameras = Json::array();
  {
    const Interrupt interrupt;
    draw_views(*part, store, finished, common, [&](const ConsoleView& view) {
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
  CLI::App* parser = add_subcommand(program, "console",
                                    "A page on which to turn the lamps, the Sun and the "
                                    "cameras of a scene or of a finished study");
  const auto call = std::make_shared<ConsoleCall>();
  add_scene_options(*parser, call->study.scene);
  parser->get_option("SCENE")->description("Scene file (TOML), or the folder of a finished study");
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
  parser->add_flag("--serve", call->serve,
                   can_serve() ? "Live preview at an address of this machine, until Ctrl-C"
                               : "Not in this build: it needs libcpp-httplib-dev");
  add_whole_number(*parser, "--port", call->port, 1024, 65535,
                   "Port of --serve (default: a free one)");
  return {parser, [call, parser](const Common& common) {
            if (call->serve) return serve_scene(*call, *parser, common);
            run(*call, common);
          }};
}

}  // namespace earthshine::app
