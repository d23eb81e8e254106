// SPDX-License-Identifier: Apache-2.0
// Improves a solution without another matrix: the matrix stays on the coarse patches, while the
// light is stored on patches as fine as needed. Samples (surface_samples.h) correct the light of
// each patch; the matrix propagates the correction, e = (1 - rho F)^-1 r (the equation of the
// error; Lischinski, Smits and Greenberg 1994 bound it, here it is solved for the residual itself).
#pragma once

#include "radiosity/fill_solution.h"
#include "radiosity/patches/patches.h"
#include "radiosity/patches/split.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SharedSamples;

// If ranks divide the form factors, each rank has the patches and their light, and only the root
// rank has the rest. All ranks must call functions that use the matrix or change the light; the
// root's arguments count.
class LightOnSurfaces {
 public:
  // coarse: solved with these factors, balanced or not; rays: of each patch. Of the coarse light
  // only direct_lx and indirect_lx are read.
  LightOnSurfaces(const scenes::World& scene, radiosity::Solution coarse,
                  radiosity::FormFactors factors, double rays);

  [[nodiscard]] const SurfaceLight& light() const { return light_; }
  [[nodiscard]] const radiosity::Patches& patches() const { return light_.solution.patches; }
  [[nodiscard]] const radiosity::ClosedBodies* bodies() const { return factors_.open.bodies.get(); }
  [[nodiscard]] const base::Shares& shares() const { return factors_.shares; }

  [[nodiscard]] bool is_spot(std::uint32_t patch) const { return light_.is_spot(patch); }

  // Luminance, averaged over the open parts. On the root rank only, like lamp_rays() and
  // gather_rays().
  [[nodiscard]] double mean_radiosity() const;
  [[nodiscard]] double mean_on_all_ranks() const;  // collective; on all ranks
  // Samples already in the light of a patch.
  [[nodiscard]] double lamp_rays(std::uint32_t patch) const { return lamp_rays_[patch]; }
  [[nodiscard]] double gather_rays(std::uint32_t patch) const { return gather_rays_[patch]; }

  // Illuminance per coarse patch and column by all bounces of a residual of the radiosity (per
  // patch and column): F (1 - rho F)^-1 r.
  [[nodiscard]] std::vector<double> brought(std::vector<double> residual,
                                            std::size_t columns) const;
  // The coarse patch of a patch; on the root rank only.
  [[nodiscard]] std::uint32_t coarse(std::uint32_t patch) const { return coarse_[patch]; }

  // Adds samples to the light, each patch weighted by the share of the new samples in all. The
  // patches of a coarse patch share the light from cosine rays (shared_samples.h).
  void correct(const SurfaceSamples& samples, std::span<const std::uint32_t> which,
               std::span<const SampleBudget> budget);
  // Divides patches. Each part takes the light interpolated at its centre. It inherits the fraction
  // kept_rays (per patch) of its parent's cosine rays and none of its shadow rays. Returns the
  // parent of each patch.
  std::vector<std::uint32_t> cut(const std::vector<radiosity::Cut>& wanted,
                                 std::span<const float> kept_rays);

  struct Finished {
    radiosity::Solution solution;
    // Defect of the energy ledger, relative to the mean radiosity or the flux, luminance.
    double ledger_defect = 0.0;
  };
  [[nodiscard]] Finished finished() const;

 private:
  void sum_up();
  void take_gathered(const SurfaceSamples& samples, const SharedSamples& sharing,
                     std::span<const std::uint32_t> which, const std::vector<double>& more);
  void drop_unread();
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
  std::vector<Rgb> emitted_;                     // per coarse patch: emission in the form factors;
                                                 // empty: none
  std::vector<std::uint32_t> coarse_;            // per patch
  std::vector<double> coarse_reflectance_;       // per own coarse row and colour
  std::vector<double> lamp_rays_, gather_rays_;  // per patch
  std::vector<double> escape_, lost_;            // per patch: shares of the light that leaves it
};

}  // namespace earthshine::raytrace
