// SPDX-License-Identifier: Apache-2.0
// The error of a solution over all surfaces, from samples of its residual and the matrix at hand:
//   L - L~ = e = r + rho F e + ...        the second part from (1 - rho F) e = r, by patches
// so that at a point of patch p  e = r + g_p,  and the mean square over the patch is
//   <r^2> + 2 <r> g_p + g_p^2,
// each square as a product of two halves of the samples that share no chance.
#pragma once

#include "raytrace/surfaces/surface_error.h"
#include "raytrace/surfaces/surface_light.h"
#include "raytrace/surfaces/surface_refiner.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

struct ResidualError {
  SolutionError parts;
  double mean = 0.0;            // of the radiosity as it should be, luminance, lm/m^2
  double square = 0.0;          // all relative to the mean's square: of the error
  double patches = 0.0;         // of it, what is no noise: patches too large
  double standard_error = 0.0;  // standard error of `square`
  double unweighted = 0.0;      // root mean square at points, each counted in full
};

// Of the light itself, expected of the samples it was made from: mean squares over a patch, lm/m^2.
struct LightNoise {
  std::vector<double> rays, lamps;  // per patch
  [[nodiscard]] std::vector<double> all() const;
};

// Points and rays of a patch for so many cosine rays, at least 128: eight points with ever more rays
// first. Of two points those of the largest product are the largest by chance.
[[nodiscard]] SampleBudget budget_of(double rays);
// So many points over all patches by area, eight on each at least.
[[nodiscard]] std::vector<SampleBudget> even_budget(const LightOnSurfaces& light, double points);
// The same of some patches, and `points` more by the share of all that is uneven.
[[nodiscard]] std::vector<SampleBudget> budget_where_uneven(const radiosity::Patches& patches,
                                                            std::span<const std::uint32_t> which,
                                                            const SurfaceRefiner& choice,
                                                            double points);

// Shadow rays alone: eight points on each of these patches, and `points` more over all surfaces.
[[nodiscard]] std::vector<SampleBudget> shadow_budget(const radiosity::Patches& patches,
                                                      std::span<const std::uint32_t> which,
                                                      double points);

// Rays in proportion to the root of area times variance, so that the noise that is left in all is
// `target`; `most` of them, and at least so many points that the error can be stated. variance: of
// the patches before a cut, of which `parent` tells.
[[nodiscard]] std::vector<SampleBudget> budget_for(const LightOnSurfaces& light,
                                                   const std::vector<double>& variance,
                                                   const std::vector<std::uint32_t>& parent,
                                                   double target, double most, double points);

// The variance of r as one ray finds it, per patch: half its own guess, half the mean of all that
// `which` names, of which budget is; 0 of others.
[[nodiscard]] std::vector<double> ray_variance(const radiosity::Patches& patches,
                                               const SurfaceSamples& samples,
                                               std::span<const std::uint32_t> which,
                                               std::span<const SampleBudget> budget);
[[nodiscard]] LightNoise noise_of(const LightOnSurfaces& light,
                                  const std::vector<double>& ray_variance,
                                  const SurfaceSamples& samples);

// samples: of all patches, and noise, both the first rank's; of ranks that divide the factors of
// the light each must ask, and gets it.
[[nodiscard]] ResidualError residual_error(const LightOnSurfaces& light,
                                           const SurfaceSamples& samples, const LightNoise& noise,
                                           const radiosity::PatchAlbedos& reflectances,
                                           double solver_error);

}  // namespace earthshine::raytrace
