// SPDX-License-Identifier: Apache-2.0
// What bodies leave open of the patches (closed_bodies.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace earthshine::radiosity {

class ClosedBodies;

struct OpenParts {
  std::vector<double> share;  // per patch: of its points, those that no body covers; empty: all 1
  std::shared_ptr<const ClosedBodies> bodies;  // null: nothing is covered
};

// area_m2 times the share.
[[nodiscard]] std::vector<double> open_areas(const OpenParts& open,
                                             std::span<const double> area_m2);

}  // namespace earthshine::radiosity
