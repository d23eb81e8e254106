// SPDX-License-Identifier: Apache-2.0
// The project's only use of threads (oneTBB). Results never depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace earthshine::base {

// Limits every parallel loop to `threads` for as long as it lives; 0 means all cores of the
// process.
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

// CPU seconds of this process so far, all threads together: what others on the machine take is not
// in it.
[[nodiscard]] double cpu_seconds();

// While it lives, parallel loops end by throwing Stopped once `asked` says true. It is asked from
// many threads, between chunks. One at a time.
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
// the slots it owns. The first exception is rethrown on the calling thread.
void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

// Fresh memory takes longer to come than to be filled: each is touched first by one of all threads,
// and taken by the caller's, which gives it back.
template <class Vectors>
void resize_together(Vectors& all, std::size_t size) {
  for (auto& one : all) one.reserve(size);
  parallel_chunks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) all[k].resize(size);
  });
}

// Sums sum_chunk(begin, end) over fixed chunks, adding in chunk order: the same bits on any number
// of threads.
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
