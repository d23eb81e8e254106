// SPDX-License-Identifier: Apache-2.0
#include "base/ranks/ranks.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace earthshine::base {
namespace {

Ranks* in_force = nullptr;

}  // namespace

Ranks* ranks() { return in_force; }

RanksInForce::RanksInForce(Ranks* ranks) : before_(std::exchange(in_force, ranks)) {}

RanksInForce::~RanksInForce() { in_force = before_; }

void share_loop(std::size_t count, const std::function<void(std::size_t)>& work,
                const std::function<void(std::size_t, Parcel&)>& transfer) {
  Ranks* const all = count > 1 ? ranks() : nullptr;
  const std::size_t step = all == nullptr ? 1 : static_cast<std::size_t>(all->count());
  const std::size_t first = all == nullptr ? 0 : static_cast<std::size_t>(all->number());
  const std::size_t own = count > first ? (count - first + step - 1) / step : 0;
  parallel_chunks(own, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) work(first + k * step);
  });
  if (step == 1) return;
  Parcel sent;
  for (std::size_t k = first; k < count; k += step) transfer(k, sent);
  const std::vector<std::string> got = all->gather(sent.bytes());
  for (std::size_t rank = 0; rank < step; ++rank) {
    if (rank == first) continue;
    Parcel parcel(got[rank]);
    for (std::size_t k = rank; k < count; k += step) transfer(k, parcel);
  }
}

void share_chunks(std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t, std::size_t)>& body,
                  const std::function<void(std::size_t, std::size_t, Parcel&)>& transfer) {
  const auto end_of = [&](std::size_t k) { return std::min(count, (k + 1) * chunk); };
  share_loop((count + chunk - 1) / chunk, [&](std::size_t k) { body(k * chunk, end_of(k)); },
             [&](std::size_t k, Parcel& parcel) { transfer(k * chunk, end_of(k), parcel); });
}

bool holds_on_all_ranks(bool here) {
  if (ranks() == nullptr) return here;
  const std::vector<std::string> all = ranks()->gather(here ? "1" : "0");
  return std::all_of(all.begin(), all.end(), [](const std::string& one) { return one == "1"; });
}

}  // namespace earthshine::base
