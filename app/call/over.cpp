// SPDX-License-Identifier: Apache-2.0
#include "app/call/over.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "app/call/render_call.h"
#include "app/console.h"
#include "app/options.h"
#include "base/error.h"
#include "base/files/overlay.h"
#include "raytrace/camera/camera.h"
#include "raytrace/camera/wire.h"

namespace earthshine::app {

using base::Blame;
using base::Error;

namespace {

constexpr double crease_deg = 35.0;  // a cylinder of 12 sides or more is round
constexpr double aspect_tolerance = 0.01;
constexpr double rim_px = 2.0;  // dark, on both sides of a line: it shows on bright ground too
constexpr base::Colour8 line_colour = {0, 255, 140};
constexpr base::Colour8 rim_colour = {0, 0, 0};
constexpr double rim_alpha = 0.5;  // of the line's

// Lines keep their weight on photographs of any size.
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
    fail(over.style ? "--over-style" : "--over-alpha", "stands without a photograph", "",
         "Add --over PHOTO.png");
  }
  if (call.png.empty()) fail("--over", "has no file for its picture", "", "Add --png FILE.png");
  if (call.size || call.crop) {
    fail(call.size ? "--size" : "--crop", "disagrees with --over",
         "the picture has the photograph's size", "Leave one of the two out");
  }
  if (call.wire_alone() && (call.json || call.timings || call.per_light || !call.aovs.empty())) {
    fail("--over", "draws lines and renders nothing to report",
         "--json, --timings, --per-light and --aov belong to a picture",
         "Add -o FILE.exr, or leave them out");
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
