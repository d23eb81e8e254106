// SPDX-License-Identifier: Apache-2.0
#include "base/ranks/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/files/output_file.h"
#include "base/numbers/random.h"
#include "tests/base/silent_ranks.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

using test::Silent;

std::vector<Shares::Range> ranges(const std::vector<double>& cost, int ranks) {
  std::vector<Shares::Range> all;
  for (int rank = 0; rank < ranks; ++rank) {
    Silent silent(rank, ranks);
    const RanksInForce in_force(&silent);
    all.push_back(Shares(cost).own(cost.size()));
  }
  return all;
}

TEST(Shares, RanksHaveAsMuchCostEachToWithinTheDearestItem) {
  // Each end differs from its ideal position, k / R of the cost, by at most half an item, and each
  // range by at most one item.
  Rng rng(Key(20, Stream::Test, 0));
  std::vector<double> cost(1000);
  for (double& c : cost) c = 1.0 + 99.0 * rng.next() * rng.next();
  const double all = std::accumulate(cost.begin(), cost.end(), 0.0);
  const double dearest = *std::max_element(cost.begin(), cost.end());
  for (const int count : {1, 2, 3, 5, 8, 64}) {
    std::size_t end = 0;
    for (const Shares::Range& range : ranges(cost, count)) {
      EXPECT_EQ(range.begin, end);  // consecutive, without gaps
      end = range.end;
      const double held = std::accumulate(cost.begin() + static_cast<std::ptrdiff_t>(range.begin),
                                          cost.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
      EXPECT_NEAR(held, all / count, dearest * (1.0 + 1e-12));
    }
    EXPECT_EQ(end, cost.size());
  }
}

TEST(Shares, RangesBeginAtMultiplesOfTheGrain) {
  // 103 items of equal cost in grains of 8: 12 whole grains and 7 items. Each end differs from its
  // ideal position, k / R of the items, by at most half a grain.
  const std::vector<double> cost(103, 1.0);
  for (const int count : {2, 3, 5, 8, 64}) {
    std::size_t end = 0;
    for (int rank = 0; rank < count; ++rank) {
      Silent silent(rank, count);
      const RanksInForce in_force(&silent);
      const Shares::Range range = Shares(cost, 8).own(cost.size());
      EXPECT_EQ(range.begin, end);
      EXPECT_TRUE(range.begin % 8 == 0 || range.begin == cost.size()) << range.begin;
      EXPECT_NEAR(double(range.begin), 103.0 * rank / count, 4.0);
      end = range.end;
    }
    EXPECT_EQ(end, cost.size());
  }
}

// One of several ranks; each has the numbers 1 / (1 + k) for its items k.
class OneOfSome : public Silent {
 public:
  using Silent::Silent;
  // Checks this rank's chunks, then computes the chunks of the other ranks.
  void all_gather(void* items, std::size_t bytes_each,
                  const std::vector<std::size_t>& start) override {
    ASSERT_EQ(bytes_each, 2 * sizeof(double));
    auto* const parts = static_cast<double*>(items);
    const auto mine = static_cast<std::size_t>(number());
    for (std::size_t chunk = 0; chunk < start.back(); ++chunk) {
      const bool is_here = chunk >= start[mine] && chunk < start[mine + 1];
      double sums[2] = {0.0, 0.0};
      add(chunk * 4, std::min<std::size_t>(items_, chunk * 4 + 4), sums);
      for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(parts[2 * chunk + std::size_t(k)], is_here ? sums[k] : 0.0);
        parts[2 * chunk + std::size_t(k)] = sums[k];
      }
    }
  }
  static void add(std::size_t begin, std::size_t end, double* sums) {
    for (std::size_t k = begin; k < end; ++k) {
      sums[0] += 1.0 / (1.0 + double(k));
      sums[1] += double(k);
    }
  }
  static constexpr std::size_t items_ = 1002;
};

