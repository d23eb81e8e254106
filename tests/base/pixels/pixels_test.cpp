// SPDX-License-Identifier: Apache-2.0
#include "base/pixels/pixels.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/files/png_file.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

std::string refusal(std::string_view bytes) {
  try {
    static_cast<void>(read_pixels(bytes, "a.png"));
  } catch (const Error& error) {
    EXPECT_EQ(error.blame(), Blame::Input);
    return error.what();
  }
  return "was not refused";
}

TEST(Pixels, JpegComesAsItWasWritten) {
  const Pixels pixels =
      read_pixels(bytes_of(std::filesystem::path(EARTHSHINE_TEST_DATA) / "red-blue.jpg"), "a.jpg");
  ASSERT_EQ(pixels.width, 16);
  ASSERT_EQ(pixels.height, 8);
  const auto at = [&](int x, int y, int c) {
    return int{pixels.rgba[std::size_t(4 * (16 * y + x) + c)]};
  };
  // Quality 95: the colours of the two flat blocks are accurate to a few steps.
  EXPECT_NEAR(at(2, 3, 0), 250, 4);
  EXPECT_NEAR(at(2, 3, 2), 10, 4);
  EXPECT_NEAR(at(13, 6, 0), 10, 4);
  EXPECT_NEAR(at(13, 6, 2), 250, 4);
  EXPECT_EQ(at(0, 0, 3), 255);
}

TEST(Pixels, PngComesAsItWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb{1, 2, 3, 250, 251, 252};
  write_png(folder / "a.png", 2, 1, 3, rgb);
  const Pixels pixels = read_pixels(bytes_of(folder / "a.png"), "a.png");
  EXPECT_EQ(pixels.rgba, (std::vector<std::uint8_t>{1, 2, 3, 255, 250, 251, 252, 255}));
}

TEST(Pixels, BrokenPicturesAreRefused) {
  EXPECT_NE(refusal("GIF89a").find("neither a PNG nor a JPEG"), std::string::npos);
  EXPECT_NE(refusal("").find("neither"), std::string::npos);
  const std::string jpeg = bytes_of(std::filesystem::path(EARTHSHINE_TEST_DATA) / "red-blue.jpg");
  const test::TemporaryFolder folder;
  write_png(folder / "a.png", 2, 1, 3, std::vector<std::uint8_t>(6, 7));
  const std::string png = bytes_of(folder / "a.png");
  for (std::size_t cut = 8; cut < png.size() - 12; cut += 5) {
    EXPECT_NE(refusal(png.substr(0, cut)).find("broken PNG"), std::string::npos) << cut;
  }
  for (std::size_t cut = 2; cut < jpeg.size() - 2; cut += 37) {
    EXPECT_NE(refusal(jpeg.substr(0, cut)).find("broken JPEG"), std::string::npos) << cut;
  }
  // Without the end marker only: libjpeg warns once, and all pixels are present.
  EXPECT_NE(refusal(jpeg.substr(0, jpeg.size() - 2)).find("cut short"), std::string::npos);
}

TEST(Pixels, EdgesAreFromOneToTheLargest) {
  constexpr std::uint64_t most = largest_picture_edge_px;
  EXPECT_NO_THROW(check_size(most, 1, "a.png"));
  EXPECT_NO_THROW(check_size(1, most, "a.png"));
  EXPECT_THROW(check_size(most + 1, 1, "a.png"), Error);
  EXPECT_THROW(check_size(1, most + 1, "a.png"), Error);
  EXPECT_THROW(check_size(0, 1, "a.png"), Error);
  EXPECT_THROW(check_size(1, 0, "a.png"), Error);
}

}  // namespace
}  // namespace earthshine::base
