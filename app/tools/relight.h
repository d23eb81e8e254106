// SPDX-License-Identifier: Apache-2.0
// Changes lamp settings in a picture with a layer per light group.
#pragma once

#include <string>
#include <vector>

#include "base/files/exr_file.h"

namespace earthshine::app {

// settings: GROUP=FACTOR or GROUP=R,G,B. Removes the stated error from the header and adds the
// settings. source: named in errors. Throws base::Error (Input) as studies::relight, and for an
// invalid setting.
void relight(base::ExrFile& file, const std::vector<std::string>& settings,
             const std::string& source);

}  // namespace earthshine::app
