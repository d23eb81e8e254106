// SPDX-License-Identifier: Apache-2.0
// All relations of data and display window: both readers return the pixels in both windows.
#include "base/files/exr_window.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <optional>

#include "base/error.h"
#include "base/files/exr_reader.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using Box = Imath::Box2i;
using test::error_of;
using test::TemporaryFolder;

// A pixel's value encodes its position in the plane of both windows.
float value_at(int x, int y) { return static_cast<float>(1000 * y + x + 100000); }

void write(const std::filesystem::path& path, const Box& data, const Box& display, bool tiled) {
  Imf::Header header(display, data);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> values;
  for (int y = data.min.y; y <= data.max.y; ++y) {
    for (int x = data.min.x; x <= data.max.x; ++x) values.push_back(value_at(x, y));
  }
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), data));
  if (tiled) {
    header.setTileDescription(Imf::TileDescription(4, 3, Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    return;
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(data.max.y - data.min.y + 1);
}

void expect_picture(const Image& image, const Box& wanted, const std::string& what) {
  ASSERT_EQ(image.width, wanted.max.x - wanted.min.x + 1) << what;
  ASSERT_EQ(image.height, wanted.max.y - wanted.min.y + 1) << what;
  std::size_t i = 0;
  for (int y = wanted.min.y; y <= wanted.max.y; ++y) {
    for (int x = wanted.min.x; x <= wanted.max.x; ++x) {
      ASSERT_EQ(image.find("Y")->values[i++], value_at(x, y)) << what << ' ' << x << ' ' << y;
    }
  }
}

struct Relation {
  const char* name;
  Box data, picture;
  bool crop;
};

// The display window is (0, 0) to (9, 7), also moved by (-30, 50).
const Box display({0, 0}, {9, 7});
const Relation relations[] = {
    {"the same", {{0, 0}, {9, 7}}, {{0, 0}, {9, 7}}, false},
    {"overscan on all sides", {{-3, -2}, {12, 11}}, {{0, 0}, {9, 7}}, false},
    {"overscan left and right", {{-5, 0}, {14, 7}}, {{0, 0}, {9, 7}}, false},
    {"overscan above and below", {{0, -4}, {9, 9}}, {{0, 0}, {9, 7}}, false},
    {"overscan left alone", {{-1, 0}, {9, 7}}, {{0, 0}, {9, 7}}, false},
    {"overscan below alone", {{0, 0}, {9, 8}}, {{0, 0}, {9, 7}}, false},
    {"one row short", {{0, 0}, {9, 6}}, {{0, 0}, {9, 6}}, true},
    {"overscan but one row short", {{-3, -2}, {12, 6}}, {{0, 0}, {9, 6}}, true},
    {"one column short", {{1, 0}, {9, 7}}, {{1, 0}, {9, 7}}, true},
    {"inside", {{2, 3}, {4, 5}}, {{2, 3}, {4, 5}}, true},
    {"overscan left, crop right", {{-4, 0}, {5, 7}}, {{0, 0}, {5, 7}}, true},
    {"shifted", {{3, 2}, {12, 9}}, {{3, 2}, {9, 7}}, true},
    {"one pixel in common", {{9, 7}, {40, 40}}, {{9, 7}, {9, 7}}, true},
    {"a cross", {{4, -5}, {5, 20}}, {{4, 0}, {5, 7}}, true}};

TEST(ExrWindow, ThePictureIsWhatLiesInBothWindows) {
  const TemporaryFolder folder;
  const auto path = folder / "a.exr";
  for (const Relation& relation : relations) {
    for (const Imath::V2i& shift : {Imath::V2i(0, 0), Imath::V2i(-30, 50)}) {
      for (const bool tiled : {false, true}) {
        const auto moved = [&](const Box& box) { return Box(box.min + shift, box.max + shift); };
        const Box wanted = moved(relation.picture);
        write(path, moved(relation.data), moved(display), tiled);
        ExrReader reader(path);
        ASSERT_EQ(reader.height(), wanted.max.y - wanted.min.y + 1) << relation.name;
        expect_picture(reader.read_rows(0, reader.height()), wanted, relation.name);
        const int last = reader.height() - 1;
        expect_picture(reader.read_rows(last, 1),
                       {{wanted.min.x, wanted.max.y}, {wanted.max.x, wanted.max.y}}, relation.name);
        const ExrFile whole_file = read_exr(path);
        expect_picture(whole_file.image, wanted, relation.name);
        for (const ExrHeader::Whole& whole : {reader.header().whole, whole_file.header.whole}) {
          EXPECT_EQ(whole.columns, relation.crop ? 10 : 0) << relation.name;
          EXPECT_EQ(whole.rows, relation.crop ? 8 : 0) << relation.name;
          EXPECT_EQ(whole.x, relation.crop ? relation.picture.min.x : 0) << relation.name;
          EXPECT_EQ(whole.y, relation.crop ? relation.picture.min.y : 0) << relation.name;
        }
      }
    }
  }
}

TEST(ExrWindow, WindowsWithoutACommonPixelAreRefused) {
  const TemporaryFolder folder;
  for (const Box& data : {Box({10, 0}, {19, 7}), Box({0, -8}, {9, -1}), Box({-3, 20}, {-1, 21})}) {
    write(folder / "a.exr", data, display, false);
    for (const std::string& message :
         {error_of(Blame::Input, [&] { static_cast<void>(read_exr(folder / "a.exr")); }),
          error_of(Blame::Input, [&] { const ExrReader reader(folder / "a.exr"); })}) {
      EXPECT_NE(message.find("outside of the picture"), std::string::npos) << message;
      EXPECT_NE(message.find("(0, 0) to (9, 7)"), std::string::npos) << message;
    }
  }
}

// A crop that is read and written again keeps its position.
TEST(ExrWindow, ACropStaysACrop) {
  const TemporaryFolder folder;
  write(folder / "a.exr", {{-4, 2}, {5, 6}}, display, false);
  const ExrFile once = read_exr(folder / "a.exr");
  write_exr(folder / "b.exr", once.image, once.header);
  const ExrFile again = read_exr(folder / "b.exr");
  EXPECT_EQ(again.header.whole.columns, 10);
  EXPECT_EQ(again.header.whole.y, 2);
  expect_picture(again.image, {{0, 2}, {5, 6}}, "written again");
}

// Pixels of the overscan are not checked; pixels of the picture are.
TEST(ExrWindow, NotANumberInTheOverscanIsNoFault) {
  const TemporaryFolder folder;
  Image image{4, 3, {}};
  std::vector<float>& values = image.add("Y");
  values = {9, 9, 9, std::nanf(""), 1, 2, 3, 9, 1, 2, 3, 9};
  const auto with_display = [&](const Box& box) {
    Imf::Header header(box, Box({0, 0}, {3, 2}));
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
    Imf::OutputFile file((folder / "a.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(3);
  };
  with_display({{0, 1}, {2, 2}});
  EXPECT_EQ(ExrReader(folder / "a.exr").read_rows(0, 2).find("Y")->values,
            (std::vector<float>{1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(read_exr(folder / "a.exr").image.width, 3);
  with_display({{1, 0}, {3, 2}});  // the NaN is the third pixel of the picture's first row
  EXPECT_NE(error_of(Blame::Input,
                     [&] { static_cast<void>(ExrReader(folder / "a.exr").read_rows(0, 2)); })
                .find("pixel (2, 0)"),
            std::string::npos);
}

}  // namespace
}  // namespace earthshine::base
