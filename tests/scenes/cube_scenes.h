// SPDX-License-Identifier: Apache-2.0
// A unit cube as an OBJ file, with deliberate faults.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "tests/scenes/scene_text.h"

namespace earthshine::test {

// The unit cube's corners and its faces, outward.
inline constexpr const char* corners =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
inline constexpr std::array<std::array<int, 4>, 6> cube = {
    {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};

inline std::string face(const std::array<int, 4>& f, bool turned = false, int start = 0) {
  std::string text = "f";
  for (int k = 0; k < 4; ++k) {
    const int at = ((turned ? 3 - k : k) + start) % 4;
    text += fmt::format(" {}", f[static_cast<std::size_t>(at)]);
  }
  return text + "\n";
}

// turned: faces with reversed winding.
inline std::string cube_obj(const std::array<bool, 6>& turned, std::size_t faces = 6) {
  std::string text = corners;
  for (std::size_t k = 0; k < faces; ++k) text += face(cube[k], turned[k]);
  return text;
}
inline constexpr std::array<bool, 6> none{}, all = {true, true, true, true, true, true};

inline std::string scene_of(const std::string& more = "", const std::string& camera = "[5, 5, 5]") {
  return "format = 1\n[[material]]\nname = \"white\"\ndiffuse = 0.5\n[[material]]\nname = \"red\"\n"
         "diffuse = [0.5, 0.1, 0.1]\n[[camera]]\nname = \"A\"\nposition = " +
         camera +
         "\nlook_at = [0.5, 0.5, 0.4]\n[[object]]\nname = \"body\"\nmesh = \"a.obj\"\n"
         "material = \"white\"\n" +
         more;
}

inline scenes::Scene read(const std::string& obj, const std::string& toml = scene_of(),
                          const std::string& second = "") {
  const SceneFolder folder;
  folder.put("a.obj", obj);
  if (!second.empty()) folder.put("b.obj", second);
  return folder.read(toml);
}

// Volume by the divergence theorem, a sixth of the sum of a (b x c): 1 for the cube with outward
// faces.
inline double volume(const scenes::Scene& scene) {
  double sum = 0.0;
  for (const scenes::Triangle& t : scene.triangles) {
    const Vec3 &a = scene.vertices[t.vertex[0]], &b = scene.vertices[t.vertex[1]],
               &c = scene.vertices[t.vertex[2]];
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

inline std::string warnings(const scenes::Scene& scene) {
  std::string text;
  for (const std::string& warning : scene.warnings) text += warning + "\n";
  return text;
}

}  // namespace earthshine::test
