// SPDX-License-Identifier: Apache-2.0
// Two libraries define it: one for the plain program (alone.cpp), one with Open MPI (open_mpi.cpp).
#pragma once

#include <memory>

#include "base/ranks/ranks.h"

namespace earthshine::base {

// The ranks that mpirun or srun started this process as one of; null where it is alone. Once in a
// process, before anything else; what it gives must live to its end. Throws base::Error (Input) for
// one of several processes of srun that do not know of each other: each would do all of the work.
[[nodiscard]] std::unique_ptr<Ranks> start_ranks(int& argc, char**& argv);

}  // namespace earthshine::base
