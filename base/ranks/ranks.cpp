// SPDX-License-Identifier: Apache-2.0
#include "base/ranks/ranks.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/parallel.h"

namespace earthshine::base {
namespace {

using Work = std::function<void(std::size_t)>;
using Transfer = std::function<void(std::size_t, Parcel&)>;

Ranks* in_force = nullptr;

void work_alone(std::size_t count, const Work& work) {
  parallel_chunks(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) work(k);
  });
}

// All ranks, or rank 0, receive the results of the others.
void exchange(Ranks& all, std::vector<std::size_t>& mine, const Transfer& transfer,
              Receivers receivers) {
  const auto say = [&] {
    Parcel sent;
    sent.pass(mine);
    for (const std::size_t k : mine) transfer(k, sent);
    return sent.take_bytes();
  };
  const auto take = [&](int rank, std::string bytes) {
    if (rank == all.number()) return;
    Parcel got(std::move(bytes));
    std::vector<std::size_t> theirs;
    got.pass(theirs);
    for (const std::size_t k : theirs) transfer(k, got);
  };
  if (receivers == Receivers::All) return sequential_broadcast(all, say, take);
  if (all.number() > 0) all.send(say(), 0);
  for (int rank = 1; all.number() == 0 && rank < all.count(); ++rank) take(rank, all.receive(rank));
  meet(all);
}

}  // namespace

Ranks* ranks() { return in_force; }

RanksInForce::RanksInForce(Ranks* ranks) : before_(std::exchange(in_force, ranks)) {}

RanksInForce::~RanksInForce() { in_force = before_; }

void sequential_broadcast(Ranks& ranks, const std::function<std::string()>& say,
                          const std::function<void(int, std::string)>& take) {
  for (int rank = 0; rank < ranks.count(); ++rank) {
    std::string bytes;
    if (rank == ranks.number()) bytes = say();
    std::uint64_t size = bytes.size();
    ranks.broadcast(&size, sizeof size, rank);
    bytes.resize(size);
    ranks.broadcast(bytes.data(), size, rank);
    take(rank, std::move(bytes));
  }
}

std::vector<std::string> swap(Ranks& ranks, std::vector<std::string> to) {
  std::vector<std::string> got(to.size());
  for (int step = 0; step < ranks.count(); ++step) {  // staggered, so that ranks do not all send to
                                                      // the same one
    const int other = (ranks.number() + step) % ranks.count();
    std::string& bytes = to[static_cast<std::size_t>(other)];
    if (step == 0) {
      got[static_cast<std::size_t>(other)] = std::move(bytes);
    } else {
      ranks.send(std::move(bytes), other);
    }
  }
  for (int rank = 0; rank < ranks.count(); ++rank) {
    if (rank != ranks.number()) got[static_cast<std::size_t>(rank)] = ranks.receive(rank);
  }
  return got;
}

void meet(Ranks& ranks) {
  sequential_broadcast(
      ranks, [] { return std::string(); }, [](int, const std::string&) {});
}

void share_loop(std::size_t count, const Work& work, const Transfer& transfer,
                Receivers receivers) {
  if (count < 2 || ranks() == nullptr) return work_alone(count, work);
  std::vector<std::uint8_t> is_mine(count);
  const auto take_all = [&](std::size_t, std::size_t) {
    for (std::size_t k = ranks()->take(); k < count; k = ranks()->take()) {
      work(k);
      is_mine[k] = 1;
    }
  };
  parallel_chunks(static_cast<std::size_t>(available_threads()), 1, take_all);
  std::vector<std::size_t> mine;
  for (std::size_t k = 0; k < count; ++k) {
    if (is_mine[k] != 0) mine.push_back(k);
  }
  exchange(*ranks(), mine, transfer, receivers);
  ranks()->end_of_taking();
}

void share_chunks(std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t, std::size_t)>& body,
                  const std::function<void(std::size_t, std::size_t, Parcel&)>& transfer,
                  Receivers receivers) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto end_of = [&](std::size_t k) { return std::min(count, (k + 1) * chunk); };
  const auto work = [&](std::size_t k) { body(k * chunk, end_of(k)); };
  if (chunks < 2 || ranks() == nullptr) return work_alone(chunks, work);
  std::vector<std::size_t> mine;
  for (auto k = static_cast<std::size_t>(ranks()->number()); k < chunks;
       k += static_cast<std::size_t>(ranks()->count())) {
    mine.push_back(k);
  }
  work_alone(mine.size(), [&](std::size_t i) { work(mine[i]); });
  exchange(
      *ranks(), mine,
      [&](std::size_t k, Parcel& parcel) { transfer(k * chunk, end_of(k), parcel); }, receivers);
}

bool holds_on_all_ranks(bool here) {
  bool everywhere = here;
  if (ranks() != nullptr) {
    sequential_broadcast(
        *ranks(), [&] { return std::string(here ? "1" : "0"); },
        [&](int, const std::string& there) { everywhere = everywhere && there == "1"; });
  }
  return everywhere;
}

}  // namespace earthshine::base
