// SPDX-License-Identifier: Apache-2.0
#include "studies/measured_noise.h"

#include <algorithm>
#include <cmath>

#include "base/image.h"
#include "base/random.h"
#include "raytrace/probe.h"

namespace earthshine::studies {
namespace {

constexpr std::size_t most_looked_at = 1024, fewest_looked_at = 256;
constexpr double evenly_looked_at = 0.5;  // share of the looks that do not follow the stated error
constexpr raytrace::ProbeOptions close_look{.camera_samples = 64};
// Enough to tell lamps from edges.
constexpr raytrace::ProbeOptions quick_look{.reads_solution = true};
constexpr double most_of_the_picture = 0.15;  // of its rays
constexpr double one_sided_95 = 1.645;
// Few pixels hold much of the squared error, and the spread that some hundred looks show is too
// small as a rule: over seeds they scatter 1.5 times as far (docs/validation.md).
constexpr double unseen_spread = 1.5;

// Of a mean of products that most often are small and now and then large: its logarithm is nearer
// to normal than itself, and what lies beyond one standard error is worth as much again.
double bound_of_mean(double mean, double error) {
  const double linear = one_sided_95 * unseen_spread * error;
  const double x = mean > 0.0 ? std::min(linear / mean, one_sided_95) : one_sided_95;
  return mean + linear * (x > 0.0 ? std::expm1(x) / x : 1.0);
}

double pixel_luminance(const base::Image& image, std::size_t at) {
  const auto& c = image.channels;
  return base::luminance(
      {double(c[0].values[at]), double(c[1].values[at]), double(c[2].values[at])});
}

// Mean squared error over the pixels and its standard error.
struct Measured {
  double mean = 0.0, error = 0.0;
};

class CloserLook {
 public:
  CloserLook(const StudyScene& scene, const radiosity::Solution& solution,
             const WatchedPicture& picture, const raytrace::Frame& frame, const SurfacePixels& seen)
      : scene_(scene), solution_(solution), picture_(picture), frame_(frame), seen_(seen) {}

  // mean: of the pixels' luminance; stated: their mean squared error.
  Measured squared_error(const std::vector<std::uint32_t>& pixels, double mean, double stated) {
    const auto count = static_cast<double>(pixels.size());
    std::vector<double> weights;
    weights.reserve(pixels.size());
    for (const std::uint32_t pixel : pixels) {
      const std::size_t at = seen_.in_window(pixel);
      const double weight = error_weight(pixel_luminance(frame_.image, at), mean);
      const double own = weight * weight * double(frame_.squared_error[at]);
      const double by_error = stated > 0.0 ? own / (stated * count) : 1.0 / count;
      weights.push_back((1.0 - evenly_looked_at) * by_error + evenly_looked_at / count);
    }
    const auto chosen = spread_by_weight(weights, affordable(pixels.size()), picture_.options.seed);
    std::vector<std::uint32_t> looked_at;
    for (const std::size_t k : chosen) looked_at.push_back(pixels[k]);
    const raytrace::Probed a = look(looked_at, close_look, 1), b = look(looked_at, close_look, 2);
    // A pixel that was chosen more than once was looked at by the same rays: one value.
    double sum = 0.0, squares = 0.0, values = 0.0;
    for (std::size_t k = 0, next = 0; k < chosen.size(); k = next) {
      while (next < chosen.size() && chosen[next] == chosen[k]) ++next;
      const double own = pixel_luminance(frame_.image, seen_.in_window(looked_at[k]));
      const double weight = error_weight(own, mean);
      const double off = double(next - k) * weight * weight * (own - a.luminance[k]) *
                         (own - b.luminance[k]) / (weights[chosen[k]] * count);
      sum += off;
      squares += off * off;
      values += 1.0;
    }
    if (values < 2.0) return {stated, stated};
    const auto looks = static_cast<double>(chosen.size());
    const double spread = std::max(0.0, squares - sum * sum / values) * values / (values - 1.0);
    Measured found;
    found.mean = sum / looks;
    found.error = std::sqrt(spread) / looks;
    return found;
  }

