// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/radiance_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/settings/presets.h"
#include "tests/base/temporary_folder.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

// A colour picture with some negative light; no grid divides its size.
base::Image scattered(int width, int height) {
  base::Image image = base::make_rgb_image(width, height);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double t = std::fmod(static_cast<double>(i * 3 + c) * 0.6180339887498949, 1.0);
      image.channels[c].values[i] = static_cast<float>(100.0 * t - 5.0);
    }
  }
  return image;
}

RadianceFile read(const std::filesystem::path& path, const degrade::Setup& setup,
                  std::size_t most_pixels) {
  base::ExrReader reader(path);
  return read_radiance(reader, setup, most_pixels);
}

// The same sums in the same order: the chain gives the same bytes for the averages as for the
// picture.
TEST(RadianceFile, StripsGiveTheBytesOfTheWholePicture) {
  const test::TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{733, 1201}, {1500, 611}, {97, 61}}) {
    base::write_exr(folder / "a.exr", scattered(width, height));
    for (const char* name : {"ccd-colour", "sit-monochrome"}) {
      const Preset& preset = *find_preset(name);
      const degrade::Setup setup{preset.camera, preset.monitor, {}};
      const RadianceFile whole = read(folder / "a.exr", setup, most_pixels_kept);
      const RadianceFile strips = read(folder / "a.exr", setup, 0);
      EXPECT_FALSE(whole.averaged);
      ASSERT_TRUE(strips.averaged);
      EXPECT_EQ(strips.columns, width);
      const Result a = degrade(whole.image, setup.camera, setup.monitor, setup.options);
      const Result b = degrade(strips.image, setup.camera, setup.monitor, setup.options);
      EXPECT_EQ(a.pixels, b.pixels) << name << " " << width << " x " << height;
      EXPECT_EQ(a.report.negative_pixels, strips.negative_pixels);
      EXPECT_EQ(b.report.negative_pixels, 0U);
    }
  }
}

TEST(RadianceFile, WithoutTheSensorsGridThePictureKeepsItsSize) {
  const test::TemporaryFolder folder;
  base::write_exr(folder / "a.exr", scattered(31, 17));
  degrade::Setup setup;
  setup.options.off = {"sensor-grid"};
  EXPECT_EQ(read(folder / "a.exr", setup, 0).image.width, 31);
}

}  // namespace
}  // namespace earthshine::degrade
