// SPDX-License-Identifier: Apache-2.0
// Other lamp settings of a picture that has a layer per light group.
#pragma once

#include <string>
#include <vector>

#include "base/files/exr_file.h"

namespace earthshine::app {

// settings: GROUP=FACTOR or GROUP=R,G,B. The header loses its stated error and says the settings.
// source: what errors name. Throws base::Error (Input) as studies::relight, and for a setting that
// is none.
void relight(base::ExrFile& file, const std::vector<std::string>& settings,
             const std::string& source);

}  // namespace earthshine::app
