// SPDX-License-Identifier: Apache-2.0
#include "base/files/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::error_of;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

TEST(OutputFile, TextArrivesWholeAndNothingElseIsLeft) {
  const TemporaryFolder folder;
  const std::string text("one\0two\n", 8);
  write_text(folder / "a.txt", text);
  EXPECT_EQ(read_bytes(folder / "a.txt"), text);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(OutputFile, OldFileStaysUntilCommitAndForeverWithoutIt) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "old");
  {
    OutputFile output(folder / "a.txt");
    write_bytes(output.temporary(), "half of the n");
    EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  }
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
  write_text(folder / "a.txt", "new");
  EXPECT_EQ(read_bytes(folder / "a.txt"), "new");
}

TEST(OutputFile, PermissionsOfTheOldFileAreKept) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "old");
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0600), 0);
  write_text(folder / "a.txt", "new");
  EXPECT_EQ(std::filesystem::status(folder / "a.txt").permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST(OutputFile, LinkIsFollowedAndKept) {
  const TemporaryFolder folder;
  write_text(folder / "real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  write_text(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_bytes(folder / "real.txt"), "new");
}

TEST(OutputFile, MissingFolderAndFolderAsTargetAreTheCallersMistake) {
  const TemporaryFolder folder;
  const std::string missing = error_of(Blame::Input, [&] { write_text(folder / "no/a.txt", "x"); });
  EXPECT_NE(missing.find("there is no folder"), std::string::npos) << missing;
  const std::string is_folder = error_of(Blame::Input, [&] { write_text(folder.path(), "x"); });
  EXPECT_NE(is_folder.find("is a folder"), std::string::npos) << is_folder;
  error_of(Blame::Input, [] { write_text("", "x"); });
  error_of(Blame::Input, [&] { write_text(folder.path().string() + "/", "x"); });
}

TEST(OutputFile, FullDiskIsReportedAsFailedWork) {
  const std::string message = error_of(Blame::Work, [] { write_text("/dev/full", "x"); });
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFile, FolderThatTakesNoFilesIsReportedAsFailedWork) {
  // /proc refuses new files to every user, also to root.
  error_of(Blame::Work, [] { write_text("/proc/earthshine-test.txt", "new"); });
}

TEST(OutputFile, VeryLongNamesAreWritten) {
  const TemporaryFolder folder;
  const std::string name = std::string(250, 'n') + ".txt";
  write_text(folder / name, "x");
  EXPECT_EQ(read_bytes(folder / name), "x");
}

TEST(OutputFile, WhatKilledProcessesLeftIsCleared) {
  const TemporaryFolder folder;
  // Linux has no process with this number: the limit is 2^22.
  for (const char* name : {".a.json.999999999-0.part", ".b.c.exr.999999999-12.part"}) {
    write_bytes(folder / name, "half");
  }
  const std::string own = ".a.json." + std::to_string(::getpid()) + "-7.part";
  for (const std::string& name : {own, std::string("a.json.999999999-0.part"),
                                  std::string(".a.part"), std::string(".a.json.999999999-0"),
                                  std::string(".a.json.x-0.part"), std::string(".part")}) {
    write_bytes(folder / name, "kept");
  }
  remove_abandoned_files(folder.path());
  EXPECT_EQ(folder.file_count(), 6U);
  EXPECT_TRUE(std::filesystem::exists(folder / own));
  remove_abandoned_files(folder / "none");
}

TEST(OutputFile, WhatAKilledRunLeftGoesWithTheNextWrite) {
  const TemporaryFolder folder;
  write_bytes(folder / ".a.json.999999999-3.part", "half");
  write_text(folder / "a.json", "new");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(OutputFile, WhatAnotherMachineIsWritingIsLeftAlone) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / ".a.json.999999999-3.part";
  write_bytes(path, "at work");
  const int file = ::open(path.c_str(), O_RDWR);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  write_text(folder / "a.json", "new");
  remove_abandoned_files(folder.path());
  EXPECT_EQ(read_bytes(path), "at work");
  ::close(file);
}

TEST(OutputFile, LocksThatOtherMachinesDoNotSeeAreTold) {
  const std::string mounts =
      "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n"
      "40 22 0:50 / /home rw shared:2 - nfs4 a:/home rw,vers=4.2,hard,local_lock=none,addr=b\n"
      "41 22 0:51 / /old rw shared:3 - nfs a:/old rw,vers=3,nolock,local_lock=all,addr=b\n"
      "42 22 0:52 / /flock rw shared:4 - nfs a:/f rw,vers=3,local_lock=flock,addr=b\n"
      "43 22 0:53 / /posix rw shared:5 - nfs a:/p rw,vers=3,local_lock=posix,addr=b\n"
      "44 22 9:54 / /scratch rw shared:6 - lustre a@tcp:/s rw,localflock\n";
  EXPECT_TRUE(others_see_locks(mounts, 8, 1));
  EXPECT_TRUE(others_see_locks(mounts, 0, 50));
  EXPECT_FALSE(others_see_locks(mounts, 0, 51));
  EXPECT_FALSE(others_see_locks(mounts, 0, 52));
  EXPECT_TRUE(others_see_locks(mounts, 0, 53));  // the server handles flock()
  EXPECT_FALSE(others_see_locks(mounts, 9, 54));
}

TEST(OutputFile, TwoWritersOfOneFileDoNotMeet) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.txt"), second(folder / "a.txt");
  ASSERT_NE(first.temporary(), second.temporary());
  write_bytes(first.temporary(), "first");
  write_bytes(second.temporary(), "second");
  second.commit();
  first.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "first");
}

TEST(OutputFile, OfTwoThatWriteANewFileTheFirstStays) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.txt"), second(folder / "a.txt");
  write_bytes(first.temporary(), "first");
  write_bytes(second.temporary(), "second");
  EXPECT_TRUE(first.commit_if_new());
  EXPECT_FALSE(second.commit_if_new());
  EXPECT_FALSE(write_new_text(folder / "a.txt", "third"));
  EXPECT_EQ(read_bytes(folder / "a.txt"), "first");
  EXPECT_EQ(std::filesystem::hard_link_count(folder / "a.txt"), 1U);
}

TEST(OutputFile, APipeIsRefusedAndDoesNotKeepAnybodyWaiting) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::string message = error_of(Blame::Input, [&] { write_text(folder / "pipe", "x"); });
  EXPECT_NE(message.find("is a pipe or a device"), std::string::npos) << message;
}

}  // namespace
}  // namespace earthshine::base
