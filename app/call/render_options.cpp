// SPDX-License-Identifier: Apache-2.0
// Options of render: less than the whole picture (a part of it, a time), and how light gets around.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "app/call/render_call.h"
#include "app/options.h"
#include "radiosity/bodies/walls.h"
#include "scenes/effects/quality.h"

namespace earthshine::app {
namespace {

// Whole numbers between the cache_key of `pattern`: "," and "x" stand for themselves, each # for
// one.
std::optional<std::vector<int>> numbers_like(std::string_view pattern, std::string_view text) {
  std::vector<int> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (const char mark : pattern) {
    if (mark == '#') {
      int number = 0;
      const auto read = std::from_chars(at, end, number);
      if (read.ec != std::errc() || number < 0 || *at == '-') return std::nullopt;
      at = read.ptr;
      numbers.push_back(number);
    } else if (at == end || *at++ != mark) {
      return std::nullopt;
    }
  }
  return at == end ? std::optional(numbers) : std::nullopt;
}

void add_indirect_options(CLI::App& parser, RenderCall& call) {
  using raytrace::Indirect;
  add_choice<Indirect, Indirect>(
      parser, "--indirect", call.indirect,
      {{"radiosity", Indirect::Radiosity},
       {"distributed", Indirect::Distributed},
       {"none", Indirect::None},
       {"paths", Indirect::Paths}},
      "radiosity (default), distributed (many lights, no interreflection), none, paths (slow "
      "reference)");
  add_whole_number(parser, "--distributed-lights", call.distributed_lights, 1, 1U << 20U,
                   "Lights of --indirect distributed (default 64)");
  parser
      .add_option("--distributed-over", call.distributed_over,
                  "Spread the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
}

}  // namespace

void add_window_options(CLI::App& parser, RenderCall& call) {
  parser
      .add_option_function<std::string>(
          "--crop",
          [&call](const std::string& text) {
            const auto n = numbers_like("#,#,#x#", text);
            if (!n || (*n)[2] < 1 || (*n)[3] < 1) {
              throw CLI::ValidationError(
                  "--crop", "\"" + text +
                                "\" is not X,Y,COLUMNSxROWS in whole pixels from the top left "
                                "corner, such as 100,40,64x64");
            }
            call.crop = raytrace::Window{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
          },
          "Only this part of the picture, as it is in the whole one")
      ->type_name("X,Y,CxR");
  const auto pixel_option = [&](const std::string& name, bool probe, const char* help) {
    return parser
        .add_option_function<std::string>(
            name,
            [&call, name, probe](const std::string& text) {
              const auto n = numbers_like("#,#", text);
              if (!n) {
                throw CLI::ValidationError(
                    name, "\"" + text +
                              "\" is not X,Y in whole pixels from the top left corner, such as "
                              "100,40");
              }
              call.crop = raytrace::Window{(*n)[0], (*n)[1], 1, 1};
              call.only_pixel = true;
              call.probe = probe;
              call.per_light = call.per_light || probe;
            },
            help)
        ->type_name("X,Y")
        ->excludes("--crop");
  };
  pixel_option("--only-pixel", false, "Replays one pixel and prints all of it; -o is not needed");
  pixel_option("--probe", true,
               "Draws one pixel alone and names where its light comes from, by source and by last "
               "bounce; -o is not needed")
      ->excludes("--only-pixel");
  parser
      .add_flag("--no-error", call.no_error,
                "State no error: as many samples as the settings say, each one for the picture")
      ->excludes("--error");
  add_time_limit(parser, call.time_limit_s,
                 "The best picture in that time, or no longer than that for --error; the bytes "
                 "then differ between runs");
}

std::vector<const scenes::Camera*> wanted_cameras(const std::vector<std::string>& texts,
                                                  const scenes::Scene& scene) {
  std::vector<const scenes::Camera*> cameras;
  const auto is_name = [&scene](const std::string& text) {
    return std::any_of(scene.cameras.begin(), scene.cameras.end(),
                       [&text](const scenes::Camera& camera) { return camera.name == text; });
  };
  for (const std::string& text : texts) {
    if (text == "all" && !is_name(text)) {
      for (const scenes::Camera& camera : scene.cameras) cameras.push_back(&camera);
      continue;
    }
    for (const std::string& name :
         is_name(text) ? std::vector<std::string>{text} : split_at_commas(text)) {
      cameras.push_back(&choose_camera(scene, name));
    }
  }
  if (cameras.empty()) cameras.push_back(&choose_camera(scene, ""));
  return cameras;
}

void add_picture_options(CLI::App& parser, RenderCall& call) {
  parser
      .add_option("--camera", call.cameras,
                  "Cameras of the scene (render: its first unless said): A or A,B or all; with "
                  "several, files are called FILE-A, FILE-B")
      ->type_name("NAME");
  add_size_option(parser, call.size);
  add_indirect_options(parser, call);
  parser
      .add_option_function<std::string>(
          "--aov", [&call](const std::string& text) { call.aovs = split_at_commas(text); },
          fmt::format("Further layers, of {}", fmt::join(raytrace::aov_names(), ", ")))
      ->type_name("LIST");
  parser.add_flag("--all-effects", call.all_effects,
                  "Also those that cannot matter (plan says which they are)");
  parser.add_flag("--per-light", call.per_light,
                  "One layer per light group: light_<group>.R, .G, .B");
}

void check_aovs(const RenderCall& call) {
  for (const std::string& name : call.aovs) {
    const std::vector<std::string>& known = raytrace::aov_names();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw base::Error(base::Blame::Input, "--aov", "there is no layer \"" + name + "\"",
                      fmt::format("the layers are {}", fmt::join(known, ", ")));
  }
}

std::vector<scenes::Culling> decide_effects(LoadedScene& loaded, const RenderCall& call,
                                            const scenes::Asked& asked) {
  loaded.effects = scenes::find_effects(loaded.scene, loaded.groups, asked);
  const bool reference = call.indirect == raytrace::Indirect::Paths;
  if (call.all_effects || reference || !call.solution.empty()) return {};
  return scenes::cull_effects(
      loaded.scene, asked, loaded.scene.quality.error.value_or(scenes::default_error),
      radiosity::hidden_lights(loaded.scene, asked.cameras), loaded.groups, loaded.effects);
}

scenes::Asked asked_of(const RenderCall& call, std::vector<const scenes::Camera*> cameras) {
  scenes::Asked asked;
  asked.cameras = std::move(cameras);
  if (call.indirect == raytrace::Indirect::Paths) asked.paths = scenes::LightPaths::Traced;
  if (call.indirect == raytrace::Indirect::None) asked.paths = scenes::LightPaths::Straight;
  if (call.indirect == raytrace::Indirect::Distributed) {
    asked.paths = scenes::LightPaths::Distributed;
  }
  asked.earth_on_area = !call.distributed_over.empty();
  asked.per_light = call.per_light;
  asked.layers = call.aovs;
  return asked;
}

}  // namespace earthshine::app
