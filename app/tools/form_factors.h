// SPDX-License-Identifier: Apache-2.0
// The matrix of form factors between objects, and to the sky.
#pragma once

#include <string>

#include "app/command.h"

namespace earthshine::app {

enum class FactorMethod { Auto, Rays, Exact };
// "auto", "rays" or "exact". Throws base::Error (Input), naming the option, for other words.
[[nodiscard]] FactorMethod factor_method(const std::string& option, const std::string& word);

// The report of `form-factors --json`. raw: rays as cast, before closure and reciprocity.
[[nodiscard]] Json form_factors_json(LoadedScene& loaded, FactorMethod method, bool raw,
                                     const Common& common);

}  // namespace earthshine::app
