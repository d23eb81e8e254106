// SPDX-License-Identifier: Apache-2.0
#include "app/parts/shared_solution.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "app/console.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "base/ranks/ranks.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

// The first reader stores the digest that all must find.
void agree_on_digest(const fs::path& file, const std::string& digest) {
  const fs::path record = file.string() + ".json";
  if (!is_there(record) && base::write_new_text(record, dump({{"digest", digest}}))) return;
  const Json json = json_in(record);
  if (json == Json::object({{"digest", digest}})) return;
  throw base::Error(
      base::Blame::Input, file.string(),
      fmt::format("is another solution than the other parts have read (digest {})", digest),
      fmt::format("{} has their digest", record.string()),
      "Bring theirs back; or remove all of the folder and begin anew");
}

void wait_for(const fs::path& file, double wait_s, bool quiet) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(wait_s);
  bool is_noted = false;
  while (!is_there(file) && Clock::now() < end && !Interrupt::asked()) {
    if (!is_noted && !quiet) note(fmt::format("waiting for {}", file.string()));
    is_noted = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  if (!is_there(file)) end_part_if_interrupted();
}

}  // namespace

SharedSolution shared_solution(const fs::path& file, const radiosity::SolutionOrigin& origin,
                               const PartCall& part, bool quiet,
                               const std::function<radiosity::Solution()>& solve) {
  SharedSolution shared;
  if (part.task == PartCall::Task::Share) wait_for(file, part.wait_s, quiet);
  shared.found = base::holds_on_all_ranks(is_there(file));
  if (!shared.found && part.task == PartCall::Task::Merge) {
    throw base::Error(base::Blame::Work, file.string(), "is not there", {},
                      "Make the same call with --part solve, then merge again");
  }
  if (!shared.found) {
    shared.solution = solve();
    if (base::another_rank_writes()) return shared;
    shared.found = !base::write_new_text(file, radiosity::solution_bytes(shared.solution, origin));
  }
  if (shared.found) shared.solution = radiosity::read_solution(file, origin);
  shared.digest = digest_of_file(file);
  agree_on_digest(file, shared.digest);
  return shared;
}

fs::path solution_file_in(const fs::path& folder, const Json& scene_cache_key) {
  return folder / ("solution-" + digest_of(scene_cache_key) + ".h5");
}

Json solver_cache_key(const radiosity::SolveOptions& options) {
  Json knobs = Json::object();
  for (const radiosity::SolveKnob& knob : radiosity::solve_knobs(options)) {
    std::visit([&](const auto& value) { knobs[knob.key] = value; }, knob.value);
  }
  return knobs;
}

}  // namespace earthshine::app
