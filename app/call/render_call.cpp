// SPDX-License-Identifier: Apache-2.0
// Options of render: partial pictures (a window, a time limit), and indirect light.
#include "app/call/render_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "app/console.h"
#include "app/options.h"
#include "app/provenance.h"
#include "base/error.h"
#include "base/files/overlay.h"
#include "raytrace/camera/camera.h"
#include "raytrace/camera/wire.h"
#include "scenes/effects/quality.h"

namespace earthshine::app {

using base::Blame;
using base::Error;

namespace {

// Integers in a text of the form `pattern`: "," and "x" are literal, each # is an integer.
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
  parser
      .add_option_function<std::string>(
          "--distributed-lights",
          [&call](const std::string& text) {
            call.distributed_lights = read_whole_number("--distributed-lights", text, 1, 1U << 20U);
          },
          "Lights of --indirect distributed (default 64)")
      ->type_name("N");
  parser
      .add_option("--distributed-over", call.distributed_over,
                  "Spread the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
}

constexpr double crease_deg = 35.0;  // rounds cylinders of 12 sides or more
constexpr double aspect_tolerance = 0.01;
constexpr double rim_px = 2.0;  // dark, on both sides of a line: makes it visible on bright ground
constexpr base::Colour8 line_colour = {0, 255, 140};
constexpr base::Colour8 rim_colour = {0, 0, 0};
constexpr double rim_alpha = 0.5;  // relative to the line's

// Lines keep their visual weight on photographs of any size.
double line_width_px(const base::Picture8& photo) { return std::max(1.0, photo.height / 600.0); }

void draw_wire(base::Picture8& photo, const scenes::Scene& scene, const scenes::RayQuery& query,
               const scenes::Camera& camera, double alpha) {
  const auto segments =
      raytrace::visible_wire(raytrace::feature_edges(scene, crease_deg), query,
                             raytrace::make_camera_model(camera, photo.width, photo.height));
  std::vector<base::Line> lines;
  lines.reserve(segments.size());
  for (const raytrace::WireSegment& s : segments) lines.push_back({s.x0, s.y0, s.x1, s.y1});
  const double width = line_width_px(photo);
  const auto cover = [&](double px) {
    return base::line_coverage(photo.width, photo.height, lines, px);
  };
  base::paint(photo, cover(width + rim_px), rim_colour, rim_alpha * alpha);
  base::paint(photo, cover(width), line_colour, alpha);
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
          "Only this part of the picture; with --no-error as it is in the whole one")
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
      cameras.push_back(&choose_camera(scene, name, {"--camera"}));
    }
  }
  if (cameras.empty()) cameras.push_back(&first_camera(scene));
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
  parser.add_flag("--no-caustics", call.no_caustics,
                  "With --indirect paths: without what pictures on a solution leave out");
  parser.add_flag("--per-light", call.per_light,
                  "One layer per light group: light_<group>.R, .G, .B");
}

void check_picture_options(const RenderCall& call, bool quiet) {
  for (const std::string& name : call.aovs) {
    const std::vector<std::string>& known = raytrace::aov_names();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw base::Error(base::Blame::Input, "--aov", "there is no layer \"" + name + "\"",
                      fmt::format("the layers are {}", fmt::join(known, ", ")));
  }
  if (call.indirect == raytrace::Indirect::Paths && !call.aovs.empty()) {
    throw Error(Blame::Input, "--aov", "--indirect paths has no further layers", {},
                "Take them from a render without it");
  }
  if (call.no_caustics && call.indirect != raytrace::Indirect::Paths) {
    throw Error(Blame::Input, "--no-caustics",
                fmt::format("belongs to --indirect paths, not {}", indirect_name(call.indirect)),
                {}, "Leave it out, or write --indirect paths");
  }
  if (call.indirect == raytrace::Indirect::Distributed) return;
  if (!call.distributed_over.empty()) {
    throw Error(Blame::Input, "--distributed-over",
                fmt::format("--indirect {} spreads no lights", indirect_name(call.indirect)), {},
                "Write --indirect distributed");
  }
  if (call.distributed_lights && !quiet) {
    note(fmt::format("note: --distributed-lights has no effect: --indirect {} spreads none",
                     indirect_name(call.indirect)));
  }
}

WantedEffects wanted_effects(const RenderCall& call, std::vector<const scenes::Camera*> cameras) {
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
  const bool reference = call.indirect == raytrace::Indirect::Paths;
  return {asked, !call.all_effects && !reference && call.solution.empty()};
}

void add_over_options(CLI::App& command, OverCall& call) {
  command
      .add_option("--over", call.photo,
                  "Lay the scene over this photograph (PNG), into the file of --png")
      ->type_name("PHOTO.png");
  add_choice<std::optional<OverStyle>, OverStyle>(
      command, "--over-style", call.style,
      {{"wire", OverStyle::Wire}, {"blend", OverStyle::Blend}, {"both", OverStyle::Both}},
      "wire (default): visible edges; blend: the tone-mapped picture; both");
  add_number(command, "--over-alpha", call.alpha, 0.0, 1.0,
             "Opacity of what is laid over (default: lines 1, picture 0.5)");
}

void check_over(const RenderCall& call) {
  const OverCall& over = call.over;
  const auto fail = [](const char* option, const char* found, const char* allowed,
                       const char* remedy) {
    throw Error(Blame::Input, option, found, allowed, remedy);
  };
  if (!over.asked()) {
    if (!over.style && !over.alpha) return;
    fail(over.style ? "--over-style" : "--over-alpha", "is given without a photograph", "",
         "Add --over PHOTO.png");
  }
  if (call.png.empty()) fail("--over", "has no file for its picture", "", "Add --png FILE.png");
  if (call.size || call.crop) {
    fail(call.size ? "--size" : call.crop_option(), "disagrees with --over",
         "the picture has the photograph's size", "Leave one of the two out");
  }
}

base::Picture8 read_photo(const OverCall& call, const scenes::Camera& camera, bool quiet) {
  base::Picture8 photo = base::read_png(call.photo);
  const double own = static_cast<double>(camera.columns) / camera.rows;
  const double found = static_cast<double>(photo.width) / photo.height;
  if (!quiet && std::fabs(found / own - 1.0) > aspect_tolerance) {
    note(fmt::format(
        "note: {} is {} x {}, camera \"{}\" makes {} x {}: fov_deg = {:g} is taken as the "
        "photograph's height; if it was cropped, change camera.{}.fov_deg to what is left",
        call.photo, photo.width, photo.height, camera.name, camera.columns, camera.rows,
        camera.fov_deg, camera.name));
  }
  return photo;
}

base::Picture8 lay_over(const OverCall& call, base::Picture8 photo, const scenes::Scene& scene,
                        const scenes::RayQuery& query, const scenes::Camera& camera,
                        std::span<const std::uint8_t> rendered_rgb) {
  const OverStyle style = call.style.value_or(OverStyle::Wire);
  if (call.needs_picture()) base::blend(photo, rendered_rgb, call.alpha.value_or(0.5));
  if (style == OverStyle::Wire) draw_wire(photo, scene, query, camera, call.alpha.value_or(1.0));
  if (style == OverStyle::Both) draw_wire(photo, scene, query, camera, 1.0);
  return photo;
}

}  // namespace earthshine::app
