// SPDX-License-Identifier: Apache-2.0
// include = [...]: tables that scenes share.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

class IncludedFiles : public ::testing::Test {
 protected:
  test::SceneFolder folder;
};

constexpr const char* quad =
    "[[object]]\nname = \"floor\"\nshape = \"quad\"\nmaterial = \"white\"\n"
    "corners = [[0,0,0],[1,0,0],[1,1,0],[0,1,0]]\n";

TEST_F(IncludedFiles, EntriesFollowTheScenesOwnWhichReplaceThem) {
  folder.put("paint.toml",
             "[[material]]\nname = \"white\"\ndiffuse = 0.8\n"
             "[[material]]\nname = \"black\"\ndiffuse = 0.1\n[quality]\nerror = 0.1\n");
  const Scene plain = folder.read(std::string("format = 1\ninclude = [\"paint.toml\"]\n") + quad);
  ASSERT_EQ(plain.materials.size(), 2U);
  EXPECT_EQ(plain.materials[0].diffuse, Rgb(0.8));
  EXPECT_EQ(plain.quality.error, 0.1);
  ASSERT_EQ(plain.files.size(), 2U);
  EXPECT_EQ(plain.files[1], folder.path() / "paint.toml");
  const Scene own =
      folder.read(std::string("format = 1\ninclude = [\"paint.toml\"]\n[quality]\nerror = 0.2\n"
                              "[[material]]\nname = \"white\"\ndiffuse = 0.5\n") +
                      quad,
                  {"material.black.diffuse=0.2"});
  ASSERT_EQ(own.materials.size(), 2U);
  EXPECT_EQ(own.materials[0].diffuse, Rgb(0.5));
  EXPECT_EQ(own.materials[1].name, "black");
  EXPECT_EQ(own.materials[1].diffuse, Rgb(0.2));
  EXPECT_EQ(own.quality.error, 0.2);
}

TEST_F(IncludedFiles, FileNamesAreRelativeToTheFileThatHasThem) {
  folder.put("parts/meshes/q.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.put("parts/inner/more.toml",
             "[[object]]\nname = \"two\"\nmesh = \"../meshes/q.obj\"\nmaterial = \"white\"\n"
             "translate = [0, 0, 1]\n");
  folder.put("parts/one.toml",
             "include = [\"inner/more.toml\"]\n[[material]]\nname = \"white\"\ndiffuse = 0.8\n"
             "[[object]]\nname = \"one\"\nmesh = \"meshes/q.obj\"\nmaterial = \"white\"\n");
  const Scene scene = folder.read("format = 1\ninclude = [\"parts/one.toml\"]\n");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "one");
  EXPECT_EQ(scene.objects[1].name, "two");
  EXPECT_EQ(scene.objects[1].area_m2, 0.5);
}

// The first camera is the one that commands use without --camera. Of two files the later one
// replaces.
TEST_F(IncludedFiles, CamerasAreInTheOrderSceneFirstFileSecondFile) {
  const auto camera = [](const char* name, int x) {
    return fmt::format(
        "[[camera]]\nname = \"{}\"\nposition = [{}, 0, 3]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n",
        name, x);
  };
  folder.put("one.toml", camera("a", 1) + camera("b", 1));
  folder.put("two.toml", camera("c", 2) + camera("a", 2) + camera("own", 2));
  const Scene scene =
      folder.read("format = 1\ninclude = [\"one.toml\", \"two.toml\"]\n" + camera("own", 0));
  std::vector<std::pair<std::string, double>> found;
  for (const Camera& one : scene.cameras) found.emplace_back(one.name, one.position.x);
  const std::vector<std::pair<std::string, double>> expected = {
      {"own", 0.0}, {"b", 1.0}, {"c", 2.0}, {"a", 2.0}};
  EXPECT_EQ(found, expected);
}

TEST_F(IncludedFiles, WhatCannotBeIncludedIsRefused) {
  folder.put("again.toml", "include = [\"scene.toml\"]\n");
  folder.put("feet.toml", std::string("unit = \"ft\"\n") + quad);
  folder.put("bad.toml", "[[material]]\nname = \"white\"\ndifuse = 0.8\n");
  const struct {
    const char* include;
    std::vector<std::string> says;
  } bad[] = {{"\"paint.toml\"", {"scene.toml:2", "the string", "list of files"}},
             {"[3]", {"scene.toml:2", "the number 3"}},
             {"[\"none.toml\"]", {"scene.toml:2", "none.toml"}},
             {"[\"again.toml\"]", {"again.toml:1", "scene.toml includes itself"}},
             {"[\"feet.toml\"]", {"feet.toml:1", "unit is \"ft\"", "scene \"m\""}},
             {"[\"bad.toml\"]", {"bad.toml:3", "difuse"}}};
  for (const auto& one : bad) {
    const std::string said =
        folder.refusal(fmt::format("format = 1\ninclude = {}\n{}", one.include, quad));
    EXPECT_TRUE(holds(said, one.says)) << said;
  }
}

// Every material of the library conserves energy: reading a scene rejects others.
TEST_F(IncludedFiles, ShippedMaterialsAreRead) {
  const Scene scene = folder.read(
      fmt::format("format = 1\ninclude = [\"{}/scenes/library/materials/spacecraft.toml\"]\n",
                  EARTHSHINE_SOURCE_DIR));
  EXPECT_EQ(scene.materials.size(), 13U);
}

}  // namespace
}  // namespace earthshine::scenes
