// SPDX-License-Identifier: Apache-2.0
#include "base/ranks/shares.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/parallel.h"

namespace earthshine::base {

Shares::Shares(std::span<const double> cost, std::size_t grain) {
  if (ranks() == nullptr) return;
  const auto count = static_cast<std::size_t>(ranks()->count());
  const double all = std::accumulate(cost.begin(), cost.end(), 0.0);
  start_.assign(count + 1, cost.size());
  start_[0] = 0;
  double before = 0.0;
  std::size_t rank = 1;
  for (std::size_t i = 0; i < cost.size() && rank < count; i += grain) {
    const std::span<const double> grains = cost.subspan(i, std::min(grain, cost.size() - i));
    const double held = std::accumulate(grains.begin(), grains.end(), 0.0);
    // Chooses the end of the grain that is nearer to the wanted end of the range.
    const double middle = before + 0.5 * held;
    for (; rank < count && middle * double(count) >= all * double(rank); ++rank) start_[rank] = i;
    before += held;
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

void Shares::broadcast(const std::function<void(Parcel&)>& pass) const {
  if (!divided()) return;
  Parcel said;
  if (is_root()) pass(said);
  std::string bytes = said.take_bytes();
  std::uint64_t size = bytes.size();
  broadcast(&size, 1);
  bytes.resize(size);
  broadcast(bytes.data(), size);
  if (is_root()) return;
  Parcel received(std::move(bytes));
  pass(received);
}

void Shares::sequential_reduce(const Pass& say, const Pass& listen) const {
  if (!divided()) return;
  const auto bytes = [&] {
    Parcel parcel;
    say(parcel);
    return parcel.take_bytes();
  };
  sequential_broadcast(*ranks(), bytes, [&](int, std::string said) {
    Parcel parcel(std::move(said));
    listen(parcel);
  });
}

std::size_t Shares::sum(std::size_t of_own) const {
  std::size_t all = divided() ? 0 : of_own;
  sequential_reduce([&](Parcel& parcel) { parcel.pass(of_own); },
                    [&](Parcel& parcel) {
                      std::size_t found = 0;
                      parcel.pass(found);
                      all += found;
                    });
  return all;
}

std::vector<double> Shares::ordered_sums(std::size_t count, std::size_t chunk, std::size_t each,
                                         const AddChunk& add) const {
  constexpr std::size_t chunks_at_once = 64;
  const auto chunks = [chunk](std::size_t items) { return (items + chunk - 1) / chunk; };
  const Range mine = own(count);
  const std::size_t first = chunks(mine.begin), last = chunks(mine.end);
  std::vector<double> parts(chunks(count) * each, 0.0), sums(each, 0.0);
  parallel_chunks(last - first, chunks_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = first + begin; k < first + end; ++k) {
      add(k * chunk, std::min(count, (k + 1) * chunk), parts.data() + k * each);
    }
  });
  if (divided() && each > 0) {
    std::vector<std::size_t> start;
    for (const std::size_t item : start_) start.push_back(chunks(item));
    ranks()->all_gather(parts.data(), each * sizeof(double), start);
  }
  for (std::size_t k = 0; k < parts.size(); ++k) sums[k % each] += parts[k];
  return sums;
}

void Shares::add_up(std::vector<double>& sums, bool exact,
                    const std::function<void(std::vector<double>&)>& add) const {
  if (!divided()) return add(sums);
  std::vector<double> own(sums.size(), 0.0), theirs;
  if (exact) add(own);
  sequential_reduce(
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
