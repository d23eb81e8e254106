// SPDX-License-Identifier: Apache-2.0
#include "base/free_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <fstream>
#include <sstream>

#include "base/error.h"

// Defined if the program is linked with jemalloc.
extern "C" [[gnu::weak]] int mallctl(const char* name, void* old, std::size_t* old_size, void* set,
                                     std::size_t set_size);

namespace earthshine::base {
namespace {

namespace fs = std::filesystem;
using Bytes = std::optional<std::uint64_t>;

void take_least(Bytes& least, Bytes found) {
  if (found && (!least || *found < *least)) least = found;
}

std::uint64_t less(std::uint64_t a, std::uint64_t b) { return a > b ? a - b : 0; }

// The number in a file; none for "max".
Bytes number_in(const fs::path& path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  if (!(file >> value)) return std::nullopt;
  return value;
}

// The number after a word: "MemAvailable: 123 kB", "inactive_file 123".
Bytes number_after(const fs::path& path, const std::string& word) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string first;
    std::uint64_t value = 0;
    if (words >> first >> value && first == word) return value;
  }
  return std::nullopt;
}

struct GroupFiles {
  const char *limit, *usage, *cache;
};
constexpr GroupFiles version_1 = {"memory.limit_in_bytes", "memory.usage_in_bytes",
                                  "total_inactive_file"};
constexpr GroupFiles version_2 = {"memory.max", "memory.current", "inactive_file"};

// Free memory of one control group.
Bytes bytes_left(const fs::path& folder, const GroupFiles& files) {
  const Bytes limit = number_in(folder / files.limit);
  if (!limit) return std::nullopt;
  const std::uint64_t usage = number_in(folder / files.usage).value_or(0);
  const std::uint64_t cache = number_after(folder / "memory.stat", files.cache).value_or(0);
  return less(*limit, less(usage, cache));
}

// Least free memory of the process's control group and its ancestors. In a container /proc may name
// a path that is not mounted; the loop then reaches the top of the mount, which is the container's
// group.
Bytes left_of_groups(const fs::path& root) {
  Bytes least;
  std::ifstream file(root / "proc/self/cgroup");
  std::string line;
  while (std::getline(file, line)) {  // "4:memory:/a/b" or, version 2, "0::/a/b"
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool second_version = controllers.empty();
    if (!second_version && ("," + controllers + ",").find(",memory,") == std::string::npos)
      continue;
    const fs::path mount = root / (second_version ? "sys/fs/cgroup" : "sys/fs/cgroup/memory");
    fs::path group = fs::path(line.substr(second + 1)).relative_path();
    while (true) {
      take_least(least, bytes_left(mount / group, second_version ? version_2 : version_1));
      if (group.empty()) break;
      group = group.parent_path();
    }
  }
  return least;
}

// Address space without memory that the allocator keeps.
std::uint64_t retained_bytes() {
  if (&mallctl == nullptr) return 0;
  std::uint64_t epoch = 1;  // refreshes the statistics
  std::size_t retained = 0, size = sizeof(retained);
  mallctl("epoch", nullptr, nullptr, &epoch, sizeof(epoch));
  return mallctl("stats.retained", &retained, &size, nullptr, 0) == 0 ? retained : 0;
}

Bytes left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const std::uint64_t pages = number_in(root / "proc/self/statm").value_or(0);
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return less(limit.rlim_cur, less(pages * page_bytes, retained_bytes()));
}

// Free memory of the machine and of the process's control groups.
Bytes left_of_machine(const fs::path& root) {
  Bytes least;
  if (const Bytes kib = number_after(root / "proc/meminfo", "MemAvailable:")) least = *kib * 1024;
  take_least(least, left_of_groups(root));
  return least;
}

// Limits of this process, bytes; 0: none.
std::atomic<std::uint64_t> most_bytes{0}, room_bytes{0};
std::atomic<int> sharers{1};

// Returns all unused memory of the allocator to the system.
void give_back() {
  if (&mallctl == nullptr) {
    ::malloc_trim(0);
  } else {
    constexpr const char* of_all_arenas = "arena.4096.purge";
    mallctl(of_all_arenas, nullptr, nullptr, nullptr, 0);
  }
}

// Resident memory of the process; 0 if Linux does not report it.
std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t whole = 0, resident = 0;
  file >> whole >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// Free memory by measure(). First returns the allocator's unused memory, which is at most the
// resident memory; not if the resident memory is an eighth of the free memory or less.
template <class Measure>
Bytes left_for_use(const Measure& measure) {
  const Bytes left = measure();
  if (!left || resident_bytes() <= *left / 8) return left;
  give_back();
  return measure();
}

}  // namespace

MemoryLimit::MemoryLimit(std::uint64_t bytes, int processes) {
  const auto parts = static_cast<std::uint64_t>(processes);
  if (processes > 1) room_bytes = left_of_machine("/").value_or(0) / parts;
  most_bytes = bytes / parts;
  sharers = processes;
}

MemoryLimit::~MemoryLimit() {
  most_bytes = room_bytes = 0;
  sharers = 1;
}

void check_room(std::uint64_t bytes, std::string_view what) {
  constexpr std::uint64_t mib = 1 << 20, small = 8 * mib;
  if (bytes < small) return;
  const std::uint64_t cap = most_bytes;
  const auto left_of_limit = [](std::uint64_t most) {
    return left_for_use([most] { return Bytes(less(most, resident_bytes())); });
  };
  Bytes left = cap == 0 ? free_memory_bytes() : left_of_limit(cap);
  if (const std::uint64_t room = room_bytes) take_least(left, left_of_limit(room));
  if (!left || bytes <= *left) return;
  throw Error(
      Blame::Work, what, "needs " + std::to_string(bytes / mib) + " MiB more",
      std::to_string(*left / mib) + (cap == 0 ? " MiB are free" : " MiB are left of --max-memory"),
      cap == 0 ? "Make it smaller or free some memory" : "Make it smaller or allow more");
}

std::string memory_bound() {
  std::string bound = most_bytes == 0 ? "free" : "allowed by --max-memory";
  if (sharers > 1) bound += " for each of " + std::to_string(sharers) + " ranks on this machine";
  return bound;
}

std::optional<std::uint64_t> free_memory_bytes(const fs::path& root) {
  Bytes least = left_for_use([&] {
    Bytes left = left_of_machine(root);
    take_least(left, left_of_address_space(root));
    return left;
  });
  for (const std::uint64_t cap : {most_bytes.load(), room_bytes.load()}) {
    if (cap > 0) take_least(least, cap);
  }
  return least;
}

void give_back_freed_memory(std::size_t bytes) {
  constexpr std::size_t small = 16U << 20U;
  if (bytes >= small) give_back();
}

}  // namespace earthshine::base
