// SPDX-License-Identifier: Apache-2.0
// What a render gives: named layers and a report.
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

// Each ray counts once, as what it was cast for. A lens has no rays of its own: camera rays start
// on it.
struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t shadow = 0;                                   // all of them
  std::array<std::uint64_t, scenes::light_kinds> to_light{};  // shadow by LightKind
  std::uint64_t gather = 0;      // over the hemisphere of diffuse surfaces
  std::uint64_t lobe = 0;        // over the lobe of glossy ones
  std::uint64_t mirror = 0;      // on from mirrors, whatever ray met them
  std::uint64_t refraction = 0;  // on from glass
  std::uint64_t planning = 0;    // of the look ahead, all kinds together
  std::uint64_t layers = 0;      // for layers alone

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
  double seconds = 0.0;         // wall
  double gather_seconds = 0.0;  // of them for the gather field
  double relative_noise = 0.0;  // the stated error over the mean luminance, root mean square
  double camera_samples = 0.0;  // per pixel, mean
  int most_camera_samples = 0;
  int gather_rays = 0;           // per pixel
  int least_camera_samples = 0;  // of a finished pixel
  double finished_share = 1.0;   // of the pixels; less than 1 if it was stopped, the others then
                                 // show one sample or two
  bool stopped = false;
  // Samples in all that the wanted error is expected to take, over those that were cast; 0 where it
  // was surely reached (Allocator), or before there were some all over the picture.
  double growth = 0.0;
  // Pixels where the witness expects light that the samples have not found; it is in the error.
  std::size_t unexplained_pixels = 0;
  bool gave_up = false;  // far more samples than should do have not reached the wanted error
};

// How light reached the camera, by the last surface before it.
enum class Part {
  Direct,    // seen itself, or diffusely reflected straight from a source
  Indirect,  // diffusely reflected after at least one other surface
  Specular   // by a highlight, a glossy reflection, a mirror or glass
};
inline constexpr std::size_t part_count = 3;

// What a picture's error is due to.
enum class ErrorPart {
  Gather,    // noise of gather rays that read the solution, and what sharing them blurs
  Residual,  // the same of paths that find what the solution lacks
  Lobe,      // and of rays over Phong lobes
  Camera     // camera samples: edges, lamps, the lens, mirrors
};
inline constexpr std::size_t error_parts = 4;

// What the error of a pixel is stated of: nothing (the sky, the even light of a source), what a
// surface reflects, or all light where the edge of a source lies in the pixel.
enum class Shows : std::uint8_t { Nothing, Surface, SourceEdge };

// Luminance of the sources that a pixel's samples saw themselves, and its square; how many samples
// met a surface that reflects.
struct SourceSeen {
  double luminance = 0.0, luminance2 = 0.0, reflecting = 0.0;
  void add(double seen) { luminance += seen, luminance2 += seen * seen; }
  // Whether so many samples show a surface that reflects and no edge of a source itself.
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
  // By part, (cd/m^2)^2: of the luminance; at the edge of a source of all light.
  std::vector<std::array<float, error_parts>> squared;
  std::vector<Shows> shows;

  explicit StatedError(std::size_t pixels = 0)
      : luminance(pixels, 0.0F), source(pixels, 0.0F), squared(pixels), shows(pixels) {}
  // Mean luminances are those of such pixels.
  [[nodiscard]] bool counts(std::size_t pixel) const { return shows[pixel] == Shows::Surface; }
  [[nodiscard]] std::vector<bool> counted() const {  // all of these
    std::vector<bool> all(shows.size());
    for (std::size_t p = 0; p < all.size(); ++p) all[p] = counts(p);
    return all;
  }
  // error_weight() of all light of the pixel.
  [[nodiscard]] double weight(std::size_t pixel, double mean) const;
};

// What an error at a pixel counts, over a picture (or a target) of that mean luminance: pixels
// brighter than four times the mean count in proportion to their own. A glint or the wall beside a
// lamp may be a thousand times as bright as the rest; its last per mille is nobody's concern.
inline constexpr double error_bright = 4.0;  // over the mean
[[nodiscard]] inline double error_weight(double luminance, double mean) {
  return mean > 0.0 && luminance > error_bright * mean ? error_bright * mean / luminance : 1.0;
}
inline double StatedError::weight(std::size_t pixel, double mean) const {
  return error_weight(double(luminance[pixel]) + double(source[pixel]), mean);
}

