// SPDX-License-Identifier: Apache-2.0
#include "base/input/exr_guard.h"

#include <gtest/gtest.h>

#include "base/files/exr_file.h"
#include "base/files/exr_reader.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

std::string little_endian(std::uint32_t value) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
  return bytes;
}

// A valid picture with an additional attribute at the start of its header.
std::string picture_with(const TemporaryFolder& folder, const std::string& attribute) {
  Image image{8, 8, {}};
  image.add("Y");
  write_exr(folder / "a.exr", image);
  const std::string bytes = read_bytes(folder / "a.exr");
  return bytes.substr(0, 8) + attribute + bytes.substr(8);
}

TEST(ExrGuard, ASoundPictureIsRead) {
  const TemporaryFolder folder;
  write_bytes(folder / "b.exr", picture_with(folder, ""));
  guard_exr(folder / "b.exr");
  EXPECT_EQ(read_exr(folder / "b.exr").image.width, 8);
}

TEST(ExrGuard, AnAttributeLargerThanTheFileIsRefusedByItsName) {
  const TemporaryFolder folder;
  for (const std::string type : {"string", "unheard-of", "float"}) {
    write_bytes(folder / "b.exr", picture_with(folder, std::string("story\0", 6) + type + '\0' +
                                                           little_endian(800U << 20U)));
    for (const std::string& message :
         {error_of(Blame::Input, [&] { (void)read_exr(folder / "b.exr"); }),
          error_of(Blame::Input, [&] { const ExrReader reader(folder / "b.exr"); })}) {
      EXPECT_NE(message.find("announces 838860800 bytes of attribute \"story\""), std::string::npos)
          << message;
    }
  }
}

// The library reads four bytes of a float, a list of channels up to the empty name, and each text
// of a vector with its stated length. It continues from there, not from the end of the attribute.
TEST(ExrGuard, AnAttributeThatIsNotAsLongAsItsTypeIsRefused) {
  const std::string hidden =
      std::string("x\0string\0", 9) + little_endian(1800U << 20U);  // would be read as the next
                                                                    // attribute
  const auto attribute = [](const std::string& type, const std::string& value) {
    return std::string("story\0", 6) + type + '\0' +
           little_endian(static_cast<std::uint32_t>(value.size())) + value;
  };
  const std::string channel = std::string("Y\0", 2) + std::string(16, '\0');
  const std::string sound = attribute("float", little_endian(0)) +
                            attribute("chlist", channel + '\0') +
                            attribute("stringvector", little_endian(2) + "ab") +
                            attribute("preview", little_endian(1) + little_endian(1) + "rgba");
  const TemporaryFolder folder;
  write_bytes(folder / "b.exr", picture_with(folder, sound));
  guard_exr(folder / "b.exr");
  for (const std::string& torn :
       {attribute("float", little_endian(0) + hidden), attribute("chlist", channel + '\0' + hidden),
        attribute("chlist", channel), attribute("stringvector", little_endian(1800U << 20U) + "ab"),
        attribute("preview", little_endian(1U << 31U) + little_endian(1U << 31U)),
        attribute("preview", little_endian(1)), attribute(std::string(300, 's'), "")}) {
    write_bytes(folder / "b.exr", picture_with(folder, torn));
    const std::string message = error_of(Blame::Input, [&] { guard_exr(folder / "b.exr"); });
    EXPECT_TRUE(message.find("attribute \"story\"") != std::string::npos ||
                message.find("a name of more than 255 bytes") != std::string::npos)
        << message;
  }
}

TEST(ExrGuard, MoreChunksThanTheFileHasRoomForAreRefused) {
  const TemporaryFolder folder;
  write_bytes(folder / "b.exr",
              picture_with(folder, std::string("chunkCount\0int\0", 15) + little_endian(4) +
                                       little_endian(1U << 30U)));
  const std::string message = error_of(Blame::Input, [&] { (void)read_exr(folder / "b.exr"); });
  EXPECT_NE(message.find("announces 1073741824 chunks"), std::string::npos) << message;
}

TEST(ExrGuard, WhatIsNoPictureIsLeftToTheLibrary) {
  const TemporaryFolder folder;
  for (const char* bytes : {"", "v", "this is text and no picture"}) {
    write_bytes(folder / "b.exr", bytes);
    guard_exr(folder / "b.exr");
    error_of(Blame::Input, [&] { (void)read_exr(folder / "b.exr"); });
  }
}

}  // namespace
}  // namespace earthshine::base
