// SPDX-License-Identifier: Apache-2.0
// The path tracer against pictures of other programs (tests/data/README.md: Tungsten and Cycles,
// unlimited bounces).
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "raytrace/paths/path_tracer.h"
#include "scenes/read/scene_file.h"
#include "tests/support/agreement.h"
#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

constexpr int reference_edge = 256, edge = 64;
constexpr int block = reference_edge / edge;

// Luminance of a colour PFM of 256 x 256 (little-endian, bottom row first), averaged over blocks.
std::vector<double> read_reference(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind, width, height, scale;
  file >> kind >> width >> height >> scale;
  file.get();
  EXPECT_EQ(kind + width + height, "PF256256");
  std::vector<std::array<float, 3>> pixels(reference_edge * reference_edge);
  file.read(reinterpret_cast<char*>(pixels.data()),
            static_cast<std::streamsize>(pixels.size() * sizeof(pixels[0])));
  EXPECT_TRUE(file.good());
  std::vector<double> luminance(edge * edge);
  for (int y = 0; y < reference_edge; ++y) {
    for (int x = 0; x < reference_edge; ++x) {
      const auto& p =
          pixels[static_cast<std::size_t>((reference_edge - 1 - y) * reference_edge + x)];
      luminance[static_cast<std::size_t>(y / block * edge + x / block)] +=
          base::luminance(Rgb(p[0], p[1], p[2])) / (block * block);
    }
  }
  return luminance;
}

struct Case {
  const char* scene;
  int paths;
  double noise;     // of the reference, relative RMS per pixel
  double programs;  // relative difference of the programs' means
};

class Reference : public testing::TestWithParam<Case> {};

TEST_P(Reference, PathTracerDrawsWhatOtherPathTracersDraw) {
  const std::filesystem::path folder =
      std::filesystem::path(EARTHSHINE_SOURCE_DIR) / "tests/data/peers" / GetParam().scene;
  const std::vector<double> reference = read_reference(folder / "reference-256.pfm");
  const scenes::Scene scene = scenes::read_scene(folder / "scene.toml");
  const tests::Prepared prepared(scene);
  raytrace::PathOptions options;
  options.columns = options.rows = edge;
  options.paths_per_pixel = GetParam().paths;
  const tests::Measured traced =
      tests::measured(raytrace::trace_paths(prepared, scene.cameras.front(), options).image);
  const auto n = static_cast<double>(reference.size());
  double mean = 0.0, expected = 0.0, variance = 0.0;
  for (std::size_t p = 0; p < reference.size(); ++p) {
    mean += traced.mean[p] / n;
    expected += reference[p] / n;
    variance += traced.variance[p] / (n * n);
  }
  const double std_error = std::sqrt(variance) / expected;
  EXPECT_NEAR(mean / expected, 1.0, 4.0 * std_error + GetParam().programs);
  EXPECT_LT(4.0 * std_error, 0.02);

  // Pixel by pixel: the mean squared difference is the sum of the two variances; the variance of
  // the reference is as stated. Its figure excludes lamps, which have no noise; the factor 1.5
  // allows for uneven noise.
  double squares = 0.0;
  for (std::size_t p = 0; p < reference.size(); ++p) {
    squares += std::pow(traced.mean[p] - reference[p], 2) / n;
  }
  const double of_reference = std::pow(GetParam().noise * expected / block, 2);
  EXPECT_LT(squares, 1.5 * (variance * n + of_reference));
  EXPECT_GT(squares, (variance * n + of_reference) / 1.5);
}
INSTANTIATE_TEST_SUITE_P(Peers, Reference,
                         testing::Values(Case{"bay", 256, 0.0071, 0.0005},
                                         Case{"cornell", 256, 0.0107, 0.0008},
                                         Case{"furnace", 32, 0.0196, 0.002}),
                         [](const auto& test) { return test.param.scene; });

}  // namespace
}  // namespace earthshine
