// SPDX-License-Identifier: Apache-2.0
// Measured luminaires: IES LM-63 files of 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scenes/light/photometry.h"

namespace earthshine::scenes {

// Change of the lamp's output when its luminaire is tilted from the position of its measurement.
struct TiltTable {
  std::vector<double> angle_deg, factor;
  [[nodiscard]] double factor_at(double tilt_deg) const;  // interpolates; constant beyond the ends
};

struct Luminaire {
  std::string description;                  // from the keywords, or the first line of text
  std::optional<TiltTable> tilt;            // from TILT=INCLUDE
  double opening_m = 0.0;                   // longest side of the luminous opening
  std::shared_ptr<const Photometry> light;  // includes candela multiplier and ballast factors
  std::string warning;                      // names unused contents; may be empty
};

inline constexpr std::size_t max_ies_bytes = std::size_t{16} << 20;

// Photometry of type C only. Symmetries are expanded: the table covers the full circle. Throws
// base::Error (Input) at file:line[:column] for any other content.
[[nodiscard]] Luminaire parse_ies(std::string_view bytes, const std::string& file);

// asked_at: the place that names the file. Pipes and devices are an error.
[[nodiscard]] Luminaire read_ies(const std::filesystem::path& path, const base::Location& asked_at);

}  // namespace earthshine::scenes
