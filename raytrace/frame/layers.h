// SPDX-License-Identifier: Apache-2.0
// The layers of a frame, with the names that compositing programs know.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"

namespace earthshine::raytrace {

// Channel numbers of the layers of a frame.
struct Layout {
  std::vector<std::size_t> radiance;  // first of the three channels of each image layer
                                      // light_<group>; empty with one group
  std::vector<std::size_t> parts;     // per Part: its first channel, or none_wanted
  std::size_t variance = none_wanted;

  static constexpr std::size_t none_wanted = static_cast<std::size_t>(-1);
  [[nodiscard]] bool splits_parts() const;
};

// R, G, B come first. The layers of first_hit.h and cryptomatte.h are found by name. Throws
// base::Error (Input) for an unknown layer.
[[nodiscard]] Layout add_layers(base::Image& image, const std::vector<std::string>& light_groups,
                                const std::vector<std::string>& aovs);

}  // namespace earthshine::raytrace
