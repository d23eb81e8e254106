// SPDX-License-Identifier: Apache-2.0
// How much memory this process may still take: of the machine, of its control group, of its limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::base {

// Caps what free_memory_bytes() says for as long as it lives; 0: no cap. processes: of one call, on
// this machine, of which this is one: what is free as it begins is theirs together, as is the cap,
// and each gets an equal part.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t bytes, int processes = 1);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

// Throws base::Error (Work) where `bytes` more than the process holds now would pass that cap, or
// are not free. `what` names what they are for. For readers, which cannot know beforehand what the
// whole work takes; a few MiB are not asked about.
void check_room(std::uint64_t bytes, std::string_view what);

// Whose bytes free_memory_bytes() tells: "free", "allowed by --max-memory", for each of how many.
[[nodiscard]] std::string memory_bound();

// Bytes. The least of what Linux calls MemAvailable, what is left below the limit of the control
// group or any above it (versions 1 and 2; file cache that can be dropped counts as free), and what
// is left of RLIMIT_AS; what the allocator kept is given back first where it matters. Nothing where
// none of them can be read. Inside `root`, for tests, stand proc/ and sys/.
[[nodiscard]] std::optional<std::uint64_t> free_memory_bytes(
    const std::filesystem::path& root = "/");

// Frees what a vector holds; `values = {}` would keep it for further ones.
template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

// What was freed of arrays of so many bytes together is the system's again, unless they are small:
// to take its pages anew would cost more. The allocator else keeps it, for each thread by itself.
void give_back_freed_memory(std::size_t bytes);

}  // namespace earthshine::base
