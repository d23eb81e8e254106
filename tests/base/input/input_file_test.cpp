// SPDX-License-Identifier: Apache-2.0
#include "base/input/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/free_memory.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::TemporaryFolder;
using test::write_bytes;

const Location asked_at{"scene.toml", 3, 8};

TEST(InputFile, BytesArriveAsTheyAre) {
  const TemporaryFolder folder;
  const std::string bytes("one\0two\r\n", 9);
  write_bytes(folder / "a", bytes);
  EXPECT_EQ(read_input_file(folder / "a", 9, asked_at), bytes);
  write_bytes(folder / "empty", "");
  EXPECT_EQ(read_input_file(folder / "empty", 9, asked_at), "");
  EXPECT_FALSE(read_input_file("/proc/self/status", 1 << 20, asked_at).empty());  // reports size 0
}

TEST(InputFile, WhatIsNoFileOnDiskIsRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::filesystem::path& path :
       {folder / "pipe", std::filesystem::path("/dev/zero"), std::filesystem::path("/dev/null")}) {
    const std::string message =
        error_of(Blame::Input, [&] { (void)read_input_file(path, 100, asked_at); });
    EXPECT_EQ(message, "scene.toml:3:8: \"" + path.string() +
                           "\" is a pipe or a device; a file on disk is wanted here. Write it to a "
                           "file first");
    error_of(Blame::Input, [&] { check_input_file(path, asked_at); });
  }
}

TEST(InputFile, MissingFoldersAndTooLargeAreNamedOnce) {
  const TemporaryFolder folder;
  write_bytes(folder / "a", "12345");
  const std::string name = (folder / "a").string();
  EXPECT_EQ(error_of(Blame::Input, [&] { (void)read_input_file(folder / "a", 4, {name}); }),
            name +
                ": is larger than 4 bytes; that is the largest file of this kind that is read. "
                "Split it");
  EXPECT_NE(error_of(Blame::Input, [&] { check_input_file(folder.path(), asked_at); })
                .find("\" is a folder"),
            std::string::npos);
  EXPECT_NE(
      error_of(Blame::Input, [&] { check_input_file(folder / "b", asked_at); }).find("cannot open"),
      std::string::npos);
}

TEST(InputFile, AFileBeyondTheMemoryAllowedIsNotRead) {
  const TemporaryFolder folder;
  write_bytes(folder / "a", "");
  std::filesystem::resize_file(folder / "a", std::uintmax_t{400} << 20);  // sparse: no blocks on
                                                                          // disk
  const MemoryLimit limit(std::uint64_t{100} << 20);
  const std::string message = error_of(
      Blame::Work, [&] { (void)read_input_file(folder / "a", std::size_t{1} << 30, asked_at); });
  EXPECT_NE(message.find("--max-memory"), std::string::npos) << message;
}

}  // namespace
}  // namespace earthshine::base
