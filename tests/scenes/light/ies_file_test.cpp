// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/ies_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "base/numbers/random.h"
#include "tests/scenes/scene_text.h"
#include "tests/support/ies_text.h"

namespace earthshine::scenes {
namespace {

using base::pi;
using tests::IesText;
using tests::steps;

double cosine(double deg) { return std::cos(deg * pi / 180.0); }

// Varies in both angles, and dark in one plane near the axis.
double lopsided(double theta_deg, double phi_deg) {
  return 100.0 * (1.0 + cosine(theta_deg)) * (1.2 + cosine(phi_deg - 40.0)) + phi_deg / 10.0;
}

double candela(const Luminaire& luminaire, double theta_deg, double phi_deg) {
  return luminaire.light->peak_cd() *
         luminaire.light->relative(theta_deg * pi / 180.0, phi_deg * pi / 180.0);
}

double flux(const Luminaire& luminaire) {
  return luminaire.light->peak_cd() * luminaire.light->solid_angle_sr();
}

std::string refusal(const std::string& text) {
  return test::error_of(base::Blame::Input,
                        [&] { static_cast<void>(parse_ies(text, "lamp.ies")); });
}

TEST(IesFile, EvenIntensityHasTheFluxOfItsSolidAngle) {
  IesText file;
  EXPECT_NEAR(flux(parse_ies(file.text(), "a")), 100.0 * 2.0 * pi, 1e-9);
  file.vertical = {0.0, 30.0, 180.0};
  EXPECT_NEAR(flux(parse_ies(file.text(), "a")), 100.0 * 4.0 * pi, 1e-9);
  file.vertical = {90.0, 180.0};
  const Luminaire up = parse_ies(file.text(), "a");
  EXPECT_NEAR(flux(up), 100.0 * 2.0 * pi, 1e-9);
  EXPECT_EQ(candela(up, 89.0, 0.0), 0.0);
}

TEST(IesFile, FluxIsTheIntegralOfWhatIsInterpolated) {
  // Midpoint rule over the interpolated table, 900 x 720 points: error below 1e-5 if the table's
  // steps are multiples of the rule's.
  IesText file;
  file.vertical = {0.0, 10.0, 35.0, 90.0, 120.0, 180.0};
  file.horizontal = {0.0, 45.0, 100.0, 180.0, 300.0, 360.0};
  file.candela = lopsided;
  const Luminaire luminaire = parse_ies(file.text(), "a");
  double sum = 0.0;
  for (int i = 0; i < 900; ++i) {
    const double theta = 0.2 * (i + 0.5);
    for (int k = 0; k < 720; ++k) {
      sum += candela(luminaire, theta, 0.5 * (k + 0.5)) * std::sin(theta * pi / 180.0);
    }
  }
  EXPECT_NEAR(sum * (0.2 * pi / 180.0) * (0.5 * pi / 180.0) / flux(luminaire), 1.0, 1e-5);
}

TEST(IesFile, ValuesStandAtTheirAnglesAndLinearlyBetween) {
  IesText file;
  file.vertical = {0.0, 20.0, 90.0};
  file.horizontal = {0.0, 90.0, 360.0};
  file.candela = lopsided;
  const Luminaire luminaire = parse_ies(file.text(), "a");
  EXPECT_NEAR(candela(luminaire, 20.0, 90.0), lopsided(20.0, 90.0), 1e-9);
  const double quarter = 0.5 * (0.75 * lopsided(20.0, 0.0) + 0.25 * lopsided(20.0, 90.0)) +
                         0.5 * (0.75 * lopsided(90.0, 0.0) + 0.25 * lopsided(90.0, 90.0));
  EXPECT_NEAR(candela(luminaire, 55.0, 22.5), quarter, 1e-9);
  EXPECT_NEAR(candela(luminaire, 55.0, 22.5 - 360.0), quarter, 1e-9);
}

TEST(IesFile, PartsOfTheCircleAreMirrored) {
  IesText file;
  file.candela = lopsided;
  struct Row {
    std::vector<double> planes;
    double asked, same_as;
  };
  const Row rows[] = {{{0.0}, 213.0, 0.0},
                      {{0.0, 30.0, 90.0}, 150.0, 30.0},
                      {{0.0, 30.0, 90.0}, 210.0, 30.0},
                      {{0.0, 30.0, 90.0}, 330.0, 30.0},
                      {{0.0, 30.0, 90.0}, 270.0, 90.0},
                      {{0.0, 130.0, 180.0}, 230.0, 130.0},
                      {{90.0, 130.0, 270.0}, 50.0, 130.0},
                      {{90.0, 130.0, 270.0}, 270.0, 270.0}};
  for (const Row& row : rows) {
    file.horizontal = row.planes;
    EXPECT_NEAR(candela(parse_ies(file.text(), "a"), 45.0, row.asked), lopsided(45.0, row.same_as),
                1e-9)
        << row.planes.size() << " planes, " << row.asked;
  }
}

TEST(IesFile, FactorsMultiplyAndTheSecondOnlyUntil1991) {
  IesText file;
  file.multiplier = 2.0;
  file.ballast = 0.9;
  file.second = 0.5;
  EXPECT_NEAR(parse_ies(file.text(), "a").light->peak_cd(), 180.0, 1e-12);
  file.head = "IES:LM-63-2019\n";
  EXPECT_NEAR(parse_ies(file.text(), "a").light->peak_cd(), 180.0, 1e-12);
  for (const char* old : {"", "Any text\n", "IESNA91\n[TEST] a\n", "IESNA:LM-63-1991\n"}) {
    file.head = old;
    EXPECT_NEAR(parse_ies(file.text(), "a").light->peak_cd(), 90.0, 1e-12) << old;
  }
}

TEST(IesFile, WhatTheKeywordsSayIsKept) {
  IesText file;
  EXPECT_EQ(parse_ies(file.text(), "a").description, "test lamp");
  EXPECT_NEAR(parse_ies(file.text(), "a").opening_m, 0.2, 1e-12);
  file.head = "a lamp of 1986\n";
  file.units = 1;  // feet
  EXPECT_EQ(parse_ies(file.text(), "a").description, "a lamp of 1986");
  EXPECT_NEAR(parse_ies(file.text(), "a").opening_m, 0.2 * 0.3048, 1e-12);
}

TEST(IesFile, TiltTableIsReadAndInterpolated) {
  IesText file;
  file.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1.0 0.9 0.8\n";
  const Luminaire luminaire = parse_ies(file.text(), "a");
  ASSERT_TRUE(luminaire.tilt);
  EXPECT_NEAR(luminaire.tilt->factor_at(0.0), 1.0, 1e-12);
  EXPECT_NEAR(luminaire.tilt->factor_at(60.0), 0.9 - 0.1 / 3.0, 1e-12);
  EXPECT_NEAR(luminaire.tilt->factor_at(170.0), 0.8, 1e-12);
  EXPECT_NEAR(luminaire.light->peak_cd(), 100.0, 1e-12);
}

TEST(IesFile, CommasAndOddLineBreaksSeparateToo) {
  std::string text = IesText().text();
  const std::size_t at = text.find("1 1000");
  for (std::size_t k = at; k < text.size(); ++k) {
    if (text[k] == ' ') text[k] = k % 2 == 0 ? ',' : '\n';
  }
  EXPECT_NEAR(parse_ies(text, "a").light->peak_cd(), 100.0, 1e-12);
}

// 100 cd over a hemisphere are 628.32 lm, with any end-of-file mark.
TEST(IesFile, MarksOfAFilesEndAreNoNumbers) {
  const std::string good = IesText().text();
  const std::string whole = good.substr(0, good.find_last_not_of(" \n") + 1);
  using namespace std::string_literals;
  for (const std::string& end : {""s, "\n"s, "\r\n\r\n"s, "\x1a"s, "\n\x1a"s, "\r\n\x1a\r\n"s,
                                 "\x1a\0\0\0"s, "\n\x1a\x1a\x1a"s, "\nEND\n"s, " END"s, "\nend"s,
                                 "\r\nEND\r\n\x1a"s, "\nEND\nEND\n"s, ",\n\n"s}) {
    const Luminaire luminaire = parse_ies(whole + end, "a");
    EXPECT_NEAR(flux(luminaire), 628.3185, 1e-3);
    EXPECT_EQ(luminaire.warning, "") << end;
  }
}

TEST(IesFile, OtherWordsAfterTheNumbersAreNamed) {
  const std::string good = IesText().text();
  for (const std::string more :
       {"made by hand 7\n", "[MORE] 1\n", "END\n[MORE] 1\n", "\x1a\n7 lm\n"}) {
    const Luminaire luminaire = parse_ies(good + more, "lamp.ies");
    EXPECT_NEAR(flux(luminaire), 628.3185, 1e-3);
    EXPECT_TRUE(test::holds(luminaire.warning,
                            {"lamp.ies:1", "follows the last candela value", "not read"}));
  }
  const test::SceneFolder folder;
  folder.put("lamp.ies", good + "made by hand\n");
  std::string toml =
      "format = 1\n[[material]]\nname = \"w\"\n[[object]]\nname = \"o\"\nshape = \"box\"\nmin = "
      "[0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"w\"\n";
  for (const char* name : {"a", "b"}) {
    toml += std::string("[[light]]\ntype = \"ies\"\nname = \"") + name +
            "\"\nfile = \"lamp.ies\"\nposition = [0, 0, 5]\naim = [0, 0, 0]\n";
  }
  const Scene scene = folder.read(toml);
  ASSERT_EQ(scene.warnings.size(), 1U);  // once for both lamps
  EXPECT_TRUE(test::holds(scene.warnings[0], {"lamp.ies:10:1", "\"made\""}));
}

TEST(IesFile, BrokenFilesAreRefusedWithTheirPlace) {
  const std::string good = IesText().text();
  const auto changed = [&](auto change) {
    IesText file;
    change(file);
    return file.text();
  };
  const auto with = [&](const std::string& old, const std::string& fresh) {
    std::string text = good;
    return text.replace(text.find(old), old.size(), fresh);
  };
  struct Row {
    std::string text;
    std::vector<std::string> says;
  };
  const Row rows[] = {
      {"", {"lamp.ies", "no line TILT="}},
      {"#VRML V2.0\n1 2 3\n", {"lamp.ies", "no line TILT=", "not IES"}},
      {std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), {"lamp.ies:3:1", "NUL"}},
      {with("2002", "2050"), {"lamp.ies:1", "LM-63-2050", "IESNA91"}},
      {with("TILT=NONE", "TILT=lamp.tlt"), {"lamp.ies:4", "lamp.tlt", "TILT=INCLUDE"}},
      {good.substr(0, good.find("TILT")), {"no line TILT="}},
      {good.substr(0, good.size() - 6), {"lamp.ies:9", "ends", "candela value 3 of 3"}},
      {good.substr(0, good.find("0 45")), {"lamp.ies:6", "vertical angle 1 of 3"}},
      {good + "7\n", {"lamp.ies:10:1", "follows the last", "counts"}},
      {with("100 100 100", "100 nan 100"), {"lamp.ies:9:5", "nan"}},
      {with("100 100 100", "100 1e400 100"), {"lamp.ies:9:5", "1e400"}},
      {with("100 100 100", "100 -1 100"), {"lamp.ies:9:5", "candela value 2 of 3", "from 0"}},
      {with("100 100 100", "0 0 0"), {"lamp.ies", "every candela value is 0"}},
      {with("100 100 100", "100 ten 100"), {"lamp.ies:9:5", "\"ten\" is not a number"}},
      {with("0 45 90", "0 95 90"), {"lamp.ies:7:6", "vertical angle 3 of 3", "after 95", "grow"}},
      {with("0 45 90", "0 45 80"), {"lamp.ies:7:6", "from 0 to 80", "0 or 90 to 90 or 180"}},
      {with(" 3 1 1 2 ", " 99999999999999 1 1 2 "), {"lamp.ies:5:10", "from 2 to 4096"}},
      {with(" 3 1 1 2 ", " 4096 4096 1 2 "), {"lamp.ies:5", "4096 x 4096"}},
      {with(" 3 1 1 2 ", " 2.5 1 1 2 "), {"lamp.ies:5:10", "whole number"}},
      {with(" 3 1 1 2 ", " 4 1 1 2 "), {"lamp.ies:8:1", "vertical angle 4 of 4", "counts"}},
      {with(" 3 1 1 2 ", " -3 1 1 2 "), {"lamp.ies:5:10", "vertical angles"}},
      {with(" 3 1 1 2 ", " 3 1 2 2 "), {"lamp.ies:5", "type B", "type C"}},
      {with(" 3 1 1 2 ", " 3 1 3 2 "), {"lamp.ies:5", "type A", "type C"}},
      {with(" 3 1 1 2 ", " 3 1 1 3 "), {"lamp.ies:5", "units", "from 1 to 2"}},
      {changed([](IesText& f) { f.multiplier = 0.0; }), {"lamp.ies:5:8", "candela multiplier"}},
      {changed([](IesText& f) { f.ballast = -1.0; }), {"lamp.ies:6:1", "ballast factor"}},
      {changed([](IesText& f) {
         f.horizontal = {0.0, 120.0};
       }),
       {"lamp.ies:8:3", "from 0 to 120", "90 to 270"}},
      {changed([](IesText& f) { f.tilt = "TILT=INCLUDE\n1\n2\n0 90\n1.0 -1\n"; }),
       {"lamp.ies:8:5", "tilt factor"}}};
  for (const Row& row : rows) EXPECT_TRUE(test::holds(refusal(row.text), row.says));
}

TEST(IesFile, WhatIsNoFileOnDiskIsRefusedAtOnce) {
  const test::SceneFolder folder;
  const auto message = [&](const char* name) {
    return test::error_of(base::Blame::Input, [&] {
      static_cast<void>(read_ies(folder.path() / name, base::Location{"scene.toml", 3}));
    });
  };
  ASSERT_EQ(::mkfifo((folder.path() / "pipe.ies").c_str(), 0600), 0);
  std::filesystem::create_directory(folder.path() / "folder.ies");
  EXPECT_TRUE(test::holds(message("pipe.ies"), {"scene.toml:3", "pipe.ies", "pipe or a device"}));
  EXPECT_TRUE(test::holds(message("folder.ies"), {"scene.toml:3", "a folder"}));
  EXPECT_TRUE(test::holds(message("none.ies"), {"scene.toml:3", "No such file"}));
}

TEST(IesFile, MutatedFilesAreReadOrRefused) {
  // Random changes, deletions and duplications of bytes: the table is valid or rejected.
  IesText file;
  file.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1.0 0.9 0.8\n";
  file.horizontal = {0.0, 45.0, 90.0};
  file.candela = lopsided;
  const std::string seed = file.text();
  const std::string letters = "0123456789.,-+eE \nTILT=nafi[]\xff";
  base::Rng rng(base::Key(1, base::Stream::Test, 63));
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(rng.next() * static_cast<double>(n));
  };
  int sound = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = seed;
    for (std::size_t n = 1 + below(3); n > 0; --n) {
      const std::size_t at = below(text.size()), length = 1 + below(8);
      switch (below(3)) {
        case 0:
          text[at] = letters[below(letters.size())];
          break;
        case 1:
          text.erase(at, length);
          break;
        default:
          text.insert(at, text.substr(below(text.size()), length));
      }
    }
    try {
      const Luminaire luminaire = parse_ies(text, "lamp.ies");
      ASSERT_TRUE(std::isfinite(flux(luminaire)) && flux(luminaire) > 0.0) << text;
      const auto angles = luminaire.light->sample(rng.next(), rng.next());
      ASSERT_GT(luminaire.light->relative(angles.theta_rad, angles.phi_rad), 0.0) << text;
      ++sound;
    } catch (const base::Error& error) {
      ASSERT_NE(std::string(error.what()).find("lamp.ies"), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(sound, 100);
  EXPECT_GT(refused, 1000);
}

TEST(Photometry, SampledDirectionsHaveTheTablesMoments) {
  // Means of cos theta, sin theta cos phi and sin theta sin phi against midpoint integrals of the
  // interpolated table. Independent samples in [-1, 1]: the standard error of a mean of N is below
  // 1 / sqrt(N).
  IesText file;
  file.vertical = {0.0, 80.0, 120.0, 180.0};  // wide bands: theta within a band matters
  file.horizontal = {0.0, 45.0, 100.0, 180.0, 300.0, 360.0};
  file.candela = [](double theta, double phi) {
    return theta == 80.0 && phi > 90.0 ? 0.0 : lopsided(theta, phi);
  };
  const auto light = parse_ies(file.text(), "a").light;
  double exact[3] = {0, 0, 0};
  for (int i = 0; i < 900; ++i) {
    const double theta = 0.2 * (i + 0.5) * pi / 180.0;
    for (int k = 0; k < 720; ++k) {
      const double phi = 0.5 * (k + 0.5) * pi / 180.0;
      const double value = light->relative(theta, phi) * std::sin(theta);
      exact[0] += value * std::cos(theta);
      exact[1] += value * std::sin(theta) * std::cos(phi);
      exact[2] += value * std::sin(theta) * std::sin(phi);
    }
  }
  const int count = 200000;
  base::Rng rng(base::Key(1, base::Stream::Test, 64));
  double mean[3] = {0, 0, 0};
  for (int n = 0; n < count; ++n) {
    const double x = rng.next(), y = rng.next();
    const auto [theta, phi] = light->sample(x, y);
    mean[0] += std::cos(theta) / count;
    mean[1] += std::sin(theta) * std::cos(phi) / count;
    mean[2] += std::sin(theta) * std::sin(phi) / count;
  }
  for (int m = 0; m < 3; ++m) {
    exact[m] *= 0.2 * 0.5 * (pi / 180.0) * (pi / 180.0) / light->solid_angle_sr();
    EXPECT_NEAR(mean[m], exact[m], 4.0 / std::sqrt(double(count))) << m;
  }
}

}  // namespace
}  // namespace earthshine::scenes
