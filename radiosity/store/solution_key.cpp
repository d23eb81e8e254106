// SPDX-License-Identifier: Apache-2.0
#include "radiosity/store/solution_key.h"

#include "base/numbers/digest.h"
#include "scenes/light/photometry.h"
#include "scenes/sky/albedo_grid.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/texture/texture.h"

namespace earthshine::radiosity {
namespace {

using base::Digest;
using scenes::Scene;

// Structured bindings below list all members: a new member does not compile until it is decided
// whether it belongs in the digest.

std::uint64_t geometry(const Scene& scene) {
  Digest digest;
  digest.add(std::uint64_t{scene.triangles.size()});
  for (const scenes::Triangle& triangle : scene.triangles) {
    const auto& [vertex, object, material, polygon] = triangle;
    for (const std::uint32_t v : vertex) {
      digest.add(scene.vertices[v]);
      if (scene.vertex_uv.empty() || !scene.materials[material].maps) continue;
      digest.add(double(scene.vertex_uv[v].x));
      digest.add(double(scene.vertex_uv[v].y));
      if (!scene.second_uv.empty()) {
        digest.add(double(scene.second_uv[v].x));
        digest.add(double(scene.second_uv[v].y));
      }
      if (!scene.vertex_colour.empty()) digest.add(Vec3(scene.vertex_colour[v]));
    }
    digest.add(std::uint64_t{object});
    digest.add(std::uint64_t{polygon});
  }
  return digest.value();
}

// Digest over the materials of all triangles, in order: unused materials and the order in the file
// do not matter.
template <class Part>
std::uint64_t of_worn(const Scene& scene, Part part) {
  std::vector<std::uint64_t> parts;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) parts.push_back(part(m));
  Digest digest;
  for (const scenes::Triangle& triangle : scene.triangles) digest.add(parts[triangle.material]);
  return digest.value();
}

std::uint64_t of_map(const scenes::TextureMap& map) {
  Digest digest;
  if (!map.texture) return digest.value();
  digest.add(map.texture->digest());
  digest.add(std::uint64_t{map.by_second});
  const auto& [matrix, shift] = *map.transform;
  for (const double x : {matrix[0].x, matrix[0].y, matrix[1].x, matrix[1].y, shift.x, shift.y}) {
    digest.add(x);
  }
  return digest.value();
}

std::uint64_t surfaces(const Scene& scene) {
  return of_worn(scene, [&](std::size_t m) {
    const auto& [name, diffuse, specular, shininess, mirror, transmit, ior, emit, group, sheet,
                 even_lobe, maps] = scene.materials[m];
    Digest digest;
    digest.add(diffuse);
    digest.add(specular);
    digest.add(shininess);
    digest.add(mirror);
    digest.add(transmit);
    digest.add(ior);
    digest.add(std::uint64_t{sheet});
    digest.add(std::uint64_t{even_lobe});
    if (maps) {
      digest.add(of_map(maps->diffuse));
      digest.add(of_map(maps->opacity));
      digest.add(maps->cutoff);
      digest.add(std::uint64_t{maps->by_vertex});
    }
    return digest.value();
  });
}

std::uint64_t lights(const Scene& scene, const scenes::LightGroups& groups) {
  Digest digest;
  for (const std::string& name : groups.names) digest.add(std::string_view(name));
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    const auto& [name, group, kind, position, axis, intensity_cd, beam_deg, field_deg, edge_u,
                 edge_v, radius_m, exitance, c0, photometry, source, motion, illuminance_lx, joint,
                 object] = scene.lamps[k];
    digest.add(std::uint64_t{groups.lamp[k]});
    digest.add(static_cast<std::uint64_t>(kind));
    for (const Vec3& v : {position, axis, intensity_cd, edge_u, edge_v, exitance, illuminance_lx})
      digest.add(v);
    for (const double x : {beam_deg, field_deg, radius_m}) digest.add(x);
    if (photometry) {
      digest.add(c0);
      for (const auto* list :
           {&photometry->vertical_rad(), &photometry->horizontal_rad(), &photometry->values()}) {
        digest.add(std::uint64_t{list->size()});
        for (const double x : *list) digest.add(x);
      }
    }
  }
  digest.add(of_worn(scene, [&](std::size_t m) {
    Digest emission;
    emission.add(scene.materials[m].emit);
    emission.add(std::uint64_t{groups.material[m]});
    if (scene.materials[m].maps) emission.add(of_map(scene.materials[m].maps->emit));
    return emission.value();
  }));
  return digest.value();
}

