// SPDX-License-Identifier: Apache-2.0
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/files/exr_file.h"
#include "base/free_memory.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;

Image pattern(int width, int height) {
  Image image = make_rgb_image(width, height);
  image.add("light_sun.G");
  image.add("Z");
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
      image.channels[c].values[i] =
          std::ldexp(1.0F + 1e-6F * static_cast<float>(i), static_cast<int>(c * 7));
    }
  }
  image.channels[0].values[0] = -3.25F;
  return image;
}

TEST(Exr, EveryBitOfEveryChannelComesBack) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {33, 1}, {1, 40}, {37, 35}}) {
    const Image image = pattern(width, height);
    write_exr(folder / "a.exr", image);
    const Image back = read_exr(folder / "a.exr").image;
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    ASSERT_EQ(back.channels.size(), image.channels.size());
    for (const Channel& channel : image.channels) {
      ASSERT_NE(back.find(channel.name), nullptr) << channel.name;
      EXPECT_EQ(back.find(channel.name)->values, channel.values) << channel.name;
    }
  }
}

// Halves have 10 binary digits after the point, from 2^-14 on. Values that fit are read back bit
// for bit; others become the nearest half, with a relative error of at most 2^-11. Other channels
// are unchanged.
TEST(Exr, NamedChannelsAreHalvesAndOthersAreNot) {
  const TemporaryFolder folder;
  Image image = pattern(37, 35);
  std::vector<float>& exact = image.add("exact");
  for (std::size_t i = 0; i < exact.size(); ++i) {
    exact[i] =
        std::ldexp(1.0F + static_cast<float>(i % 1024) / 1024.0F, static_cast<int>(i % 29) - 14);
  }
  ExrHeader header;
  header.half_channels = {"exact", "B"};
  write_exr(folder / "a.exr", image, header);
  const Image back = read_exr(folder / "a.exr").image;
  for (const Channel& channel : image.channels) {
    if (channel.name == "B") continue;
    EXPECT_EQ(back.find(channel.name)->values, channel.values) << channel.name;
  }
  const std::vector<float>&sent = image.find("B")->values, &read = back.find("B")->values;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_NEAR(read[i], sent[i], std::ldexp(sent[i], -11));
  }
  const Imf::InputFile file((folder / "a.exr").string().c_str());
  EXPECT_EQ(file.header().channels()["exact"].type, Imf::HALF);
  EXPECT_EQ(file.header().channels()["Z"].type, Imf::FLOAT);
}

TEST(Exr, HeaderSaysCandelaRec709FloatAndZip) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", pattern(4, 4));
  const Imf::InputFile file((folder / "a.exr").c_str());
  const Imf::Header& header = file.header();
  EXPECT_EQ(Imf::whiteLuminance(header), 1.0F);
  EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
  EXPECT_EQ(header.channels().findChannel("R")->type, Imf::FLOAT);
  const Imf::Chromaticities primaries = Imf::chromaticities(header);
  EXPECT_FLOAT_EQ(primaries.red.x, 0.64F);
  EXPECT_FLOAT_EQ(primaries.green.y, 0.60F);
  EXPECT_FLOAT_EQ(primaries.blue.x, 0.15F);
  EXPECT_FLOAT_EQ(primaries.white.x, 0.3127F);
  EXPECT_FALSE(Imf::hasCapDate(header));
}

TEST(Exr, AttributesSurviveReadingAndWritingAgain) {
  const TemporaryFolder folder;
  const ExrHeader header{{{"scene", "bay.toml"}, {"note", ""}}, {{"seed", 7.0F}, {"x", -1e-3F}}};
  write_exr(folder / "a.exr", pattern(2, 2), header);
  const ExrFile once = read_exr(folder / "a.exr");
  EXPECT_EQ(once.header.text, (std::vector<std::pair<std::string, std::string>>{
                                  {"note", ""}, {"scene", "bay.toml"}}));
  EXPECT_EQ(once.header.numbers, (std::vector<std::pair<std::string, float>>{
                                     {"screenWindowWidth", 1.0F}, {"seed", 7.0F}, {"x", -1e-3F}}));
  write_exr(folder / "b.exr", once.image, once.header);
  EXPECT_EQ(read_bytes(folder / "a.exr"), read_bytes(folder / "b.exr"));
}

