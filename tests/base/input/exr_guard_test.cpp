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

// A sound picture, and the same with an attribute more at the head of its header.
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
