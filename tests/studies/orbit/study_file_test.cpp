// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/study_file.h"

#include <gtest/gtest.h>

#include "tests/base/temporary_folder.h"

namespace earthshine::studies {
namespace {

class StudyFiles : public testing::Test {
 protected:
  [[nodiscard]] StudyFile read(const std::string& text) const {
    test::write_bytes(folder_ / "s.toml", text);
    return read_study_file(folder_ / "s.toml");
  }
  // Expects an error at `line` of the file that contains all of the words.
  void refused(const std::string& text, int line, const std::vector<std::string>& words) const {
    const std::string said = test::error_of(base::Blame::Input, [&] { (void)read(text); });
    EXPECT_NE(said.find("s.toml:" + std::to_string(line) + ":"), std::string::npos) << said << "\n"
                                                                                    << text;
    for (const std::string& word : words) {
      EXPECT_NE(said.find(word), std::string::npos) << said << "\nlacks: " << word;
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(StudyFiles, AFullFileIsReadBack) {
  const StudyFile study = read(R"(format = 1
name = "Day and night"
scenes = ["day.toml", "/elsewhere/night.toml"]
set = ["sun.illuminance=1e5"]
cameras = ["A", "B"]
targets = ["tss"]
size = "640x480"
iris = ["peak", "fixed"]
wanted = ["tss>=0.9", "a>=b>=0.25"]
seen = 0.7
earth_cells = 12
camera_models = { A = "mine", B = "none" }

[orbit]
positions_deg = [360, -90, 0.5]

[[lamps]]
name = "all"

[[lamps]]
name = "half"
others = "off"
set = { bay-lamps = 0.5, red = [1, 0, 0] }

[[picture]]
name = "p"
title = "By night"
camera = "B"
position_deg = -90
lamps = "half"
shows = "distributed-cctv"
lights = 16

[[picture]]
name = "q"
camera = "A"

[[pair]]
title = "Both"
left = "p"
right = "q"

[[cctv]]
name = "mine"
like = "sit-monochrome"

[monitor]
gamma = 2.2
)");
  EXPECT_EQ(study.name, "Day and night");
  ASSERT_EQ(study.scenes.size(), 2U);
  EXPECT_EQ(study.scenes[0], folder_ / "day.toml");
  EXPECT_EQ(study.scenes[1], "/elsewhere/night.toml");
  EXPECT_EQ(study.overrides, std::vector<std::string>{"sun.illuminance=1e5"});
  EXPECT_EQ(study.cameras, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(study.targets, std::vector<std::string>{"tss"});
  EXPECT_EQ(study.columns, 640);
  EXPECT_EQ(study.rows, 480);
  EXPECT_EQ(study.iris, (std::vector<std::string>{"peak", "fixed"}));
  ASSERT_EQ(study.wanted.size(), 2U);
  EXPECT_EQ(study.wanted[0].target, "tss");
  EXPECT_EQ(study.wanted[0].probability, 0.9);
  EXPECT_EQ(study.wanted[0].text, "tss>=0.9");
  EXPECT_EQ(study.wanted[1].target, "a>=b");
  EXPECT_EQ(study.wanted[1].probability, 0.25);
  EXPECT_EQ(study.seen_probability, 0.7);
  EXPECT_EQ(study.basis.disc_cells, 12U);
  EXPECT_EQ(study.basis.sphere_cells, 12U);
  EXPECT_EQ(study.camera_models,
            (std::map<std::string, std::string>{{"A", "mine"}, {"B", "none"}}));
  EXPECT_EQ(study.positions_deg, (std::vector<double>{-90.0, 0.5, 360.0}));  // rising
  EXPECT_FALSE(study.timeline);
  ASSERT_EQ(study.lamps.size(), 2U);
  EXPECT_EQ(study.lamps[0].name, "all");
  EXPECT_FALSE(study.lamps[0].others_off);
  EXPECT_TRUE(study.lamps[0].factors.empty());
  EXPECT_TRUE(study.lamps[1].others_off);
  EXPECT_EQ(study.lamps[1].factors.at("bay-lamps"), Rgb(0.5));
  EXPECT_EQ(study.lamps[1].factors.at("red"), Rgb(1, 0, 0));
  ASSERT_EQ(study.pictures.size(), 2U);
  const PictureWish& p = study.pictures[0];
  EXPECT_EQ(p.title, "By night");
  EXPECT_EQ(p.camera, "B");
  EXPECT_EQ(p.position_deg, -90.0);
  EXPECT_EQ(p.lamps, "half");
  EXPECT_EQ(p.shows, Shows::DistributedCctv);
  EXPECT_EQ(p.lights, 16);
  const PictureWish& q = study.pictures[1];
  EXPECT_EQ(q.title, "q");
  EXPECT_FALSE(q.position_deg);
  EXPECT_EQ(q.shows, Shows::Clean);
  ASSERT_EQ(study.pairs.size(), 1U);
  EXPECT_EQ(study.pairs[0].left, "p");
  EXPECT_EQ(study.pairs[0].right, "q");
  ASSERT_EQ(study.cctv.cctv.size(), 1U);
  EXPECT_EQ(study.cctv.cctv[0].name, "mine");
  EXPECT_TRUE(study.cctv.monitor);
}

TEST_F(StudyFiles, WhatIsLeftOutHasItsDefault) {
  const StudyFile study = read("format = 1\nscene = \"a.toml\"\n");
  EXPECT_EQ(study.name, "s");
  EXPECT_EQ(study.scenes.size(), 1U);
  EXPECT_TRUE(study.cameras.empty() && study.targets.empty() && study.positions_deg.empty());
  ASSERT_EQ(study.lamps.size(), 1U);
  EXPECT_TRUE(study.lamps[0].factors.empty());
  EXPECT_FALSE(study.columns || study.rows || study.timeline);
  EXPECT_EQ(study.seen_probability, 0.5);
}

TEST_F(StudyFiles, EvenPositionsAreATimelineOfOneTurn) {
  const auto with = [&](const char* orbit) {
    return read(std::string("format = 1\nscene = \"a\"\n[orbit]\n") + orbit + "\n");
  };
  const StudyFile even = with("positions = 4");
  EXPECT_EQ(even.positions_deg, (std::vector<double>{0, 90, 180, 270}));
  EXPECT_TRUE(even.timeline);
  const StudyFile one = with("positions = 1");
  EXPECT_EQ(one.positions_deg, std::vector<double>{0.0});
  EXPECT_FALSE(one.timeline);
}

const std::string head = "format = 1\nscene = \"a.toml\"\n";

TEST_F(StudyFiles, FormatIsDemanded) {
  refused("scene = \"a.toml\"\n", 1, {"format", "format = 1"});
  refused("format = 2\nscene = \"a.toml\"\n", 1, {"format", "2", "1"});
  refused("format = \"1\"\nscene = \"a.toml\"\n", 1, {"format"});
  refused("format = 1\nscene = \n", 2, {});
}

TEST_F(StudyFiles, ScenesAreDemanded) {
  refused("format = 1\n", 1, {"scene"});
  refused(head + "scenes = [\"b.toml\"]\n", 3, {"scenes", "Keep one"});
  refused("format = 1\nscenes = []\n", 2, {"scenes", "one or more"});
  refused("format = 1\nscenes = [\"a\", \"a\"]\n", 2, {"twice"});
}

TEST_F(StudyFiles, UnknownKeysAreNamedWhereTheyStand) {
  refused(head + "camera = \"A\"\n", 3, {"camera", "cameras"});
  refused(head + "\n[orbit]\nposition = 3\n", 5, {"position", "positions"});
  refused(head + "[[lamps]]\nname = \"x\"\nother = \"off\"\n", 5, {"other"});
  refused(head + "[[picture]]\nname = \"x\"\ncamera = \"A\"\nlight = 3\n", 6, {"light"});
  refused(head + "[[pair]]\ntitle = \"x\"\nleft = \"l\"\nright = \"r\"\nup = \"u\"\n", 7, {"up"});
}

TEST_F(StudyFiles, WrongTypesAndEmptyListsAreRefused) {
  for (const std::string key : {"set", "cameras", "targets", "iris", "wanted"}) {
    for (const std::string value : {"[]", "\"A\"", "3", "[3]", "[\"\"]"}) {
      refused(head + key + " = " + value + "\n", 3, {key, "allowed"});
    }
  }
  refused(head + "cameras = [\"A\", \"A\"]\n", 3, {"cameras", "twice"});
  refused(head + "name = 3\n", 3, {"name"});
  refused(head + "iris = [\"wide\"]\n", 3, {"wide", "peak"});
  for (const char* seen : {"0", "1", "-0.5", "\"x\"", "nan"}) {
    refused(head + "seen = " + seen + "\n", 3, {"seen"});
  }
  for (const char* cells : {"1", "4097", "2.5", "0"}) {
    refused(head + "earth_cells = " + cells + "\n", 3, {"earth_cells"});
  }
  refused(head + "camera_models = 3\n", 3, {"camera_models", "table"});
  refused(head + "camera_models = { A = 3 }\n", 3, {"camera_models", "A"});
}

TEST_F(StudyFiles, SizesAreTwoWholeNumbers) {
  for (const char* size :
       {"64", "64x", "x64", "64x48x2", "0x48", "64x-1", "64x16385", "64 x 48", "6.4x48"}) {
    refused(head + "size = \"" + size + "\"\n", 3, {"size", "16384"});
  }
  refused(head + "size = 64\n", 3, {"size"});
  refused(head + "size = \"\"\n", 3, {"size", "not empty"});
}

TEST_F(StudyFiles, PositionsComeOneWay) {
  const std::string orbit = head + "[orbit]\n";
  refused(orbit, 3, {"positions"});
  refused(orbit + "positions = 3\npositions_deg = [1]\n", 5, {"positions_deg", "either"});
  for (const char* count : {"0", "-1", "3601", "2.5"}) {
    refused(orbit + "positions = " + count + "\n", 4, {"positions"});
  }
  for (const char* list : {"[]", "3", "[361]", "[-361]", "[nan]", "[\"0\"]", "[0, 0.0]"}) {
    refused(orbit + "positions_deg = " + list + "\n", 4, {"positions_deg"});
  }
  refused(head + "orbit = 3\n", 3, {"orbit"});
}

TEST_F(StudyFiles, WantedIsATargetAndAProbability) {
  for (const char* wanted : {"tss", ">=0.5", "tss>=2", "tss>=1", "tss>=0", "tss>=", "tss>=x",
                             "tss>=-0.5", "tss>=0.5x", "tss>=nan", "tss > 0.5"}) {
    refused(head + "wanted = [\"" + wanted + "\"]\n", 3, {wanted, "TARGET>=P", "between 0 and 1"});
  }
}

TEST_F(StudyFiles, LampSettingsAreTables) {
  const std::string lamps = head + "[[lamps]]\nname = \"x\"\n";
  refused(lamps + "set = 0.5\n", 5, {"set", "table", "bay-lamps = 0.5"});
  refused(lamps + "set = { a = -1 }\n", 5, {"a"});
  refused(lamps + "set = { a = \"on\" }\n", 5, {"a"});
  refused(lamps + "set = { a = [1, 2] }\n", 5, {"a"});
  refused(lamps + "others = \"on\"\n", 5, {"others", "as-they-are", "off"});
  refused(lamps + "[[lamps]]\nname = \"x\"\n", 5, {"\"x\"", "unique"});
  refused(head + "[[lamps]]\nothers = \"off\"\n", 3, {"name"});
}

TEST_F(StudyFiles, PicturesAndPairsAreWhole) {
  const std::string picture = head + "[[picture]]\nname = \"p\"\n";
  refused(picture, 3, {"camera"});
  const std::string whole = picture + "camera = \"A\"\n";
  refused(whole + "shows = \"noise\"\n", 6, {"shows", "clean", "distributed-cctv"});
  refused(whole + "lights = 1\n", 6, {"lights"});
  refused(whole + "position_deg = 400\n", 6, {"position_deg", "360"});
  refused(whole + "[[picture]]\nname = \"p\"\ncamera = \"A\"\n", 6, {"\"p\"", "unique"});
  refused(whole + "[[pair]]\ntitle = \"t\"\nleft = \"p\"\nright = \"q\"\n", 9,
          {"\"q\"", "not there", "[[picture]]"});
  refused(whole + "[[pair]]\nleft = \"p\"\nright = \"p\"\n", 6, {"title"});
}

TEST_F(StudyFiles, OneThatIsNotThereIsNamed) {
  const std::string said =
      test::error_of(base::Blame::Input, [&] { (void)read_study_file(folder_ / "none.toml"); });
  EXPECT_NE(said.find("none.toml"), std::string::npos) << said;
}

}  // namespace
}  // namespace earthshine::studies
