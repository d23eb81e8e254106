// SPDX-License-Identifier: Apache-2.0
// Invalid scene files: the error names the place, the key and the correct form.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

struct Case {
  std::string name;
  std::string body;  // after "format = 1\n", so that its first line is line 2
  std::vector<std::string> message;
};

// The scene is rejected with a message that contains all texts of the case.
void expect_refusals(const std::vector<Case>& cases) {
  const test::SceneFolder folder;
  for (const Case& c : cases) {
    EXPECT_TRUE(test::holds(folder.refusal("format = 1\n" + c.body), c.message)) << c.name;
  }
}

const std::string light = "[[light]]\nname = \"a\"\ntype = \"point\"\nposition = [0, 0, 0]\n";
const std::string material = "[[material]]\nname = \"m\"\n";
const std::string box =
    "[[object]]\nname = \"o\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";
const std::string camera = "[[camera]]\nname = \"A\"\nposition = [0, 0, 0]\nlook_at = [1, 0, 0]\n";
const std::string earth = "[earth]\ndirection = [0, 0, 1]\n";

TEST(SceneFile, UnknownKeysAreRefusedWithTheNearestKey) {
  expect_refusals(
      {Case{"TopLevel",
            "lights = 1\n",
            {"scene.toml:2:1: unknown key \"lights\" in the scene", "allowed keys: format",
             "Did you mean \"light\"?"}},
       Case{"Light",
            light + "intensty = 1\n",
            {"scene.toml:6:1: unknown key \"intensty\" in [[light]]",
             "Did you mean \"intensity\"?"}},
       Case{"FirstInTheFile", light + "zz = 1\naa = 1\n", {"scene.toml:6:1: unknown key \"zz\""}},
       Case{
           "Material", material + "difuse = 1\n", {"scene.toml:4:1", "\"difuse\"", "\"diffuse\"?"}},
       Case{"Object", box + "materail = \"m\"\n", {"scene.toml:7:1", "\"material\"?"}},
       Case{"Camera", camera + "fov = 3\n", {"scene.toml:6:1", "\"fov_deg\"?"}},
       Case{"Sun", "[sun]\nilluminanc = 3\n", {"scene.toml:3:1", "in [sun]", "\"illuminance\"?"}},
       Case{"Earth", earth + "albdo = 3\n", {"scene.toml:4:1", "\"albedo\"?"}},
       Case{"Orbit", "[orbit]\nbeta = 3\n", {"scene.toml:3:1", "\"beta_deg\"?"}},
       Case{"Ambient", "[ambient]\nradianc = 3\n", {"scene.toml:3:1", "\"radiance\"?"}},
       Case{"Quality", "[quality]\ngather_ray = 3\n", {"scene.toml:3:1", "\"gather_rays\"?"}},
       Case{"OfAnotherLamp",
            light + "intensity = 1\naim = [1, 0, 0]\n",
            {"scene.toml:7:1", "\"aim\"", "does not belong to a light of type \"point\""}},
       Case{"OfAnotherShape",
            box + "radius = 1\n",
            {"scene.toml:7:1", "\"radius\"", "shape \"box\""}},
       Case{"ShapeKeyOfAMesh",
            "[[object]]\nname = \"o\"\nmesh = \"m.obj\"\nradius = 1\n",
            {"scene.toml:5:1", "\"radius\"", "an object with a mesh"}},
       Case{"SingleBrackets", "[light]\nname = \"a\"\n", {"scene.toml:2:", "[[light]]"}},
       Case{"DoubleBrackets", "[[sun]]\n", {"scene.toml:2:", "[sun]"}},
       Case{"Unnamed",
            "[[camera]]\nposition = [0, 0, 0]\n",
            {"scene.toml:2:1", "[[camera]] has no \"name\""}},
       Case{
           "EmptyName", "[[material]]\nname = \"\"\n", {"scene.toml:3:1", "\"name\"", "not empty"}},
       Case{"NamedTwice",
            material + material,
            {"scene.toml:4:1", "a second [[material]]", "scene.toml:2:1"}},
       Case{"ObjectsNamedTwice",
            material + box + "material = \"m\"\n" + box + "material = \"m\"\n",
            {"scene.toml:10:1", "a second [[object]]"}}});
}

