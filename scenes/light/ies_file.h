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

// How the lamp's output changes as its luminaire is tilted from the position it was measured in.
struct TiltTable {
  std::vector<double> angle_deg, factor;
  [[nodiscard]] double factor_at(double tilt_deg) const;  // linear between; the ends hold beyond
};

struct Luminaire {
  std::string description;                  // of the keywords, or the first line of text
  std::optional<TiltTable> tilt;            // of TILT=INCLUDE
  double opening_m = 0.0;                   // longest side of the luminous opening
  std::shared_ptr<const Photometry> light;  // candela multiplier and ballast factors applied
  std::string warning;                      // of content that is not used; may be empty
};

inline constexpr std::size_t max_ies_bytes = std::size_t{16} << 20;

// Photometry of type C only. Symmetries are unfolded: the table covers the full circle.
// Throws base::Error (Input) at file:line[:column] for anything that is not such a file.
[[nodiscard]] Luminaire parse_ies(std::string_view bytes, const std::string& file);

// asked_at is the place that names the file. A pipe or a device is refused, not waited for.
[[nodiscard]] Luminaire read_ies(const std::filesystem::path& path, const base::Location& asked_at);

}  // namespace earthshine::scenes
