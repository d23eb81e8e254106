// SPDX-License-Identifier: Apache-2.0
// Ranks of Open MPI. Only this file uses the library.
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <list>
#include <mutex>
#include <string>

#include "base/error.h"
#include "base/ranks/start.h"

namespace earthshine::base {
namespace {

// Components of Open MPI for one-sided communication (the counters on rank 0). Debian's settings
// exclude pt2pt, the only one over TCP, and ucx, which needs special networks. The default here
// allows pt2pt; the environment or an option of mpirun overrides it.
constexpr const char* components = "OMPI_MCA_osc";

// Counts in MPI are ints, so that messages are divided.
constexpr std::uint64_t most_at_once = 1U << 30U;

class OpenMpi : public Ranks {
 public:
  OpenMpi() {
    MPI_Comm_rank(MPI_COMM_WORLD, &number_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &count_here_);
    MPI_Allreduce(&number_, &lowest_here_, 1, MPI_INT, MPI_MIN, here);
    MPI_Comm_free(&here);
    const MPI_Aint bytes = number_ == 0 ? 2 * sizeof(std::uint64_t) : 0;
    std::uint64_t* counters = nullptr;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    int problem = MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                                   static_cast<void*>(&counters), &window_);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_ARE_FATAL);
    MPI_Allreduce(MPI_IN_PLACE, &problem, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (problem != MPI_SUCCESS) refuse_window();
    if (number_ == 0) std::fill_n(counters, 2, 0);
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
  }
  ~OpenMpi() override {
    for (Sent& sent : sent_) {
      MPI_Waitall(static_cast<int>(sent.requests.size()), sent.requests.data(),
                  MPI_STATUSES_IGNORE);
    }
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] int count() const override { return count_; }
  [[nodiscard]] int count_here() const override { return count_here_; }
  [[nodiscard]] bool first_is_here() const override { return lowest_here_ == 0; }

  void broadcast(void* first, std::size_t bytes, int from) override {
    in_pieces(first, bytes, [&](char* piece, int count) {
      MPI_Bcast(piece, count, MPI_BYTE, from, MPI_COMM_WORLD);
    });
  }

  void send(std::string bytes, int to) override {
    const std::lock_guard alone(speaking_);
    sent_.remove_if([](Sent& sent) {
      int arrived = 0;
      MPI_Testall(static_cast<int>(sent.requests.size()), sent.requests.data(), &arrived,
                  MPI_STATUSES_IGNORE);
      return arrived != 0;
    });
    Sent& sent = sent_.emplace_back();
    sent.size = bytes.size();
    sent.bytes = std::move(bytes);
    MPI_Isend(&sent.size, 1, MPI_UINT64_T, to, 0, MPI_COMM_WORLD, &sent.requests.emplace_back());
    in_pieces(sent.bytes.data(), sent.size, [&](char* first, int count) {
      MPI_Isend(first, count, MPI_BYTE, to, 0, MPI_COMM_WORLD, &sent.requests.emplace_back());
    });
  }

