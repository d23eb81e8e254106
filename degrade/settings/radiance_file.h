// SPDX-License-Identifier: Apache-2.0
// The picture that the chain starts from, out of a file of any size.
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
  bool averaged = false;            // to the sensor's grid already
  std::size_t negative_pixels = 0;  // taken as black before averaging
};

// As it is, or, of more than `most_pixels`, read in strips and averaged onto the grid of
// picture_grid, exactly as the stage sensor-grid would: memory is that of a strip. Not averaged
// where that stage is off. Throws base::Error (Input) as ExrReader does, and (Work) when the
// picture needs more memory than is free, before anything is taken.
[[nodiscard]] RadianceFile read_radiance(base::ExrReader& reader, const Setup& setup,
                                         std::size_t most_pixels = most_pixels_kept);

}  // namespace earthshine::degrade
