// SPDX-License-Identifier: Apache-2.0
// The Earth's albedo by latitude and longitude, from a table or a map.
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::scenes {

// Values at the nodes of a grid. Bilinear between them; constant beyond the outermost latitudes,
// periodic in longitude.
class AlbedoGrid {
 public:
  // Both in degrees, rising; longitudes within one turn. One longitude: by latitude alone.
  // values: by row of one latitude.
  AlbedoGrid(std::vector<double> latitudes, std::vector<double> longitudes,
             std::vector<double> values);

  // up: unit, along ITRF's axes; its latitude is geocentric.
  [[nodiscard]] double at(const Vec3& up) const;
  [[nodiscard]] double largest() const { return largest_; }
  [[nodiscard]] const std::vector<double>& latitudes() const { return latitudes_; }
  [[nodiscard]] const std::vector<double>& longitudes() const { return longitudes_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> latitudes_, longitudes_, values_;
  double largest_;
};

// A map (*.png, *.exr) covers the whole Earth: rows from the north pole, columns eastward from -180
// deg, values at the middles of pixels: of a grey PNG of 8 or 16 bits over the largest one, linear;
// of an EXR its only channel, Y, or equal R, G, B. Else a CSV file, in which
// the header names "latitude_deg" and then the longitudes, east, in degrees; or "latitude_deg,
// albedo" for one by latitude alone. Rows rise in latitude. Throws base::Error (Input) at file,
// line and column for anything else, and for albedos that are not from 0 to 1.
[[nodiscard]] AlbedoGrid read_albedo_grid(const std::filesystem::path& path,
                                          const base::Location& asked_at);

}  // namespace earthshine::scenes
