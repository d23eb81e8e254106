// SPDX-License-Identifier: Apache-2.0
// Errors of form factors and radiosities of the closed cube against its closed forms.
#pragma once

#include <cmath>
#include <vector>

#include "radiosity/linear_solve.h"
#include "tests/support/exact_cube.h"

namespace earthshine::tests {

inline constexpr int ceiling_face = 5;

inline ExactCube grey_cube(int n) {
  return ExactCube(n, [](SceneBuilder& builder, int, int, int) {
    if (builder.scene.materials.empty()) builder.material(grey(0.5));
    return 0U;
  });
}

inline radiosity::FormFactors cast_cube(const ExactCube& cube, int rays, std::uint64_t seed = 1) {
  const scenes::RayQuery query(cube.builder.scene);
  const radiosity::Patches patches = radiosity::subdivide(cube.builder.scene, 1.0);
  return radiosity::cast_form_factors(cube.builder.scene, query, patches, {rays, seed});
}

// Mean over the rows of sqrt(sum_j (F_ij - exact)^2).
inline double mean_row_error(const ExactCube& cube, const radiosity::FormFactors& f) {
  double sum = 0.0;
  std::vector<double> row(f.count());
  for (std::size_t i = 0; i < f.count(); ++i) {
    std::fill(row.begin(), row.end(), 0.0);
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      row[f.column[e]] = f.row_scale[i] * double(f.hits[e]) * f.column_scale[f.column[e]];
    }
    double square = 0.0;
    for (std::size_t j = 0; j < f.count(); ++j) {
      const double d = row[j] - cube.form_factor(i, j);
      square += d * d;
    }
    sum += std::sqrt(square);
  }
  return sum / double(f.count());
}

// Relative L2 error of the indirect part of B, for a ceiling of M = 1, solved with F.
inline double indirect_error(const ExactCube& cube, const radiosity::FormFactors& f, double rho) {
  std::vector<double> source(cube.count(), 0.0), reflectance(cube.count(), rho);
  for (std::size_t i = cube.count() / 6 * ceiling_face; i < cube.count(); ++i) source[i] = 1.0;
  const std::vector<double> exact = cube.radiosity(source, rho);
  const radiosity::LinearSolve found = radiosity::solve_linear(f, source, reflectance, 1, 1e-10);
  double difference = 0.0, all = 0.0;
  for (std::size_t i = 0; i < cube.count(); ++i) {
    difference += (found.x[i] - exact[i]) * (found.x[i] - exact[i]);
    all += (exact[i] - source[i]) * (exact[i] - source[i]);
  }
  return std::sqrt(difference / all);
}

// Relative L2 error of B - M by `solve`, where 2 x 2 patches of the ceiling of the cube of 6 x 16 x
// 16 emit and rho = 0.5.
inline double lamp_error(int rays, std::uint64_t seed = 1) {
  constexpr int n = 16;
  const auto lamp = [](int face, int i, int j) {
    return face == ceiling_face && i / 2 == 4 && j / 2 == 3;
  };
  const ExactCube cube(n, [&](SceneBuilder& builder, int face, int i, int j) {
    if (builder.scene.materials.empty()) {
      builder.material(grey(0.5));
      builder.material(grey(0.5, 1.0));
    }
    return lamp(face, i, j) ? 1U : 0U;
  });
  const Prepared prepared(cube.builder.scene);
  radiosity::SolveOptions options;
  options.patch_edge_m = 1.0;
  options.form_factor_rays = rays;
  options.seed = seed;
  const radiosity::Solution solution = prepared.solve(options);
  std::vector<double> source(cube.count(), 0.0);
  for (std::size_t k = 0; k < cube.count(); ++k) {
    if (lamp(int(k) / (n * n), int(k) / n % n, int(k) % n)) source[k] = 1.0;
  }
  const std::vector<double> exact = cube.radiosity(source, 0.5);
  double difference = 0.0, all = 0.0;
  for (std::size_t k = 0; k < cube.count(); ++k) {
    const double found = double(solution.radiosity[3 * k]);  // without M of explicit emitters
    difference += (found - (exact[k] - source[k])) * (found - (exact[k] - source[k]));
    all += (exact[k] - source[k]) * (exact[k] - source[k]);
  }
  return std::sqrt(difference / all);
}

}  // namespace earthshine::tests
