// SPDX-License-Identifier: Apache-2.0
// Memory that this process may still allocate: limits of machine, control group and process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::base {

// RAII: limits free_memory_bytes() in the current scope; 0: no limit. processes: number of ranks of
// one call on this machine. Each gets an equal share of the limit and of the memory that is free at
// the start.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t bytes, int processes = 1);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

// Throws base::Error (Work) if `bytes` more than the resident memory would exceed this limit or the
// free memory. `what` names the data in the message. For readers, which do not know the memory of
// the whole work. Requests below 8 MiB always pass.
void check_room(std::uint64_t bytes, std::string_view what);

// Describes free_memory_bytes() in messages: "free" or "allowed by --max-memory", with the number
// of ranks.
[[nodiscard]] std::string memory_bound();

// The least of MemAvailable of Linux, the free memory of the control group and its ancestors
// (versions 1 and 2; cache that can be dropped is free), and the rest of RLIMIT_AS. If the
// allocator may keep much unused memory, it is returned first. Empty if none can be read. root:
// folder with proc/ and sys/, for tests.
[[nodiscard]] std::optional<std::uint64_t> free_memory_bytes(
    const std::filesystem::path& root = "/");

// Frees the memory of a vector; `values = {}` would keep its capacity.
template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

// Returns memory of freed arrays of `bytes` in all to the system. Otherwise the allocator keeps it
// for each thread. Small sizes are ignored: new pages would cost more.
void give_back_freed_memory(std::size_t bytes);

}  // namespace earthshine::base
