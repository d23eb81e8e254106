// SPDX-License-Identifier: Apache-2.0
// study.json, written and read by the lists of fields in results_fields.h.
#pragma once

#include <string>

#include "app/study/results.h"

namespace earthshine::app {

[[nodiscard]] Json to_json(const StudyResults& results);
// Throws base::Error (Input) with the place in `file` where something is not as it should be.
[[nodiscard]] StudyResults read_results(const std::string& file, const Json& json);

}  // namespace earthshine::app
