// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/layers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "raytrace/frame/cryptomatte.h"
#include "raytrace/frame/first_hit.h"

namespace earthshine::raytrace {
namespace {

// In the order of Part.
constexpr std::array<const char*, part_count> part_names = {"direct", "indirect", "specular"};

struct AovChannels {
  std::string aov;
  std::vector<std::string> channels;
};
const std::vector<AovChannels>& aov_table() {
  static const std::vector<AovChannels> table = [] {
    std::vector<AovChannels> all;
    for (const FirstHitLayer& layer : first_hit_layers()) {
      all.push_back({layer.aov, layer.channels});
    }
    for (const char* part : part_names) {
      const std::string name = part;
      all.push_back({name, {name + ".R", name + ".G", name + ".B"}});
    }
    all.push_back({"variance", {"variance"}});
    for (const CryptomatteType& type : cryptomatte_types) {
      all.push_back({type.aov, cryptomatte_channels(type.name)});
    }
    return all;
  }();
  return table;
}

const AovChannels& find_aov(const std::string& aov) {
  const auto row = std::find_if(aov_table().begin(), aov_table().end(),
                                [&](const AovChannels& entry) { return aov == entry.aov; });
  if (row != aov_table().end()) return *row;
  std::string allowed = "allowed:";
  for (const AovChannels& entry : aov_table()) allowed += " " + entry.aov;
  const std::string nearest = base::nearest_word(aov, aov_names());
  throw base::Error(base::Blame::Input, "--aov", "unknown layer \"" + aov + "\"", allowed,
                    nearest.empty() ? "" : "Did you mean \"" + nearest + "\"?");
}

bool lies_in(const Window& part, const Window& whole) {
  return part.x >= whole.x && part.y >= whole.y &&
         part.x + part.columns <= whole.x + whole.columns &&
         part.y + part.rows <= whole.y + whole.rows;
}

// values: those of a part, row by row.
template <class Value>
void place(const std::vector<Value>& values, const Window& part, const Window& whole,
           std::vector<Value>& all) {
  for (int row = 0; row < part.rows; ++row) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(row) * part.columns;
    std::copy(from, from + part.columns,
              all.begin() + static_cast<std::ptrdiff_t>(whole.index(part.x, part.y + row)));
  }
}

}  // namespace

bool Layout::splits_parts() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](std::size_t channel) { return channel != none_wanted; });
}

Layout add_layers(base::Image& image, const std::vector<std::string>& light_groups,
                  const std::vector<std::string>& aovs) {
  Layout layout;
  for (const std::string& name : light_groups) {
    layout.radiance.push_back(image.channels.size());
    for (const char* channel : {".R", ".G", ".B"}) image.add("light_" + name + channel);
  }
  layout.parts.assign(part_count, Layout::none_wanted);
  for (const std::string& aov : aovs) {
    const AovChannels& row = find_aov(aov);
    const std::size_t first = image.channels.size();
    if (image.find(row.channels.front()) != nullptr) continue;  // asked for twice
    for (const std::string& channel : row.channels) image.add(channel);
    const auto part = std::find(part_names.begin(), part_names.end(), aov);
    if (part != part_names.end()) {
      layout.parts[static_cast<std::size_t>(part - part_names.begin())] = first;
    } else if (aov == "variance") {
      layout.variance = first;
    }
  }
  return layout;
}

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const AovChannels& row : aov_table()) list.emplace_back(row.aov);
    return list;
  }();
  return names;
}

Frame join(const std::vector<Frame>& parts, const Window& window) {
  std::size_t pixels = 0;
  for (const Frame& part : parts) {
    pixels += part.window.pixel_count();
    if (!lies_in(part.window, window)) throw std::invalid_argument("a part leaves the picture");
  }
  if (pixels != window.pixel_count()) throw std::invalid_argument("the parts do not fill it");
  Frame whole;
  whole.window = window;
  whole.report = parts.front().report;
  whole.report.rays = {};
  whole.report.seconds = whole.report.gather_seconds = 0.0;
  whole.image = {window.columns, window.rows, {}};
  for (const base::Channel& channel : parts.front().image.channels) whole.image.add(channel.name);
  whole.error = StatedError(pixels);
  // Sums of whole numbers, which means of the parts give back exactly.
  double samples = 0.0, finished = 0.0;
  for (const Frame& part : parts) {
    const auto count = static_cast<double>(part.window.pixel_count());
    samples += std::round(part.report.camera_samples * count);
    finished += std::round(part.report.finished_share * count);
    whole.report.most_camera_samples =
        std::max(whole.report.most_camera_samples, part.report.most_camera_samples);
    whole.report.rays += part.report.rays;
    whole.report.seconds += part.report.seconds;
    whole.report.gather_seconds += part.report.gather_seconds;
    for (base::Channel& channel : whole.image.channels) {
      const base::Channel* const own = part.image.find(channel.name);
      if (own == nullptr) throw std::invalid_argument("a part lacks a layer");
      place(own->values, part.window, window, channel.values);
    }
    place(part.error.luminance, part.window, window, whole.error.luminance);
    place(part.error.squared, part.window, window, whole.error.squared);
    place(part.error.counts, part.window, window, whole.error.counts);
  }
  whole.report.camera_samples = samples / static_cast<double>(pixels);
  whole.report.finished_share = finished / static_cast<double>(pixels);
  whole.report.relative_noise = std::sqrt(add_up(whole.error).squared_error());
  return whole;
}

}  // namespace earthshine::raytrace
