// SPDX-License-Identifier: Apache-2.0
// Pictures in files of other programs, and thousands of broken files.
#include "base/files/exr_reader.h"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/files/exr_attributes.h"
#include "base/numbers/random.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

constexpr int width = 37, height = 41;

float value_at(int x, int y) { return static_cast<float>(1 + x + 100 * y); }

std::vector<float> ramp() {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) values.push_back(value_at(x, y));
  }
  return values;
}

// One channel Y of the ramp, in scan lines or in tiles.
void write_ramp(const std::filesystem::path& path, Imf::Compression compression, bool tiled,
                Imf::LineOrder order = Imf::INCREASING_Y) {
  Imf::Header header(width, height);
  header.compression() = compression;
  header.lineOrder() = order;
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> values = ramp();
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
  if (tiled) {
    header.setTileDescription(Imf::TileDescription(16, 8, Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  } else {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
}

// Depth in the first part, the picture in the second.
void write_parts(const std::filesystem::path& path) {
  std::vector<Imf::Header> headers;
  for (const char* name : {"depth", "beauty"}) {
    headers.emplace_back(width, height);
    headers.back().setName(name);
    headers.back().setType(Imf::SCANLINEIMAGE);
    headers.back().channels().insert(name[0] == 'b' ? "Y" : "Z", Imf::Channel(Imf::FLOAT));
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
  std::vector<float> values = ramp();
  for (int p = 0; p < 2; ++p) {
    Imf::OutputPart part(file, p);
    Imf::FrameBuffer buffer;
    buffer.insert(p == 1 ? "Y" : "Z",
                  Imf::Slice::Make(Imf::FLOAT, values.data(), headers[0].dataWindow()));
    part.setFrameBuffer(buffer);
    part.writePixels(height);
  }
}

// Strips of any height, in any order, have the rows of the picture.
TEST(ExrReader, RowsAreTheSameInAnyStrips) {
  const TemporaryFolder folder;
  const auto check = [&](const char* what) {
    ExrReader reader(folder / "a.exr");
    ASSERT_EQ(reader.width(), width) << what;
    ASSERT_EQ(reader.height(), height) << what;
    for (const auto& [first, count] : {std::pair{0, height}, {20, 21}, {0, 20}, {7, 1}, {40, 1}}) {
      const Image strip = reader.read_rows(first, count);
      ASSERT_NE(strip.find("Y"), nullptr);
      for (int y = 0; y < count; ++y) {
        for (int x = 0; x < width; ++x) {
          const auto i = static_cast<std::size_t>(y * width + x);
          ASSERT_EQ(strip.channels[0].values[i], value_at(x, first + y)) << what << first;
        }
      }
    }
  };
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
        Imf::PIZ_COMPRESSION}) {
    write_ramp(folder / "a.exr", compression, false);
    check("lines");
    write_ramp(folder / "a.exr", compression, true);
    check("tiles");
  }
  write_ramp(folder / "a.exr", Imf::ZIP_COMPRESSION, false, Imf::DECREASING_Y);
  check("from the bottom");
  write_parts(folder / "a.exr");
  check("second part");
}

// (1, 1, 1) is white for all primaries with the same white point: R = G = B = 1. A primary of
// another set keeps its luminance and chromaticity.
TEST(ExrReader, OtherPrimariesKeepTheirColour) {
  const TemporaryFolder folder;
  const Imf::Chromaticities p3({0.68F, 0.32F}, {0.265F, 0.69F}, {0.15F, 0.06F}, {0.3127F, 0.329F});
  const auto read = [&](const std::vector<float>& rgb) {
    Imf::Header header(1, 1);
    Imf::addChromaticities(header, p3);
    Imf::FrameBuffer buffer;
    std::vector<float> values = rgb;
    const char* const names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &values[c], header.dataWindow()));
    }
    {
      Imf::OutputFile file((folder / "a.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(1);
    }
    return ExrReader(folder / "a.exr").read_rows(0, 1);
  };
  for (const Channel& channel : read({1, 1, 1}).channels) {
    EXPECT_NEAR(channel.values[0], 1.0F, 1e-4F) << channel.name;
  }
  // Y of the green of P3 (D65) is 0.6917, of its red 0.2290.
  EXPECT_NEAR(luminance_of(read({0, 1, 0}))[0], 0.6917F, 2e-4F);
  EXPECT_NEAR(luminance_of(read({1, 0, 0}))[0], 0.2290F, 2e-4F);
}

TEST(ExrReader, PictureIsFoundByItsNames) {
  using Kind = ExrPicture::Kind;
  EXPECT_EQ(find_picture({"A", "B", "G", "R", "Y"}).kind, Kind::Rgb);
  EXPECT_EQ(find_picture({"X", "Y", "Z"}).kind, Kind::Xyz);
  EXPECT_EQ(find_picture({"Y", "Z"}).kind, Kind::Luminance);
  EXPECT_EQ(find_picture({"P.X", "P.Y", "P.Z"}).kind, Kind::None);
  EXPECT_EQ(find_picture({"Z", "a"}).kind, Kind::None);
  const ExrPicture two = find_picture({"a.B", "a.G", "a.R", "b.Y"});
  EXPECT_EQ(two.kind, Kind::None);
  EXPECT_EQ(two.layers, (std::vector<std::string>{"a", "b"}));
}

// Hundreds of files with one to four changed bytes: a picture or one error, never a crash, an
// endless loop or another exception.
TEST(ExrReader, BrokenBytesGiveAPictureOrAClearError) {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
        Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION}) {
    for (const bool tiled : {false, true}) {
      write_ramp(folder / "a.exr", compression, tiled);
      files.push_back(read_bytes(folder / "a.exr"));
    }
  }
  write_parts(folder / "a.exr");
  files.push_back(read_bytes(folder / "a.exr"));
  const Key key(5, Stream::ReadNoise, 0);
  std::uint64_t draw = 0;
  const auto below = [&](std::size_t most) {
    return static_cast<std::size_t>(uniform(key, draw++) * static_cast<double>(most));
  };
  int pictures = 0, errors = 0;
  for (int round = 0; round < 600; ++round) {
    std::string bytes = files[static_cast<std::size_t>(round) % files.size()];
    // Half of the changes are in the header, where they have most effect.
    const std::size_t span = below(2) == 0 ? 400 : bytes.size();
    for (std::size_t n = 1 + below(4); n > 0; --n) {
      bytes[below(std::min(span, bytes.size()))] = static_cast<char>(below(256));
    }
    if (below(8) == 0) bytes.resize(below(bytes.size()));
    write_bytes(folder / "broken.exr", bytes);
    try {
      ExrReader reader(folder / "broken.exr");
      if (static_cast<std::int64_t>(reader.width()) * reader.height() > 1000000) continue;
      static_cast<void>(reader.read_rows(0, reader.height()));
      ++pictures;
    } catch (const Error& e) {
      EXPECT_EQ(e.blame(), Blame::Input);
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
      ++errors;
    }
  }
  EXPECT_GT(pictures, 50);
  EXPECT_GT(errors, 100);
}

}  // namespace
}  // namespace earthshine::base
