// SPDX-License-Identifier: Apache-2.0
#include "studies/cost/memory.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "radiosity/factors/row_pilot.h"
#include "radiosity/refine.h"
#include "raytrace/frame/cryptomatte.h"
#include "raytrace/incoming/radiance_table.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/surface_texture.h"

namespace earthshine::studies {
namespace {

constexpr double program_bytes = 18e6;   // code and libraries
constexpr double open_mpi_bytes = 12e6;  // its libraries and buffers

constexpr double vertex_bytes = 24.0 + 12.0;          // the scene's, the ray structure's copy
constexpr double triangle_bytes = 24.0 + 12.0 + 4.0;  // the scene's, the copy, of_triangle
constexpr double hierarchy_bytes = 150.0;             // per triangle
// With patches: per facet, of which there are at most as many as triangles or patches; per
// triangle, as a target of rays; per triangle of a cluster.
constexpr double facet_bytes = sizeof(radiosity::Facet), target_bytes = 32.0, member_bytes = 40.0;

constexpr double patch_bytes = 8.0 + 4.0 + sizeof(radiosity::Cell) + 1.0 + 8.0;
// Per patch, for the matrix's rows and columns: start of a row, scales, shares of sky and black
// backs, absorbed share, open share; light per part of the sky. During casting also the result of
// each row.
constexpr double row_bytes = 80.0, sky_bytes = 24.0, cast_bytes = 50.0;
// During balancing: data on all ranks; for a rank's own patches the vectors of Newton's step; and
// sums of columns in 16 bands. A rank holds its own bands, the ones it has sent, and the received
// ones.
constexpr double balance_bytes = 48.0, newton_bytes = 90.0, bands_bytes = 128.0;
constexpr double counter_bytes = 4.125;  // per patch and thread
constexpr double entry_bytes = 8.0;      // column and hits
// Bands of rows are joined to the matrix in sixteenths. Ranks send them to each other; a fast rank
// has cast more bands than its part.
constexpr double joined_copies = 1.0 + 1.0 / 16.0, sent_copies = 1.5;
// Doubles per patch and column, of own rows. During the linear solve: direct light and nine vectors
// (linear_solve.h), and three of reflectance a row. After it: exitance, radiosity and illuminance,
// which the four floats of the solution on every rank replace.
constexpr double light_vectors = 1.0, iteration_vectors = 9.0, found_vectors = 4.0;
constexpr double reflectance_bytes = 24.0;
// During the statement of the solution's error: two parts of the light and the solution as floats,
// and the table that rays read. Bytes: on the root rank the samples and the data of patches, on
// each rank the list of samples and those in progress; and a linear system of six columns.
constexpr double error_floats = 3.0, found_bytes = 190.0, samples_bytes = 200.0;
constexpr double error_columns = 6.0;
constexpr double solution_bytes = 4.0 * sizeof(float);  // per patch and column

constexpr double texel_bytes = 16.0;  // radiance of a patch or knot in a layer

double record_bytes(const MemoryCase& m) {
  const auto layers = static_cast<double>(m.layers);
  const double entries = layers + (m.splits_parts ? 3.0 : 0.0);
  const PixelRecordBytes& b = pixel_record_bytes;
  const double per_layer = b.gather_per_layer + (m.in_rounds ? b.cast_per_layer : 0.0);
  return b.sums + b.sums_per_entry * entries +
         (m.gathers ? b.gather_point + per_layer * layers : 0.0);
}

// Bytes per patch of a linear solve, whose product packs its columns in fours.
double solver_bytes(const MemoryCase& m, double columns) {
  const double packed = 4.0 * std::ceil(columns / 4.0);
  return sizeof(double) * (packed + columns * iteration_vectors / m.ranks) +
         reflectance_bytes / m.ranks;
}

// Bytes per patch of the error over the surfaces, beside the matrix: light for samples and rays,
// then the equation of the error.
double stating_bytes(const MemoryCase& m, double columns) {
  const double tables = (columns / 3.0 + 2.0) * texel_bytes;
  const double more = m.first_rank ? found_bytes + row_bytes : 3.0 * sizeof(double);
  return columns * error_floats * sizeof(float) + samples_bytes + more +
         std::max(tables, solver_bytes(m, error_columns) +
                              (m.first_rank ? error_columns * sizeof(double) : 0.0));
}

}  // namespace

double MemoryNeed::total() const {
  double sum = 0.0;
  for (const MemoryPart& part : parts) sum += part.bytes;
  return sum;
}

MemoryNeed memory_needed(const MemoryCase& m) {
  const auto patches = static_cast<double>(m.patches), columns = static_cast<double>(m.columns);
  const auto triangles = static_cast<double>(m.triangles);
  const auto pixels = static_cast<double>(m.pixels), layers = static_cast<double>(m.layers);
  MemoryNeed standing = {{{"program", program_bytes + (m.has_mpi ? open_mpi_bytes : 0.0)},
                          {"scene", double(m.vertices) * vertex_bytes +
                                        triangles * (triangle_bytes + hierarchy_bytes)}}};
  if (m.texture_bytes > 0) standing.parts.push_back({"textures", double(m.texture_bytes)});
  if (m.solves || m.columns > 0) {
    const double member = patches < triangles ? member_bytes : 0.0;
    standing.parts.push_back({"patches", patches * patch_bytes +
                                             std::min(patches, triangles) * facet_bytes +
                                             triangles * (target_bytes + member)});
  }
  // In sequence: casting and balancing of the matrix, linear solve, error of the solution, picture.
  MemoryNeed casting = standing, balancing = standing, solving = standing, stating = standing;
  if (m.solves) {
    const double entries = patches * m.row_entries * entry_bytes / m.ranks;
    const double counters = patches * counter_bytes * m.threads;
    const double rows = patches * (row_bytes + sky_bytes * double(m.sky_parts)) + counters;
    const double bands = bands_bytes * (m.ranks > 1 ? 3.0 / m.ranks : 1.0);
    casting.parts.push_back({"form factors", entries * (m.ranks > 1 ? sent_copies : joined_copies) +
                                                 rows + patches * cast_bytes});
    balancing.parts.push_back(
        {"form factors", entries * (m.copies_matrix ? 2.0 : 1.0) + rows +
                             patches * (balance_bytes + newton_bytes / m.ranks + bands)});
    const double own = columns * sizeof(double) / m.ranks, kept = columns * solution_bytes;
    solving.parts.push_back({"form factors", entries + rows});
    solving.parts.push_back(
        {"light groups", patches * std::max({solver_bytes(m, columns) + light_vectors * own,
                                             found_vectors * own, own + kept})});
    if (m.states_error) {
      stating.parts.push_back({"form factors", entries + counters});
      stating.parts.push_back({"light groups", patches * stating_bytes(m, columns)});
    }
  }
  MemoryNeed drawing = standing;
  if (m.columns > 0) {
    const double texels = (m.refined ? 1.0 + double(raytrace::knots_per_cell) : 1.0);
    drawing.parts.push_back(
        {"solution", patches * columns * solution_bytes + patches * layers * texels * texel_bytes});
  }
  if (m.pixels > 0) {
    drawing.parts.push_back(
        {"picture", pixels * (double(m.channels) * sizeof(float) + record_bytes(m))});
  }
  return std::max({casting, balancing, solving, stating, drawing},
                  [](const MemoryNeed& a, const MemoryNeed& b) { return a.total() < b.total(); });
}

std::string memory_remedy(const MemoryNeed& need) {
  const auto largest =
      std::max_element(need.parts.begin(), need.parts.end(),
                       [](const MemoryPart& a, const MemoryPart& b) { return a.bytes < b.bytes; });
  if (largest == need.parts.end()) return "";
  if (largest->name == "picture") return "Lower --size, or leave out --per-light and layers";
  if (largest->name == "form factors") {
    return "Lower quality.max_patches or quality.form_factor_rays, or raise quality.patch_edge";
  }
  if (largest->name == "textures") return "Shrink the pictures of the textures";
  if (largest->name == "scene") return "Leave out objects, or take meshes of fewer triangles";
  return "Lower quality.max_patches, raise quality.patch_edge, or give lights a common group";
}

MemoryCase memory_case(const scenes::Scene& scene, const scenes::LightGroups& groups,
                       const scenes::Effects& effects, const radiosity::SolveOptions& options,
                       std::optional<std::size_t> patches) {
  MemoryCase m;
  m.vertices = scene.vertices.size();
  m.triangles = scene.triangles.size();
  m.texture_bytes = scenes::texture_bytes(scene);
  m.threads = base::available_threads();
  m.has_mpi = base::ranks() != nullptr;
  if (m.has_mpi) m.ranks = base::ranks()->count();
  if (!radiosity::is_lit(effects) || scene.triangles.empty()) return m;
  m.patches = patches             ? *patches
              : options.refine.on ? radiosity::most_refined_patches(scene, options)
                                  : radiosity::count_patches(scene, options.patch_edge_m);
  m.row_entries = std::min(double(m.patches), double(options.form_factor_rays));
  m.refined = options.refine.on;
  m.copies_matrix = true;
  m.columns = 3 * groups.count();
  if (effects.earth_by_gather) m.sky_parts = scenes::earth_parts(scene);
  m.solves = true;
  return m;
}

void add_picture(MemoryCase& m, const scenes::LightGroups& groups, const scenes::Effects& effects,
                 const raytrace::RenderOptions& options) {
  m.pixels = options.crop.columns > 0 ? options.crop.pixel_count()
                                      : static_cast<std::size_t>(options.columns) *
                                            static_cast<std::size_t>(options.rows);
  m.layers = options.per_light ? std::max<std::size_t>(1, groups.count()) : 1;
  m.channels = 3 + (options.per_light ? 3 * groups.count() : 0);
  for (const std::string& aov : options.aovs) {
    // other AOVs have at most three channels
    m.channels += aov.starts_with("crypto_") ? raytrace::cryptomatte_channel_count : 3;
  }
  const auto is_part = [](const std::string& aov) {
    return aov == "direct" || aov == "indirect" || aov == "specular";
  };
  m.splits_parts = std::any_of(options.aovs.begin(), options.aovs.end(), is_part);
  m.in_rounds = options.has_rounds();
  if (options.indirect != raytrace::Indirect::Radiosity || !effects.solution) {
    m.solves = false;
    m.columns = 0;
  }
  m.gathers = (options.indirect == raytrace::Indirect::Radiosity && effects.solution) ||
              (options.indirect != raytrace::Indirect::Distributed && effects.earth_by_gather);
}

void expect_rows(MemoryCase& m, const scenes::Scene& scene, const scenes::RayQuery& query,
                 const radiosity::SolveOptions& options) {
  if (!m.solves || m.patches == 0) return;
  const radiosity::ExpectedRows rows =
      radiosity::expected_rows(scene, query, m.patches, options.form_factor_rays);
  m.row_entries = rows.entries;
  // Refinement leaves patches that are small enough to get no hits, wherever light varies.
  m.copies_matrix = options.refine.on || rows.meets_backs ||
                    radiosity::expected_unreached(scene, m.patches, options.form_factor_rays) > 0.5;
}

}  // namespace earthshine::studies
