// SPDX-License-Identifier: Apache-2.0
// Divides the Suns of a sky in parts into strata. A path samples the Suns of one stratum only, with
// their light times the number of strata. In pictures that are weighted by one Sun at a time, a
// shadow ray to every Sun at each bounce of a path gains little. Camera samples carry all Suns,
// since their small number resolves each Sun's shadow edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/units.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

class SunStrata {
 public:
  SunStrata() = default;  // one stratum with all light
  // first_layer: of the first Sun; the layers of the Suns are consecutive.
  SunStrata(std::size_t first_layer, std::size_t suns)
      : first_(first_layer),
        suns_(suns),
        count_(suns > tuning::most_sun_sets ? tuning::most_sun_sets : 1) {}

  [[nodiscard]] std::size_t count() const { return count_; }
  // Stratum of the k-th sample of a half. Each half takes all strata in turn, because otherwise the
  // halves would differ systematically. They begin with different strata, so that two halves of few
  // samples cover all strata; halves of less than four samples then overstate the noise of their
  // sum.
  [[nodiscard]] std::size_t of_sample(std::uint64_t first, std::uint64_t k,
                                      std::size_t half) const {
    return (first + k + half * (tuning::most_sun_sets / 2)) % count_;
  }
  // Weight of a layer's light in samples of a stratum. The Suns of a stratum are spread over the
  // orbit, so that all strata are about equally bright.
  [[nodiscard]] double weight(std::size_t layer, std::size_t stratum) const {
    if (count_ == 1 || layer < first_ || layer >= first_ + suns_) return 1.0;
    return (layer - first_) % count_ == stratum ? static_cast<double>(count_) : 0.0;
  }
  // Weights all layers of a sample.
  void weigh(std::size_t stratum, std::span<Rgb> layers) const {
    for (std::size_t k = 0; count_ > 1 && k < suns_; ++k) {
      layers[first_ + k] *= weight(first_ + k, stratum);
    }
  }

 private:
  std::size_t first_ = 0, suns_ = 0, count_ = 1;
};

}  // namespace earthshine::raytrace
