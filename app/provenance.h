// SPDX-License-Identifier: Apache-2.0
// The header of a rendered EXR file: all input that determines its pixels, and its error. No number
// of threads, and no times unless requested: the same call gives the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/command.h"
#include "base/files/exr_file.h"
#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/scene.h"

namespace earthshine::app {

struct Provenance {
  const scenes::Scene& scene;
  const std::vector<std::string>& overrides;
  const scenes::Camera& camera;
  const raytrace::RenderOptions& options;
  const radiosity::SolveOptions& solver;
  const radiosity::SolveReport* solution;  // nullptr: no solution
  const raytrace::RenderReport& render;
};

// Mark for outputs derived from a stopped picture, from its header: "earthshine:partial"; else
// empty.
[[nodiscard]] HeaderTexts partial_mark(const base::ExrHeader& header);

[[nodiscard]] std::string indirect_name(raytrace::Indirect indirect);

// Version, scene, overrides and seed.
void add_origin(base::ExrHeader& header, const scenes::Scene& scene,
                const std::vector<std::string>& overrides, std::uint64_t seed);

// Attributes "earthshine:…".
[[nodiscard]] base::ExrHeader provenance_header(const Provenance& provenance);

// Adds the camera: its keys, intrinsics and pose (raytrace/camera/camera.h) as
// "earthshine:camera.K" and "earthshine:camera.to_world", and as OpenEXR's worldToCamera,
// worldToNDC, screenWindowWidth and focus.
void add_camera(base::ExrHeader& header, const scenes::Camera& camera, int columns, int rows);

// Adds the meaning of the requested layers' numbers: "earthshine:objects" and
// "earthshine:materials" as JSON arrays of names, and Cryptomatte's attributes and manifests.
void add_names(base::ExrHeader& header, const scenes::Scene& scene,
               const std::vector<std::string>& aovs);

// Adds "earthshine:seconds.<stage>".
void add_times(base::ExrHeader& header, const StageTimes& times);

}  // namespace earthshine::app
