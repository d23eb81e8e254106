// SPDX-License-Identifier: Apache-2.0
// The header of a rendered EXR file: everything that decides its pixels, and how good they are.
// Never the number of threads or a time (unless asked for): the same call gives the same bytes.
#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "base/exr_file.h"
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
  const radiosity::SolveReport* solution;  // nullptr: nothing was solved
  const raytrace::RenderReport& render;
};

[[nodiscard]] std::string indirect_name(raytrace::Indirect indirect);

// Attributes "earthshine:…".
[[nodiscard]] base::ExrHeader provenance_header(const Provenance& provenance);

// Adds "earthshine:seconds.<stage>".
void add_times(base::ExrHeader& header, const StageTimes& times);

}  // namespace earthshine::app
