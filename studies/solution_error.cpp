// SPDX-License-Identifier: Apache-2.0
#include "studies/solution_error.h"

#include <algorithm>
#include <cmath>

#include "studies/pixel_choice.h"

namespace earthshine::studies {
namespace {

std::vector<double> taken(const std::vector<double>& values,
                          const std::vector<std::uint32_t>& which) {
  std::vector<double> some;
  some.reserve(which.size());
  for (const std::uint32_t i : which) some.push_back(values[i]);
  return some;
}

std::vector<std::vector<double>> taken(const std::vector<std::vector<double>>& tries,
                                       const std::vector<std::uint32_t>& which) {
  std::vector<std::vector<double>> some;
  for (const auto& values : tries) some.push_back(taken(values, which));
  return some;
}

// Mean of (a - b)(a - c).
double mean_product(const std::vector<double>& a, const std::vector<double>& b,
                    const std::vector<double>& c) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - c[i]);
  return sum / static_cast<double>(a.size());
}

// Of convergence at hard shadows, which lies between that of their edge, 1/2, and that of creases,
// 1: quarters need 2.1 times the difference, twice the edge 1.5 times
// (tests/studies/surface_error_test.cpp).
constexpr double least_order = 0.75;

// Of the difference between two cuts, what the solution's own is still off by when the finer one
// has `q` of the other's error.
double patch_share(bool other_is_finer, double q) { return (other_is_finer ? 1.0 : q) / (1.0 - q); }

// Rays that lead through a small opening may be found by none of the few-ray solutions, which then
// agree with each other and not with the solution: the larger of the two variances counts, each
// without what lamps add to it.
Spread form_factor_spread(const Looks& looks, const radiosity::SecondLooks& made, double lamps) {
  Spread spread = spread_of(looks.few_rays);
  const auto tries = static_cast<double>(looks.few_rays.size());
  std::vector<double> mean(looks.own.size(), 0.0);
  for (const auto& one : looks.few_rays) {
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / tries;
  }
  // E (own - mean)^2 = variance (ray_share + 1 / tries) + lamps (point_share + 1 / tries)
  const double apart =
      (mean_product(looks.own, mean, mean) - lamps * (made.point_share + 1.0 / tries)) /
      (made.ray_share + 1.0 / tries);
  spread.variance = std::max({0.0, spread.variance - lamps, apart});
  return spread;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double mean_of(const std::vector<std::vector<double>>& tries) {
  double sum = 0.0;
  for (const auto& values : tries) sum += mean_of(values);
  return sum / static_cast<double>(tries.size());
}

// The mean without the share by which it is too bright: light that leaks under a wall may be nearly
// all that a dark room has, and an error of all of it is many times what the room should have.
double true_mean(double excess) {
  constexpr double darkest = 0.02;  // two cuts do not tell more
  return std::clamp(1.0 - excess, darkest, 1.0);
}

}  // namespace

void Looks::add(radiosity::Look look, std::vector<double> values) {
  switch (look) {
    case radiosity::Look::FewRays:
      few_rays.push_back(std::move(values));
      break;
    case radiosity::Look::OtherDirect:
      other_direct.push_back(std::move(values));
      break;
    case radiosity::Look::OtherPatches:
      other_patches.push_back(std::move(values));
      break;
  }
}

Looks some_of(const Looks& looks, const std::vector<std::uint32_t>& which) {
  return {taken(looks.own, which), taken(looks.few_rays, which), taken(looks.other_direct, which),
          taken(looks.other_patches, which)};
}

SolutionError solution_error(const Looks& looks, const radiosity::SecondLooks& made,
                             double solver_error, double scale) {
  SolutionError error;
  if (looks.own.empty() || scale <= 0.0) return error;
  error.solver = {solver_error, solver_error};

  const Spread lamps = spread_of(looks.other_direct);
  error.lamps = doubt_of(lamps, looks.other_direct.size(), made.point_share, scale);
  const Spread chance = form_factor_spread(looks, made, lamps.variance);
  error.form_factors = doubt_of(chance, looks.few_rays.size(), made.ray_share, scale);

  const auto& others = looks.other_patches;
  const double own_noise = chance.variance * made.ray_share + lamps.variance * made.point_share;
  const double apart =
      std::max(0.0, mean_product(looks.own, others.front(), others.back()) - own_noise);
  // Their noise has the modes of the few-ray solutions', which is told by more tries.
  const double above = 1.645 * spread_of(others).variance / std::sqrt(sure_modes(chance));
  const double r = made.error_ratio;
  const double share = patch_share(made.finer, r * r),
               most = patch_share(made.finer, std::pow(r, least_order));
  const double excess = (mean_of(looks.own) - mean_of(others)) / scale;
  error.patches = {share * std::sqrt(apart) / (scale * true_mean(share * excess)),
                   most * std::sqrt(apart + above) / (scale * true_mean(most * excess))};
  return error;
}

SolutionError weighed_error(Looks looks, const radiosity::SecondLooks& made, double solver_error) {
  double mean = 0.0;
  for (const double value : looks.own) mean += value / static_cast<double>(looks.own.size());
  std::vector<double> weights;
  for (const double value : looks.own) weights.push_back(error_weight(value, mean));
  const auto weigh = [&](std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= weights[i];
  };
  weigh(looks.own);
  for (auto* tries : {&looks.few_rays, &looks.other_direct, &looks.other_patches}) {
    std::for_each(tries->begin(), tries->end(), weigh);
  }
  return solution_error(looks, made, solver_error, mean);
}

PictureWatch::PictureWatch(const StudyScene& scene, const radiosity::Solution& solution,
                           const scenes::Camera& camera, const raytrace::RenderOptions& options,
                           std::vector<std::uint32_t> pixels)
    : scene_(scene),
      solution_(solution),
      camera_(camera),
      options_(options),
      pixels_(std::move(pixels)) {
  looks_.own = look_at(solution);
}

std::vector<double> PictureWatch::look_at(const radiosity::Solution& solution) {
  raytrace::Probed probed = raytrace::probe(
      scene_.scene, scene_.groups, scene_.effects, scene_.query, solution, solution_, camera_,
      options_, pixels_, {.seed = options_.seed, .lamp_seed = options_.seed});
  rays_ += probed.rays.total();
  return std::move(probed.luminance);
}

void PictureWatch::add(radiosity::Look look, const radiosity::Solution& other) {
  looks_.add(look, look_at(other));
}

}  // namespace earthshine::studies
