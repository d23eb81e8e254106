// SPDX-License-Identifier: Apache-2.0
// Faces that stand at the same place more than once.
#pragma once

#include "scenes/health/coincident.h"
#include "scenes/health/sheets.h"

namespace earthshine::scenes {

// Whether there are any but in objects that are to be left as they are.
[[nodiscard]] bool has_doubled_faces(const Scene& scene);

// As mend_surfaces has it; whether any were taken out or changed.
[[nodiscard]] bool mend_doubled_faces(Scene& scene, Sheets& sheets, const FaceParts& parts);

}  // namespace earthshine::scenes
