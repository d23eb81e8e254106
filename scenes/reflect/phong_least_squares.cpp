// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/phong_least_squares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace earthshine::scenes {
namespace {

using Points = std::span<const ReflectancePoint>;

constexpr double noise_floor = 0.01;  // of the largest R (ReflectanceNoise::Proportional)
constexpr double chance_of_lobe = 1e-3;
constexpr double rounding_of_squares = 1e-20;  // of a sum of squares
constexpr int unknowns = 3;

// Relative noise of each point.
using Shape = std::vector<double>;

struct Data {
  Points points;
  std::vector<double> log_cosine;  // -infinity beyond 90 degrees
  Shape shape;
};

// cos^n, 0 outside the lobe.
std::vector<double> lobe(const Data& data, double shininess) {
  std::vector<double> basis(data.points.size());
  for (std::size_t i = 0; i < basis.size(); ++i) {
    basis[i] = std::exp(shininess * data.log_cosine[i]);
  }
  return basis;
}

Shape noise_shape(const PhongFit& fit, const Data& data) {
  double largest = 0.0;
  for (const ReflectancePoint& p : data.points) largest = std::max(largest, p.reflectance);
  Shape shape = lobe(data, fit.shininess);
  for (double& h : shape) {
    h = std::hypot(fit.diffuse + fit.specular * h, noise_floor * largest);
    if (!(h > 0.0)) h = 1.0;  // a black sample
  }
  return shape;
}

double weighted_squares(const PhongFit& fit, const Data& data, const std::vector<double>& basis) {
  double sum = 0.0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const double off = data.points[i].reflectance - fit.diffuse - fit.specular * basis[i];
    const double r = off / data.shape[i];
    sum += r * r;
  }
  return sum;
}

struct Candidate {
  PhongFit fit;
  double squares = 0.0;
};

// For a given n the model is linear in k_d and k_s: best fit with both non-negative.
Candidate best_for(double shininess, const Data& data) {
  const std::vector<double> basis = lobe(data, shininess);
  double n = 0.0, s = 0.0, ss = 0.0, r = 0.0, sr = 0.0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const double weight = 1.0 / (data.shape[i] * data.shape[i]);
    n += weight;
    s += weight * basis[i];
    ss += weight * basis[i] * basis[i];
    r += weight * data.points[i].reflectance;
    sr += weight * basis[i] * data.points[i].reflectance;
  }
  PhongFit fit;
  fit.shininess = shininess;
  fit.points_used = data.points.size();
  const double determinant = n * ss - s * s;
  if (determinant > 1e-14 * n * ss) {
    fit.specular = (n * sr - s * r) / determinant;
    fit.diffuse = (r - fit.specular * s) / n;
  }
  if (fit.specular <= 0.0) {
    fit.specular = 0.0;
    fit.diffuse = r / n;
  } else if (fit.diffuse < 0.0) {
    fit.diffuse = 0.0;
    fit.specular = sr / ss;
  }
  return {fit, weighted_squares(fit, data, basis)};
}

// Golden-section search over log n.
PhongFit bottom_of(double a, double b, const Data& data) {
  const auto at = [&](double log_n) { return best_for(std::exp(log_n), data); };
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double at_c = at(c).squares, at_d = at(d).squares;
  while (b - a > 1e-11) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = at(c).squares;
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = at(d).squares;
    }
  }
  return at(0.5 * (a + b)).fit;
}

// A scan over log n finds the valley, golden-section search its minimum.
PhongFit least_squares_fit(const Data& data) {
  constexpr int steps = 160;
  const double low = std::log(least_shininess), high = std::log(most_shininess);
  const auto log_of = [&](int k) { return low + (high - low) * k / steps; };
  int best_step = 0;
  double best = best_for(least_shininess, data).squares;
  for (int k = 1; k <= steps; ++k) {
    const double squares = best_for(std::exp(log_of(k)), data).squares;
    if (squares < best) {
      best = squares;
      best_step = k;
    }
  }
  return bottom_of(log_of(std::max(0, best_step - 1)), log_of(std::min(steps, best_step + 1)),
                   data);
}

// Alternates weights and fit.
PhongFit reweighted_fit(Data& data, ReflectanceNoise noise) {
  constexpr int most_rounds = 30;
  constexpr double agreed = 1e-9, reach = 0.3;  // of log n
  PhongFit fit = least_squares_fit(data);
  if (noise == ReflectanceNoise::Constant) return fit;
  for (int round = 0; round < most_rounds; ++round) {
    const PhongFit last = fit;
    data.shape = noise_shape(fit, data);
    const double log_n = std::log(fit.shininess);
    // The first weights may move the valley; later changes are small.
    fit = round == 0 ? least_squares_fit(data)
                     : bottom_of(std::max(std::log(least_shininess), log_n - reach),
                                 std::min(std::log(most_shininess), log_n + reach), data);
    const double moved = std::fabs(std::log(fit.shininess / last.shininess));
    if (moved < agreed && std::fabs(fit.diffuse - last.diffuse) < agreed * fit.diffuse &&
        std::fabs(fit.specular - last.specular) < agreed * fit.specular) {
      break;
    }
  }
  return fit;
}