TEST(SceneFile, ValuesOfWrongTypeOrRangeAreRefused) {
  expect_refusals(
      {Case{"WrongType",
            light + "intensity = \"bright\"\n",
            {"scene.toml:6:1: \"intensity\" in [[light]] \"a\" is the string \"bright\"",
             "a number or [r, g, b]"}},
       Case{"ColourOfTwo",
            light + "intensity = [1, 2]\n",
            {"scene.toml:6:1", "an array of 2: the number 1, the number 2"}},
       Case{"Negative",
            light + "intensity = [1, -2, 1]\n",
            {"scene.toml:6:1", "is -2", "from 0 to 1e+15"}},
       Case{"NaN", light + "intensity = nan\n", {"scene.toml:6:1", "is nan", "number"}},
       Case{"Infinite",
            "[sun]\ndirection = [0, 0, 1]\nilluminance = inf\n",
            {"scene.toml:4:1", "is inf"}},
       Case{"Date", light + "intensity = 1979-05-27\n", {"scene.toml:6:1", "a date or time"}},
       Case{"AboveOne",
            material + "diffuse = [0.5, 1.1, 0]\n",
            {"scene.toml:4:1", "is 1.1", "from 0 to 1"}},
       Case{"IorBelowOne", material + "ior = 0.9\n", {"scene.toml:4:1", "is 0.9", "from 1 to 10"}},
       Case{"Shininess", material + "shininess = -1\n", {"scene.toml:4:1", "from 0"}},
       Case{"Energy",
            material + "diffuse = 0.8\nspecular = [0, 1, 0]\nshininess = 2\nmirror = 0.1\n",
            {"scene.toml:2:1", "[[material]] \"m\"", "green", "0.8", "0.5", "0.1", "1.4",
             "at most 1"}},
       Case{"Unit", "unit = \"km\"\n", {"scene.toml:2:1", "\"km\"", "m, cm, mm, ft, in"}},
       Case{"ZeroDirection", "[sun]\ndirection = [0, 0, 0]\n", {"scene.toml:3:1", "has no length"}},
       Case{"Flag", material + "two_sided = 1\n", {"scene.toml:4:1", "true or false"}},
       Case{"FieldOfView", camera + "fov_deg = 180\n", {"scene.toml:6:1", "above 0 and below 180"}},
       Case{
           "Resolution", camera + "resolution = [0, 512]\n", {"scene.toml:6:1", "from 1 to 16384"}},
       Case{"LooksAtItself",
            "[[camera]]\nname = \"A\"\nposition = [1, 1, 1]\nlook_at = [1, 1, 1]\n",
            {"scene.toml:5:1", "own position"}},
       Case{"UpAlongTheView",
            "[[camera]]\nname = \"A\"\nposition = [0, 0, 0]\nlook_at = [0, 0, -1]\n",
            {"scene.toml:5:1", "parallel to up", "another up"}},
       Case{"FocusAlone", camera + "focus = 3\n", {"scene.toml:6:1", "\"aperture\""}},
       Case{"ApertureAlone", camera + "aperture = 0.01\n", {"scene.toml:6:1", "\"focus\""}},
       Case{"QualityError", "[quality]\nerror = 0\n", {"scene.toml:3:1", "above 0"}},
       Case{"WholeNumber", "[quality]\ngather_rays = 2.5\n", {"scene.toml:3:1", "whole number"}},
       Case{"TooManyRays", "[quality]\ngather_rays = 2000000\n", {"scene.toml:3:1", "1048576"}},
       Case{"MaxPatchesWord",
            "[quality]\nmax_patches = \"many\"\n",
            {"scene.toml:3:1", "\"max_patches\"", "whole number"}},
       Case{"RefineNumber", "[quality]\nrefine = 1\n", {"scene.toml:3:1", "\"refine\"", "true"}},
       Case{"BudgetOfNothing",
            "[quality]\nmax_patches = 500\nrefine = false\n",
            {"scene.toml:3:1", "\"max_patches\"", "refine = false", "Leave out"}},
       Case{"SettingOfTables",
            "[monitor]\nrows = { a = 1 }\n",
            {"scene.toml:3:1", "\"rows\"", "a table"}},
       Case{"SettingOfWords",
            "[monitor]\nrows = [1, \"a\"]\n",
            {"scene.toml:3:1", "the string \"a\""}}});
}

