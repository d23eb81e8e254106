// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <ctime>
#include <utility>

#ifdef __SANITIZE_THREAD__
#include <exception>
#include <mutex>
#include <thread>
#endif

namespace earthshine::base {

namespace {

std::atomic<const std::function<bool()>*> stop_in_force{nullptr};

}  // namespace

#ifdef __SANITIZE_THREAD__
namespace {

// The thread sanitizer does not see the synchronisation in the uninstrumented oneTBB and would
// report races in every task. Under it the chunks run on plain threads, so that it reports only
// races of this project.
template <class Run>
void run_on_plain_threads(std::size_t chunks, const Run& run) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (std::size_t k = next++; k < chunks; k = next++) {
      try {
        run(k);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  const std::size_t most =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  for (std::size_t t = 1; t < std::min(most, chunks); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace
#endif

ThreadLimit::ThreadLimit(int threads)
    : control_(new tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          static_cast<std::size_t>(threads > 0 ? threads : available_threads()))) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

StopInForce::StopInForce(std::function<bool()> asked) : asked_(std::move(asked)) {
  stop_in_force = &asked_;
}

StopInForce::~StopInForce() { stop_in_force = nullptr; }

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// At most the number of cores and the current ThreadLimit.
int available_threads() {
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(tbb::info::default_concurrency(), static_cast<int>(allowed));
}

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const std::function<bool()>* const stops = stop_in_force;
  const auto run = [&](std::size_t k) {
    if (stops != nullptr && *stops && (*stops)()) throw Stopped();
    body(k * chunk, std::min(count, (k + 1) * chunk));
  };
#ifdef __SANITIZE_THREAD__
  run_on_plain_threads(chunks, run);
#else
  // simple_partitioner with a grain of one chunk keeps the chunk boundaries the same in every run.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) run(k);
      },
      tbb::simple_partitioner());
#endif
}

}  // namespace earthshine::base
