// SPDX-License-Identifier: Apache-2.0
// compare.html: what the comparison found, as one page beside its pictures, without scripts.
#pragma once

#include <string>
#include <vector>

#include "studies/compare/compare.h"

namespace earthshine::app {

inline constexpr const char* compare_page = "compare.html";

// The file of a method's picture, and of its difference from the reference; of the reference its
// picture alone, which would differ from itself by nothing.
[[nodiscard]] std::vector<std::string> picture_files(const studies::Method& method);

// The whole page; the pictures are named, not put in. scene, camera: names, any text. warnings: of
// the scene.
[[nodiscard]] std::string page_of(const std::string& scene, const std::string& camera,
                                  const std::vector<std::string>& warnings,
                                  const studies::Comparison& comparison);

}  // namespace earthshine::app
