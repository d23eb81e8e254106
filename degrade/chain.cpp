// SPDX-License-Identifier: Apache-2.0
#include "degrade/chain.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/tone.h"

namespace earthshine::degrade {
namespace {

// The channels that the chain works on, checked; negative light counts as none.
Frame take_in(const base::Image& radiance, bool colour) {
  Frame frame;
  Picture& picture = frame.picture;
  picture.columns = radiance.width;
  picture.rows = radiance.height;
  const bool has_rgb = radiance.find("R") != nullptr && radiance.find("G") != nullptr &&
                       radiance.find("B") != nullptr;
  if (colour && has_rgb) {
    for (const char* name : {"R", "G", "B"}) picture.planes.push_back(radiance.find(name)->values);
  } else {
    picture.planes.assign(colour ? 3 : 1, base::luminance_of(radiance));
  }
  for (Plane& plane : picture.planes) {
    for (std::size_t i = 0; i < plane.size(); ++i) {
      if (!std::isfinite(plane[i])) {
        const std::size_t width = static_cast<std::size_t>(radiance.width);
        throw base::Error(base::Blame::Input, "picture",
                          "pixel (" + std::to_string(i % width) + ", " + std::to_string(i / width) +
                              ") is not a finite number",
                          "radiance must be finite", "Render it again or repair the picture");
      }
      if (plane[i] < 0.0F) {
        ++frame.report.negative_pixels;
        plane[i] = 0.0F;
      }
    }
  }
  return frame;
}

void check_names(const std::vector<std::string>& off) {
  std::vector<std::string_view> names;
  for (const Stage& stage : stages()) names.push_back(stage.name);
  for (const std::string& name : off) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string nearest = base::nearest_word(name, names);
    throw base::Error(base::Blame::Input, "stage \"" + name + "\"", "is not in the chain",
                      nearest.empty() ? "" : "the nearest name is \"" + nearest + "\"",
                      "earthshine degrade --list shows the stages");
  }
}

bool is_off(const Stage& stage, const Options& options) {
  return std::find(options.off.begin(), options.off.end(), stage.name) != options.off.end();
}

std::vector<std::uint8_t> screen_bytes(const Picture& viewed, double white) {
  std::vector<std::uint8_t> bytes(viewed.pixel_count() * viewed.planes.size());
  for_each_run(viewed, [&](std::size_t plane, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      bytes[i * viewed.planes.size() + plane] =
          base::srgb_byte(static_cast<double>(viewed.planes[plane][i]) / white);
    }
  });
  return bytes;
}

}  // namespace

std::vector<StagePlan> plan(const CctvCamera& camera, const Monitor& monitor,
                            const Options& options) {
  check_names(options.off);
  const Setup setup{camera, monitor, options};
  std::vector<StagePlan> rows;
  for (const Stage& stage : stages()) {
    rows.push_back({&stage, !is_off(stage, options) && stage.runs(setup, nullptr)});
  }
  return rows;
}

Result degrade(const base::Image& radiance, const CctvCamera& camera, const Monitor& monitor,
               const Options& options) {
  check_names(options.off);
  if (radiance.width < 1 || radiance.height < 1) {
    throw base::Error(base::Blame::Input, "picture", "has no pixels");
  }
  const Setup setup{camera, monitor, options};
  Frame frame = take_in(radiance, camera.colour);
  frame.report.noise = noise_law(camera);
  // What stands if the stages that decide it are off.
  frame.report.sensor = {radiance.width, radiance.height};
  frame.report.exposure.f_number = camera.f_number;

  Result result;
  double white = 1.0;
  for (const Stage& stage : stages()) {
    if (stage.part == Part::Monitor && result.signal.channels.empty()) {
      result.signal = to_image(frame.picture);
    }
    if (is_off(stage, options) || !stage.runs(setup, &frame.report)) continue;
    frame = stage.apply(std::move(frame), setup);
    frame.report.stages.emplace_back(stage.name);
    if (stage.name == "screen") white = monitor.white_luminance;
    if (stage.name == "room-light") white += room_luminance(monitor);
  }
  result.columns = frame.picture.columns;
  result.rows = frame.picture.rows;
  result.channels = static_cast<int>(frame.picture.planes.size());
  result.pixels = screen_bytes(frame.picture, white);
  result.viewed = to_image(frame.picture);
  result.report = std::move(frame.report);
  return result;
}

}  // namespace earthshine::degrade
