// SPDX-License-Identifier: Apache-2.0
// Ranks of Open MPI. The only user of the library.
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "base/ranks/start.h"

namespace earthshine::base {
namespace {

// Counts of MPI are ints.
constexpr std::uint64_t most_at_once = 1U << 30U;

class OpenMpi : public Ranks {
 public:
  OpenMpi() {
    MPI_Comm_rank(MPI_COMM_WORLD, &number_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  ~OpenMpi() override { MPI_Finalize(); }

  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] int count() const override { return count_; }

  // Each rank in turn sends to all, in pieces: no rank needs room for more than what it will keep.
  [[nodiscard]] std::vector<std::string> gather(const std::string& mine) override {
    const std::uint64_t size = mine.size();
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(count_));
    MPI_Allgather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    std::vector<std::string> all(sizes.size());
    for (int rank = 0; rank < count_; ++rank) {
      std::string& bytes = all[static_cast<std::size_t>(rank)];
      if (rank == number_) bytes = mine;
      bytes.resize(sizes[static_cast<std::size_t>(rank)]);
      for (std::uint64_t at = 0; at < bytes.size(); at += most_at_once) {
        const auto count =
            static_cast<int>(std::min<std::uint64_t>(most_at_once, bytes.size() - at));
        MPI_Bcast(&bytes[at], count, MPI_BYTE, rank, MPI_COMM_WORLD);
      }
    }
    return all;
  }

  [[noreturn]] void end_all(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

 private:
  int number_ = 0, count_ = 1;
};

}  // namespace

// Other threads work while one speaks, but none of them speaks.
std::unique_ptr<Ranks> start_ranks(int& argc, char**& argv) {
  // Without mpirun or srun there is nobody to talk to.
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr && std::getenv("PMIX_RANK") == nullptr) {
    return nullptr;
  }
  int given = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &given);
  return std::make_unique<OpenMpi>();
}

}  // namespace earthshine::base
