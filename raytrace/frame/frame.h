// SPDX-License-Identifier: Apache-2.0
// The result of a render: named layers and a report.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "raytrace/camera/camera.h"
#include "scenes/effects/effects.h"

namespace earthshine::raytrace {

// Each ray counts once, by its purpose. Rays through a lens count as camera rays.
struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t shadow = 0;                                   // sum of to_light
  std::array<std::uint64_t, scenes::light_kinds> to_light{};  // shadow by LightKind
  std::uint64_t gather = 0;      // over the hemisphere of diffuse surfaces
  std::uint64_t lobe = 0;        // over the lobe of glossy surfaces
  std::uint64_t mirror = 0;      // continued at mirrors, for any kind of ray
  std::uint64_t refraction = 0;  // continued at glass
  std::uint64_t planning = 0;    // of the witness, all kinds
  std::uint64_t layers = 0;      // for layers only

  void add_shadow(scenes::LightKind kind, std::uint64_t count = 1) {
    shadow += count;
    to_light[static_cast<std::size_t>(kind)] += count;
  }
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera;
    shadow += other.shadow;
    gather += other.gather;
    lobe += other.lobe;
    mirror += other.mirror;
    refraction += other.refraction;
    planning += other.planning;
    layers += other.layers;
    for (std::size_t k = 0; k < to_light.size(); ++k) to_light[k] += other.to_light[k];
    return *this;
  }
  [[nodiscard]] std::uint64_t total() const {
    return camera + shadow + gather + lobe + mirror + refraction + planning + layers;
  }
};

struct RenderReport {
  RayCounts rays;
  double seconds = 0.0;         // wall clock
  double gather_seconds = 0.0;  // part for the gather field
  double relative_noise = 0.0;  // stated RMS error over the mean luminance
  double camera_samples = 0.0;  // per pixel, mean
  int most_camera_samples = 0;
  int gather_rays = 0;           // per pixel
  int least_camera_samples = 0;  // of a finished pixel
  double finished_share = 1.0;   // of the pixels; less than 1 after a stop: the others have one or
                                 // two samples
  bool stopped = false;
  // Predicted ratio of all samples for the wanted error to the samples so far; 0 if the error is
  // reached with confidence (Allocator), or while parts of the picture have no samples.
  double growth = 0.0;
  // Pixels where the witness predicts light that the samples have not found; the error includes it.
  std::size_t unexplained_pixels = 0;
  bool gave_up = false;  // far more samples than expected have not reached the wanted error
};

// The way of light to the camera, by the last surface before it.
enum class Part {
  Direct,    // visible sources, and diffuse reflection of light straight from a source
  Indirect,  // diffuse reflection of light from other surfaces
  Specular   // highlights, glossy reflections, mirrors and glass
};
inline constexpr std::size_t part_count = 3;

// Causes of a picture's error.
enum class ErrorPart {
  Gather,    // gather rays that read the solution: noise and blur
  Residual,  // residual paths: noise and blur
  Lobe,      // rays over Phong lobes: noise and blur
  Camera     // camera samples: edges, lamps, the lens, mirrors
};
inline constexpr std::size_t error_parts = 4;

// The light in a pixel's stated error: none (the sky, the even light of a source), reflected light,
// or all light if the edge of a source is in the pixel.
enum class Shows : std::uint8_t { Nothing, Surface, SourceEdge };

// Luminance of the sources that a pixel's samples see directly, and its square; number of samples
// that hit a reflecting surface.
struct SourceSeen {
  double luminance = 0.0, luminance2 = 0.0, reflecting = 0.0;
  void add(double seen) { luminance += seen, luminance2 += seen * seen; }
  // Whether this number of samples shows a reflecting surface and no edge of a source.
  [[nodiscard]] bool counts(double samples) const {
    return reflecting > 0.0 && (luminance == 0.0 || (reflecting == samples && !varies(samples)));
  }
  [[nodiscard]] Shows shows(double samples) const {
    if (counts(samples)) return Shows::Surface;
    const bool is_edge = luminance > 0.0 && (reflecting > 0.0 || varies(samples));
    return is_edge ? Shows::SourceEdge : Shows::Nothing;
  }

