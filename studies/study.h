// SPDX-License-Identifier: Apache-2.0
// What every study is given: the world (scenes/effects/world.h) and who is told of its progress.
#pragma once

#include <functional>
#include <string>

#include "raytrace/render.h"

namespace earthshine::studies {

// Told the name of each stage as it begins; gives the listener for its progress, which may be
// empty.
using StageListener = std::function<raytrace::Progress(const std::string& stage)>;

}  // namespace earthshine::studies
