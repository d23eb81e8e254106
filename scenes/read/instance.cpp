// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/free_memory.h"
#include "scenes/ray_query.h"
#include "scenes/read/material_choice.h"
#include "scenes/read/scene_parts.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

constexpr const char* title = "[[object]]";
constexpr std::string_view instance_keys[] = {"name",  "instance_of", "translate", "rotate",
                                              "scale", "material",    "target",    "velocity",
                                              "joint", "spin",        "spin_about"};

// Transform from the original's placement to the instance's.
Instance relation(std::uint32_t object, const Placement& from, const Placement& to) {
  Instance instance;
  instance.object = object;
  glm::dmat3 scale(1.0);
  for (int k = 0; k < 3; ++k) scale[k][k] = to.scale[k] / from.scale[k];
  instance.linear = to.rotation * scale * glm::transpose(from.rotation);
  instance.offset_m = to.unit_m * to.translate - instance.linear * (from.unit_m * from.translate);
  return instance;
}

// Whether it is a rotation with uniform scale.
bool is_uniform(const glm::dmat3& linear, double scale) {
  const glm::dmat3 square = glm::transpose(linear) * linear;
  for (int k = 0; k < 3; ++k) {
    Vec3 off = square[k];
    off[k] -= scale * scale;
    if (glm::length(off) > 1e-12 * scale * scale) return false;
  }
  return true;
}

bool is_same_pose(const Instance& a, const Instance& b) {
  constexpr double rounding = 1e-12;
  for (int k = 0; k < 3; ++k) {
    if (glm::length(a.linear[k] - b.linear[k]) > rounding) return false;
  }
  return glm::length(a.offset_m - b.offset_m) <= rounding * (1.0 + glm::length(a.offset_m));
}

// Duplicate faces are not searched among instances: an instance at its original's place makes them.
void check_alone(const Scene& scene, const TableReader& table, const Instance& instance) {
  const auto refuse = [&table](const std::string& name) {
    table.fail("instance_of", fmt::format("puts it exactly where {} stands", in_quotes(name)),
               "a surface is in the scene once", "Give it a separate pose");
  };
  if (is_same_pose(instance, Instance{})) refuse(scene.objects[instance.object].name);
  for (const Object& other : scene.objects) {
    if (!other.instance || other.instance->object != instance.object) continue;
    if (is_same_pose(instance, *other.instance)) refuse(other.name);
  }
}

void copy_vertices(Scene& scene, const TableReader& table, const VertexRange& of,
                   const Instance& instance) {
  const auto copy = [&](auto& list, const auto& otherwise) {
    if (list.empty()) return;
    list.resize(scene.vertices.size() + of.count, otherwise);
    std::copy_n(list.begin() + of.first, of.count, list.begin() + instance.first_vertex);
  };
  copy(scene.vertex_uv, glm::vec2(0.0F));
  copy(scene.second_uv, glm::vec2(0.0F));
  copy(scene.vertex_colour, glm::vec3(1.0F));
  for (std::uint32_t k = 0; k < of.count; ++k) {
    const Vec3 p = instance.linear * scene.vertices[of.first + k] + instance.offset_m;
    for (int c = 0; c < 3; ++c) {
      if (std::abs(p[c]) <= largest_length) continue;
      table.fail("instance_of", fmt::format("has a vertex at ({}, {}, {}) m", p.x, p.y, p.z),
                 fmt::format("coordinates are finite and at most {} m", largest_length),
                 "Check scale and translate");
    }
    scene.vertices.push_back(p);
  }
}

