// SPDX-License-Identifier: Apache-2.0
// Light sampled at points of all patches, to be set against what a solution says there:
//   r = S + T L~ - L~
// S: emission and the light of Sun, Earth, lamps and small emitters by shadow rays; T L~: what
// cosine rays bring that read the solution L~ as pictures do (raytrace/incoming/radiance_table.h),
// and the sky; all reflected as radiosity has it (scenes/reflect/energy.h). Every
// point is looked at twice, by two halves of independent rays: the mean of their product is that of
// r^2, whatever noise each has. Nothing is sampled where bodies cover a patch.
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

// What L~ is made of: emission M and illuminances. Per patch and column (3 * groups) but `sky`.
struct SurfaceLight {
  radiosity::Solution solution;        // patches, columns, radiosity = M + rho (lamps + gathered)
  std::vector<float> lamps, gathered;  // lx: by shadow rays; by cosine rays, the sky with it
  std::vector<Rgb> sky;                // per patch and part of the sky, within `gathered`
  std::vector<double> open_share;      // per patch, what no body covers; empty: nothing is covered
  // The area of a spot, over which the error counts means alone: the square of a 256th of the
  // scene's diagonal, the pixel of a picture of 256 x 256 that shows all of it.
  double spot_m2 = 0.0;
  // Per patch, of each half at a point, to each source that has a size; to wide ones four at least.
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

// How much is sampled on a patch.
struct SampleBudget {
  std::uint16_t points = 2;  // an even number
  std::uint16_t rays = 8;    // cosine rays of each half at each point, a multiple of 8, or none
  [[nodiscard]] std::uint32_t all_rays() const { return 2U * points * rays; }
};

// Of one patch. r as luminance of the radiosity, lm/m^2, times error_weight() of the larger of
// what the solution says there and what it should say; what
// gather rays find is held to 2 max(solution, 4 means), but for the means that are not weighted.
struct PatchResidual {
  std::uint16_t taken = 0;                   // points that nothing covers
  float open = 1.0F;                         // share of the patch that nothing covers
  float square = 0.0F, square_error = 0.0F;  // mean of r^2 over the patch, and its standard error
  float weight = 1.0F;                       // mean error_weight()
  float unweighted = 0.0F;                   // mean of r^2 where each point counts in full
  bool wants_shadow_rays = false;            // more of them at a point: its halves are far apart
  float mean_square = 0.0F;                  // of r's mean, without its noise
  float mean_variance = 0.0F;                // of the mean of the taken points, due to rays
  float lamps_mean_square = 0.0F, lamps_mean_variance = 0.0F;  // of S's part of r
  float along_s = 0.0F, along_t = 0.0F;  // of r^2, what halving the patch takes away
  std::array<float, 2> mean{};  // of r, of every other point; on spots independent of each other
  // The same, not weighted.
  std::array<glm::vec3, 2> half{glm::vec3(0.0F), glm::vec3(0.0F)};
  std::array<float, 2> gathered{};  // luminance, lx: what either half of the rays brings
};

struct SurfaceSamples {
  std::vector<double> lamps, gathered;  // mean illuminance per patch and column, lx
  std::vector<Rgb> sky;
  std::vector<double> escaped, lost;    // per patch: of its rays, to the sky, to black backs
  std::vector<PatchResidual> residual;  // per patch
  std::uint64_t rays = 0;
};

// What of it is wanted: all, or the residual and `rays` alone.
enum class SamplesOf { Light, Residual };

class PatchSampler;
class ResidualSums;
struct SurfaceSpot;

// The hit of a ray that meets the patch at (x, y), as Patches::point() has it.
[[nodiscard]] scenes::Hit hit_at(const radiosity::Patches& patches, std::uint32_t patch, double x,
                                 double y);

class SurfaceSampler {
 public:
  // The scene must outlive it.
  explicit SurfaceSampler(const scenes::World& scene, std::uint64_t seed);

  // which: patches; budget: of each of them. The others' entries stay empty. `pass` numbers
  // independent sets of samples. mean: of the radiosity, that error_weight() goes by. `bodies` may
  // cover points; null: nothing is covered. progress: told how many patches are done. hears: the
  // rank that has what is found, of which each has `rays`; First: only where there are ranks.
  [[nodiscard]] SurfaceSamples sample(const SurfaceLight& light,
                                      std::span<const std::uint32_t> which,
                                      std::span<const SampleBudget> budget, std::uint32_t pass,
                                      double mean, const radiosity::ClosedBodies* bodies,
                                      const Progress& progress = {},
                                      SamplesOf of = SamplesOf::Light,
                                      base::Hears hears = base::Hears::All) const;

  [[nodiscard]] const radiosity::PatchAlbedos& reflectances() const { return reflectances_; }
  [[nodiscard]] const std::vector<bool>& is_explicit() const { return is_explicit_; }

 private:
  // Independent rays tell the weight of points whose halves do not agree how bright they are: by
  // their own values those that miss the light by chance would count most. gathers: into the
  // hemisphere, too.
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
