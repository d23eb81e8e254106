// SPDX-License-Identifier: Apache-2.0
// Some pixels of a picture, looked at closely: what they show with one solution or another, by the
// same rays, so that what differs is the solutions alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/render.h"

namespace earthshine::raytrace {

struct ProbeOptions {
  int camera_samples = 4;  // per pixel
  int gather_rays = 16;    // of each sample
  // What the camera sees itself is read from the solution in place of gathering: no noise but that
  // of edges, lamps and lobes.
  bool reads_solution = false;
  std::uint64_t seed = 1;
  std::uint64_t lamp_seed = 1;  // of shadow and lobe rays
};

struct Probed {
  std::vector<double> luminance;          // per pixel asked for, cd/m^2
  std::vector<double> sample_variance;    // of one camera sample's luminance, noise of all kinds
  std::vector<std::uint8_t> sees_source;  // a sample saw a source itself
  RayCounts rays;
};

// pixels: row * columns + column of the picture that `options` describe. Plain gathering, whatever
// the options say about sharing: unbiased given the solution. aimed_at: whose bright patches gather
// rays are aimed at (bright_patches.h); the same one for all solutions that are compared.
[[nodiscard]] Probed probe(const scenes::Scene& scene, const scenes::LightGroups& groups,
                           const scenes::Effects& effects, const scenes::RayQuery& query,
                           const radiosity::Solution& solution, const radiosity::Solution& aimed_at,
                           const scenes::Camera& camera, const RenderOptions& options,
                           std::span<const std::uint32_t> pixels, const ProbeOptions& how);

}  // namespace earthshine::raytrace
