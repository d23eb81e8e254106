// SPDX-License-Identifier: Apache-2.0
// Thumbnails of conditions, clean and on the monitor, from the available layers: the report shows
// them with the reasons of a cell.
#pragma once

#include <cstddef>
#include <vector>

#include "app/visibility/camera_work.h"

namespace earthshine::app {

// Conditions with a thumbnail. For one camera and each lamp setting: the positions nearest to noon
// and to midnight, the first position, each position where a target's verdict changes, and, for a
// camera with few conditions, each one at which a target that is not hidden is missed. In a study
// without an orbit all conditions.
[[nodiscard]] std::vector<std::size_t> pictured_conditions(const StudyPart& part,
                                                           const Judged& judged);

// Whether all of them exist from an earlier run.
[[nodiscard]] bool thumbnails_are_there(const CameraWork& work, const Judged& judged);

// Draws the missing ones into pictures/, at most 160 pixels wide, with their own exposures;
// conditions are numbered as in `judged`. view: null if all exist.
[[nodiscard]] std::vector<ThumbnailEntry> draw_thumbnails(const CameraWork& work,
                                                          const studies::BasisView* view,
                                                          const Judged& judged);

}  // namespace earthshine::app
