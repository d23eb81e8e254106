// SPDX-License-Identifier: Apache-2.0
#include "raytrace/layers.h"

#include <algorithm>
#include <limits>

#include "raytrace/shading.h"

namespace earthshine::raytrace {
namespace {

struct AovChannels {
  const char* aov;
  std::vector<const char*> channels;
};
const std::vector<AovChannels>& aov_table() {
  static const std::vector<AovChannels> table = {
      {"albedo", {"albedo.R", "albedo.G", "albedo.B"}},
      {"normal", {"N.X", "N.Y", "N.Z"}},
      {"position", {"P.X", "P.Y", "P.Z"}},
      {"depth", {"Z"}},
      {"range", {"range"}},
      {"object", {"object"}},
      {"material", {"material"}},
      {"direct", {"direct.R", "direct.G", "direct.B"}},
      {"indirect", {"indirect.R", "indirect.G", "indirect.B"}},
      {"specular", {"specular.R", "specular.G", "specular.B"}},
      {"variance", {"variance"}}};
  return table;
}

const AovChannels& find_aov(const std::string& aov) {
  const auto row = std::find_if(aov_table().begin(), aov_table().end(),
                                [&](const AovChannels& entry) { return aov == entry.aov; });
  if (row != aov_table().end()) return *row;
  std::string allowed = "allowed:";
  for (const AovChannels& entry : aov_table()) allowed += std::string(" ") + entry.aov;
  const std::string nearest = base::nearest_word(aov, aov_names());
  throw base::Error(base::Blame::Input, "--aov", "unknown layer \"" + aov + "\"", allowed,
                    nearest.empty() ? "" : "Did you mean \"" + nearest + "\"?");
}

// In the order of Part.
constexpr std::array<const char*, part_count> part_names = {"direct", "indirect", "specular"};

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
    for (const char* channel : row.channels) image.add(channel);
    const auto part = std::find(part_names.begin(), part_names.end(), aov);
    if (part != part_names.end()) {
      layout.parts[static_cast<std::size_t>(part - part_names.begin())] = first;
    } else if (aov == "variance") {
      layout.variance = first;
    } else {
      for (std::size_t k = 0; k < row.channels.size(); ++k) {
        layout.unfiltered.push_back({row.channels[k], first + k});
      }
    }
  }
  return layout;
}

float unfiltered_value(const scenes::Scene& scene, const CameraModel& camera, const Ray& ray,
                       const scenes::Hit& hit, const std::string& channel) {
  const auto axis = [&](const Vec3& v) {
    const char last = channel.back();
    return static_cast<float>(last == 'X' || last == 'R'   ? v.x
                              : last == 'Y' || last == 'G' ? v.y
                                                           : v.z);
  };
  const float nothing = std::numeric_limits<float>::infinity();
  if (channel == "Z") {
    return hit.missed() ? nothing
                        : static_cast<float>(hit.t * glm::dot(ray.direction, camera.forward));
  }
  if (channel == "range") return hit.missed() ? nothing : static_cast<float>(hit.t);
  if (hit.missed()) return channel == "object" || channel == "material" ? -1.0F : 0.0F;
  const scenes::Triangle& triangle = scene.triangles[hit.triangle];
  if (channel == "object") return static_cast<float>(triangle.object);
  if (channel == "material") return static_cast<float>(triangle.material);
  if (channel.front() == 'a') return axis(scene.materials[triangle.material].diffuse);
  if (channel.front() == 'P') return axis(scenes::hit_position(scene, hit));
  const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
  return axis(hit.front ? normal : -normal);
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