  // Of the spread of camera samples, the share that is due to lamps and lobes.
  double lamp_share(const std::vector<std::uint32_t>& pixels) {
    const auto looked_at = spread_evenly(pixels, most_looked_at, picture_.options.seed);
    const raytrace::Probed one = look(looked_at, quick_look, 3);
    raytrace::ProbeOptions same_view = quick_look;
    same_view.seed = one_seed(3);
    same_view.lamp_seed = one_seed(4);
    const raytrace::Probed other = probe(looked_at, same_view);
    double lamps = 0.0, all = 0.0;
    for (std::size_t k = 0; k < looked_at.size(); ++k) {
      const double off = one.luminance[k] - other.luminance[k];
      lamps += 0.5 * off * off * quick_look.camera_samples;
      all += one.sample_variance[k];
    }
    return all > 0.0 ? std::min(1.0, lamps / all) : 0.0;
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  [[nodiscard]] std::uint64_t one_seed(std::uint64_t number) const {
    return base::mix64(picture_.options.seed + 0x517cc1b727220a95ULL * number);
  }
  raytrace::Probed look(const std::vector<std::uint32_t>& pixels, raytrace::ProbeOptions how,
                        std::uint64_t number) {
    how.seed = how.lamp_seed = one_seed(number);
    return probe(pixels, how);
  }
  raytrace::Probed probe(const std::vector<std::uint32_t>& pixels,
                         const raytrace::ProbeOptions& how) {
    raytrace::Probed probed =
        raytrace::probe(scene_.scene, scene_.groups, scene_.effects, scene_.query, solution_,
                        solution_, *picture_.camera, picture_.options, pixels, how);
    rays_ += probed.rays.total();
    return probed;
  }
  // How many looks cost no more than a share of the picture itself.
  [[nodiscard]] std::size_t affordable(std::size_t pixels) const {
    const double each = 2.0 * close_look.camera_samples * (close_look.gather_rays + 2.0);
    const double all = most_of_the_picture * static_cast<double>(frame_.report.rays.total());
    const auto count = static_cast<std::size_t>(std::max(0.0, all / each));
    return std::min(pixels, std::clamp(count, fewest_looked_at, most_looked_at));
  }

  const StudyScene& scene_;
  const radiosity::Solution& solution_;
  const WatchedPicture& picture_;
  const raytrace::Frame& frame_;
  const SurfacePixels& seen_;
  std::uint64_t rays_ = 0;
};

}  // namespace

PixelMeans pixel_means(const raytrace::Frame& frame, const SurfacePixels& seen,
                       std::span<const std::uint32_t> pixels) {
  PixelMeans means;
  for (const std::uint32_t pixel : pixels) {
    const std::size_t at = seen.in_window(pixel);
    if (frame.squared_error[at] == raytrace::shows_source) continue;
    means.luminance += pixel_luminance(frame.image, at);
    ++means.pixels;
  }
  if (means.pixels == 0) return means;
  means.luminance /= static_cast<double>(means.pixels);
  for (const std::uint32_t pixel : pixels) {
    const std::size_t at = seen.in_window(pixel);
    if (frame.squared_error[at] == raytrace::shows_source) continue;
    const double weight = error_weight(pixel_luminance(frame.image, at), means.luminance);
    means.squared_error += weight * weight * double(frame.squared_error[at]);
  }
  means.squared_error /= static_cast<double>(means.pixels);
  return means;
}

MeasuredNoise measure_noise(const StudyScene& scene, const radiosity::Solution& solution,
                            const WatchedPicture& picture, const raytrace::Frame& frame,
                            const SurfacePixels& seen) {
  MeasuredNoise noise;
  if (frame.squared_error.empty()) {  // paths: independent samples that state their own spread
    const double stated = frame.report.relative_noise;
    noise.camera = {stated, stated};
    noise.pixels = stated > 0.0 ? seen.all().size() : 0;
    return noise;
  }
  std::vector<std::uint32_t> pixels;
  for (const std::uint32_t pixel : seen.all()) {
    if (frame.squared_error[seen.in_window(pixel)] != raytrace::shows_source) {
      pixels.push_back(pixel);
    }
  }
  const PixelMeans means = pixel_means(frame, seen, pixels);
  noise.pixels = means.luminance > 0.0 ? means.pixels : 0;
  if (noise.pixels == 0) return noise;
  CloserLook looks(scene, solution, picture, frame, seen);
  const Measured measured = looks.squared_error(pixels, means.luminance, means.squared_error);
  const double least = std::max(measured.mean, 0.0);
  const double most = bound_of_mean(least, measured.error);
  const double all = std::sqrt(least) / means.luminance, bound = std::sqrt(most) / means.luminance;
  if (means.squared_error > 0.0) {
    noise.correction = {std::sqrt(least / means.squared_error),
                        std::sqrt(most / means.squared_error)};
  }
  const double relative = frame.report.relative_noise;
  const double gather_share =
      relative > 0.0 ? std::pow(frame.report.gather_noise / relative, 2.0) : 0.0;
  const double lamp_share = (1.0 - gather_share) * looks.lamp_share(pixels);
  const double camera_share = std::max(0.0, 1.0 - gather_share - lamp_share);
  const auto part = [&](double share) {
    return Doubt{std::sqrt(share) * all, std::sqrt(share) * bound};
  };
  noise.gather = part(gather_share);
  noise.lamps = part(lamp_share);
  noise.camera = part(camera_share);
  noise.rays = looks.rays();
  return noise;
}

}  // namespace earthshine::studies