 private:
  [[nodiscard]] bool varies(double samples) const {
    return luminance2 - luminance * luminance / samples > 1e-6 * luminance2;
  }
};

// Per pixel of a window.
struct StatedError {
  std::vector<float> luminance;  // without sources that the camera sees itself, cd/m^2
  std::vector<float> source;     // of these sources, cd/m^2
  // By part, (cd/m^2)^2: of `luminance`; at the edge of a source, of all light.
  std::vector<std::array<float, error_parts>> squared;
  std::vector<Shows> shows;

  explicit StatedError(std::size_t pixels = 0)
      : luminance(pixels, 0.0F), source(pixels, 0.0F), squared(pixels), shows(pixels) {}
  // Whether the pixel contributes to mean luminances.
  [[nodiscard]] bool counts(std::size_t pixel) const { return shows[pixel] == Shows::Surface; }
  [[nodiscard]] std::vector<bool> counted() const {  // counts() of all pixels
    std::vector<bool> all(shows.size());
    for (std::size_t p = 0; p < all.size(); ++p) all[p] = counts(p);
    return all;
  }
  // error_weight() of all light of the pixel.
  [[nodiscard]] double weight(std::size_t pixel, double mean) const;
};

// Weight of an error at a pixel in a picture (or a target) with that mean luminance. Pixels
// brighter than four times the mean have a weight in inverse proportion to their luminance. A
// glint, or the wall beside a lamp, may be a thousand times brighter than the rest; the error would
// be mostly theirs.
inline constexpr double error_bright = 4.0;  // over the mean
[[nodiscard]] inline double error_weight(double luminance, double mean) {
  return mean > 0.0 && luminance > error_bright * mean ? error_bright * mean / luminance : 1.0;
}
inline double StatedError::weight(std::size_t pixel, double mean) const {
  return error_weight(double(luminance[pixel]) + double(source[pixel]), mean);
}

// Sums over some pixels. The squared errors at edges of sources are added to those of the surfaces
// that count, and divided by the number of the latter, so that sources do not reduce the error.
struct ErrorSums {
  std::size_t pixels = 0;  // that count; in a picture without reflected light, also edges of
                           // sources
  double luminance = 0.0;  // their mean; of all light if there is no reflected light
  // Denominator of relative errors: the mean, or, if noise has made it negative, half of the
  // pixels' RMS error, so that no wanted error, at most 1, is reached.
  double reference_luminance = 0.0;
  std::array<double, error_parts>
      squared{};  // mean squared errors, weighted, over reference_luminance^2
  // Factor on the stated error for its own uncertainty. Each pixel has a single difference d of its
  // halves. For normal noise of variance s^2, d^2 has the variance 2 s^4, 2/3 of the mean of d^4;
  // 1.28 standard errors of the sum of d^2 are added. The true error exceeds the result once in ten
  // times if many pixels hold it, and twice in ten times if a dozen do, because small d^2 come with
  // small d^4. Errors of all parts of a pixel are assumed fully correlated.
  double confidence_factor = 1.0;
  [[nodiscard]] double squared_error() const {
    double all = 0.0;
    for (const double part : squared) all += part;
    return all;
  }
};
// pixels: indices in the window.
[[nodiscard]] ErrorSums add_up(const StatedError& stated, std::span<const std::size_t> pixels);
[[nodiscard]] ErrorSums add_up(const StatedError& stated);  // all pixels

// Noise of the layers at some places of a picture. Each row holds one round of samples; rounds are
// independent, so that the squares of a place's rows add up.
struct LayerNoise {
  int edge_px = 1;                   // of the square of pixels that a place serves
  std::vector<std::uint32_t> place;  // the pixel of the picture in its middle
  std::vector<float> cover;          // share of these pixels that it serves
  std::vector<float> stands_for;     // number of places of the picture that this one represents
  // row * layers: half the difference of the means of the round's two halves, times the round's
  // share of all samples there, as seen by the camera; and the pixel's light. Luminances, cd/m^2.
  std::vector<float> off, luminance;

