// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <vector>

#include "base/files/png_file.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;

std::vector<std::uint8_t> read_back(const std::filesystem::path& path, png_uint_32 format,
                                    int& width, int& height) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0) << png.message;
  png.format = format;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0) << png.message;
  width = static_cast<int>(png.width);
  height = static_cast<int>(png.height);
  return pixels;
}

TEST(Png, EveryByteComesBackInGreyAndColour) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(17 * 5 * channels));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 37);
    write_png(folder / "a.png", 17, 5, channels, pixels);
    int width = 0, height = 0;
    const auto back = read_back(folder / "a.png", channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB,
                                width, height);
    EXPECT_EQ(width, 17);
    EXPECT_EQ(height, 5);
    EXPECT_EQ(back, pixels);
  }
}

TEST(Png, SaysSrgbAndCarriesTextAndSameInputGivesSameBytes) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> pixel = {200};
  const std::vector<std::pair<std::string, std::string>> text = {{"Seed", "7"},
                                                                 {"Scene",
                                                                  "B\xc3\xb6"
                                                                  "schung"}};
  write_png(folder / "a.png", 1, 1, 1, pixel, text);
  write_png(folder / "b.png", 1, 1, 1, pixel, text);
  const std::string bytes = read_bytes(folder / "a.png");
  EXPECT_EQ(bytes, read_bytes(folder / "b.png"));
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  EXPECT_NE(bytes.find(std::string("tEXtSeed\0", 9) + "7"), std::string::npos);
  EXPECT_NE(bytes.find("iTXtScene"), std::string::npos);
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);
}

TEST(Png, WrongSizesAndKeywordsAreRefusedBeforeAFileAppears) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> pixels(4);
  error_of(Blame::Work, [&] { write_png(folder / "a.png", 3, 1, 1, pixels); });
  error_of(Blame::Work, [&] { write_png(folder / "a.png", 2, 1, 2, pixels); });
  error_of(Blame::Work, [&] { write_png(folder / "a.png", 0, 0, 1, {}); });
  error_of(Blame::Work, [&] {
    write_png(folder / "a.png", 4, 1, 1, pixels, {{std::string(80, 'k'), "v"}});
  });
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Png, FullDiskIsReportedAsFailedWork) {
  const std::vector<std::uint8_t> pixel = {200};
  error_of(Blame::Work, [&] { write_png("/dev/full", 1, 1, 1, pixel); });
}

TEST(Png, MissingFolderIsTheCallersMistake) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> pixel = {200};
  error_of(Blame::Input, [&] { write_png(folder / "no/a.png", 1, 1, 1, pixel); });
}

}  // namespace
}  // namespace earthshine::base
