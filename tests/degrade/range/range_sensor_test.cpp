// SPDX-License-Identifier: Apache-2.0
#include "degrade/range/range_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace earthshine::degrade {
namespace {

// Layers of a sensor at the origin, pixel by pixel: a surface at `place` with normal `normal`.
class View {
 public:
  View(int width, int height) : image{width, height, {}} {
    for (const char* name :
         {"range", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "albedo.R", "albedo.G", "albedo.B"}) {
      image.add(name);
    }
    for (float& range : image.channels[0].values) range = std::numeric_limits<float>::infinity();
  }
  void put(std::size_t pixel, const Vec3& place, const Vec3& normal, double albedo = 0.5) {
    image.channels[0].values[pixel] = static_cast<float>(glm::length(place));
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      image.channels[1 + k].values[pixel] = static_cast<float>(normal[c]);
      image.channels[4 + k].values[pixel] = static_cast<float>(place[c]);
      image.channels[7 + k].values[pixel] = static_cast<float>(albedo);
    }
  }
  base::Image image;
};

// A wall that faces the sensor at equal distance everywhere: the inside of a sphere.
View sphere(int width, int height, double radius_m, double albedo = 0.5) {
  View view(width, height);
  for (std::size_t i = 0; i < view.image.pixel_count(); ++i) {
    const double angle = 0.001 * static_cast<double>(i % 1000);
    const Vec3 direction(std::sin(angle), 0.0, std::cos(angle));
    view.put(i, radius_m * direction, -direction, albedo);
  }
  return view;
}

struct RangeMoments {
  double mean = 0.0, deviation = 0.0, count = 0.0;
};
RangeMoments errors(const RangeView& sensed, double exact) {
  RangeMoments m;
  double squares = 0.0;
  for (std::size_t i = 0; i < sensed.image.pixel_count(); ++i) {
    if (sensed.image.find("valid")->values[i] == 0.0F) continue;
    const double error = static_cast<double>(sensed.image.find("range")->values[i]) - exact;
    m.mean += error;
    squares += error * error;
    m.count += 1.0;
  }
  m.mean /= m.count;
  m.deviation = std::sqrt(squares / m.count - m.mean * m.mean);
  return m;
}

TEST(RangeSensor, WithoutFaultsReportsTheExactRange) {
  const View view = sphere(40, 30, 7.25);
  const RangeView sensed = sense_range(view.image, Vec3(0.0), {});
  EXPECT_EQ(sensed.image.find("range")->values, view.image.find("range")->values);
  EXPECT_EQ(sensed.report.returned, 1200U);
}

// Errors are Gaussian with the law's sigma: the standard error of their mean is sigma / sqrt(n), of
// their deviation sigma / sqrt(2 n).
TEST(RangeSensor, NoiseHasMeanZeroAndTheStatedDeviation) {
  RangeSensor sensor;
  sensor.noise_m = 0.002;
  sensor.noise_m_per_m = 0.0005;
  sensor.noise_m_per_m2 = 0.0003;
  for (const double range : {0.5, 2.0, 16.0}) {
    const RangeView sensed = sense_range(sphere(200, 200, range).image, Vec3(0.0), sensor);
    const RangeMoments m = errors(sensed, static_cast<double>(static_cast<float>(range)));
    const double sigma = 0.002 + 0.0005 * range + 0.0003 * range * range;
    EXPECT_EQ(m.count, 40000.0);
    EXPECT_LT(std::abs(m.mean), 4.0 * sigma / std::sqrt(m.count)) << range;
    EXPECT_LT(std::abs(m.deviation - sigma), 4.0 * sigma / std::sqrt(2.0 * m.count)) << range;
  }
}

// Ranges over many steps: the rounding error is uniform in one step q, with the deviation q /
// sqrt(12). Its relative standard error is sqrt(1/5 / n) (fourth moment 9/5).
TEST(RangeSensor, QuantisationErrorIsUniformInOneStep) {
  constexpr double q = 0.01;
  RangeSensor sensor;
  sensor.quantum_m = q;
  View view(200, 200);
  for (std::size_t i = 0; i < view.image.pixel_count(); ++i) {
    view.put(i, Vec3(0, 0, 2.0 + 0.7331 * static_cast<double>(i) / 40000.0), Vec3(0, 0, -1));
  }
  const RangeView sensed = sense_range(view.image, Vec3(0.0), sensor);
  double sum = 0.0, squares = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < view.image.pixel_count(); ++i) {
    const auto reading = static_cast<double>(sensed.image.find("range")->values[i]);
    const double error = reading - static_cast<double>(view.image.find("range")->values[i]);
    EXPECT_NEAR(reading / q, std::round(reading / q), 1e-4);
    sum += error;
    squares += error * error;
    worst = std::max(worst, std::abs(error));
  }
  const double deviation = q / std::sqrt(12.0), n = 40000.0;
  EXPECT_LT(std::abs(sum / n), 4.0 * deviation / std::sqrt(n));
  EXPECT_LT(std::abs(std::sqrt(squares / n) - deviation), 4.0 * deviation * std::sqrt(0.2 / n));
  EXPECT_LE(worst, q / 2 + 1e-6);
}

