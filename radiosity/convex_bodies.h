// SPDX-License-Identifier: Apache-2.0
// Closed convex bodies among a scene's facets, whoever modelled them. From outside, what such a
// body hides is hidden by its faces towards the viewer alone: the others need no cutting.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/convex_polygon.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_body = 0xFFFFFFFFU;

// Per polygon: the closed convex body it is a face of, or no_body. A body's faces share whole edges
// with one another, two by two, and look outwards. Corners within margin_m are one.
[[nodiscard]] std::vector<std::uint32_t> find_convex_bodies(std::span<const ConvexPolygon> polygons,
                                                            double margin_m);

}  // namespace earthshine::radiosity
