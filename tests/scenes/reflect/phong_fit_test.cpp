// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/phong_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/numbers/random.h"
#include "base/units.h"

namespace earthshine::scenes {
namespace {

double model(double angle_deg, double k_d, double k_s, double n) {
  return k_d + k_s * std::pow(std::max(0.0, std::cos(base::radians(std::fabs(angle_deg)))), n);
}

std::vector<ReflectancePoint> sampled(double from_deg, double to_deg, double step_deg, double k_d,
                                      double k_s, double n) {
  std::vector<ReflectancePoint> points;
  for (int k = 0; from_deg + k * step_deg <= to_deg + 1e-9; ++k) {
    const double angle = from_deg + k * step_deg;
    points.push_back({angle, model(angle, k_d, k_s, n)});
  }
  return points;
}

class PhongFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("earthshine-" + std::string(test->name()) + ".csv");
  }
  void TearDown() override { std::filesystem::remove(path_); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    write(text);
    try {
      const auto points = read_reflectance(path_);
      static_cast<void>(fit_phong(points, path_.string()));
    } catch (const base::Error& error) {
      EXPECT_EQ(error.blame(), base::Blame::Input);
      return error.what();
    }
    return "accepted";
  }
  std::filesystem::path path_;
};

TEST(PhongFit, BothMethodsRecoverASyntheticHighlight) {
  // cos^20(80 deg) = 6e-16, so that the value at 80 degrees is k_d to rounding.
  const PhongFits fits = fit_phong(sampled(0, 85, 5, 0.3, 0.9, 20.0), "test");
  for (const PhongFit& fit : {fits.report, fits.least_squares}) {
    EXPECT_NEAR(fit.diffuse, 0.3, 1e-6);
    EXPECT_NEAR(fit.specular, 0.9, 1e-6);
    EXPECT_NEAR(fit.shininess, 20.0, 1e-4);
    EXPECT_LT(fit.residual, 1e-6);
  }
  EXPECT_TRUE(fits.notes.empty());
}

TEST(PhongFit, LeastSquaresRecoversABroadHighlightThatTheReportsMethodMisses) {
  // At n = 2 the lobe still has k_s cos^2(80) = 0.03 k_s at 80 degrees, which the report's method
  // counts as k_d.
  const PhongFits fits = fit_phong(sampled(0, 80, 5, 0.2, 0.5, 2.0), "test");
  EXPECT_NEAR(fits.report.diffuse, 0.2 + 0.5 * std::pow(std::cos(base::radians(80.0)), 2), 1e-12);
  EXPECT_NEAR(fits.least_squares.diffuse, 0.2, 1e-6);
  EXPECT_NEAR(fits.least_squares.specular, 0.5, 1e-6);
  EXPECT_NEAR(fits.least_squares.shininess, 2.0, 1e-5);
  EXPECT_LT(fits.least_squares.residual, fits.report.residual);
}

TEST(PhongFit, LeastSquaresIsNeverWorseThanTheReportsMethodOnNoisyData) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto points = sampled(-80, 80, 4, 0.4, 0.6, 15.0);
    base::Rng rng(base::Key(seed, base::Stream::Test, 0));
    for (ReflectancePoint& p : points) p.reflectance *= 0.95 + 0.1 * rng.next();
    const PhongFits fits = fit_phong(points, "test", ReflectanceNoise::Constant);
    EXPECT_LE(fits.least_squares.residual, fits.report.residual);
    EXPECT_NEAR(fits.least_squares.shininess, 15.0, 3.0);
  }
}

TEST(PhongFit, ValuesAtZeroAndEightyAreInterpolated) {
  // -5 and 5 give the value at 0; 75 and 85 give the value at 80.
  const std::vector<ReflectancePoint> points = {
      {-5, 1.0}, {5, 0.8}, {20, 0.5}, {75, 0.22}, {85, 0.18}};
  const PhongFit fit = fit_phong(points, "test").report;
  EXPECT_DOUBLE_EQ(fit.diffuse, 0.20);
  EXPECT_DOUBLE_EQ(fit.diffuse + fit.specular, 0.90);
}

TEST(PhongFit, FlatDataHaveNoHighlight) {
  const PhongFits fits = fit_phong(sampled(0, 80, 10, 0.5, 0.0, 1.0), "test");
  EXPECT_EQ(fits.report.specular, 0.0);
  EXPECT_NEAR(fits.least_squares.diffuse + fits.least_squares.specular, 0.5, 1e-9);
  ASSERT_EQ(fits.notes.size(), 2U);  // one per method
  EXPECT_NE(fits.notes[1].find("no highlight above the noise"), std::string::npos);
}

TEST(PhongFit, TooMuchReflectedEnergyIsNoted) {
  const PhongFits fits = fit_phong(sampled(0, 80, 5, 0.95, 2.0, 10.0), "test");
  EXPECT_GT(reflected_share(fits.report), 1.0);
  EXPECT_FALSE(fits.notes.empty());
}

TEST_F(PhongFile, HeadingCommentsBlankLinesAndSpacesAreRead) {
  write(
      "\xEF\xBB\xBF# gonioreflectometer, 1990\r\nangle_deg,reflectance\r\n\r\n0, 0.9\n +10 ,0.5 # "
      "mean of 3\n-80,2e-1");
  const auto points = read_reflectance(path_);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[1].angle_deg, 10.0);
  EXPECT_EQ(points[1].reflectance, 0.5);
  EXPECT_EQ(points[2].angle_deg, -80.0);
}

TEST_F(PhongFile, BrokenRowsAreRefusedWithLineAndColumn) {
  const std::string good = "angle,R\n0,0.9\n40,0.4\n80,0.2\n";
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_NE(refusal(good + "50,zero\n").find(".csv:5:4: \"zero\" is no reflectance"),
            std::string::npos);
  EXPECT_NE(refusal(good + "50,nan\n").find(":5:4"), std::string::npos);
  EXPECT_NE(refusal(good + "200,0.1\n").find(":5:1"), std::string::npos);
  EXPECT_NE(refusal(good + "50,-0.1\n").find(":5:4"), std::string::npos);
  EXPECT_NE(refusal(good + "50\n").find(":5: \"50\" does not have two columns"), std::string::npos);
  EXPECT_NE(refusal(good + "50,1,2\n").find("two columns"), std::string::npos);
  EXPECT_NE(refusal(good + "again,R\n").find(":5:1"), std::string::npos);
  EXPECT_NE(refusal(good + ",0.4\n").find(":5:1: \"\" is no angle"), std::string::npos);
}

TEST_F(PhongFile, DataThatDoNotReachAreRefused) {
  EXPECT_NE(refusal("").find("has 0 different angles"), std::string::npos);
  EXPECT_NE(refusal("0,1\n0,1\n80,0.5\n").find("has 2 different angles"), std::string::npos);
  EXPECT_NE(refusal("5,1\n40,0.5\n80,0.2\n").find("from 5 to 80 degrees"), std::string::npos);
  EXPECT_NE(refusal("0,1\n40,0.5\n70,0.2\n").find("Measure from 0 to 80"), std::string::npos);
  EXPECT_THROW(static_cast<void>(read_reflectance("/nowhere/data.csv")), base::Error);
}

}  // namespace
}  // namespace earthshine::scenes