TEST(Shares, OrderedSumsHaveTheSameBitsOnAnyNumberOfRanks) {
  // 1 + 1/2 + ... + 1/1002 is rounded at every addition. Adding in reverse order, or without
  // chunks, changes the last digit.
  const auto sums = [](int rank, int count) {
    OneOfSome one(rank, count);
    const RanksInForce in_force(count > 1 ? &one : nullptr);
    const Shares shares(std::vector<double>(OneOfSome::items_, 1.0), 4);
    return shares.ordered_sums(OneOfSome::items_, 4, 2, OneOfSome::add);
  };
  const std::vector<double> alone = sums(0, 1);
  EXPECT_NEAR(alone[0], std::log(1002.0) + 0.5772156649 + 0.5 / 1002.0, 1e-6);
  EXPECT_EQ(alone[1], 1001.0 * 1002.0 / 2.0);
  double plain[2] = {0.0, 0.0};
  OneOfSome::add(0, OneOfSome::items_, plain);
  EXPECT_NE(alone[0], plain[0]);
  for (const int count : {2, 3, 7}) {
    for (int rank = 0; rank < count; ++rank) EXPECT_EQ(sums(rank, count), alone) << rank;
  }
}

TEST(Shares, MoreRanksThanItemsLeaveSomeWithout) {
  const std::vector<double> cost = {1.0, 5.0, 1.0};
  const std::vector<Shares::Range> all = ranges(cost, 7);
  Silent silent(0, 7);
  const RanksInForce in_force(&silent);
  const Shares shares(cost);
  for (std::size_t item = 0; item < cost.size(); ++item) {
    const Shares::Range& range = all[static_cast<std::size_t>(shares.holder(item))];
    EXPECT_TRUE(range.begin <= item && item < range.end) << item;
  }
}

// Rank 1 of two; rank 0 has sent a given string.
class Second : public Silent {
 public:
  explicit Second(std::string said) : Silent(1, 2), said_(std::move(said)) {}
  // Receives the given string of rank 0, after its size.
  void broadcast(void* first, std::size_t bytes, int from) override {
    if (from != 0) return;
    if (std::exchange(is_size_, !is_size_)) {
      const std::uint64_t size = said_.size();
      std::memcpy(first, &size, sizeof size);
    } else {
      said_.copy(static_cast<char*>(first), bytes);
    }
  }

 private:
  std::string said_;
  bool is_size_ = true;
};

TEST(Shares, SumsThatAreRoundedAreTakenItemByItem) {
  // The first rank's item is 1e16, where doubles have a spacing of 2. In the order of the items
  // 1e16 + 1 + 1 = 1e16; if the second rank's items were added separately, the sum would be 1e16 +
  // 2.
  const auto total = [](bool exact, double item = 1.0) {
    std::vector<double> first = {1e16};
    Parcel parcel;
    parcel.pass(first);
    Second second(parcel.take_bytes());
    const RanksInForce in_force(&second);
    const Shares shares(std::vector<double>{2.0, 1.0, 1.0});
    std::vector<double> sums = {0.0};
    shares.add_up(sums, exact, [item](std::vector<double>& all) {
      all[0] += item;
      all[0] += item;
    });
    return sums[0];
  };
  EXPECT_EQ(total(false), 1e16);
  EXPECT_EQ(total(true), 1e16 + 2.0);
  for (const bool exact : {false, true}) EXPECT_EQ(total(exact, 2.0), 1e16 + 4.0);
}

TEST(Ranks, TheFirstAloneMakesFiles) {
  const test::TemporaryFolder folder;
  for (const int number : {1, 0}) {
    Silent silent(number, 2);
    const RanksInForce in_force(&silent);
    if (number == 1)
      OutputFile(folder / "there" / "a").commit();  // it does not need the missing folder
    OutputFile file(folder / "a");
    const bool is_made = !std::filesystem::is_empty(folder.path());
    EXPECT_EQ(is_made, number == 0);
    EXPECT_EQ(another_rank_writes(), number == 1);
    EXPECT_EQ(file.temporary() == "/dev/null", number == 1);
    file.commit();
    EXPECT_EQ(std::filesystem::exists(folder / "a"), number == 0);
  }
}

TEST(Shares, OfOneProcessAreUndivided) {
  const std::vector<double> cost = {1.0, 2.0};
  const Shares shares(cost);
  EXPECT_FALSE(shares.divided());
  EXPECT_EQ(shares.own(2).begin, 0U);
  EXPECT_EQ(shares.own(2).end, 2U);
  EXPECT_EQ(shares.sum(5), 5U);
}

}  // namespace
}  // namespace earthshine::base
