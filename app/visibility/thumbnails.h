// SPDX-License-Identifier: Apache-2.0
// Small pictures of conditions, clean and on the monitor, from the layers that are at hand: the
// report shows them beside the reasons of a cell.
#pragma once

#include <cstddef>
#include <vector>

#include "app/visibility/camera_work.h"

namespace earthshine::app {

// Of one camera: under each lamp setting the places nearest to noon and to midnight, the first one,
// and each at which the verdict on a target is another than at the place before; of a study without
// an orbit all conditions. `judged`: a list of targets for each condition.
[[nodiscard]] std::vector<std::size_t> pictured_conditions(const StudyPart& part,
                                                           const std::vector<Json>& judged);

// Whether all of them are there from an earlier run.
[[nodiscard]] bool thumbnails_are_there(const CameraWork& work, const std::vector<Json>& judged);

// Draws those that are not there into pictures/, at most 160 pixels wide, each by its own exposure;
// adds entries of study.json to `thumbnails`. view: null where all are there.
void draw_thumbnails(const CameraWork& work, const studies::BasisView* view,
                     const std::vector<Json>& judged, Json& thumbnails);

}  // namespace earthshine::app
