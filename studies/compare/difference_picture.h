// SPDX-License-Identifier: Apache-2.0
// How far one picture's luminance is off another's, in bands of the ratio, with the scale drawn
// beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "studies/targets/target_view.h"

namespace earthshine::studies {

struct DifferencePicture {
  int columns = 0;                // the picture's and the scale's
  int rows = 0;                   // the picture's, or the scale's if that is taller
  std::vector<std::uint8_t> rgb;  // sRGB
};

// Bands of L / L_ref: white within a factor 1.1, then red for too bright and blue for too dark at
// 1.1, 1.5, 2 and 4; black in both is white. The scale stands to the right, the brightest band on
// top, each limit written at the line between its bands: "x1.5", "/1.5". Both pictures have the
// same size.
[[nodiscard]] DifferencePicture difference_picture(const base::Image& image,
                                                   const base::Image& reference);

// The same with a caption below, a paragraph per entry; pixels that show no object, which are not
// compared, are grey, and the scale says so ("sky"). Pixels of a small picture are
// drawn as squares; a narrow one gets paper beside it.
[[nodiscard]] DifferencePicture difference_picture(const base::Image& image,
                                                   const base::Image& reference,
                                                   const ObjectMap& map,
                                                   const std::vector<std::string>& caption);

}  // namespace earthshine::studies
