// SPDX-License-Identifier: Apache-2.0
// Files of other programs, and files that no program should write.
#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include <utility>
#include <vector>

#include "base/files/exr_file.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

// 5 x 3 pixels with the values 1 to 15 in every channel.
std::vector<float> counting() {
  std::vector<float> values(15);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i + 1);
  return values;
}

template <class T>
void write_scanlines(const std::filesystem::path& path, Imf::PixelType type,
                     const std::vector<std::string>& names, float white = 0.0F) {
  const Imath::Box2i window({0, 0}, {4, 2});
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
  if (white > 0.0F) Imf::addWhiteLuminance(header, white);
  std::vector<T> values;
  for (float v : counting()) values.push_back(static_cast<T>(v));
  Imf::FrameBuffer buffer;
  for (const std::string& name : names) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice::Make(type, values.data(), window));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(3);
}

TEST(ExrReading, HalfFloatAndUintBecomeFloat) {
  const TemporaryFolder folder;
  write_scanlines<half>(folder / "half.exr", Imf::HALF, {"Y"});
  write_scanlines<float>(folder / "float.exr", Imf::FLOAT, {"Y"});
  write_scanlines<unsigned>(folder / "uint.exr", Imf::UINT, {"Y"});
  for (const char* name : {"half.exr", "float.exr", "uint.exr"}) {
    const Image image = read_exr(folder / name).image;
    ASSERT_NE(image.find("Y"), nullptr);
    EXPECT_EQ(image.find("Y")->values, counting()) << name;
  }
}

TEST(ExrReading, ChannelsBesideTheColoursAreReadToo) {
  const TemporaryFolder folder;
  write_scanlines<float>(folder / "a.exr", Imf::FLOAT, {"R", "G", "B", "A", "id"});
  const Image image = read_exr(folder / "a.exr").image;
  EXPECT_EQ(image.width, 5);
  EXPECT_EQ(image.height, 3);
  for (const char* name : {"R", "A", "id"}) EXPECT_EQ(image.find(name)->values, counting());
}

TEST(ExrReading, WhiteLuminanceScalesColourOnly) {
  const TemporaryFolder folder;
  write_scanlines<float>(folder / "a.exr", Imf::FLOAT, {"R", "G", "B", "Z"}, 250.0F);
  const Image image = read_exr(folder / "a.exr").image;
  EXPECT_EQ(image.find("G")->values[14], 15.0F * 250.0F);
  EXPECT_EQ(image.find("Z")->values[14], 15.0F);
}

TEST(ExrReading, TiledAndMipmappedFilesAreReadAtFullSize) {
  const TemporaryFolder folder;
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
    {
      Imf::Header header(5, 3);
      header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
      header.setTileDescription(Imf::TileDescription(2, 2, mode));
      Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
      for (int level = 0; level < file.numLevels(); ++level) {
        std::vector<float> values = counting();
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                      sizeof(float), 5 * sizeof(float)));
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
      }
    }
    const Image image = read_exr(folder / "a.exr").image;
    EXPECT_EQ(image.find("Y")->values, counting());
  }
}

TEST(ExrReading, FirstPartOfAMultiPartFileIsThePicture) {
  const TemporaryFolder folder;
  {
    std::vector<Imf::Header> headers;
    for (const char* name : {"beauty", "other"}) {
      headers.emplace_back(5, 3);
      headers.back().setName(name);
      headers.back().setType(Imf::SCANLINEIMAGE);
      headers.back().channels().insert(name[0] == 'b' ? "Y" : "Z", Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
    std::vector<float> values = counting();
    for (int p = 0; p < 2; ++p) {
      Imf::OutputPart part(file, p);
      Imf::FrameBuffer buffer;
      buffer.insert(p == 0 ? "Y" : "Z",
                    Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                               5 * sizeof(float)));
      part.setFrameBuffer(buffer);
      part.writePixels(3);
    }
  }
  const ExrFile file = read_exr(folder / "a.exr");
  EXPECT_EQ(file.image.channels.size(), 1U);
  EXPECT_EQ(file.image.find("Y")->values, counting());
}

TEST(ExrReading, DeepSubsampledAndOversizedFilesAreRefusedByName) {
  const TemporaryFolder folder;
  const auto header_only = [&](const Imf::Header& header) {  // the file has no pixels
    Imf::OutputFile file((folder / "a.exr").c_str(), header);
  };
  const auto message = [&] {
    return error_of(Blame::Input, [&] { return read_exr(folder / "a.exr"); });
  };
  {
    Imf::Header header(5, 3);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::DeepScanLineOutputFile file((folder / "a.exr").c_str(), header);
  }
  EXPECT_NE(message().find("deep"), std::string::npos);

  Imf::Header chroma(4, 4);
  chroma.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  header_only(chroma);
  EXPECT_NE(message().find("\"RY\""), std::string::npos);

  Imf::Header wide(20000, 1);
  wide.channels().insert("Y", Imf::Channel(Imf::HALF));
  header_only(wide);
  EXPECT_NE(message().find("20000 x 1 pixels"), std::string::npos);

  Imf::Header many(16384, 16384);
  for (int c = 0; c < 5; ++c) many.channels().insert("c" + std::to_string(c), Imf::Channel());
  header_only(many);
  EXPECT_NE(message().find("5 channels"), std::string::npos);
}

TEST(ExrReading, MissingFileFolderAndOtherFormatsAreNamed) {
  const TemporaryFolder folder;
  const auto message = [&](const std::filesystem::path& path) {
    return error_of(Blame::Input, [&] { return read_exr(path); });
  };
  EXPECT_NE(message(folder / "none.exr").find("no such file"), std::string::npos);
  EXPECT_NE(message(folder.path()).find("is a folder"), std::string::npos);
  write_bytes(folder / "text.exr", "this is no picture");
  message(folder / "text.exr");
  write_bytes(folder / "empty.exr", "");
  message(folder / "empty.exr");
}

TEST(ExrReading, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  write_scanlines<float>(folder / "whole.exr", Imf::FLOAT, {"R", "G", "B"});
  const std::string whole = read_bytes(folder / "whole.exr");
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    write_bytes(folder / "cut.exr", whole.substr(0, size));
    error_of(Blame::Input, [&] { return read_exr(folder / "cut.exr"); });
  }
}

TEST(ExrReading, AnyFlippedByteGivesAPictureOrAClearError) {
  const TemporaryFolder folder;
  write_scanlines<float>(folder / "whole.exr", Imf::FLOAT, {"R", "G", "B"});
  const std::string whole = read_bytes(folder / "whole.exr");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0xff);
    write_bytes(folder / "flipped.exr", bytes);
    try {
      const ExrFile file = read_exr(folder / "flipped.exr");
      EXPECT_GE(file.image.width, 1);
    } catch (const Error& e) {
      EXPECT_EQ(e.blame(), Blame::Input);
    }
  }
}

}  // namespace
}  // namespace earthshine::base
