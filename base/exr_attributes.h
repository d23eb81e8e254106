// SPDX-License-Identifier: Apache-2.0
// Between ExrHeader and the library's own header. For exr_file.cpp alone.
#pragma once

#include <ImfHeader.h>

#include "base/exr_file.h"

namespace earthshine::base {

// Sets ZIP compression, Rec. 709 chromaticities, whiteLuminance = 1 and all of `attributes`.
void set_exr_attributes(Imf::Header& header, const ExrHeader& attributes);

// Text, numbers (whole ones and doubles as float) and 4 x 4 matrices of a file, so that they can be
// written again: not what describes the storage or is set by set_exr_attributes.
[[nodiscard]] ExrHeader exr_attributes(const Imf::Header& header);

}  // namespace earthshine::base
