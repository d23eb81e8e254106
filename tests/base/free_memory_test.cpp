// SPDX-License-Identifier: Apache-2.0
#include "base/free_memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

class FreeMemory : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  [[nodiscard]] std::optional<std::uint64_t> found() const {
    return free_memory_bytes(folder_.path());
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(FreeMemory, NothingIsKnownWhereNothingCanBeRead) { EXPECT_FALSE(found()); }

TEST_F(FreeMemory, TheMachineHasWhatLinuxCallsAvailable) {
  write("proc/meminfo", "MemTotal:       4000 kB\nMemFree:  1 kB\nMemAvailable:    3000 kB\n");
  EXPECT_EQ(found(), 3000U * 1024);
}

TEST_F(FreeMemory, AControlGroupLeavesItsLimitLessWhatIsUsedAndCannotBeDropped) {
  write("proc/meminfo", "MemAvailable: 3000 kB\n");
  write("proc/self/cgroup", "0::/user/run\n");
  write("sys/fs/cgroup/user/run/memory.max", "max\n");
  EXPECT_EQ(found(), 3000U * 1024);
  write("sys/fs/cgroup/user/memory.max", "1000000\n");
  write("sys/fs/cgroup/user/memory.current", "700000\n");
  write("sys/fs/cgroup/user/memory.stat", "anon 5\ninactive_file 200000\n");
  EXPECT_EQ(found(), 500000U);
}

TEST_F(FreeMemory, TheFirstVersionOfControlGroupsIsReadToo) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/\n4:memory:/box\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "90000\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "100000\n");
  EXPECT_EQ(found(), 0U);  // above its limit: nothing is free, without overflow to a huge number
}

TEST(FreeMemoryHere, ThisMachineHasSome) {
  ASSERT_TRUE(free_memory_bytes());
  EXPECT_GT(*free_memory_bytes(), 1U << 20U);
}

TEST(FreeMemoryHere, ProcessesOfOneCallHaveAnEqualPartEach) {
  constexpr std::uint64_t cap = 1U << 20U;
  const std::uint64_t whole = *free_memory_bytes();
  {
    const MemoryLimit limit(cap, 4);
    EXPECT_EQ(*free_memory_bytes(), cap / 4);
    EXPECT_EQ(memory_bound(), "allowed by --max-memory for each of 4 ranks on this machine");
  }
  {
    // The machine's free memory may change meanwhile, but not by a factor of five.
    const MemoryLimit limit(0, 100);
    EXPECT_LT(*free_memory_bytes(), whole / 20);
    EXPECT_EQ(memory_bound(), "free for each of 100 ranks on this machine");
    EXPECT_THROW(check_room(whole / 10, "a picture"), Error);
  }
  EXPECT_GT(*free_memory_bytes(), whole / 5);
  EXPECT_EQ(memory_bound(), "free");
}

}  // namespace
}  // namespace earthshine::base
