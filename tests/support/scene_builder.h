// SPDX-License-Identifier: Apache-2.0
// Scenes built in memory, so that a test of a law shows all of its input.
#pragma once

#include <array>
#include <string>

#include "radiosity/solution.h"
#include "scenes/effects/world.h"
#include "scenes/scene.h"

namespace earthshine::tests {

inline scenes::Material grey(double diffuse, double emit = 0.0) {
  scenes::Material material;
  material.name = "grey";
  material.light_group = "panels";
  material.diffuse = Rgb(diffuse);
  material.emit = Rgb(emit);
  return material;
}

class SceneBuilder {
 public:
  scenes::Scene scene;

  std::uint32_t material(const scenes::Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
  }

  // A parallelogram as a separate object; the front is where its corners run counter-clockwise.
  void quad(std::uint32_t material, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto object = static_cast<std::uint32_t>(scene.objects.size());
    scenes::Object record;
    record.name = "quad-" + std::to_string(object);
    record.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    record.triangle_count = 2;
    scene.objects.push_back(record);
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), {a, b, c, d});
    scene.triangles.push_back({{v, v + 1, v + 2}, object, material, object});
    scene.triangles.push_back({{v, v + 2, v + 3}, object, material, object});
  }

  // Square of side `size` at height `height`, centred on the axis, front up or down.
  void plate(std::uint32_t material, double size, double height, bool up) {
    const double h = size / 2;
    if (up) {
      quad(material, {-h, -h, height}, {h, -h, height}, {h, h, height}, {-h, h, height});
    } else {
      quad(material, {-h, -h, height}, {-h, h, height}, {h, h, height}, {h, -h, height});
    }
  }

  // The box [0,1]^3 seen from inside; materials of x = 0, x = 1, y = 0, y = 1, z = 0, z = 1.
  void room(const std::array<std::uint32_t, 6>& m) {
    quad(m[0], {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
    quad(m[1], {1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0});
    quad(m[2], {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    quad(m[3], {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1});
    quad(m[4], {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    quad(m[5], {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1});
  }
};

// Input of every stage besides the scene.
struct Prepared {
  const scenes::Scene& scene;
  scenes::LightGroups groups;
  scenes::Effects effects;
  scenes::RayQuery query;

  explicit Prepared(const scenes::Scene& s)
      : scene(s),
        groups(scenes::find_light_groups(s)),
        effects(scenes::find_effects(s, groups)),
        query(s) {}

  operator scenes::World() const { return {scene, groups, effects, query}; }

  [[nodiscard]] radiosity::Solution solve(const radiosity::SolveOptions& options) const {
    return radiosity::solve(*this, options);
  }
};

}  // namespace earthshine::tests