// Over some pixels. The squared errors at edges of sources are added to those of the surfaces that
// count, and divided by the number of the latter, so that sources make no error look smaller.
struct ErrorSums {
  std::size_t pixels = 0;  // that count; of a picture without reflected light, edges of sources too
  double luminance = 0.0;  // their mean, of all light where there is no reflected light
  // What errors are relative to: that mean, or, where noise has made it negative, half of what
  // pixels are off by, so that no error that can be asked for, 1 at most, is reached there.
  double reference_luminance = 0.0;
  std::array<double, error_parts>
      squared{};  // mean squared errors, weighted, over reference luminance^2
  // By how much the error may well be larger than is stated: as if each pixel were told by itself,
  // by one difference of its halves, d, whose square scatters by 2 s^4 for normal noise of variance
  // s^2, 2/3 of the mean of d^4; 1.28 of the root of their sum is added. The true error is more
  // than that once in ten times where many pixels hold it, twice of ten where a dozen do, whose own
  // d^4 tell it too small when they are small. All parts of a pixel are taken as going the same
  // way.
  double confidence_factor = 1.0;
  [[nodiscard]] double squared_error() const {
    double all = 0.0;
    for (const double part : squared) all += part;
    return all;
  }
};
// pixels: numbers in the window.
[[nodiscard]] ErrorSums add_up(const StatedError& stated, std::span<const std::size_t> pixels);
[[nodiscard]] ErrorSums add_up(const StatedError& stated);  // all

// Noise of layers at some places of a picture, in rows of one round of samples each: rounds are
// independent, so that the squares of a place's rows add up.
struct LayerNoise {
  int edge_px = 1;                   // of the square of pixels that a place serves
  std::vector<std::uint32_t> place;  // the pixel of the picture in its middle
  std::vector<float> cover;          // share of these pixels that it serves
  std::vector<float> stands_for;     // as many places of the picture, of which this one is noted
  // row * layers: half the difference of the means of two independent halves of the round's samples
  // times their share of all samples there, as the camera sees it, and the pixel's light;
  // luminances, cd/m^2
  std::vector<float> off, luminance;

  struct Row {
    std::size_t place = 0;
    float cover = 1.0F, stands_for = 1.0F;
  };
  void add(const Row& row, std::span<const float> off_by);
  [[nodiscard]] Row row(std::size_t k) const { return {place[k], cover[k], stands_for[k]}; }
};

// What the error of any weighted sum of a picture's layers follows from.
struct LayerErrors {
  std::vector<double> luminance;  // of each layer, mean of the pixels that count, cd/m^2
  std::vector<double> per_noise;  // by part: what is stated of the sum of all, over its noise
  std::vector<LayerNoise> noise;  // by part

  [[nodiscard]] std::size_t layer_count() const {
    for (const LayerNoise& part : noise) {
      if (!part.place.empty()) return part.off.size() / part.place.size();
    }
    return luminance.size();
  }
  // Keeps of the places that stand for themselves alone one of `step`, which stands for as many.
  void thin(std::size_t step);
  // Takes each place's light from the picture. groups: its layers'.
  void see(const base::Image& picture, std::span<const std::string> groups);
  // squared: by part, stated of the sum of all: mean, over reference luminance^2 (ErrorSums).
  void scale_to(std::span<const double> squared, double reference_luminance);
  // Error of the sum with these weights, whose bright pixels count as error_weight says: of each
  // part what is stated of the sum of all, by as much as its samples' noise is that of the weighted
  // sum, before neighbours share it. None where the sum is dark or nothing is known.
  struct OfSum {
    double rms, mean;  // over the pixels that count, cd/m^2
    [[nodiscard]] double relative() const { return rms / mean; }
  };
  [[nodiscard]] std::optional<OfSum> of(std::span<const double> weights) const;
};
// Noise of the layers' means over regions of a picture. Samples of different places are
// independent, and neighbours that share noise leave a mean over many pixels as it is.
struct RegionNoise {
  std::size_t layers = 0;
  // region * layers (layers + 1) / 2: covariance of layers j <= k at k (k + 1) / 2 + j, luminance,
  // (cd/m^2)^2
  std::vector<float> covariance;

  RegionNoise() = default;
  // regions: pixels, ascending, of a picture with so many columns, where all places have rows.
  RegionNoise(const LayerErrors& errors, std::span<const std::vector<std::uint32_t>> regions,
              std::size_t columns);
  // Of each region's mean in the sum with these weights, (cd/m^2)^2.
  [[nodiscard]] std::vector<double> variances(std::span<const double> weights) const;
};
// Every so many pixels or gather points tell the noise of the layers.
[[nodiscard]] inline std::size_t layer_noise_step(std::size_t count) {
  constexpr std::size_t enough = 4096;
  return count / enough + 1;
}

// image: R, G, B radiance in cd/m^2; with per_light also light_<group>.R/G/B, whose sum is R, G, B;
// with aovs:
//   direct, indirect, specular .R/G/B: what the camera sees of sources themselves and of light
//   straight from them on diffuse surfaces; light that other surfaces reflected first; highlights,
//   glossy and mirror reflections, glass. Their sum is R, G, B.
//   variance: of the mean luminance of the pixel, (cd/m^2)^2
//   the unfiltered layers of first_hit.h and the coverages of cryptomatte.h
struct Frame {
  base::Image image;
  Window window;  // which part of the picture the image is
  StatedError error;
  RegionNoise regions;  // with per_light, of RenderOptions::regions
  LayerErrors layers;   // with per_light and layers for samples of all pixels alike; else empty
  RenderReport report;
};
}  // namespace earthshine::raytrace
