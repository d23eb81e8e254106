// SPDX-License-Identifier: Apache-2.0
// The errors of several weighted sums of a picture's layers while it is drawn: the conditions of a
// study. Some thousand places sample the noise of all layers.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "raytrace/frame/frame.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// A factor on the squared error of the sum of all layers, by part and block of the picture.
class ErrorDemand {
 public:
  ErrorDemand() = default;
  explicit ErrorDemand(const Window& window);
  [[nodiscard]] float at(std::size_t part, std::size_t pixel) const {
    return factor_[part][block_of(pixel)];
  }
  [[nodiscard]] std::size_t block_of(std::size_t pixel) const;
  [[nodiscard]] std::size_t blocks() const { return columns_ * rows_; }
  std::vector<float>& part(std::size_t part) { return factor_[part]; }

 private:
  std::size_t picture_columns_ = 0, columns_ = 0, rows_ = 0;  // px; blocks
  std::array<std::vector<float>, error_parts> factor_;
};

class SumErrors {
 public:
  // sums: of the whole picture. field: with samples; it need not be denoised by layer. all: the
  // stated error of the sum of all layers. of: weights of the layers' luminance, by sum. `sums` and
  // `of` must outlive it.
  SumErrors(const PixelSums& sums, const GatherField& field, const ErrorSums& all,
            std::span<const std::vector<double>> of, int columns);

  // Squared relative error of each sum; 0 if it is dark.
  [[nodiscard]] const std::vector<double>& squared() const { return squared_; }
  // With these factors, the squared error in each block and part is the greatest of the sums, each
  // relative to its own mean.
  [[nodiscard]] ErrorDemand demand(std::span<const std::size_t> of) const;

 private:
  const PixelSums& sums_;
  std::span<const std::vector<double>> of_;
  LayerErrors errors_;
  std::vector<double> squared_;
};

// Noise of the layers by part, at places of the whole picture. one_in: LayerNoise::selects().
[[nodiscard]] std::vector<LayerNoise> noise_by_part(const PixelSums& sums, const GatherField& field,
                                                    int columns, std::size_t one_in);

}  // namespace earthshine::raytrace
