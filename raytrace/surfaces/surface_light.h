// SPDX-License-Identifier: Apache-2.0
// A solution that is made better without another matrix: the matrix stays on the coarse patches
// that were solved for, light is kept on patches as fine as wanted. What samples find
// (surface_samples.h) goes into each patch; what it changes elsewhere, e = (1 - rho F)^-1 r, goes
// through the matrix (the equation of the error; Lischinski, Smits and Greenberg 1994 bound it,
// here it is solved with the residual itself).
#pragma once

#include "radiosity/fill_solution.h"
#include "radiosity/patches/patches.h"
#include "radiosity/patches/split.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SharedSamples;

// Of ranks that divide the factors each has the patches and their light, which samples read, and
// the first alone the rest: all of them must call what needs the matrix or changes the light, with
// what the first one gives.
class LightOnSurfaces {
 public:
  // coarse: solved with those factors, balanced or not; `rays` of them a patch. Of its light only
  // direct_lx and indirect_lx are read.
  LightOnSurfaces(const scenes::World& scene, radiosity::Solution coarse,
                  radiosity::FormFactors factors, double rays);

  [[nodiscard]] const SurfaceLight& light() const { return light_; }
  [[nodiscard]] const radiosity::Patches& patches() const { return light_.solution.patches; }
  [[nodiscard]] const radiosity::ClosedBodies* bodies() const { return factors_.open.bodies.get(); }
  [[nodiscard]] const base::Shares& shares() const { return factors_.shares; }

  [[nodiscard]] bool is_spot(std::uint32_t patch) const { return light_.is_spot(patch); }

  // The first rank's, as are the two below. Luminance, over what no body covers.
  [[nodiscard]] double mean_radiosity() const;
  [[nodiscard]] double told_mean() const;  // the same, by all ranks and to all
  // Samples that are in the light of a patch already.
  [[nodiscard]] double lamp_rays(std::uint32_t patch) const { return lamp_rays_[patch]; }
  [[nodiscard]] double gather_rays(std::uint32_t patch) const { return gather_rays_[patch]; }

  // The illuminance, per coarse patch and column, that a residual of the radiosity (per patch and
  // column) brings there by all its bounces: F (1 - rho F)^-1 r.
  [[nodiscard]] std::vector<double> brought(std::vector<double> residual,
                                            std::size_t columns) const;
  // The coarse patch that a patch is of; the first rank's.
  [[nodiscard]] std::uint32_t coarse(std::uint32_t patch) const { return coarse_[patch]; }

  // Takes in samples, each patch by the share of its samples in all that it has seen; what cosine
  // rays find is shared between the patches of a coarse one (shared_samples.h).
  void correct(const SurfaceSamples& samples, std::span<const std::uint32_t> which,
               std::span<const SampleBudget> budget);
  // Halves take what is interpolated at their middle; they have the samples of their parent for
  // what gathers, which count by the share kept_rays (per patch), none for shadows. Returns the
  // parent of each patch.
  std::vector<std::uint32_t> cut(const std::vector<radiosity::Cut>& wanted,
                                 std::span<const float> kept_rays);

  struct Finished {
    radiosity::Solution solution;
    double lacks =
        0.0;  // of the mean radiosity or the flux, luminance, before the ledger was closed
  };
  [[nodiscard]] Finished finished() const;

 private:
  void sum_up();
  void take_gathered(const SurfaceSamples& samples, const SharedSamples& sharing,
                     std::span<const std::uint32_t> which, const std::vector<double>& more);
  void keep_what_samples_read();
  [[nodiscard]] double fill(radiosity::Solution& solution) const;
  [[nodiscard]] std::vector<double> means_of(const std::vector<double>& residual,
                                             std::size_t columns) const;
  [[nodiscard]] double close_energy(radiosity::PatchLight& found) const;
  [[nodiscard]] double close_flux(radiosity::PatchLight& found,
                                  std::vector<radiosity::SourceFlux>& sources) const;

  scenes::World scene_;
  SurfaceLight light_;
  radiosity::FormFactors factors_;
  radiosity::PatchAlbedos reflectances_;
  std::vector<Rgb> emitted_;                // per coarse patch, through form factors; empty: none
  std::vector<std::uint32_t> coarse_;       // per patch
  std::vector<double> coarse_reflectance_;  // per own coarse row and colour
  std::vector<double> lamp_rays_, gather_rays_;  // per patch
  std::vector<double> escape_, lost_;            // per patch: shares of what leaves it
};

}  // namespace earthshine::raytrace
