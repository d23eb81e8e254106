// SPDX-License-Identifier: Apache-2.0
// The Suns of a sky in parts take turns: a path carries one set of them alone, as many times as
// bright as there are sets. A picture that is to be weighted by one Sun at a time gains little from
// a shadow ray to every Sun wherever a path turns. Camera samples carry them all: their few show
// each Sun's shadow edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/units.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

class SunStrata {
 public:
  SunStrata() = default;  // nothing takes turns: turn 0 has it all
  // first_layer: of the first Sun, with one layer after another for each.
  SunStrata(std::size_t first_layer, std::size_t suns)
      : first_(first_layer),
        suns_(suns),
        count_(suns > tuning::most_sun_sets ? tuning::most_sun_sets : 1) {}

  [[nodiscard]] std::size_t count() const { return count_; }
  // Of the k-th sample of a half. Each half takes all turns one after another, or the halves would
  // not differ by chance alone; those of few samples together, as they begin with different ones:
  // what halves of less than four samples differ by tells more noise than their sum has.
  [[nodiscard]] std::size_t turn_of(std::uint64_t first, std::uint64_t k, std::size_t half) const {
    return (first + k + half * (tuning::most_sun_sets / 2)) % count_;
  }
  // What the light of a layer counts in samples of that turn. Suns of one turn are spread over the
  // orbit, so that all turns are about equally bright.
  [[nodiscard]] double weight(std::size_t layer, std::size_t turn) const {
    if (count_ == 1 || layer < first_ || layer >= first_ + suns_) return 1.0;
    return (layer - first_) % count_ == turn ? static_cast<double>(count_) : 0.0;
  }
  // Of a whole sample.
  void weigh(std::size_t turn, std::span<Rgb> layers) const {
    for (std::size_t k = 0; count_ > 1 && k < suns_; ++k) {
      layers[first_ + k] *= weight(first_ + k, turn);
    }
  }

 private:
  std::size_t first_ = 0, suns_ = 0, count_ = 1;
};

}  // namespace earthshine::raytrace
