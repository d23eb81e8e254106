// SPDX-License-Identifier: Apache-2.0
// What every study is given.
#pragma once

#include <functional>
#include <string>

#include "raytrace/render.h"

namespace earthshine::studies {

// A scene with what the stages need beside it; all must outlive the study.
struct StudyScene {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const scenes::Effects& effects;
  const scenes::RayQuery& query;
};

// Told the name of each stage as it begins; gives the listener for its progress, which may be
// empty.
using StageListener = std::function<raytrace::Progress(const std::string& stage)>;

}  // namespace earthshine::studies
