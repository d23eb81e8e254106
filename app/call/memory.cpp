// SPDX-License-Identifier: Apache-2.0
#include "app/call/memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/ranks/ranks.h"

namespace earthshine::app {
namespace {

std::string size_text(double in_mib) {
  if (in_mib < 1000.0) return fmt::format("{:.0f} MiB", in_mib);
  return fmt::format("{:.{}f} GiB", in_mib / 1024.0, in_mib < 10240.0 ? 1 : 0);
}

// Memory of one process; with ranks the mean over those on this machine, whose free memory is
// divided by their number (base/free_memory.h): the first needs more than the others.
double bytes_here(studies::MemoryCase sizes) {
  const double first = studies::memory_needed(sizes).total();
  if (base::ranks() == nullptr) return first;
  sizes.first_rank = false;
  const double others = studies::memory_needed(sizes).total();
  if (!base::ranks()->first_is_here()) return others;
  return others + (first - others) / base::ranks()->count_here();
}

// Rejects runs that cannot fit. Casts rows only if the upper bound does not fit.
void refuse_too_much(const LoadedScene& loaded, const scenes::RayQuery& query,
                     const radiosity::SolveOptions& solver, studies::MemoryCase sizes) {
  const auto free_bytes = base::free_memory_bytes();
  if (!free_bytes) return;
  const auto free = static_cast<double>(*free_bytes);
  if (bytes_here(sizes) > free && sizes.solves) {
    const base::RanksInForce alone(nullptr);  // other ranks may not need this
    studies::expect_rows(sizes, loaded.scene, query, solver);
  }
  if (bytes_here(sizes) <= free) return;
  const studies::MemoryNeed need = studies::memory_needed(sizes);
  throw base::Error(
      base::Blame::Work, loaded.scene.path.string(), "needs " + memory_text(memory_json(need)),
      size_text(free / mib) + " are " + base::memory_bound(), studies::memory_remedy(need));
}

}  // namespace

Json memory_json(const studies::MemoryNeed& need) {
  Json parts = Json::object();
  for (const studies::MemoryPart& part : need.parts) parts[part.name] = part.bytes / mib;
  return {{"total_mib", need.total() / mib}, {"parts_mib", parts}};
}

std::string memory_text(const Json& need) {
  const auto total = need["total_mib"].get<double>();
  std::vector<std::pair<double, std::string>> parts;
  for (const auto& [name, size] : need["parts_mib"].items()) {
    if (size.get<double>() >= 0.01 * total) parts.emplace_back(size.get<double>(), name);
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> words;
  for (const auto& [size, name] : parts) words.push_back(name + " " + size_text(size));
  return fmt::format("about {} ({})", size_text(total), fmt::join(words, ", "));
}

void check_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                  const radiosity::SolveOptions& solver, const raytrace::RenderOptions* picture,
                  bool solves) {
  // Refinement to an error begins with the coarse patches, and checks again before it adds more.
  std::optional<std::size_t> patches;
  if (solver.refine.on && solver.refine.error > 0.0 && radiosity::is_lit(loaded.effects)) {
    patches = radiosity::count_patches(loaded.scene, solver.refine.start_edge_m);
  }
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver, patches);
  if (picture != nullptr) {
    studies::add_picture(sizes, loaded.groups, loaded.effects, *picture);
  }
  sizes.states_error = picture == nullptr;
  if (!solves) sizes.solves = false;
  refuse_too_much(loaded, query, solver, sizes);
}

void check_patch_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                        const radiosity::SolveOptions& solver, std::size_t patches) {
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver, patches);
  refuse_too_much(loaded, query, solver, sizes);
}

bool patches_fit(const LoadedScene& loaded, const radiosity::SolveOptions& solver,
                 std::size_t patches, bool states_error) {
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver, patches);
  sizes.states_error = states_error;
  const auto free_bytes = base::free_memory_bytes();
  // Machines differ, and ranks must decide equally.
  return base::holds_on_all_ranks(!free_bytes ||
                                  bytes_here(sizes) <= static_cast<double>(*free_bytes));
}

void check_row_memory(const LoadedScene& loaded, const scenes::RayQuery& query, double patch_edge_m,
                      int rays_per_patch) {
  radiosity::SolveOptions rows;
  rows.patch_edge_m = patch_edge_m;
  rows.form_factor_rays = rays_per_patch;
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, rows);
  sizes.columns = 0;
  sizes.solves = true;
  refuse_too_much(loaded, query, rows, sizes);
}

}  // namespace earthshine::app
