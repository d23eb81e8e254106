// SPDX-License-Identifier: Apache-2.0
// Which patches are halved: those that hold most of what is uneven within them.
#pragma once

#include "radiosity/patches/worst_cuts.h"
#include "studies/surfaces/surface_samples.h"

namespace earthshine::studies {

class CutChoice {
 public:
  // spot_m2: no patch as small is cut (SurfaceLight).
  explicit CutChoice(const radiosity::Patches& patches, double spot_m2 = 0.0);

  // What samples of some patches showed, of all of them the first time. noise: of the mean square
  // of r, what is the light's own noise, per patch; empty: what patches are off by as a whole.
  void see(const radiosity::Patches& patches, const SurfaceSamples& samples,
           std::span<const std::uint32_t> which, std::span<const double> noise = {});
  // The worst patches, as many as leave `enough` of the mean square over all area if halves hold
  // half of it, at most those that hold the share `most_of` of it (Doerfler 1996: where all are cut
  // in every round, most cuts are of patches that hold little), and no more patches than `most`.
  // Empty: there is nothing left to cut that is not noise, or no need.
  [[nodiscard]] std::vector<radiosity::Cut> worst(const radiosity::Patches& patches, double enough,
                                                  double most_of, std::size_t most) const;
  // After the cut: the patches that are new, which hold their part of what they were cut from.
  std::vector<std::uint32_t> follow(const radiosity::Patches& patches,
                                    const std::vector<std::uint32_t>& parent);
  // Of the mean square over all area.
  [[nodiscard]] double total() const;
  // What a patch is known or, as a piece of another, expected to hold of it.
  [[nodiscard]] double held_by(std::uint32_t patch) const { return uneven_[patch].error; }
  // Per patch, how far the rays that its light is known by count for its pieces.
  [[nodiscard]] std::span<const float> kept_rays() const { return kept_rays_; }

 private:
  double spot_m2_;
  std::vector<radiosity::Unevenness> uneven_;  // per patch, times area over all area
  std::vector<double> patch_m2_;               // area per patch
  std::vector<float> kept_rays_;
  bool is_expected_ = false;  // after the first look
  double area_m2_ = 0.0;
};

}  // namespace earthshine::studies
