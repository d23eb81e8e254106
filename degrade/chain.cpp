// SPDX-License-Identifier: Apache-2.0
#include "degrade/chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "base/error.h"
#include "base/suggest.h"
#include "base/tone.h"
#include "degrade/stage/axis_map.h"

namespace earthshine::degrade {
namespace {

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

// fields: one picture, or two of a moving scene.
Result run_chain(std::initializer_list<const base::Image*> seen, const Setup& setup,
                 const Memory& before) {
  const CctvCamera& camera = setup.camera;
  const Options& options = setup.options;
  check_names(options.off);
  Result result;
  result.memory = before;
  Report& report = result.report;
  std::vector<Picture> fields;
  for (const base::Image* radiance : seen) {
    if (radiance->width < 1 || radiance->height < 1) {
      throw base::Error(base::Blame::Input, "picture", "has no pixels");
    }
    fields.push_back(sensor_input(*radiance, camera.colour, report.negative_pixels));
  }
  report.noise = noise_law(camera);
  // Defaults for the case that the stages which set them are off.
  report.sensor = {fields.front().columns, fields.front().rows};
  report.exposure.f_number = camera.f_number;

  const std::span<const Stage> table = stages();
  const bool interlaced = has_fields(setup, report);
  bool exposed = false;
  for (const Stage& stage : table) {
    if (stage.part == Part::Sensor && !exposed) {
      if (interlaced && fields.size() == 1) fields.push_back(fields.front());
      exposed = true;
    }
    if (stage.part == Part::Monitor && result.signal.channels.empty()) {
      result.signal = to_image(fields.front());
    }
    if (!runs(stage, setup, &report)) continue;
    if (stage.merge != nullptr) {
      fields = {stage.merge(std::move(fields[0]), fields[1])};
    } else {
      for (std::size_t f = 0; f < fields.size(); ++f) {
        fields[f] =
            stage.law(std::move(fields[f]), {setup, report, result.memory, f, fields.size()});
      }
    }
    report.stages.emplace_back(stage.name);
    if (options.watch) options.watch(stage, fields.front());
  }
  Picture& shown = fields.front();
  result.columns = shown.columns;
  result.rows = shown.rows;
  result.channels = static_cast<int>(shown.planes.size());
  result.pixels = screen_bytes(shown, report.white);
  result.viewed = to_image(std::move(shown));
  return result;
}

}  // namespace

Picture sensor_input(const base::Image& radiance, bool colour, std::size_t& negative_pixels) {
  Picture picture;
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
        ++negative_pixels;
        plane[i] = 0.0F;
      }
    }
  }
  return picture;
}

Picture StageLaw::operator()(Picture&& in, const StageContext& at) const {
  if (picture != nullptr) return picture(std::move(in), at);
  if (filter != nullptr) {
    const PlaneMap map = filter(in, at);
    return apply(in, map.along, map.across);
  }
  PointMap map;
  points(map, at);
  return transform(std::move(in), map);
}

bool runs(const Stage& stage, const Setup& setup, const Report* found) {
  const std::vector<std::string>& off = setup.options.off;
  return std::find(off.begin(), off.end(), stage.name) == off.end() && stage.runs(setup, found);
}

bool has_fields(const Setup& setup, const Report& found) {
  const std::span<const Stage> table = stages();
  return std::any_of(table.begin(), table.end(), [&](const Stage& stage) {
    return stage.merge != nullptr && runs(stage, setup, &found);
  });
}

std::vector<StagePlan> plan(const CctvCamera& camera, const Monitor& monitor,
                            const Options& options) {
  check_names(options.off);
  const Setup setup{camera, monitor, options};
  std::vector<StagePlan> rows;
  for (const Stage& stage : stages()) {
    rows.push_back({&stage, runs(stage, setup, nullptr)});
  }
  return rows;
}

void resize_screen(Result& result, int columns, int rows) {
  const auto channels = static_cast<std::size_t>(result.channels);
  std::array<float, 256> linear{};
  for (std::size_t k = 0; k < linear.size(); ++k) {
    linear[k] = static_cast<float>(base::srgb_linear(static_cast<double>(k) / 255.0));
  }
  Picture screen{result.columns, result.rows, std::vector<Plane>(channels)};
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    screen.planes[i % channels].push_back(linear[result.pixels[i]]);
  }
  screen = apply(screen, area_average(result.columns, columns), area_average(result.rows, rows));
  result.pixels = screen_bytes(screen, 1.0);
  result.columns = columns;
  result.rows = rows;
}

Result degrade(const base::Image& radiance, const CctvCamera& camera, const Monitor& monitor,
               const Options& options, const Memory& before) {
  return run_chain({&radiance}, {camera, monitor, options}, before);
}

Result degrade_fields(const base::Image& first, const base::Image& second, const CctvCamera& camera,
                      const Monitor& monitor, const Options& options, const Memory& before) {
  const auto refuse = [](const char* found, const char* allowed) {
    throw base::Error(base::Blame::Input, "fields", found, allowed);
  };
  if (!camera.interlace) refuse("the camera is not interlaced", "it must have interlace = true");
  if (!has_fields({camera, monitor, options}, {})) {
    refuse("stage \"interlace\" is left out", "two fields need it");
  }
  if (first.width != second.width || first.height != second.height) {
    refuse("the two pictures differ in size", "both fields of a frame have the same size");
  }
  return run_chain({&first, &second}, {camera, monitor, options}, before);
}

}  // namespace earthshine::degrade
