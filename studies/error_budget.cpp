// SPDX-License-Identifier: Apache-2.0
#include "studies/error_budget.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/random.h"
#include "raytrace/first_hit.h"
#include "studies/measured_noise.h"
#include "studies/pixel_choice.h"

namespace earthshine::studies {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t watched_pixels = 1024, watched_of_target = 128;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Pixels of one camera that are watched: some of the whole picture, some more of each target.
struct Watched {
  std::vector<std::uint32_t> pixels;
  std::vector<std::uint32_t> whole;  // numbers into pixels
  std::map<std::uint32_t, std::vector<std::uint32_t>> targets;
};

Watched choose_watched(const scenes::Scene& scene, const SurfacePixels& seen,
                       const raytrace::RenderOptions& options) {
  Watched watched;
  const auto take = [&](const std::vector<std::uint32_t>& from, std::size_t count,
                        std::uint64_t salt) {
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t pixel : spread_evenly(from, count, base::mix64(options.seed ^ salt))) {
      numbers.push_back(static_cast<std::uint32_t>(watched.pixels.size()));
      watched.pixels.push_back(pixel);
    }
    return numbers;
  };
  watched.whole = take(seen.all(), watched_pixels, 0);
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    if (!scene.objects[object].target) continue;
    const std::vector<std::uint32_t> pixels = seen.of_object(object);
    if (!pixels.empty()) watched.targets[object] = take(pixels, watched_of_target, object + 1);
  }
  return watched;
}

TargetError target_error(const StudyScene& scene, std::uint32_t object, const SurfacePixels& seen,
                         const raytrace::Frame& frame, const WatchedErrors& solution,
                         const MeasuredNoise& noise) {
  TargetError target;
  target.name = scene.scene.objects[object].name;
  const std::vector<std::uint32_t> pixels = seen.of_object(object);
  target.pixels = pixels.size();
  if (frame.squared_error.empty()) return target;
  const PixelMeans means = pixel_means(frame, seen, pixels);
  target.luminance = means.luminance;
  if (means.pixels == 0 || means.luminance <= 0.0) return target;
  const double stated = std::sqrt(means.squared_error) / means.luminance;
  target.error = Doubt{noise.correction.estimate * stated, noise.correction.bound_95 * stated};
  const auto found = solution.targets.find(object);
  if (found != solution.targets.end()) target.error = target.error + found->second.total();
  return target;
}

}  // namespace

Doubt ErrorParts::total() const {
  return form_factor_noise + patch_size + solver_residual + gather_noise + lamp_sampling +
         camera_samples;
}

SecondOpinion second_opinion(const StudyScene& scene, const radiosity::Solution& solution,
                             const radiosity::SolveOptions& solver,
                             const std::vector<WatchedPicture>& pictures) {
  const auto start = Clock::now();
  SecondOpinion opinion;
  opinion.pictures.resize(pictures.size());
  if (solution.columns == 0 || solution.patches.count() == 0) return opinion;
  std::vector<Watched> watched;
  std::vector<PictureWatch> watches;
  for (const WatchedPicture& picture : pictures) {
    const SurfacePixels seen(scene, *picture.camera, picture.options);
    watched.push_back(choose_watched(scene.scene, seen, picture.options));
    watches.emplace_back(scene, solution, *picture.camera, picture.options, watched.back().pixels);
    opinion.rays += seen.rays();
  }
  opinion.looks =
      radiosity::look_again(scene.scene, scene.groups, scene.effects, scene.query, solver, solution,
                            [&](radiosity::Look look, const radiosity::Solution& other) {
                              for (PictureWatch& watch : watches) watch.add(look, other);
                            });
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const auto error = [&](const std::vector<std::uint32_t>& which) {
      return weighed_error(some_of(watches[k].looks(), which), opinion.looks,
                           solution.report.solver_error);
    };
    opinion.pictures[k].whole = error(watched[k].whole);
    for (const auto& [object, which] : watched[k].targets) {
      opinion.pictures[k].targets[object] = error(which);
    }
    opinion.rays += watches[k].rays();
  }
  opinion.rays += opinion.looks.rays;
  opinion.seconds = seconds_since(start);
  return opinion;
}

ErrorBudget error_budget(const StudyScene& scene, const WatchedErrors& solution,
                         const radiosity::Solution& read, const WatchedPicture& picture,
                         const raytrace::Frame& frame) {
  const auto start = Clock::now();
  ErrorBudget budget;
  budget.not_captured = not_captured(scene, picture.options);
  const SurfacePixels seen(scene, *picture.camera, picture.options);
  const MeasuredNoise noise = measure_noise(scene, read, picture, frame, seen);
  budget.pixels = noise.pixels;
  budget.parts.form_factor_noise = solution.whole.form_factors;
  budget.parts.patch_size = solution.whole.patches;
  budget.parts.solver_residual = solution.whole.solver;
  budget.parts.gather_noise = noise.gather;
  budget.parts.lamp_sampling = noise.lamps + solution.whole.lamps;
  budget.parts.camera_samples = noise.camera;
  for (std::uint32_t object = 0; object < scene.scene.objects.size(); ++object) {
    if (!scene.scene.objects[object].target) continue;
    budget.targets.push_back(target_error(scene, object, seen, frame, solution, noise));
  }
  budget.rays = noise.rays + seen.rays();
  budget.seconds = seconds_since(start);
  return budget;
}

}  // namespace earthshine::studies
