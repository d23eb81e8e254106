// SPDX-License-Identifier: Apache-2.0
// A solution's surfaces as a page: patches in false colours, to be turned.
#pragma once

#include <string>

namespace earthshine::app {

struct SolutionPage {
  std::string html;
  std::size_t patches = 0, layers = 0;
};
// Of a file of `solve -o FILE.h5`. Throws base::Error (Input) if it is none, or larger than a page.
[[nodiscard]] SolutionPage solution_page(const std::string& path);

}  // namespace earthshine::app