TEST(Exr, APartOfAPictureSaysWhereItLies) {
  const TemporaryFolder folder;
  ExrHeader header;
  header.whole = {20, 10, 5, 3};
  const Image part = pattern(4, 2);
  write_exr(folder / "a.exr", part, header);
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {19, 9}));
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({5, 3}, {8, 4}));
  const ExrFile back = read_exr(folder / "a.exr");
  ASSERT_EQ(back.image.width, 4);
  const std::string first = part.channels.front().name;  // files have channels in alphabetical
                                                         // order
  EXPECT_EQ(back.image.find(first)->values, part.channels.front().values);
}

TEST(Exr, MatricesKeepTheirRowsAndTheScreenWindowItsWidth) {
  const TemporaryFolder folder;
  ExrMatrix matrix;
  for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] = static_cast<float>(k) + 0.5F;
  write_exr(folder / "a.exr", pattern(2, 2),
            {{}, {{"screenWindowWidth", 1.25F}, {"focus", 8.0F}}, {{"worldToNDC", matrix}}});
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_EQ(Imf::worldToNDC(file.header())[1][2], 6.5F);  // row 1, column 2
  EXPECT_EQ(file.header().screenWindowWidth(), 1.25F);
  EXPECT_EQ(Imf::focus(file.header()), 8.0F);
  const ExrFile back = read_exr(folder / "a.exr");
  ASSERT_EQ(back.header.matrices.size(), 1U);
  EXPECT_EQ(back.header.matrices[0].first, "worldToNDC");
  EXPECT_EQ(back.header.matrices[0].second, matrix);
}

TEST(Exr, DepthMayBeInfiniteColourMayNot) {
  const TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  Image image = pattern(5, 3);
  image.channels[4].values[3] = infinity;
  write_exr(folder / "depth.exr", image);
  EXPECT_EQ(read_exr(folder / "depth.exr").image.find("Z")->values[3], infinity);
  image.channels[1].values[7] = std::nanf("");
  write_exr(folder / "nan.exr", image);
  const std::string message = error_of(Blame::Input, [&] { return read_exr(folder / "nan.exr"); });
  EXPECT_NE(message.find("pixel (2, 1) of channel \"G\" is not a number"), std::string::npos)
      << message;
  image.channels[1].values[7] = -infinity;
  write_exr(folder / "inf.exr", image);
  EXPECT_NE(error_of(Blame::Input, [&] { return read_exr(folder / "inf.exr"); }).find("infinite"),
            std::string::npos);
}

TEST(Exr, FullDiskIsReportedAsFailedWork) {
  for (const int edge : {1, 400}) {  // the small one fails only at the flush of its buffer
    const std::string message =
        error_of(Blame::Work, [&] { write_exr("/dev/full", pattern(edge, edge)); });
    for (const char* part : {"No space left", "Free some space", "older file"}) {
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
}

TEST(Exr, FailureKeepsTheOldFileAndLeavesNoOther) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", pattern(4, 4));
  const std::string old = read_bytes(folder / "a.exr");
  Image broken = pattern(8, 8);
  broken.channels[2].values.pop_back();
  error_of(Blame::Work, [&] { write_exr(folder / "a.exr", broken); });
  Image twice = pattern(8, 8);
  twice.channels[4].name = "R";
  error_of(Blame::Work, [&] { write_exr(folder / "a.exr", twice); });
  error_of(Blame::Work, [&] { write_exr(folder / "a.exr", Image{}); });
  // An attribute name that the library reserves, with another type.
  error_of(Blame::Work, [&] {
    write_exr(folder / "a.exr", pattern(8, 8), {{{"compression", "none"}}, {}});
  });
  EXPECT_EQ(read_bytes(folder / "a.exr"), old);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Exr, MissingFolderAndFolderAsTargetAreTheCallersMistake) {
  const TemporaryFolder folder;
  error_of(Blame::Input, [&] { write_exr(folder / "no/a.exr", pattern(1, 1)); });
  error_of(Blame::Input, [&] { write_exr(folder.path(), pattern(1, 1)); });
}

TEST(Exr, APictureBeyondTheMemoryAllowedIsNotRead) {
  const TemporaryFolder folder;
  {
    Image dark{6000, 6000, {}};
    dark.add("Y");
    write_exr(folder / "a.exr", dark);  // 144 MB, but hardly any space on disk
  }
  const MemoryLimit limit(std::uint64_t{120} << 20U);
  const std::string message = error_of(Blame::Work, [&] { (void)read_exr(folder / "a.exr"); });
  EXPECT_NE(message.find("--max-memory"), std::string::npos) << message;
}

}  // namespace
}  // namespace earthshine::base
