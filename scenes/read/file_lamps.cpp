// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/file_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/text/table_reader.h"

namespace earthshine::scenes {
namespace {

// Room for " (2)" and the object's name in front.
constexpr std::size_t longest_own_name = 90;

bool belongs(const Mesh& mesh, std::uint32_t part_set, std::uint32_t part) {
  const auto& set = mesh.part_sets[part_set];
  return part == no_index || std::find(set.begin(), set.end(), part) != set.end();
}

template <class Named>
std::string new_name(const std::vector<Named>& known, const std::string& object,
                     const std::string& own, std::string_view otherwise) {
  const std::string first =
      fmt::format("{}.{}", object.substr(0, longest_own_name),
                  own.empty() ? otherwise : std::string_view(own).substr(0, longest_own_name));
  std::string name = first;
  for (int k = 2; std::any_of(known.begin(), known.end(),
                              [&](const Named& other) { return other.name == name; });
       ++k) {
    name = fmt::format("{} ({})", first, k);
  }
  return name;
}

Vec3 placed(const Placement& placement, const Vec3& point, const base::Location& where) {
  const Vec3 result = placement.apply(point);
  for (int c = 0; c < 3; ++c) {
    if (std::abs(result[c]) <= largest_length) continue;
    throw base::Error(
        base::Blame::Input, where,
        fmt::format("a lamp or camera of the file at ({}, {}, {}) m", result.x, result.y, result.z),
        fmt::format("coordinates are at most {} m", largest_length));
  }
  return result;
}

Vec3 direction(const Placement& placement, const Vec3& along) {
  return glm::normalize(placement.rotation * (placement.scale * along));
}

}  // namespace

void add_file_lamps(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                    const Placement& placement, const base::Location& where) {
  for (const MeshLamp& of_file : mesh.lamps) {
    if (!belongs(mesh, of_file.part_set, part)) continue;
    Lamp lamp = of_file.lamp;
    lamp.name = lamp.group = new_name(scene.lamps, object, lamp.name, "lamp");
    lamp.position = placed(placement, lamp.position, where);
    lamp.axis = direction(placement, lamp.axis);
    scene.lamps.push_back(std::move(lamp));
  }
}

void add_file_cameras(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                      const Placement& placement, const base::Location& where) {
  for (const MeshCamera& of_file : mesh.cameras) {
    if (!belongs(mesh, of_file.part_set, part)) continue;
    Camera camera = of_file.camera;
    const Vec3 along = direction(placement, camera.look_at - camera.position);
    camera.name = new_name(scene.cameras, object, camera.name, "camera");
    camera.position = placed(placement, camera.position, where);
    camera.look_at = camera.position + placement.unit_m * along;
    camera.up = direction(placement, camera.up);
    camera.where = where;
    scene.cameras.push_back(std::move(camera));
  }
}

}  // namespace earthshine::scenes