std::uint64_t sky(const Scene& scene) {
  Digest digest;
  digest.add(std::uint64_t{scene.sun.has_value()});
  if (scene.sun) {
    const auto& [direction, illuminance_lx, angular_radius_deg] = *scene.sun;
    digest.add(direction);
    digest.add(illuminance_lx);
    digest.add(angular_radius_deg);
  }
  digest.add(std::uint64_t{scene.earth.has_value()});
  if (scene.earth) {
    const auto& [direction, half_angle_deg, altitude_m, model, albedo, radiance, by_latitude, grid,
                 to_ground] = *scene.earth;
    for (const Vec3& v : {direction, albedo, radiance}) digest.add(v);
    for (const double x : {half_angle_deg, altitude_m}) digest.add(x);
    digest.add(static_cast<std::uint64_t>(model));
    if (by_latitude) {
      const auto& [a0, a1, a2, north] = *by_latitude;
      for (const double x : {a0, a1, a2}) digest.add(x);
      digest.add(north);
    }
    if (grid) {
      for (const auto& list : {grid->latitudes(), grid->longitudes(), grid->values()}) {
        digest.add(std::uint64_t{list.size()});
        for (const double x : list) digest.add(x);
      }
      for (int c = 0; c < 3; ++c) digest.add(to_ground[c]);
    }
  }
  if (scene.moon) {
    const auto& [direction, illuminance_lx, phase_deg, hidden] = *scene.moon;
    digest.add(direction);
    digest.add(illuminance_lx);
  }
  if (!scene.sky_parts) return digest.value();
  const auto& [suns, cells] = *scene.sky_parts;
  for (const auto& [direction, illuminance_lx, angular_radius_deg] : suns) {
    digest.add(direction);
    digest.add(illuminance_lx);
    digest.add(angular_radius_deg);
  }
  if (cells) {
    digest.add(cells->axis());
    for (const double bound : cells->bounds_rad()) digest.add(bound);
    for (const std::size_t sectors : cells->sectors()) digest.add(std::uint64_t{sectors});
  }
  return digest.value();
}

}  // namespace

std::vector<ScenePart> scene_parts(const Scene& scene, const scenes::LightGroups& groups) {
  return {{"digest_geometry", "the geometry", geometry(scene)},
          {"digest_materials", "the materials", surfaces(scene)},
          {"digest_lights", "the lights", lights(scene, groups)},
          {"digest_sky", "the Sun or the Earth", sky(scene)}};
}

std::vector<SolveKnob> solve_knobs(const SolveOptions& options) {
  const auto& [patch_edge_m, form_factor_rays, tolerance, seed, refine, flux_rays, direct_points,
               balance] = options;
  const auto& [on, start_edge_m, max_patches, error] = refine;
  std::vector<SolveKnob> knobs = {
      {"patch_edge_m", "quality.patch_edge in m", patch_edge_m},
      {"form_factor_rays", "quality.form_factor_rays",
       static_cast<std::uint64_t>(form_factor_rays)},
      {"solver_tolerance", "quality.solver_tolerance", tolerance},
      {"seed", "--seed", seed},
      {"refine", "quality.refine", std::uint64_t{on ? 1U : 0U}},
      {"refine_start_edge_m", "the edge that refinement starts from, by quality.patch_edge, in m",
       start_edge_m},
      {"max_patches", "quality.max_patches", std::uint64_t{max_patches}},
      {"refine_error", "quality.error of the patches", error}};
  // Files without the value used the default.
  if (flux_rays != SolveOptions().flux_rays) {
    knobs.push_back({"flux_rays", "the rays from each lamp, by quality.error",
                     static_cast<std::uint64_t>(flux_rays)});
  }
  if (direct_points != SolveOptions().direct_points) {
    knobs.push_back({"direct_points", "the points of a patch for direct light, by quality.error",
                     static_cast<std::uint64_t>(direct_points)});
  }
  if (balance != SolveOptions().balance) {
    knobs.push_back({"balance", "the defect of the balance, by quality.error", balance});
  }
  return knobs;
}

}  // namespace earthshine::radiosity
