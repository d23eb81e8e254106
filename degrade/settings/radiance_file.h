// SPDX-License-Identifier: Apache-2.0
// Reads the chain's input picture from a file of any size.
#pragma once

#include <cstddef>
#include <filesystem>

#include "base/files/exr_reader.h"
#include "degrade/chain.h"

namespace earthshine::degrade {

inline constexpr std::size_t most_pixels_kept = std::size_t{1} << 24;

struct RadianceFile {
  base::Image image;  // R, G, B or Y, cd/m^2
  int columns = 0;    // of the file
  int rows = 0;
  bool averaged = false;            // to the sensor's grid
  std::size_t negative_pixels = 0;  // replaced by black before averaging
};

// The picture of the file. With more than `most_pixels` pixels it is read in strips and averaged
// onto the grid of picture_grid, as the stage sensor-grid would do, with the memory of one strip.
// It is not averaged if that stage is off. Throws base::Error (Input) as ExrReader does. Throws
// base::Error (Work) before allocation if the picture needs more memory than is free.
[[nodiscard]] RadianceFile read_radiance(base::ExrReader& reader, const Setup& setup,
                                         std::size_t most_pixels = most_pixels_kept);

}  // namespace earthshine::degrade
