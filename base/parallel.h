// SPDX-License-Identifier: Apache-2.0
// The only use of threads in the project (oneTBB). Results never depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace earthshine::base {

// RAII: limits parallel loops to `threads` in the current scope; 0: all cores of the process.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

[[nodiscard]] int available_threads();

// CPU time of this process in seconds, over all threads, without other processes.
[[nodiscard]] double cpu_seconds();

// RAII: in its scope, parallel loops throw Stopped once `asked` returns true. Threads call it
// between chunks, concurrently. Only one instance may exist at a time.
struct Stopped {};
class StopInForce {
 public:
  explicit StopInForce(std::function<bool()> asked);
  ~StopInForce();
  StopInForce(const StopInForce&) = delete;
  StopInForce& operator=(const StopInForce&) = delete;

 private:
  std::function<bool()> asked_;
};

// Calls body(begin, end) over [0, count) in chunks of at most `chunk` items. body may write only to
// its own items. Rethrows the first exception on the calling thread.
void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

// Resizes vectors in parallel, because first access to new memory is slower than writing to it. The
// calling thread allocates the memory and later frees it.
template <class Vectors>
void resize_together(Vectors& all, std::size_t size) {
  for (auto& one : all) one.reserve(size);
  parallel_chunks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) all[k].resize(size);
  });
}

// Sum of sum_chunk(begin, end) over fixed chunks, added in chunk order: bitwise equal results for
// any number of threads.
template <class T, class SumChunk>
[[nodiscard]] T ordered_sum(std::size_t count, std::size_t chunk, T zero, SumChunk sum_chunk) {
  std::vector<T> parts((count + chunk - 1) / chunk, zero);
  parallel_chunks(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      parts[k] = sum_chunk(k * chunk, std::min(count, (k + 1) * chunk));
    }
  });
  T total = zero;
  for (const T& part : parts) total += part;
  return total;
}

}  // namespace earthshine::base
