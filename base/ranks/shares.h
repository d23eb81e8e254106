// SPDX-License-Identifier: Apache-2.0
// Distributed arrays: each rank has a range of the items, such as the rows of a large matrix.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/ranks/ranks.h"

namespace earthshine::base {

class Shares {
 public:
  struct Range {
    std::size_t begin = 0, end = 0;
  };

  Shares() = default;  // undivided: every rank has all items
  // Consecutive ranges of nearly equal cost that start at multiples of `grain`. Undivided if this
  // process is the only one.
  explicit Shares(std::span<const double> cost, std::size_t grain = 1);

  [[nodiscard]] bool divided() const { return !start_.empty(); }
  // The range of this rank, of `count` items.
  [[nodiscard]] Range own(std::size_t count) const;
  // The range of a rank. Needs divided items.
  [[nodiscard]] Range of(std::size_t rank) const { return {start_[rank], start_[rank + 1]}; }
  // Whether this rank processes results over all items: rank 0, or every rank if undivided.
  [[nodiscard]] bool is_root() const { return !divided() || ranks()->number() == 0; }
  // Ranks that receive such results.
  [[nodiscard]] Receivers receivers() const { return divided() ? Receivers::Root : Receivers::All; }
  // The rank that has the item. Needs divided items.
  [[nodiscard]] int holder(std::size_t item) const;

  // All-gather of `each` values per item; every rank has set its items.
  template <class Value>
  void all_gather(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->all_gather(values, each * sizeof(Value), start_);
  }
  // Gather: only rank 0 gets all values. On other ranks `values` has their own ones.
  template <class Value>
  void gather(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->gather(values, each * sizeof(Value), start_);
  }
  // Scatter: rank 0 has all values. Afterwards every rank has its own ones, at the start of
  // `values`.
  template <class Value>
  void scatter(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->scatter(values, each * sizeof(Value), start_);
  }
  // Broadcast from the rank for which is_root() is true: values, or data that `pass` serialises.
  template <class Value>
  void broadcast(Value* values, std::size_t count) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->broadcast(values, count * sizeof(Value), 0);
  }
  void broadcast(const std::function<void(Parcel& parcel)>& pass) const;
  // Each rank in turn broadcasts its data: it calls say() after it has received those of lower
  // ranks. All ranks, including the sender, call listen(). Does nothing if undivided.
  using Pass = std::function<void(Parcel& parcel)>;
  void sequential_reduce(const Pass& say, const Pass& listen) const;
  // Sum over all ranks.
  [[nodiscard]] std::size_t sum(std::size_t of_own) const;
  // `each` sums over all items. Chunks are added in order, which gives bitwise equal results for
  // any number of ranks and threads. add() adds a chunk of this rank's items to the sums of the
  // chunk. chunk: a multiple of which ranges start at.
  using AddChunk = std::function<void(std::size_t begin, std::size_t end, double* sums)>;
  [[nodiscard]] std::vector<double> ordered_sums(std::size_t count, std::size_t chunk,
                                                 std::size_t each, const AddChunk& add) const;
  // Sequential reduction: add() adds this rank's items to the sums, rank after rank; afterwards all
  // ranks have the totals. exact: no addition is rounded, so that the ranks add independently.
  void add_up(std::vector<double>& sums, bool exact,
              const std::function<void(std::vector<double>& sums)>& add) const;

 private:
  std::vector<std::size_t> start_;  // rank r has [start_[r], start_[r + 1])
};

}  // namespace earthshine::base