void add(Scene& scene, const TableReader& table, Instance instance, double unit_m,
         std::size_t own_material_count) {
  check_alone(scene, table, instance);
  const Object& original = scene.objects[instance.object];
  Object object = original;
  object.name = *table.name("name");
  object.source = "instance of " + original.name;
  object.unused.clear();
  object.target = table.flag("target").value_or(false);
  object.joint = table.text("joint").value_or("");
  object.motion = read_motion(table);
  object.spin_about = read_spin_about(table, unit_m);
  ShelvedMesh none;
  MaterialChoice choice(scene, table, none, own_material_count);

  const std::uint32_t count = object.triangle_count, from = object.first_triangle;
  const VertexRange vertices = vertices_of(scene, scene.objects[instance.object]);
  instance.first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
  copy_vertices(scene, table, vertices, instance);

  object.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
  const std::uint32_t polygon = scene.triangles.back().polygon + 1 - scene.triangles[from].polygon;
  const auto number = static_cast<std::uint32_t>(scene.objects.size());
  const double scale = std::cbrt(glm::determinant(instance.linear));
  const bool is_alike = is_uniform(instance.linear, scale);
  object.area_m2 = is_alike ? scale * scale * object.area_m2 : 0.0;
  for (std::uint32_t t = from; t < from + count; ++t) {
    Triangle triangle = scene.triangles[t];
    for (std::uint32_t& v : triangle.vertex) v += instance.first_vertex - vertices.first;
    triangle.object = number;
    triangle.polygon += polygon;
    if (table.has("material")) triangle.material = choice.material_of({});
    scene.triangles.push_back(triangle);
    if (is_alike) continue;
    object.area_m2 += triangle_area(scene, static_cast<std::uint32_t>(scene.triangles.size() - 1));
  }
  object.instance = instance;
  scene.objects.push_back(std::move(object));
}

}  // namespace

std::optional<std::string> InstanceReader::take(const TomlNode& node) {
  const auto* keys = std::get_if<TomlTable>(&node.value);
  if (keys == nullptr || find_entry(*keys, "instance_of") == nullptr) return std::nullopt;
  waiting_.push_back(&node);
  return TableReader(node, title, instance_keys).read_name();
}

void InstanceReader::finish(Scene& scene, double unit_m, const JointPoses& joints,
                            std::size_t own_material_count) const {
  const auto originals = static_cast<std::uint32_t>(scene.objects.size());
  std::vector<Instance> instances;
  std::size_t triangles = scene.triangles.size(), vertices = scene.vertices.size();
  for (const TomlNode* node : waiting_) {
    TableReader table(*node, title, instance_keys);
    (void)table.read_name();
    const std::string named = *table.name("instance_of");
    std::uint32_t object = 0;
    while (object < originals && scene.objects[object].name != named) ++object;
    if (object == originals) {
      std::vector<std::string> names;
      for (const Object& other : scene.objects) names.push_back(other.name);
      table.fail("instance_of", fmt::format("is {}", in_quotes(named)),
                 "it names an [[object]] with a mesh or a shape", did_you_mean(named, names));
    }
    const Placement placement = read_placement(table, unit_m, joints);
    const Placement& original = placed_.at(named);
    if (placement.is_mirrored() != original.is_mirrored()) {
      const auto text = [](const Vec3& s) {
        return fmt::format("[{:g}, {:g}, {:g}]", s.x, s.y, s.z);
      };
      table.fail("scale",
                 fmt::format("{} makes a mirror image of the original, whose scale is {}",
                             text(placement.scale), text(original.scale)),
                 "an instance, whose scale is [1, 1, 1] where none is given, has an even number of "
                 "negative factors if its original has, and an odd number if that has",
                 "Give it the original's scale, or a mesh or shape of its own");
    }
    instances.push_back(relation(object, original, placement));
    triangles += scene.objects[object].triangle_count;
    if (triangles > max_scene_triangles) {
      table.fail("instance_of", "makes the scene too large",
                 fmt::format("it has at most {} triangles", max_scene_triangles));
    }
    const VertexRange of_object = vertices_of(scene, scene.objects[object]);
    vertices += of_object.count;
  }
  if (waiting_.empty()) return;
  base::check_room(triangles * sizeof(Triangle) + vertices * sizeof(Vec3), scene.path.string());
  scene.triangles.reserve(triangles);
  scene.vertices.reserve(vertices);
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    TableReader table(*waiting_[k], title, instance_keys);
    (void)table.read_name();
    add(scene, table, instances[k], unit_m, own_material_count);
  }
}

}  // namespace earthshine::scenes