TEST(SceneFile, KeysThatDoNotGoTogetherAreRefused) {
  expect_refusals(
      {Case{"TwoStrengths",
            light + "intensity = 1\nflux = 1\n",
            {"scene.toml:7:1", "\"flux\"", "\"intensity\""}},
       Case{"NoStrength", light, {"scene.toml:2:1", "has no \"intensity\"", "flux"}},
       Case{"BeamWiderThanField",
            "[[light]]\nname = \"a\"\ntype = \"spot\"\nposition = [0, 0, 0]\naim = [1, 0, 0]\n"
            "intensity = 1\nbeam_deg = 60\nfield_deg = 30\n",
            {"scene.toml:8:1", "\"beam_deg\"", "field_deg, 30"}},
       Case{"ParallelEdges",
            "[[light]]\nname = \"a\"\ntype = \"rectangle\"\ncenter = [0, 0, 0]\nedge_u = [1, 0, "
            "0]\n"
            "edge_v = [2, 0, 0]\nexitance = 1\n",
            {"scene.toml:7:1", "\"edge_v\"", "no area"}},
       Case{"SunDirectionBesideOrbit",
            "[orbit]\naltitude_km = 400\n[sun]\ndirection = [0, 0, 1]\n",
            {"scene.toml:5:1", "\"direction\" in [sun]", "[orbit] already determines it"}},
       Case{"AltitudeBesideOrbit",
            "[orbit]\naltitude_km = 400\n[earth]\naltitude_km = 400\n",
            {"scene.toml:5:1", "\"altitude_km\" in [earth]"}},
       Case{"LambertWithoutSun",
            earth + "altitude_km = 400\n",
            {"scene.toml:2:1", "lit by the Sun", "Add [sun] or [orbit]", "uniform"}},
       Case{"RadianceOfLambert",
            "[sun]\ndirection = [0, 0, 1]\n" + earth + "altitude_km = 400\nradiance = 1\n",
            {"scene.toml:7:1", "\"radiance\"", "uniform"}},
       Case{"AlbedoOfUniform",
            earth + "altitude_km = 400\nmodel = \"uniform\"\nradiance = 1\nalbedo = 0.3\n",
            {"scene.toml:7:1", "\"albedo\"", "lambert"}},
       Case{"UniformWithoutRadiance",
            earth + "altitude_km = 400\nmodel = \"uniform\"\n",
            {"scene.toml:2:1", "has no \"radiance\""}},
       Case{"TwoDiscs",
            earth + "altitude_km = 400\nhalf_angle_deg = 70\nmodel = \"uniform\"\nradiance = 1\n",
            {"scene.toml:5:1", "\"half_angle_deg\"", "\"altitude_km\""}},
       Case{"HalfAngleOfLambert",
            "[sun]\ndirection = [0, 0, 1]\n" + earth + "half_angle_deg = 70\n",
            {"scene.toml:6:1", "\"half_angle_deg\"", "uniform"}},
       Case{
           "MeshAndShape", box + "mesh = \"m.obj\"\n", {"scene.toml:4:1", "\"shape\"", "\"mesh\""}},
       Case{"NeitherMeshNorShape",
            "[[object]]\nname = \"o\"\n",
            {"scene.toml:2:1", "has no \"mesh\"", "shape"}},
       Case{"NoMaterial", box, {"scene.toml:2:1", "has no \"material\""}},
       Case{"UnknownMaterial",
            "[[material]]\nname = \"white-paint\"\n" + box + "material = \"white-pant\"\n",
            {"scene.toml:9:1", "is not defined", "Did you mean \"white-paint\"?"}},
       Case{"BoxInsideOut",
            "[[object]]\nname = \"o\"\nshape = \"box\"\nmin = [0, 0, 2]\nmax = [1, 1, 1]\n",
            {"scene.toml:6:1", "\"max\"", "above that of min"}},
       Case{"QuadNotFlat",
            "[[object]]\nname = \"o\"\nshape = \"quad\"\ncorners = [[0,0,0], [1,0,0], [1,1,1], "
            "[0,1,0]]\n",
            {"scene.toml:5:1", "one plane"}},
       Case{"QuadOfThree",
            "[[object]]\nname = \"o\"\nshape = \"quad\"\ncorners = [[0,0,0], [1,0,0], [1,1,1]]\n",
            {"scene.toml:5:1", "3 points"}},
       Case{"TwoSegments",
            "[[object]]\nname = \"o\"\nshape = \"sphere\"\ncenter = [0,0,0]\nradius = 1\nsegments "
            "= 2\n",
            {"scene.toml:7:1", "from 3 to 4096"}},
       Case{"ZeroScale",
            material + box + "material = \"m\"\nscale = 0\n",
            {"scene.toml:10:1", "\"scale\"", "other than 0"}},
       Case{"MissingMesh",
            "[[object]]\nname = \"o\"\nmesh = \"meshes/none.obj\"\n",
            {"scene.toml:4:1", "meshes/none.obj", "No such file"}},
       Case{"MeshOfAnUnknownKind",
            "[[object]]\nname = \"o\"\nmesh = \"bay.3ds\"\n",
            {"scene.toml:4:1", ".obj, .gltf, .glb, .ply and .stl"}}});
}

