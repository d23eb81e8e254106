// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace earthshine::base {
namespace {

TEST(Parallel, EveryItemIsVisitedExactlyOnce) {
  for (std::size_t count : {0U, 1U, 7U, 64U, 1000U}) {
    std::vector<int> visits(count, 0);
    parallel_chunks(count, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(count, 1));
  }
}

TEST(Parallel, ExceptionReachesTheCaller) {
  EXPECT_THROW(parallel_chunks(100, 1,
                               [](std::size_t begin, std::size_t) {
                                 if (begin == 50) throw std::runtime_error("fifty");
                               }),
               std::runtime_error);
}

// Of 1000 chunks, at most one per thread starts after the tenth.
TEST(Parallel, AStopEndsLoopsWhileItIsInForce) {
  std::atomic<int> done{0};
  const auto loop = [&] { parallel_chunks(1000, 1, [&](std::size_t, std::size_t) { ++done; }); };
  {
    const StopInForce stop([&] { return done >= 10; });
    EXPECT_THROW(loop(), Stopped);
    EXPECT_LE(done, 10 + available_threads());
    EXPECT_THROW(loop(), Stopped);
  }
  done = 0;
  loop();
  EXPECT_EQ(done, 1000);
}

TEST(Parallel, OrderedSumHasTheSameBitsForOneAndMoreThreads) {
  const auto term = [](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i) * 1e3);
    return sum;
  };
  const ThreadLimit one(1);
  const double expected = ordered_sum(100'000, 333, 0.0, term);
  for (int threads : {2, 3, 16}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(ordered_sum(100'000, 333, 0.0, term), expected) << threads;
  }
}

TEST(Parallel, OrderedSumOfNothingIsZero) {
  EXPECT_EQ(ordered_sum(0, 16, 0, [](std::size_t, std::size_t) { return 1; }), 0);
}

}  // namespace
}  // namespace earthshine::base
