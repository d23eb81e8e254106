// SPDX-License-Identifier: Apache-2.0
// The picture of an exposure as the weighted mean of pictures of its instants, in linear light.
#pragma once

#include <vector>

#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {

// The part of an instant in a row's exposure.
struct RowShare {
  double weight = 0.0;  // of the weights of all instants
  bool middle = false;  // the instant has the middle of the row's exposure
};

// Light and squared errors of instants, which have independent samples, add up. Layers that have no
// mean (coverage by name) come from the instant in the middle of each row's exposure.
class MeanFrame {
 public:
  explicit MeanFrame(const Window& window) : window_(window), sum_(window.rows, 0.0) {}

  // rows: of the window. The frame may have fewer rows than the window, not fewer columns.
  void add(const Frame& frame, const std::vector<RowShare>& rows);
  // By the sum of the weights; rows without an instant are black.
  [[nodiscard]] Frame take();

 private:
  Window window_;
  std::vector<double> sum_;  // of the weights, by row
  Frame mean_;
  double samples_ = 0.0;
};

}  // namespace earthshine::raytrace
