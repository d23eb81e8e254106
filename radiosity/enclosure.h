// SPDX-License-Identifier: Apache-2.0
// Whether light that enters has anywhere to end.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// In a part of the scene that is closed and reflects everything, B = S + rho F B has no solution
// for any S above 0. Throws base::Error (Input) with the materials of such a part. source,
// reflectance: count x columns.
void check_enclosure(const scenes::Scene& scene, const Patches& patches, const FormFactors& factors,
                     std::span<const double> source, std::span<const double> reflectance,
                     std::size_t columns);

}  // namespace earthshine::radiosity