  [[nodiscard]] std::string receive(int from) override {
    const std::lock_guard alone(speaking_);
    std::uint64_t size = 0;
    MPI_Recv(&size, 1, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    std::string bytes(size, '\0');
    in_pieces(bytes.data(), size, [&](char* first, int count) {
      MPI_Recv(first, count, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
    return bytes;
  }

  void all_gather(void* items, std::size_t bytes_each,
                  const std::vector<std::size_t>& start) override {
    const Division division(bytes_each, start);
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, items, division.counts.data(),
                   division.begins.data(), division.item, MPI_COMM_WORLD);
  }

  void gather(void* items, std::size_t bytes_each, const std::vector<std::size_t>& start) override {
    const Division division(bytes_each, start);
    MPI_Gatherv(number_ == 0 ? MPI_IN_PLACE : items,
                division.counts[static_cast<std::size_t>(number_)], division.item, items,
                division.counts.data(), division.begins.data(), division.item, 0, MPI_COMM_WORLD);
  }

  void scatter(void* items, std::size_t bytes_each,
               const std::vector<std::size_t>& start) override {
    const Division division(bytes_each, start);
    MPI_Scatterv(items, division.counts.data(), division.begins.data(), division.item,
                 number_ == 0 ? MPI_IN_PLACE : items,
                 division.counts[static_cast<std::size_t>(number_)], division.item, 0,
                 MPI_COMM_WORLD);
  }

  [[nodiscard]] std::size_t take() override { return add_to_counter(1, MPI_SUM); }

  // Two counters alternate. Rank 0 resets this one while other ranks may already use the other
  // counter. A collective call with rank 0 lies between this reset and the next use.
  void end_of_taking() override {
    if (number_ == 0) (void)add_to_counter(0, MPI_REPLACE);
    counter_ = 1 - counter_;
  }

  [[noreturn]] void end_all(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

 private:
  // A message on its way; MPI needs the buffers until it has arrived.
  struct Sent {
    std::uint64_t size = 0;
    std::string bytes;
    std::vector<MPI_Request> requests;
  };

  // Division of items among ranks, in the form that MPI expects.
  struct Division {
    Division(std::size_t bytes_each, const std::vector<std::size_t>& start) {
      MPI_Type_contiguous(static_cast<int>(bytes_each), MPI_BYTE, &item);
      MPI_Type_commit(&item);
      for (std::size_t rank = 0; rank + 1 < start.size(); ++rank) {
        counts.push_back(static_cast<int>(start[rank + 1] - start[rank]));
        begins.push_back(static_cast<int>(start[rank]));
      }
    }
    ~Division() { MPI_Type_free(&item); }
    Division(const Division&) = delete;
    Division& operator=(const Division&) = delete;

    MPI_Datatype item = MPI_DATATYPE_NULL;
    std::vector<int> counts, begins;
  };

  template <class Pass>
  static void in_pieces(void* first, std::uint64_t bytes, Pass pass) {
    for (std::uint64_t at = 0; at < bytes; at += most_at_once) {
      pass(static_cast<char*>(first) + at,
           static_cast<int>(std::min<std::uint64_t>(most_at_once, bytes - at)));
    }
  }

  // Rank 0 reports the error; the others wait until it ends them.
  [[noreturn]] void refuse_window() const {
    if (number_ > 0) MPI_Barrier(MPI_COMM_WORLD);
    const char* const allowed = std::getenv(components);
    throw Error(Blame::Work, "Open MPI", "has no component osc for these machines",
                std::string("allowed are ") + (allowed == nullptr ? "its own" : allowed),
                "Add --mca osc ^ucx to mpirun, or ucx where pml is ucx, too");
  }

  // Returns the value before the addition. One thread at a time may call MPI.
  std::uint64_t add_to_counter(std::uint64_t number, MPI_Op how) {
    const std::lock_guard alone(speaking_);
    std::uint64_t before = 0;
    MPI_Fetch_and_op(&number, &before, MPI_UINT64_T, 0, counter_, how, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

  int number_ = 0, count_ = 1, count_here_ = 1, lowest_here_ = 0;
  MPI_Win window_ = MPI_WIN_NULL;  // two counters, on rank 0
  MPI_Aint counter_ = 0;           // index of the counter in use
  std::mutex speaking_;
  std::list<Sent> sent_;
};

}  // namespace

std::unique_ptr<Ranks> start_ranks(int& argc, char**& argv) {
  const bool by_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  std::unique_ptr<OpenMpi> ranks;
  if (by_mpirun || std::getenv("PMIX_RANK") != nullptr) {
    ::setenv(components, "^ucx", 0);
    int given = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &given);
    if (given < MPI_THREAD_SERIALIZED) {
      throw Error(Blame::Work, "Open MPI", "was built for one thread alone", {},
                  "Install one with threads");
    }
    ranks = std::make_unique<OpenMpi>();
  }
  const char* const tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  const bool alone = ranks == nullptr || ranks->count() == 1;
  if (alone && !by_mpirun && tasks != nullptr && std::atoi(tasks) > 1) {
    throw Error(Blame::Input, "srun",
                "started " + std::string(tasks) + " processes that do not know of each other", {},
                "Add --mpi=pmix to srun, or take earthshine for processes that work alone");
  }
  return ranks;
}

}  // namespace earthshine::base
