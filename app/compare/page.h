// SPDX-License-Identifier: Apache-2.0
// compare.html: results of the comparison as one page with pictures beside it, without scripts.
#pragma once

#include <string>
#include <vector>

#include "studies/compare/compare.h"

namespace earthshine::app {

inline constexpr const char* compare_page = "compare.html";

// The files of a method's picture and of its difference from the reference; for the reference only
// its picture.
[[nodiscard]] std::vector<std::string> picture_files(const studies::Method& method);

// The complete page; pictures are referenced by name. scene, camera: names, any text. warnings: of
// the scene.
[[nodiscard]] std::string page_of(const std::string& scene, const std::string& camera,
                                  const std::vector<std::string>& warnings,
                                  const studies::Comparison& comparison);

}  // namespace earthshine::app
