// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace earthshine::base {

ThreadLimit::ThreadLimit(int threads)
    : control_(new tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          static_cast<std::size_t>(threads > 0 ? threads : available_threads()))) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

int available_threads() { return tbb::info::default_concurrency(); }

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  // oneTBB orders its tasks itself, but a thread sanitizer cannot see into the library: these two
  // flags tell it what is true anyway, that chunks start after the call and end before it returns.
  std::atomic<bool> started{false};
  std::atomic<std::size_t> finished{0};
  started.store(true, std::memory_order_release);
  // simple_partitioner honours the grain of one chunk, so that chunk boundaries are the same every
  // run.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        (void)started.load(std::memory_order_acquire);
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
          body(k * chunk, std::min(count, (k + 1) * chunk));
        }
        finished.fetch_add(1, std::memory_order_release);
      },
      tbb::simple_partitioner());
  (void)finished.load(std::memory_order_acquire);
}

}  // namespace earthshine::base
