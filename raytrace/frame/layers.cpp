// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/layers.h"

#include <algorithm>

#include "base/suggest.h"
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
    if (image.find(row.channels.front()) != nullptr) continue;  // requested twice
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

}  // namespace earthshine::raytrace
