// SPDX-License-Identifier: Apache-2.0
// A table of exchanges between objects, A_i F_ij in m^2, and the reconciliation of two estimates of
// each pair.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace earthshine::radiosity {

// objects rows of objects + 2 columns: to each object, to the sky, to black backs.
class ObjectTable {
 public:
  explicit ObjectTable(std::size_t objects)
      : objects_(objects), values_(objects * (objects + 2), 0.0) {}

  [[nodiscard]] std::size_t objects() const { return objects_; }
  [[nodiscard]] double* row(std::size_t i) { return &values_[i * (objects_ + 2)]; }
  [[nodiscard]] const double* row(std::size_t i) const { return &values_[i * (objects_ + 2)]; }

 private:
  std::size_t objects_;
  std::vector<double> values_;
};

// Linear steps that make a table of ray-cast estimates reciprocal and closed:
//   1. x_ij = x_ji = (w_i x_ij + w_j x_ji) / (w_i + w_j), w the rays per area: the variance of
//      A_i F_ij is about x / w_i, and weights independent of the hits cause no bias;
//   2. x_ij += v_ij (l_i + l_j), x_ii += v_ii l_i, x_i,sky += v_i,sky l_i (black backs likewise),
//      l such that sum_j x_ij + x_i,sky + x_i,black = A_i, v the variances: weighted least squares.
class Reconciliation {
 public:
  Reconciliation(const ObjectTable& estimate, std::span<const double> area_m2,
                 std::span<const double> rays_per_m2);

  // closes_to_area: the row sums become the areas; false for noise, whose row sums become 0.
  void apply(ObjectTable& table, bool closes_to_area) const;

 private:
  void average(ObjectTable& table) const;

  std::vector<double> area_m2_, rays_per_m2_;
  ObjectTable variance_;
};

}  // namespace earthshine::radiosity
