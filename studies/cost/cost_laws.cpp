// SPDX-License-Identifier: Apache-2.0
#include "studies/cost/cost_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/refine.h"

namespace earthshine::studies {
namespace {

constexpr double least_power = 0.25, most_power = 1.0;  // exponents of the error in patches

std::uint64_t times(std::uint64_t count, double by) {
  return static_cast<std::uint64_t>(std::llround(double(count) * by));
}

// Limit of the remaining rounds on the number of patches.
double most_by_rounds(const std::vector<radiosity::RefineRound>& rounds) {
  constexpr std::size_t looked_at = 4;
  if (rounds.size() <= looked_at) return std::numeric_limits<double>::infinity();
  double growth = 1.0;  // the pilot's budget may have limited the last round
  for (std::size_t k = rounds.size() - looked_at; k < rounds.size(); ++k) {
    growth = std::max(growth, double(rounds[k].patches) / double(rounds[k - 1].patches));
  }
  const double left = std::max(0.0, radiosity::most_refine_rounds + 1.0 - double(rounds.size()));
  return double(rounds.back().patches) * std::pow(growth, left);
}

}  // namespace

double expected_patches(const std::vector<radiosity::RefineRound>& rounds, double wanted_error,
                        double most) {
  if (rounds.empty()) return most;
  const radiosity::RefineRound& last = rounds.back();
  if (last.error <= wanted_error) return static_cast<double>(last.patches);
  if (rounds.size() < 2) return most;
  const radiosity::RefineRound& first = rounds.front();
  const double growth = std::log(double(last.patches) / double(first.patches));
  const double fall = std::log(first.error / last.error);
  const double power = std::clamp(growth > 0.0 ? fall / growth : 0.0, least_power, most_power);
  const double wanted =
      double(last.patches) * std::pow(last.error / std::max(wanted_error, 1e-9), 1.0 / power);
  return std::min({most, wanted, most_by_rounds(rounds)});
}

radiosity::SolveReport scaled(const radiosity::SolveReport& small, const SolveScale& scale) {
  const double more = scale.patches / std::max(1.0, static_cast<double>(small.patches));
  const double entries = scale.patches * scale.row_entries;
  const double filled = std::max(1.0, entries / std::max(1.0, double(small.nonzeros)));
  const double rounds = std::max(1.0, more * std::max(1.0, scale.rays / 8.0));
  radiosity::SolveReport report;
  report.patches = static_cast<std::size_t>(scale.patches);
  report.form_factor_rays = times(small.form_factor_rays, more * scale.rays);
  report.refinement_rays = times(small.refinement_rays, rounds);
  report.nonzeros = static_cast<std::size_t>(entries);
  report.iterations = small.iterations;  // depends on reflectances, not on patches
  for (const auto& [name, seconds] : small.seconds) {
    double by = more;
    if (name == "form factors") by = more * scale.rays;
    if (name == "balance" || name == "linear solve") by = filled;
    if (name == "patches" && scale.refines) by = rounds;
    report.seconds.emplace_back(name, seconds * by);
  }
  report.sources_cost = small.sources_cost;
  for (radiosity::SourceCost& cost : report.sources_cost) {
    cost.rays = times(cost.rays, more);
    cost.seconds *= more;
    report.shadow_rays += cost.rays;
  }
  return report;
}

raytrace::RenderReport as_part_of(double whole_pixels, const SmallPicture& coarse,
                                  const SmallPicture& fine) {
  const double wide = 1.0 / std::sqrt(whole_pixels), less = 1.0 / std::sqrt(coarse.pixels),
               more = 1.0 / std::sqrt(fine.pixels);
  // Cost of the whole over the finer one's, from the costs of both.
  const auto change = [&](double of_coarse, double of_fine) {
    const double first = of_coarse / coarse.pixels, second = of_fine / fine.pixels;
    if (first <= second || less <= more) return 1.0;
    const double whole = second - (first - second) * (more - wide) / (less - more);
    return std::clamp(whole / second, 1.0 / 3.0, 1.0);
  };
  raytrace::RenderReport report = fine.report;
  using Counts = raytrace::RayCounts;
  for (std::uint64_t Counts::*count : {&Counts::camera, &Counts::shadow, &Counts::gather,
                                       &Counts::lobe, &Counts::mirror, &Counts::refraction}) {
    const std::uint64_t found = fine.report.rays.*count;
    if (found == 0) continue;
    report.rays.*count = times(found, change(double(coarse.report.rays.*count), double(found)));
  }
  const double of_shadow =
      double(report.rays.shadow) / std::max(1.0, double(fine.report.rays.shadow));
  for (std::uint64_t& count : report.rays.to_light) count = times(count, of_shadow);
  if (fine.report.gather_seconds > 0.0) {
    report.gather_seconds *= change(coarse.report.gather_seconds, fine.report.gather_seconds);
  }
  // Separate laws for gathering and the rest, so that neither exceeds the whole.
  const double others = fine.report.seconds - fine.report.gather_seconds;
  if (others > 0.0) {
    const double of_coarse = coarse.report.seconds - coarse.report.gather_seconds;
    report.seconds = report.gather_seconds + others * change(of_coarse, others);
  }
  return report;
}

raytrace::RenderReport scaled(const raytrace::RenderReport& small, const PictureScale& scale) {
  raytrace::RenderReport report = small;
  double more = scale.pixels / scale.small_pixels;
  if (scale.paths > 0.0) {
    more *= scale.paths / std::max(1e-9, small.camera_samples);
    report.camera_samples = scale.paths;
  }
  raytrace::RayCounts& rays = report.rays;
  for (std::uint64_t* count : {&rays.camera, &rays.shadow, &rays.gather, &rays.lobe, &rays.mirror,
                               &rays.refraction, &rays.layers}) {
    *count = times(*count, more);
  }
  for (std::uint64_t& count : rays.to_light) count = times(count, more);
  report.gather_seconds *= more;
  report.seconds *= more;
  return report;
}

}  // namespace earthshine::studies