// ---- Standard errors

// Square roots of the diagonal of the inverse of A = J^T W J; no value if J does not have full
// rank. Columns are scaled to unit length first, so that the rank does not depend on units.
std::optional<std::array<double, unknowns>> inverse_roots(const glm::dmat3& matrix) {
  glm::dvec3 scale;
  for (int k = 0; k < unknowns; ++k) {
    if (!(matrix[k][k] > 0.0)) return std::nullopt;
    scale[k] = 1.0 / std::sqrt(matrix[k][k]);
  }
  glm::dmat3 scaled;
  for (int i = 0; i < unknowns; ++i) {
    for (int k = 0; k < unknowns; ++k) scaled[i][k] = matrix[i][k] * scale[i] * scale[k];
  }
  if (!(glm::determinant(scaled) > 1e-13)) return std::nullopt;
  const glm::dmat3 inverse = glm::inverse(scaled);
  std::array<double, unknowns> roots{};
  for (int k = 0; k < unknowns; ++k) {
    roots[static_cast<std::size_t>(k)] = std::sqrt(std::max(0.0, inverse[k][k])) * scale[k];
  }
  return roots;
}

PhongErrors standard_errors(const LeastSquaresFit& found, const Data& data) {
  const PhongFit& fit = found.fit;
  const std::vector<double> basis = lobe(data, fit.shininess);
  glm::dmat3 matrix(0.0);
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const double by_shininess = basis[i] > 0.0 ? fit.specular * basis[i] * data.log_cosine[i] : 0.0;
    const glm::dvec3 row = glm::dvec3(1.0, basis[i], by_shininess) / data.shape[i];
    matrix += glm::outerProduct(row, row);
  }
  const double s = *found.noise;
  if (!found.lobe_found) return {s / std::sqrt(matrix[0][0]), {}, {}};
  const bool inside =
      fit.shininess > 1.01 * least_shininess && fit.shininess < 0.99 * most_shininess;
  if (inside) {
    // First order does not hold for an error larger than n itself: n is undetermined.
    if (const auto roots = inverse_roots(matrix); roots && s * (*roots)[2] < fit.shininess) {
      return {s * (*roots)[0], s * (*roots)[1], s * (*roots)[2]};
    }
  }
  // n is undetermined; k_d and k_s are determined for any n as large (or small).
  matrix[2] = glm::dvec3(0.0, 0.0, 1.0);
  matrix[0][2] = matrix[1][2] = 0.0;
  const auto roots = inverse_roots(matrix);
  if (!roots) return {s / std::sqrt(matrix[0][0]), {}, {}};
  return {s * (*roots)[0], s * (*roots)[1], {}};
}

// Whether a lobe lowers the sum of squares significantly.
bool finds_lobe(const PhongFit& fit, const Data& data) {
  if (!(fit.specular > 0.0)) return false;
  double sum = 0.0, weights = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const double weight = 1.0 / (data.shape[i] * data.shape[i]);
    sum += weight * data.points[i].reflectance;
    weights += weight;
    squares += weight * data.points[i].reflectance * data.points[i].reflectance;
  }
  const std::vector<double> basis = lobe(data, fit.shininess);
  PhongFit flat;
  flat.diffuse = sum / weights;
  const double without = weighted_squares(flat, data, basis);
  if (!(without > rounding_of_squares * squares)) return false;
  const double with = weighted_squares(fit, data, basis);
  const double freedom = static_cast<double>(basis.size()) - unknowns;
  return freedom < 1.0 || std::pow(with / without, freedom / 2.0) < chance_of_lobe;
}

}  // namespace

double lobe_cosine(double angle_deg) {
  return std::max(0.0, std::cos(base::radians(std::fabs(angle_deg))));
}

double rms_residual(const PhongFit& fit, Points points) {
  double sum = 0.0;
  for (const ReflectancePoint& p : points) {
    const double lobe = std::pow(lobe_cosine(p.angle_deg), fit.shininess);
    const double r = p.reflectance - fit.diffuse - fit.specular * lobe;
    sum += r * r;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

LeastSquaresFit fit_least_squares(Points points, ReflectanceNoise noise) {
  Data data{points, {}, Shape(points.size(), 1.0)};
  for (const ReflectancePoint& p : points) {
    data.log_cosine.push_back(std::log(lobe_cosine(p.angle_deg)));
  }
  LeastSquaresFit found;
  found.fit = reweighted_fit(data, noise);
  found.lobe_found = finds_lobe(found.fit, data);
  const double freedom = static_cast<double>(points.size()) - unknowns;
  if (freedom >= 1.0) {
    const double squares = weighted_squares(found.fit, data, lobe(data, found.fit.shininess));
    found.noise = std::sqrt(squares / freedom);
    found.fit.std_error = standard_errors(found, data);
  }
  found.shape = std::move(data.shape);
  if (found.fit.specular <= 0.0) found.fit.shininess = 1.0;
  found.fit.residual = rms_residual(found.fit, points);
  return found;
}

}  // namespace earthshine::scenes