TEST(SceneFile, TextThatIsNotPlainTomlIsRefused) {
  expect_refusals(
      {Case{"NotToml", "name = \n", {"scene.toml:2:", "not TOML"}},
       Case{"KeyTwice", "name = \"a\"\nname = \"b\"\n", {"scene.toml:3:", "name"}},
       Case{"FormatTwice", "format = 1\n", {"scene.toml:2:", "format"}},
       Case{"UnfinishedTable", "[#\n", {"scene.toml:2:"}},
       Case{"LongLine", "#" + std::string(9000, 'x') + "\n", {"scene.toml:2", "8192 bytes"}},
       Case{"NotUtf8", "name = \"\xff\"\n", {"scene.toml:2:9", "UTF-8"}},
       Case{"OverlongUtf8", "name = \"\xc0\xaf\"\n", {"scene.toml:2:9", "UTF-8"}},
       Case{"OutsideAString", "name = x\u00e9\n", {"scene.toml:2:9", "outside a string"}},
       Case{"NulByte", std::string("name = \"a\0b\"\n", 13), {"scene.toml:2:10", "NUL"}},
       Case{"DeepKey", "a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r = 1\n", {"scene.toml:2:", "16 dots"}},
       Case{"DeepArrays", "name = " + std::string(4000, '[') + "\n", {"scene.toml:2:"}}});
}

TEST(SceneFile, FormatIsRequiredAndIsOne) {
  const test::SceneFolder folder;
  EXPECT_TRUE(test::holds(folder.refusal("name = \"a\"\n"), {"scene.toml:1:1", "format = 1"}));
  EXPECT_TRUE(test::holds(folder.refusal("\nformat = 2\n"),
                          {"scene.toml:2:1", "the number 2", "format = 1"}));
  EXPECT_TRUE(test::holds(folder.refusal("format = \"1\"\n"), {"scene.toml:1:1", "the string"}));
}

TEST(SceneFile, LargeFilesAndMissingOnesAreRefused) {
  const test::SceneFolder folder;
  std::string comments = "format = 1\n";
  while (comments.size() <= (1U << 20)) comments += "# " + std::string(500, 'x') + "\n";
  EXPECT_TRUE(test::holds(folder.refusal(comments), {"scene.toml", "1048576"}));
  const auto none = folder.path() / "none.toml";
  EXPECT_TRUE(
      test::holds(test::error_of(base::Blame::Input, [&] { static_cast<void>(read_scene(none)); }),
                  {none.string(), "No such file"}));
  EXPECT_TRUE(test::holds(
      test::error_of(base::Blame::Input, [&] { static_cast<void>(read_scene(folder.path())); }),
      {"a folder"}));
}

}  // namespace
}  // namespace earthshine::scenes
