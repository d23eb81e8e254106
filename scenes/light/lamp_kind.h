// SPDX-License-Identifier: Apache-2.0
// What tells the kinds of lamps apart, a row each; their light is in lamp_light.h, their keys in
// scenes/read/lamp.cpp.
#pragma once

#include <array>
#include <string_view>

#include "scenes/scene.h"

namespace earthshine::scenes {

struct LampRow {
  std::string_view type;  // as scene files have it
  // Of the surface that shines, by its exitance: m^2, and the radius of the ball around it in m.
  // Null for what shines from a point, by its intensity.
  double (*area)(const Lamp&);
  double (*radius)(const Lamp&);
};
// In LampKind's order.
inline constexpr std::array<LampRow, 5> lamp_rows = {{
    {"point", nullptr, nullptr},
    {"spot", nullptr, nullptr},
    {"rectangle",
     [](const Lamp& lamp) { return glm::length(glm::cross(lamp.edge_u, lamp.edge_v)); },
     [](const Lamp& lamp) {
       return 0.5 * glm::max(glm::length(lamp.edge_u + lamp.edge_v),
                             glm::length(lamp.edge_u - lamp.edge_v));
     }},
    {"disk", [](const Lamp& lamp) { return base::pi * lamp.radius_m * lamp.radius_m; },
     [](const Lamp& lamp) { return lamp.radius_m; }},
    {"ies", nullptr, nullptr},
}};

[[nodiscard]] constexpr const LampRow& row_of(LampKind kind) {
  return lamp_rows[static_cast<std::size_t>(kind)];
}
// A wide lamp has a surface: it can be seen, hidden in part, distributed.
[[nodiscard]] constexpr bool is_wide(LampKind kind) { return row_of(kind).area != nullptr; }

}  // namespace earthshine::scenes
