// SPDX-License-Identifier: Apache-2.0
#include "base/ranks/shares.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace earthshine::base {

Shares::Shares(std::span<const double> cost) {
  if (ranks() == nullptr) return;
  const auto count = static_cast<std::size_t>(ranks()->count());
  const double all = std::accumulate(cost.begin(), cost.end(), 0.0);
  start_.assign(count + 1, cost.size());
  start_[0] = 0;
  double before = 0.0;
  std::size_t rank = 1;
  for (std::size_t i = 0; i < cost.size() && rank < count; ++i) {
    // Whichever end of the item is nearer to where the range should end.
    const double middle = before + 0.5 * cost[i];
    for (; rank < count && middle * double(count) >= all * double(rank); ++rank) start_[rank] = i;
    before += cost[i];
  }
}

Shares::Range Shares::own(std::size_t count) const {
  if (!divided()) return {0, count};
  const auto rank = static_cast<std::size_t>(ranks()->number());
  return {start_[rank], start_[rank + 1]};
}

int Shares::holder(std::size_t item) const {
  return static_cast<int>(std::upper_bound(start_.begin(), start_.end(), item) - start_.begin()) -
         1;
}

void Shares::tell_all(const std::function<void(Parcel&)>& pass) const {
  if (!divided()) return;
  Parcel said;
  if (joins()) pass(said);
  std::string bytes = said.take_bytes();
  std::uint64_t size = bytes.size();
  tell_all(&size, 1);
  bytes.resize(size);
  tell_all(bytes.data(), size);
  if (joins()) return;
  Parcel heard(std::move(bytes));
  pass(heard);
}

void Shares::hear(const Pass& say, const Pass& listen) const {
  if (!divided()) return;
  const auto bytes = [&] {
    Parcel parcel;
    say(parcel);
    return parcel.take_bytes();
  };
  hear_all(*ranks(), bytes, [&](int, std::string said) {
    Parcel parcel(std::move(said));
    listen(parcel);
  });
}

std::size_t Shares::sum(std::size_t of_own) const {
  std::size_t all = divided() ? 0 : of_own;
  hear([&](Parcel& parcel) { parcel.pass(of_own); },
       [&](Parcel& parcel) {
         std::size_t found = 0;
         parcel.pass(found);
         all += found;
       });
  return all;
}

void Shares::add_up(std::vector<double>& sums, bool exact,
                    const std::function<void(std::vector<double>&)>& add) const {
  if (!divided()) return add(sums);
  std::vector<double> own(sums.size(), 0.0), theirs;
  if (exact) add(own);
  hear(
      [&](Parcel& parcel) {
        if (!exact) add(sums);
        parcel.pass(exact ? own : sums);
      },
      [&](Parcel& parcel) {
        parcel.pass(exact ? theirs : sums);
        for (std::size_t k = 0; exact && k < sums.size(); ++k) sums[k] += theirs[k];
      });
}

}  // namespace earthshine::base