  struct Row {
    std::size_t place = 0;
    float cover = 1.0F, stands_for = 1.0F;
  };
  void add(const Row& row, std::span<const float> off_by);
  // Selects one in `one_in` of the rows that represent only themselves; it represents `one_in`.
  [[nodiscard]] static bool selects(Row& row, std::size_t one_in);
  // Of the sum with these weights, by the places that the row represents; mean: of the sum, cd/m^2.
  [[nodiscard]] double squared_error(std::size_t k, std::span<const double> weights,
                                     double mean) const;
  [[nodiscard]] Row row(std::size_t k) const { return {place[k], cover[k], stands_for[k]}; }
};

// Data for the error of any weighted sum of a picture's layers.
struct LayerErrors {
  std::vector<double> luminance;  // of each layer, mean over the pixels that count, cd/m^2
  std::vector<double> per_noise;  // by part: stated squared error of the sum of all layers, over
                                  // its noise
  std::vector<LayerNoise> noise;  // by part

  [[nodiscard]] std::size_t layer_count() const {
    for (const LayerNoise& part : noise) {
      if (!part.place.empty()) return part.off.size() / part.place.size();
    }
    return luminance.size();
  }
  // Keeps the rows that LayerNoise::selects().
  void thin(std::size_t one_in);
  // Reads each place's light from the picture. groups: names of its layers.
  void see(const base::Image& picture, std::span<const std::string> groups);
  // squared: by part, stated for the sum of all layers: mean, over reference_luminance^2
  // (ErrorSums).
  void scale_to(std::span<const double> squared, double reference_luminance);
  // Error of the sum with these weights, with error_weight() for bright pixels. Per part, the
  // stated error of the sum of all layers is scaled by the ratio of the noise of both sums before
  // denoising. Empty if the sum is dark or there is no data.
  struct OfSum {
    double rms, mean;  // over the pixels that count, cd/m^2
    [[nodiscard]] double relative() const { return rms / mean; }
  };
  [[nodiscard]] std::optional<OfSum> of(std::span<const double> weights) const;
};
// Noise of the layers' means over regions of a picture. Samples of different places are
// independent, and denoising hardly changes a mean over many pixels.
struct RegionNoise {
  std::size_t layers = 0;
  // region * layers (layers + 1) / 2: covariance of layers j <= k at k (k + 1) / 2 + j, luminance,
  // (cd/m^2)^2
  std::vector<float> covariance;

  RegionNoise() = default;
  // regions: pixels, ascending, of a picture with this many columns; all their places have rows.
  RegionNoise(const LayerErrors& errors, std::span<const std::vector<std::uint32_t>> regions,
              std::size_t columns);
  // Variance of each region's mean in the sum with these weights, (cd/m^2)^2.
  [[nodiscard]] std::vector<double> variances(std::span<const double> weights) const;
};
// One in this many pixels or gather points samples the noise of the layers.
[[nodiscard]] inline std::size_t layer_noise_step(std::size_t count) {
  constexpr std::size_t enough = 4096;
  return count / enough + 1;
}

// image: R, G, B radiance in cd/m^2; with per_light also light_<group>.R/G/B, whose sum is R, G, B;
// with aovs:
//   direct .R/G/B: visible sources and their light on diffuse surfaces
//   indirect .R/G/B: light that other surfaces reflected first
//   specular .R/G/B: highlights, glossy and mirror reflections, glass; the sum of the three is
//     R, G, B
//   variance: of the mean luminance of the pixel, (cd/m^2)^2
//   the unfiltered layers of first_hit.h and the coverages of cryptomatte.h
struct Frame {
  base::Image image;
  Window window;  // the part of the picture in `image`
  StatedError error;
  RegionNoise regions;  // with per_light, of RenderOptions::regions
  LayerErrors layers;   // with per_light, if all pixels were sampled; else empty
  RenderReport report;
};
}  // namespace earthshine::raytrace
