// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/files/png_file.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

struct Kind {
  int colour_type;
  int bit_depth;
  int interlace;
};

// 5 x 3 pixels of this kind. Byte k of the rows is 40 k + 7 (mod 256). Palette: entry i is (i, 2 i,
// 255 - i), and entry 1 is half transparent.
std::string encoded(const Kind& kind, int width = 5, int height = 3) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
               kind.bit_depth, kind.colour_type, kind.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (int i = 0; i < 1 << kind.bit_depth && i < 256; ++i) {
    palette.push_back(
        {static_cast<png_byte>(i), static_cast<png_byte>(2 * i), static_cast<png_byte>(255 - i)});
  }
  png_byte alphas[2] = {255, 128};
  if (kind.colour_type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    png_set_tRNS(png, info, alphas, 2, nullptr);
  }
  png_write_info(png, info);
  const std::size_t stride = png_get_rowbytes(png, info);
  std::vector<png_byte> data(stride * static_cast<std::size_t>(height));
  for (std::size_t k = 0; k < data.size(); ++k) data[k] = static_cast<png_byte>(40 * k + 7);
  std::vector<png_byte*> rows;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    rows.push_back(data.data() + y * stride);
  }
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

Picture8 read(const Kind& kind) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.png", encoded(kind));
  return read_png(folder / "a.png");
}

int byte_at(int k) { return (40 * k + 7) % 256; }

TEST(PngReading, RgbComesBackWithAndWithoutInterlace) {
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    const Picture8 picture = read({PNG_COLOR_TYPE_RGB, 8, interlace});
    EXPECT_EQ(picture.width, 5);
    EXPECT_EQ(picture.height, 3);
    ASSERT_EQ(picture.rgb.size(), 45U);
    for (int k = 0; k < 45; ++k) EXPECT_EQ(picture.rgb[static_cast<std::size_t>(k)], byte_at(k));
  }
}

TEST(PngReading, GreyIsRepeatedAndSmallDepthsAreStretched) {
  const Picture8 eight = read({PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_NONE});
  for (int k = 0; k < 45; ++k) EXPECT_EQ(eight.rgb[static_cast<std::size_t>(k)], byte_at(k / 3));
  // The first byte is 7 = 0000 0111. In one bit per pixel: five black pixels. In two bits: 0, 0, 1,
  // 3.
  const Picture8 one = read({PNG_COLOR_TYPE_GRAY, 1, PNG_INTERLACE_NONE});
  EXPECT_EQ(one.rgb[0], 0);
  const Picture8 two = read({PNG_COLOR_TYPE_GRAY, 2, PNG_INTERLACE_NONE});
  EXPECT_EQ(two.rgb[3 * 2], 85);
  EXPECT_EQ(two.rgb[3 * 3], 255);
}

TEST(PngReading, SixteenBitsAreRoundedToEight) {
  // Big-endian pairs v: the nearest to v 255 / 65535, which libpng may miss by less than one.
  const Picture8 picture = read({PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_ADAM7});
  for (int k = 0; k < 45; ++k) {
    const double exact = (byte_at(2 * k) * 256.0 + byte_at(2 * k + 1)) / 257.0;
    EXPECT_NEAR(picture.rgb[static_cast<std::size_t>(k)], exact, 0.51);
  }
}

TEST(PngReading, TransparencyLiesOnBlack) {
  const Picture8 rgba = read({PNG_COLOR_TYPE_RGB_ALPHA, 8, PNG_INTERLACE_NONE});
  for (int p = 0; p < 15; ++p) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(rgba.rgb[static_cast<std::size_t>(3 * p + c)],
                  byte_at(4 * p + c) * byte_at(4 * p + 3) / 255.0, 0.51);
    }
  }
  // Palette of 8 bits: byte k is the entry; no pixel has entry 1. Palette of 1 bit: 7 = 0000 0111
  // has entries 0 and 1 in the second byte, 47 = 0010 1111.
  const Picture8 palette = read({PNG_COLOR_TYPE_PALETTE, 8, PNG_INTERLACE_NONE});
  EXPECT_EQ(palette.rgb[0], 7);
  EXPECT_EQ(palette.rgb[1], 14);
  EXPECT_EQ(palette.rgb[2], 248);
  const Picture8 bits = read({PNG_COLOR_TYPE_PALETTE, 1, PNG_INTERLACE_NONE});
  const std::size_t second_row_third = 3 * (5 + 2);
  EXPECT_EQ(bits.rgb[second_row_third + 2], 254 * 128 / 255);
  EXPECT_EQ(bits.rgb[2], 255);
}

TEST(PngReading, WhatWriteWroteComesBack) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> pixels(300);
  for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = static_cast<std::uint8_t>(7 * k);
  write_png(folder / "a.png", 10, 10, 3, pixels);
  EXPECT_EQ(read_png(folder / "a.png").rgb, pixels);
}

TEST(PngReading, EveryTruncationAndEveryFlippedByteIsOneClearErrorOrAPicture) {
  const TemporaryFolder folder;
  const std::string whole = encoded({PNG_COLOR_TYPE_RGB, 8, PNG_INTERLACE_ADAM7});
  const auto path = folder / "a.png";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_bytes(path, whole.substr(0, size));
    const std::string message = error_of(Blame::Input, [&] { (void)read_png(path); });
    EXPECT_NE(message.find("a.png: "), std::string::npos) << size;
    EXPECT_NE(message.find("PNG file"), std::string::npos) << message;
  }
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string broken = whole;
    broken[at] = static_cast<char>(broken[at] ^ 0x55);
    write_bytes(path, broken);
    try {
      EXPECT_EQ(read_png(path).rgb.size(), 45U);  // e.g. a changed bit in the name of an optional
                                                  // chunk
    } catch (const Error& error) {
      EXPECT_EQ(error.blame(), Blame::Input);
    }
  }
}

TEST(PngReading, OtherFilesFoldersAndHugePicturesAreRefused) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.png", "\xFF\xD8\xFF\xE0 a photograph");
  EXPECT_NE(
      error_of(Blame::Input, [&] { (void)read_png(folder / "a.png"); }).find("not a PNG file"),
      std::string::npos);
  EXPECT_NE(
      error_of(Blame::Input, [&] { (void)read_png(folder / "none.png"); }).find("No such file"),
      std::string::npos);
  EXPECT_NE(error_of(Blame::Input, [&] { (void)read_png(folder.path()); }).find("is a folder"),
            std::string::npos);
  write_bytes(folder / "wide.png", encoded({PNG_COLOR_TYPE_GRAY, 1, PNG_INTERLACE_NONE}, 16385, 1));
  EXPECT_NE(
      error_of(Blame::Input, [&] { (void)read_png(folder / "wide.png"); }).find("16385 x 1 pixels"),
      std::string::npos);
}

}  // namespace
}  // namespace earthshine::base
