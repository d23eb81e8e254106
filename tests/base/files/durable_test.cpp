// SPDX-License-Identifier: Apache-2.0
// Order in which bytes, names and folders reach the disk, which decides the state after a power
// failure. The functions below replace those of the C library in this program.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/files/exr_file.h"
#include "base/files/output_file.h"
#include "tests/base/temporary_folder.h"

namespace {

std::vector<std::string>* calls = nullptr;

}  // namespace

extern "C" int fsync(int file) {
  struct stat status {};
  if (calls != nullptr && ::fstat(file, &status) == 0) {
    calls->push_back(S_ISDIR(status.st_mode) ? "flush folder"
                                             : "flush " + std::to_string(status.st_size));
  }
  return static_cast<int>(::syscall(SYS_fsync, file));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (calls != nullptr) calls->push_back("rename");
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace earthshine::base {
namespace {

using test::TemporaryFolder;

TEST(Durable, BytesThenNameThenFolderReachTheDisk) {
  const TemporaryFolder folder;
  std::vector<std::string> order;
  calls = &order;
  write_text(folder / "a.txt", "twelve bytes");
  calls = nullptr;
  EXPECT_EQ(order, (std::vector<std::string>{"flush 12", "rename", "flush folder"}));
}

TEST(Durable, PicturesToo) {
  const TemporaryFolder folder;
  Image image{8, 8, {}};
  image.add("Y");
  std::vector<std::string> order;
  calls = &order;
  write_exr(folder / "a.exr", image);
  calls = nullptr;
  const auto size = std::filesystem::file_size(folder / "a.exr");
  EXPECT_EQ(order,
            (std::vector<std::string>{"flush " + std::to_string(size), "rename", "flush folder"}));
}

}  // namespace
}  // namespace earthshine::base
