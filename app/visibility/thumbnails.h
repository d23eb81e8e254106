// SPDX-License-Identifier: Apache-2.0
// Small pictures of conditions, clean and on the monitor, from the layers that are at hand: the
// report shows them beside the reasons of a cell.
#pragma once

#include <cstddef>
#include <vector>

#include "app/visibility/camera_work.h"

namespace earthshine::app {

// Of one camera: under each lamp setting the places nearest to noon and to midnight, the first one,
// each at which the verdict on a target is another than at the place before, and, of a camera with
// few conditions, each at which a target that is not hidden is missed; of a study without an orbit all
// conditions.
[[nodiscard]] std::vector<std::size_t> pictured_conditions(const StudyPart& part,
                                                           const Judged& judged);

// Whether all of them are there from an earlier run.
[[nodiscard]] bool thumbnails_are_there(const CameraWork& work, const Judged& judged);

// Draws those that are not there into pictures/, at most 160 pixels wide, each by its own exposure;
// conditions are numbered as `judged`. view: null where all are there.
[[nodiscard]] std::vector<ThumbnailEntry> draw_thumbnails(const CameraWork& work,
                                                          const studies::BasisView* view,
                                                          const Judged& judged);

}  // namespace earthshine::app
