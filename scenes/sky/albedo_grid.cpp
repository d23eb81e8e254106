// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/albedo_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files/exr_file.h"
#include "base/input/input_file.h"
#include "base/pixels/pixels.h"
#include "scenes/text/csv_lines.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t max_grid_bytes = std::size_t{16} << 20, max_map_bytes = std::size_t{1} << 28;

double number(const CsvField& field, double low, double high) {
  const auto found = number_in(field.text);
  if (found && *found >= low && *found <= high) return *found;
  throw Error(Blame::Input, field.where, fmt::format("{} stands there", in_quotes(field.text)),
              fmt::format("allowed are numbers from {:g} to {:g}", low, high));
}

void check_rise(const std::vector<double>& list, double next, const base::Location& where) {
  if (list.empty() || next > list.back()) return;
  throw Error(Blame::Input, where, fmt::format("{:g} after {:g}", next, list.back()),
              "latitudes and longitudes rise");
}

// The node at or below x and the share of the way to the next one.
struct Between {
  std::size_t low, high;
  double share;
};

Between between(const std::vector<double>& nodes, double x) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), x);
  if (after == nodes.begin()) return {0, 0, 0.0};
  const auto low = static_cast<std::size_t>(after - nodes.begin()) - 1;
  if (after == nodes.end()) return {low, low, 0.0};
  return {low, low + 1, (x - nodes[low]) / (nodes[low + 1] - nodes[low])};
}

Between around(const std::vector<double>& longitudes, double x) {
  if (longitudes.size() == 1) return {0, 0, 0.0};
  x = longitudes.front() + std::fmod(std::fmod(x - longitudes.front(), 360.0) + 360.0, 360.0);
  if (x < longitudes.back()) return between(longitudes, x);
  const double gap = 360.0 - (longitudes.back() - longitudes.front());
  const double share = gap > 0.0 ? (x - longitudes.back()) / gap : 0.0;
  return {longitudes.size() - 1, 0, share};
}

}  // namespace

AlbedoGrid::AlbedoGrid(std::vector<double> latitudes, std::vector<double> longitudes,
                       std::vector<double> values)
    : latitudes_(std::move(latitudes)),
      longitudes_(std::move(longitudes)),
      values_(std::move(values)),
      largest_(*std::max_element(values_.begin(), values_.end())) {}

double AlbedoGrid::at(const Vec3& up) const {
  const Between lat = between(latitudes_, base::degrees(std::asin(std::clamp(up.z, -1.0, 1.0))));
  const Between lon = around(longitudes_, base::degrees(std::atan2(up.y, up.x)));
  const auto row = [&](std::size_t r) {
    const double* const first = values_.data() + r * longitudes_.size();
    return first[lon.low] + lon.share * (first[lon.high] - first[lon.low]);
  };
  const double low = row(lat.low);
  return low + lat.share * (row(lat.high) - low);
}

namespace {

// rows: from the north pole, columns eastward from -180 deg.
AlbedoGrid grid_of_map(const std::filesystem::path& path, int columns, int rows,
                       const std::vector<double>& values) {
  std::vector<double> latitudes, longitudes, upward;
  for (int x = 0; x < columns; ++x) longitudes.push_back(-180.0 + (x + 0.5) * 360.0 / columns);
  for (int y = rows; y-- > 0;) {
    latitudes.push_back(90.0 - (y + 0.5) * 180.0 / rows);
    for (int x = 0; x < columns; ++x) {
      const double value = values[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                  static_cast<std::size_t>(x)];
      if (!(value >= 0.0 && value <= 1.0)) {
        throw Error(Blame::Input, path.string(),
                    fmt::format("the albedo {:g} at column {}, row {}", value, x, y),
                    "allowed are numbers from 0 to 1");
      }
      upward.push_back(value);
    }
  }
  return {std::move(latitudes), std::move(longitudes), std::move(upward)};
}

AlbedoGrid read_exr_map(const std::filesystem::path& path, const base::Location& asked_at) {
  base::check_input_file(path, asked_at);
  const base::ExrFile file = base::read_exr(path);
  const base::Image& image = file.image;
  if (const auto& whole = file.header.whole; whole.columns > 0) {
    throw Error(Blame::Input, path.string(),
                fmt::format("stores {} x {} of its {} x {} pixels", image.width, image.height,
                            whole.columns, whole.rows),
                "a map of the albedo covers the whole Earth",
                "Write it with its whole data window");
  }
  const base::Channel* grey = image.channels.size() == 1 ? &image.channels[0] : image.find("Y");
  if (const base::Channel* red = image.find("R"); grey == nullptr && red != nullptr) {
    const base::Channel *green = image.find("G"), *blue = image.find("B");
    const bool same = green != nullptr && blue != nullptr && green->values == red->values &&
                      blue->values == red->values;
    if (same) grey = red;
  }
  if (grey == nullptr) {
    std::vector<std::string> names;
    for (const base::Channel& channel : image.channels) names.push_back(channel.name);
    throw Error(Blame::Input, path.string(), "has the channels " + listed(names),
                "allowed is one channel, Y, or R, G, B that are equal");
  }
  return grid_of_map(path, image.width, image.height,
                     std::vector<double>(grey->values.begin(), grey->values.end()));
}

}  // namespace

AlbedoGrid read_albedo_grid(const std::filesystem::path& path, const base::Location& asked_at) {
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".exr") return read_exr_map(path, asked_at);
  const std::string text =
      base::read_input_file(path, ending == ".png" ? max_map_bytes : max_grid_bytes, asked_at);
  if (ending == ".png") {
    const base::GreyPixels map = base::read_grey_png(text, path.string());
    return grid_of_map(path, map.width, map.height, map.values);
  }
  CsvLines lines(text, path.string());
  constexpr const char* wanted =
      "a header names latitude_deg and then longitudes, or latitude_deg, albedo";
  if (!lines.next() || lines.fields().front().text != "latitude_deg" || lines.fields().size() < 2) {
    throw Error(Blame::Input, {path.string(), std::max(1, lines.line()), 0},
                "the header is missing", wanted);
  }
  std::vector<double> latitudes, longitudes, values;
  const std::vector<CsvField> header = lines.fields();
  if (header.size() == 2 && header[1].text == "albedo") {
    longitudes = {0.0};
  } else {
    for (std::size_t k = 1; k < header.size(); ++k) {
      const double longitude = number(header[k], -180.0, 360.0);
      check_rise(longitudes, longitude, header[k].where);
      longitudes.push_back(longitude);
      if (longitude - longitudes.front() <= 360.0) continue;
      throw Error(Blame::Input, header[k].where, "longitudes go round more than once", wanted);
    }
  }
  while (lines.next()) {
    const std::vector<CsvField>& fields = lines.fields();
    if (fields.size() != header.size()) {
      throw Error(Blame::Input, {path.string(), lines.line(), 0},
                  fmt::format("a row of {} columns", fields.size()),
                  fmt::format("the header names {}", header.size()));
    }
    const double latitude = number(fields[0], -90.0, 90.0);
    check_rise(latitudes, latitude, fields[0].where);
    latitudes.push_back(latitude);
    for (std::size_t k = 1; k < fields.size(); ++k) values.push_back(number(fields[k], 0.0, 1.0));
  }
  if (latitudes.empty()) {
    throw Error(Blame::Input, {path.string(), lines.line(), 0}, "the table has no rows", wanted);
  }
  return {std::move(latitudes), std::move(longitudes), std::move(values)};
}

}  // namespace earthshine::scenes
