// SPDX-License-Identifier: Apache-2.0
// Two libraries define this function: alone.cpp for the plain program, open_mpi.cpp for Open MPI.
#pragma once

#include <memory>

#include "base/ranks/ranks.h"

namespace earthshine::base {

// Starts message passing if mpirun or srun started several processes; null if this process is the
// only one. Call it once, before anything else; the result must live until the process ends. Throws
// base::Error (Input) if srun started several processes that are not connected: each would do all
// work.
[[nodiscard]] std::unique_ptr<Ranks> start_ranks(int& argc, char**& argv);

}  // namespace earthshine::base
