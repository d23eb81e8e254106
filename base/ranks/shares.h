// SPDX-License-Identifier: Apache-2.0
// Items that stay with the ranks, a range of them with each: rows of a matrix too large for one.
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

  Shares() = default;  // undivided: every rank has all of them
  // Ranges of about as much cost each, in order, that begin at multiples of `grain`. Undivided
  // where this process is alone.
  explicit Shares(std::span<const double> cost, std::size_t grain = 1);

  [[nodiscard]] bool divided() const { return !start_.empty(); }
  // Of `count` items those that this rank has.
  [[nodiscard]] Range own(std::size_t count) const;
  // Those of a rank, of divided ones.
  [[nodiscard]] Range of(std::size_t rank) const { return {start_[rank], start_[rank + 1]}; }
  // Whether this rank is the one that works on what is found of all items: the first; each rank
  // where they are undivided.
  [[nodiscard]] bool joins() const { return !divided() || ranks()->number() == 0; }
  // Whom such finds are for.
  [[nodiscard]] Hears hears() const { return divided() ? Hears::First : Hears::All; }
  // The rank that has the item, of divided ones.
  [[nodiscard]] int holder(std::size_t item) const;

  // Per item `each` values side by side, of which every rank knows those of its own: all know all.
  template <class Value>
  void tell(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->gather(values, each * sizeof(Value), start_);
  }
  // The same for the first rank alone, which has room for all values; elsewhere they are the own.
  template <class Value>
  void tell_first(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->gather_at_first(values, each * sizeof(Value), start_);
  }
  // The other way round: the first rank has all values, afterwards each those of its own, from the
  // first place on.
  template <class Value>
  void tell_own(Value* values, std::size_t each = 1) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->scatter_from_first(values, each * sizeof(Value), start_);
  }
  // What the one that joins() has, in all: values, or what it passes.
  template <class Value>
  void tell_all(Value* values, std::size_t count) const {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (divided()) ranks()->broadcast(values, count * sizeof(Value), 0);
  }
  void tell_all(const std::function<void(Parcel& parcel)>& pass) const;
  // What each rank has found among its own, rank after rank: a rank speaks when it has heard those
  // before it, and hears itself too. Nothing where undivided.
  using Pass = std::function<void(Parcel& parcel)>;
  void hear(const Pass& say, const Pass& listen) const;
  // Of what each has found among its own.
  [[nodiscard]] std::size_t sum(std::size_t of_own) const;
  // `each` sums over all items, in chunks that are added up in order: the same bits on any number
  // of ranks and threads. add() adds what it finds in a chunk of its own items to the chunk's sums.
  // chunk: a multiple of which ranges begin at.
  using AddChunk = std::function<void(std::size_t begin, std::size_t end, double* sums)>;
  [[nodiscard]] std::vector<double> ordered_sums(std::size_t count, std::size_t chunk,
                                                 std::size_t each, const AddChunk& add) const;
  // add() adds what it finds among its own items to the sums, in their order; afterwards all of it
  // is in them. exact: no addition is rounded, so that the ranks need not wait for each other.
  void add_up(std::vector<double>& sums, bool exact,
              const std::function<void(std::vector<double>& sums)>& add) const;

 private:
  std::vector<std::size_t> start_;  // rank r has [start_[r], start_[r + 1])
};

}  // namespace earthshine::base
