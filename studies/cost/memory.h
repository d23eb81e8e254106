// SPDX-License-Identifier: Apache-2.0
// Memory of a run, by part, predicted before its work starts; with ranks, for each of them.
//
// Includes the arrays whose size grows with the scene, the patches or the picture, and the
// temporary data of each stage. Constants are bytes; those that are no sizes of types were measured
// (docs/validation.md, "Memory").
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"

namespace earthshine::studies {

// Per pixel of a picture beside its channels: the renderer's data until the picture is complete
// (raytrace/shade/pixel_sums.h, gather_field.h).
struct PixelRecordBytes {
  double sums = 64.0;              // samples, moments of the luminance, wanted samples
  double sums_per_entry = 12.0;    // radiance of an image layer or part
  double gather_point = 700.0;     // with some off-grid points: position, halves, details,
                                   // temporary fields of noise
  double gather_per_layer = 30.0;  // denoised diffuse and lobe light
  double cast_per_layer = 55.0;    // sums of three kinds, if cast in rounds
};
inline constexpr PixelRecordBytes pixel_record_bytes;

// The quantities that determine the memory.
struct MemoryCase {
  std::size_t vertices = 0, triangles = 0;
  std::size_t texture_bytes = 0;
  std::size_t patches = 0;
  bool refined = false;        // uneven patches
  double row_entries = 0.0;    // form factors of a mean row
  bool copies_matrix = false;  // a patch without hits borrows its row: the matrix exists twice
  std::size_t columns = 0;     // 3 * light groups
  std::size_t sky_parts = 0;   // whose light form-factor rays carry
  bool solves = false;         // casts the matrix; false with columns: reads the solution
  int threads = 1;
  int ranks = 1;              // that divide the entries of the matrix
  bool has_mpi = false;       // earthshine-mpi, by mpirun
  bool first_rank = true;     // which iterates for all (radiosity/linear_solve.h)
  bool states_error = false;  // of the solution, over all surfaces (raytrace/surfaces)
  std::size_t pixels = 0;     // 0: no picture
  std::size_t channels = 0;   // of the picture, 4 bytes each
  std::size_t layers = 0;     // that read the solution: 1, or the light groups
  bool splits_parts = false;  // layers direct, indirect, specular
  bool gathers = true;        // cosine rays carry light in the picture
  bool in_rounds = false;     // RenderOptions::has_rounds()
};

struct MemoryPart {
  std::string name;
  double bytes = 0.0;
};

// The parts that exist at the time of the largest total.
struct MemoryNeed {
  std::vector<MemoryPart> parts;
  [[nodiscard]] double total() const;
};
[[nodiscard]] MemoryNeed memory_needed(const MemoryCase& sizes);

// The setting to lower, for the largest part.
[[nodiscard]] std::string memory_remedy(const MemoryNeed& need);

// Sizes for a scene. patches: their number; if absent, the largest possible one is used. Refinement
// to an error may end with far fewer. Until expect_rows(), row_entries is the largest possible
// number, one for each ray or patch, and copies_matrix is true.
[[nodiscard]] MemoryCase memory_case(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                     const scenes::Effects& effects,
                                     const radiosity::SolveOptions& options,
                                     std::optional<std::size_t> patches = std::nullopt);
void add_picture(MemoryCase& sizes, const scenes::LightGroups& groups,
                 const scenes::Effects& effects, const raytrace::RenderOptions& options);
// Casts a few rows (radiosity/factors/row_pilot.h).
void expect_rows(MemoryCase& sizes, const scenes::Scene& scene, const scenes::RayQuery& query,
                 const radiosity::SolveOptions& options);

}  // namespace earthshine::studies
