// SPDX-License-Identifier: Apache-2.0
// The error of a solution over all surfaces, from samples of its residual and the existing matrix:
//   e = L - L~ = r + rho F e
// The matrix gives the second term, g = rho F (1 - rho F)^-1 r, per coarse patch. At a point of a
// patch, e = r + g, and the mean square over the patch is
//   <r^2> + 2 <r> g + g^2,
// each square as a product of two independent halves of the samples.
#pragma once

#include "raytrace/surfaces/surface_error.h"
#include "raytrace/surfaces/surface_light.h"
#include "raytrace/surfaces/surface_refiner.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

struct ResidualError {
  SolutionError parts;
  double mean = 0.0;            // true mean of the radiosity, luminance, lm/m^2
  double square = 0.0;          // squared error; this and the following relative to the mean, or
                                // its square
  double patches = 0.0;         // part of `square` due to patches that are too large
  double standard_error = 0.0;  // of `square`
  double unweighted = 0.0;      // root mean square at points, without error_weight()
};

// Expected noise of the light's samples: mean squares over a patch, lm/m^2.
struct LightNoise {
  std::vector<double> rays, lamps;  // per patch
  [[nodiscard]] std::vector<double> all() const;
};

// Points and rays of a patch for this number of cosine rays, at least 128: eight points with up to
// 64 rays per half, then more points. With two points, the largest products would be due to chance.
[[nodiscard]] SampleBudget budget_of(double rays);
// `points` over all patches by area, and two more on each; at least eight each.
[[nodiscard]] std::vector<SampleBudget> even_budget(const LightOnSurfaces& light, double points);
// The same for some patches, and `points` more in proportion to their shares of the unevenness.
[[nodiscard]] std::vector<SampleBudget> budget_where_uneven(const radiosity::Patches& patches,
                                                            std::span<const std::uint32_t> which,
                                                            const SurfaceRefiner& choice,
                                                            double points);

// Shadow rays only: eight points on each of these patches, and `points` more over all surfaces.
[[nodiscard]] std::vector<SampleBudget> shadow_budget(const radiosity::Patches& patches,
                                                      std::span<const std::uint32_t> which,
                                                      double points);

// Rays in proportion to sqrt(area * variance), so that the total remaining noise is `target`; at
// most `most` new rays, and at least `points` points, for the stated error. variance: of the
// patches before a cut; parent: patch before the cut of each patch.
[[nodiscard]] std::vector<SampleBudget> budget_for(const LightOnSurfaces& light,
                                                   const std::vector<double>& variance,
                                                   const std::vector<std::uint32_t>& parent,
                                                   double target, double most, double points);

// Variance of r for a single ray, per patch: half its own estimate, half the mean over `which`,
// which `budget` belongs to; 0 for others.
[[nodiscard]] std::vector<double> ray_variance(const radiosity::Patches& patches,
                                               const SurfaceSamples& samples,
                                               std::span<const std::uint32_t> which,
                                               std::span<const SampleBudget> budget);
[[nodiscard]] LightNoise noise_of(const LightOnSurfaces& light,
                                  const std::vector<double>& ray_variance,
                                  const SurfaceSamples& samples);

// samples (of all patches) and noise are read on the root rank only. All ranks that divide the form
// factors must call this, and all get the result.
[[nodiscard]] ResidualError residual_error(const LightOnSurfaces& light,
                                           const SurfaceSamples& samples, const LightNoise& noise,
                                           const radiosity::PatchAlbedos& reflectances,
                                           double solver_error);

}  // namespace earthshine::raytrace