// A plate tilted by theta about the end of the ray has the incidence theta.
TEST(RangeSensor, TiltedPlateDropsOutBeyondTheLargestIncidence) {
  RangeSensor sensor;
  sensor.max_incidence_deg = 70.0;
  View view(900, 1);
  const auto tilt_deg = [](std::size_t i) { return 0.05 + 0.1 * static_cast<double>(i); };
  for (std::size_t i = 0; i < 900; ++i) {
    const double theta = base::radians(tilt_deg(i));
    view.put(i, Vec3(0, 0, 3), Vec3(std::sin(theta), 0, -std::cos(theta)));
  }
  const RangeView sensed = sense_range(view.image, Vec3(0.0), sensor);
  for (std::size_t i = 0; i < 900; ++i) {
    EXPECT_EQ(sensed.image.find("valid")->values[i], tilt_deg(i) <= 70.0 ? 1.0F : 0.0F)
        << tilt_deg(i);
  }
  EXPECT_EQ(sensed.report.grazing, 200U);
}

// rho cos(theta) / r^2 of a plate of 0.5 that faces the sensor falls to 0.02 at 5 m.
TEST(RangeSensor, DimReturnsAreLostBeyondTheirDistance) {
  RangeSensor sensor;
  sensor.min_signal_per_m2 = 0.02;
  View view(100, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    view.put(i, Vec3(0, 0, 0.05 + 0.1 * static_cast<double>(i)), Vec3(0, 0, -1), 0.5);
  }
  const RangeView sensed = sense_range(view.image, Vec3(0.0), sensor);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(sensed.image.find("valid")->values[i], i < 50 ? 1.0F : 0.0F) << i;
  }
  // At 60 degrees of incidence the same plate is too dim from 5 sqrt(cos 60) = 3.54 m on.
  const Vec3 tilted(std::sin(base::radians(60.0)), 0, -std::cos(base::radians(60.0)));
  View plates(2, 1);
  plates.put(0, Vec3(0, 0, 3.53), tilted, 0.5);
  plates.put(1, Vec3(0, 0, 3.54), tilted, 0.5);
  EXPECT_EQ(sense_range(plates.image, Vec3(0.0), sensor).report.dim, 1U);
}

TEST(RangeSensor, SkyAndWhatIsTooNearOrTooFarGiveNoReturn) {
  RangeSensor sensor;
  sensor.min_range_m = 1.0;
  sensor.max_range_m = 5.0;
  View view(4, 1);  // pixel 0 is sky
  view.put(1, Vec3(0, 0, 0.9), Vec3(0, 0, -1));
  view.put(2, Vec3(0, 0, 3.0), Vec3(0, 0, -1));
  view.put(3, Vec3(0, 0, 5.1), Vec3(0, 0, -1));
  const RangeView sensed = sense_range(view.image, Vec3(0.0), sensor);
  EXPECT_EQ(sensed.image.find("range")->values, (std::vector<float>{0, 0, 3, 0}));
  EXPECT_EQ(sensed.image.find("valid")->values, (std::vector<float>{0, 0, 1, 0}));
  EXPECT_EQ(sensed.report.empty, 1U);
  EXPECT_EQ(sensed.report.out_of_range, 2U);
}

// A measured share p of n readings has the standard error sqrt(p (1 - p) / n).
TEST(RangeSensor, DropoutLosesTheStatedShare) {
  RangeSensor sensor;
  sensor.dropout = 0.1;
  const RangeView sensed = sense_range(sphere(200, 200, 2.0).image, Vec3(0.0), sensor);
  EXPECT_NEAR(static_cast<double>(sensed.report.lost) / 40000.0, 0.1,
              4.0 * std::sqrt(0.09 / 40000.0));
  EXPECT_EQ(sensed.report.returned + sensed.report.lost, 40000U);
}

TEST(RangeSensor, IncidenceIsSeenFromWhereTheSensorStands) {
  RangeSensor sensor;
  sensor.max_incidence_deg = 45.0;
  View view(1, 1);
  view.put(0, Vec3(0, 0, 0), Vec3(0, 0, 1));
  view.image.channels[0].values[0] = 2.0F;
  EXPECT_EQ(sense_range(view.image, Vec3(1, 0, 2), sensor).report.returned, 1U);
  EXPECT_EQ(sense_range(view.image, Vec3(2, 0, 1), sensor).report.grazing, 1U);
}

TEST(RangeSensor, NoiseIsKeyedByPixelSeedAndViewAlone) {
  RangeSensor sensor;
  sensor.noise_m = 0.01;
  const View view = sphere(64, 64, 2.0);
  const auto range = [&](const RangeKey& key) {
    return sense_range(view.image, Vec3(0.0), sensor, key).image.find("range")->values;
  };
  std::vector<float> one, two;
  {
    const base::ThreadLimit limit(1);
    one = range({1, 0});
  }
  {
    const base::ThreadLimit limit(2);
    two = range({1, 0});
  }
  EXPECT_EQ(one, two);
  EXPECT_NE(one, range({2, 0}));
  EXPECT_NE(one, range({1, 1}));
  const RangeView smaller = sense_range(sphere(32, 8, 2.0).image, Vec3(0.0), sensor, {1, 0});
  EXPECT_EQ(smaller.image.find("range")->values[3 * 32 + 5], one[3 * 64 + 5]);
}

TEST(RangeSensor, MissingLayersAreNamed) {
  base::Image image{1, 1, {}};
  image.add("range");
  try {
    static_cast<void>(sense_range(image, Vec3(0.0), {}));
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"N.X\""), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace earthshine::degrade
