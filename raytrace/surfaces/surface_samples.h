// SPDX-License-Identifier: Apache-2.0
// Samples of the residual of a solution at points of all patches:
//   r = S + T L~ - L~
// S: emission and the light of Sun, Earth, lamps and small emitters by shadow rays. T L~: light
// along cosine-distributed rays, which read the solution L~ as pictures do
// (raytrace/incoming/radiance_table.h) or the sky. Reflection is as in radiosity
// (scenes/reflect/energy.h). Each point has two halves of independent rays; the mean of their
// product is an unbiased estimate of r^2. Covered parts of a patch are not sampled.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/numbers/random.h"
#include "base/ranks/ranks.h"
#include "radiosity/direct/sources.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"
#include "radiosity/solution.h"
#include "raytrace/frame/options.h"
#include "raytrace/incoming/radiance_table.h"

namespace earthshine::raytrace {

// The parts of L~: emission M and illuminances. Per patch and column (3 * groups), except `sky`.
struct SurfaceLight {
  radiosity::Solution solution;        // patches, columns, radiosity = M + rho (lamps + gathered)
  std::vector<float> lamps, gathered;  // lx: by shadow rays; by cosine rays, with the sky
  std::vector<Rgb> sky;                // per patch and part of the sky, included in `gathered`
  std::vector<double> open_share;      // open share per patch; empty: no patch is covered
  // Area of a spot, over which only the mean error counts: the square of 1/256 of the scene's
  // diagonal, a pixel of a 256 x 256 picture of the whole scene.
  double spot_m2 = 0.0;
  // Per patch: rays of each half at a point to each source with extent; at least four to wide
  // sources.
  std::vector<std::uint8_t> shadow_rays;
  [[nodiscard]] std::size_t columns() const { return solution.columns; }
  [[nodiscard]] std::size_t count() const { return solution.patches.count(); }
  [[nodiscard]] bool is_spot(std::size_t patch) const {
    return solution.patches.area_m2[patch] <= spot_m2;
  }
  [[nodiscard]] double open_m2(std::size_t patch) const {
    return solution.patches.area_m2[patch] * (open_share.empty() ? 1.0 : open_share[patch]);
  }
};

// Number of samples on a patch.
struct SampleBudget {
  std::uint16_t points = 2;  // an even number
  std::uint16_t rays = 8;    // cosine rays of each half at each point: 0 or a multiple of 8
  [[nodiscard]] std::uint32_t all_rays() const { return 2U * points * rays; }
};

// Statistics of one patch. r is the luminance of the radiosity's residual, lm/m^2, times
// error_weight() of the larger of the solution's and the true radiosity. The part by gather rays is
// limited to 2 max(solution, 4 means), except in values without weight.
struct PatchResidual {
  std::uint16_t taken = 0;                   // open points
  float open = 1.0F;                         // open share of the patch
  float square = 0.0F, square_error = 0.0F;  // mean of r^2 over the patch, and its standard error
  float weight = 1.0F;                       // mean error_weight()
  float unweighted = 0.0F;                   // mean of r^2 without weight
  bool wants_shadow_rays = false;            // the halves at a point differ: use more
  float mean_square = 0.0F;                  // squared mean of r, without bias by noise
  float mean_variance = 0.0F;                // variance of the mean over the points, due to rays
  float lamps_mean_square = 0.0F, lamps_mean_variance = 0.0F;  // of S's part of r
  float along_s = 0.0F, along_t = 0.0F;  // reduction of r^2 by halving the patch
  std::array<float, 2> mean{};           // mean of r over alternate points; independent on spots
  // `mean` without weight.
  std::array<glm::vec3, 2> half{glm::vec3(0.0F), glm::vec3(0.0F)};
  std::array<float, 2> gathered{};  // luminance, lx: by each half of the rays
};

struct SurfaceSamples {
  std::vector<double> lamps, gathered;  // mean illuminance per patch and column, lx
  std::vector<Rgb> sky;
  std::vector<double> escaped, lost;    // per patch: shares of its rays to the sky, to black backs
  std::vector<PatchResidual> residual;  // per patch
  std::uint64_t rays = 0;
};

// The wanted results: all, or only the residual and `rays`.
enum class SamplesOf { Light, Residual };

class PatchSampler;
class ResidualSums;
struct SurfaceSpot;

// The hit of a ray that meets the patch at (x, y), the parameters of Patches::point().
[[nodiscard]] scenes::Hit hit_at(const radiosity::Patches& patches, std::uint32_t patch, double x,
                                 double y);

class SurfaceSampler {
 public:
  // The scene must outlive the sampler.
  explicit SurfaceSampler(const scenes::World& scene, std::uint64_t seed);

  // which: patches; budget: for each of them. Entries of other patches stay empty. pass: number of
  // the independent set of samples. mean: of the radiosity, for error_weight(). `bodies` may cover
  // points; null: none is covered. progress: gets the number of finished patches. receivers: the
  // rank that gets the result; all ranks get `rays`.
  [[nodiscard]] SurfaceSamples sample(const SurfaceLight& light,
                                      std::span<const std::uint32_t> which,
                                      std::span<const SampleBudget> budget, std::uint32_t pass,
                                      double mean, const radiosity::ClosedBodies* bodies,
                                      const Progress& progress = {},
                                      SamplesOf of = SamplesOf::Light,
                                      base::Receivers receivers = base::Receivers::All) const;

  [[nodiscard]] const radiosity::PatchAlbedos& reflectances() const { return reflectances_; }
  [[nodiscard]] const std::vector<bool>& is_explicit() const { return is_explicit_; }

 private:
  // Estimates the weight of points whose halves disagree about their brightness by independent
  // rays: with weights from their own values, points that miss the light by chance would count
  // most. gathers: also casts cosine rays.
  void weigh(PatchSampler& sampler, std::span<const SurfaceSpot> places, base::Key key, double mean,
             ResidualSums& sums, std::size_t points, bool gathers) const;

  scenes::World scene_;
  std::uint64_t seed_;
  std::vector<radiosity::LightSource> sources_;
  radiosity::PatchAlbedos reflectances_;
  std::vector<bool> is_explicit_;  // per material: emission by shadow rays
  std::vector<double> kept_;       // per material: 1 - mirror - transmit
};

}  // namespace earthshine::raytrace
