// SPDX-License-Identifier: Apache-2.0
// Denoises the Monte Carlo estimates at gather points by wavelet shrinkage over neighbours on the
// same surface.
//
// An à-trous wavelet transform over the points of one surface (Dammertz et al. 2010) splits the
// estimates into details of 1, 2, 4, 8 and 16 pixels and a rest. Every round of samples has two
// independent halves of equal size, with sums a and b. (a - b)^2 estimates the variance of a + b;
// its sum over the rounds estimates the variance of the whole sum. Its root over the samples, with
// a random sign per point, is a field of noise (wild bootstrap; Wu 1986). Several fields give
// steadier means over small surfaces than one. For a detail d of the means and n of the noise
// fields, with <> the mean over a window and e the noise that is expected from the sample counts
// alone,
//   noise  q = e <n^2 / e>
//   signal s = (<d^2 / e> - <n^2 / e>) / <1 / e>,     energy D = s + q
// The detail is multiplied by a Wiener gain c of s / (s + q) or less. The expected squared error
// after shrinkage, with Stein's term for choosing c from the same d (SURE; Stein 1981), is
//   (1 - c)^2 s + c^2 q + 4 q D c'(D) / N,   at most D
// 1/N: inverse degrees of freedom of s. The spread of the noise fields does not give N, because all
// fields come from the same rounds. Means of (d^2 - n^2) / e with random signs measure the standard
// error of s; its square is 2 / N of q^2 (more rounds give a better n and a larger N).
//
// If the ratios s / q of a level vary over the picture by no more than 2 / N, as on smooth
// surfaces, all windows share one ratio (signals.h). Where c = 0 at single pixels, the positive
// part of an uncertain s would exceed the remaining error by far: s is then limited to the range
// from 0 to s of the next coarser level. An edge has half of the coarser signal, a smooth region a
// quarter or less.
//
// The stated squared error is the sum over the levels and the noise of the rest. Noise and
// blur both vanish as samples grow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/ranks/ranks.h"
#include "base/units.h"
#include "raytrace/camera/camera.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

inline constexpr std::uint32_t seen_straight = 0xffffffffU;

// A point seen in a mirror lies at its virtual position behind the mirror.
struct GatherPoint {
  glm::vec3 position{0.0F};  // m, as Sighting::position
  float reach_m = -1.0F;     // harmonic mean length of rays that hit surfaces; negative: no rays
  glm::vec3 normal{0.0F};    // unit, on the camera's side
  float spacing_m = 0.0F;    // distance of neighbouring pixels there, across the view
  float reflectance = 0.0F;  // luminance of k_d, times the mirror's reflectance
  float lobe = 0.0F;         // luminance of k_s likewise; 0 if the lobe is not gathered
  std::uint32_t material = 0, triangle = 0;  // indices in the scene
  std::uint32_t mirror = seen_straight;      // triangle of the mirror that shows the point
};

inline constexpr std::size_t share_levels = 5;

// Sums of samples at every point.
struct Estimate {
  std::size_t layers = 0;        // per point
  std::size_t image_layers = 0;  // the first layers, whose sum is visible
  std::vector<glm::vec3> sum;    // point * layers + layer
  std::vector<glm::vec3> total;  // of the image layers; empty if there is one
  std::vector<float> luminance;  // of the sum of the image layers
  std::vector<float> variance;   // of the luminance sum, from half differences of the rounds
  std::vector<float> samples;

  Estimate() = default;
  Estimate(std::size_t points, std::size_t layers_each, std::size_t layers_seen)
      : layers(layers_each),
        image_layers(layers_seen),
        sum(points * layers_each, glm::vec3(0.0F)),
        luminance(points, 0.0F),
        variance(points, 0.0F),
        samples(points, 0.0F) {}
  void clear(std::size_t point) {
    std::fill_n(sum.begin() + static_cast<std::ptrdiff_t>(point * layers), layers, glm::vec3(0.0F));
    if (!total.empty()) total[point] = glm::vec3(0.0F);
    luminance[point] = variance[point] = samples[point] = 0.0F;
  }
  // Adds sums of some samples, by layer.
  void add(std::size_t point, std::span<const Rgb> of_layers) {
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const glm::vec3 more(of_layers[layer]);
      sum[point * layers + layer] += more;
      if (!total.empty() && layer < image_layers) total[point] += more;
    }
  }
  // An estimate with the total as its only layer.
  [[nodiscard]] Estimate of_total() const {
    Estimate one;
    one.layers = one.image_layers = 1;
    one.sum = total;
    one.luminance = luminance;
    one.variance = variance;
    one.samples = samples;
    return one;
  }
  // Adds one round: the sums of both halves.
  void add_luminance(std::size_t point, float first, float second) {
    luminance[point] += first + second;
    variance[point] += (first - second) * (first - second);
  }
  [[nodiscard]] float mean(std::size_t point) const {
    return samples[point] > 0.0F ? luminance[point] / samples[point] : 0.0F;
  }
  // Squared error of the mean.
  [[nodiscard]] float noise(std::size_t point) const {
    return samples[point] > 0.0F ? variance[point] / (samples[point] * samples[point]) : 0.0F;
  }
  // Sums of one point.
  void pass(std::size_t point, base::Parcel& parcel) {
    parcel.pass_range(&sum[point * layers], layers);
    if (!total.empty()) parcel.pass(total[point]);
    parcel.pass(luminance[point]);
    parcel.pass(variance[point]);
    parcel.pass(samples[point]);
  }
};

// Neighbourhoods for the wavelet transform: points on the same surface, up to 2 steps of 1, 2, 4
// ... pixels away in the same column, and up to 2 steps away in the rows of these.
class Neighbours {
 public:
  // The points lie row by row in the window.
  Neighbours(const Window& window, const std::vector<GatherPoint>& points);
  // The neighbours with the same material.
  [[nodiscard]] Neighbours of_like_material(const std::vector<GatherPoint>& points) const;

  // Means over each point's neighbours at distances of `1 << level` pixels, with B-spline weights
  // times `weight` (nullptr: 1). values[k] and means[k] hold the k-th value of all points.
  using Planes = std::vector<std::vector<float>>;
  [[nodiscard]] Planes planes(std::size_t number) const;  // all 0
  [[nodiscard]] std::size_t count() const { return masks_.front().size(); }
  // Whether the point has no neighbour at any distance.
  [[nodiscard]] bool is_alone(std::size_t point) const;
  void blur(std::size_t level, const Planes& values, const std::vector<float>* weight,
            Planes& means) const;

 private:
  void blur_chain(std::size_t level, std::size_t first, const Planes& values,
                  const std::vector<float>* weight, Planes& means) const;
  void blur_along(std::size_t level, std::size_t y, const Planes& values,
                  const std::vector<float>* weight, float* sums) const;
  // Keeps a neighbour q of p in `mask` if keep(p, q).
  template <class Keep>
  void sift(std::size_t level, const Keep& keep);

  int columns_, rows_;
  std::vector<std::vector<std::uint16_t>> masks_;  // per level and point
};

struct Shared {
  std::size_t layers = 0;
  std::vector<glm::vec3> radiance;  // denoised means, indexed as Estimate::sum
  // By level and point, of the luminance: mean squares of signal (an estimate that may be negative)
  // and noise, and 1 / N.
  std::array<std::vector<float>, share_levels> signal, noise, inverse_dof;
  std::vector<float> rest;  // noise of the rest
  // For off-grid points, the standard error of the signal, its least value. Empty without off-grid
  // points.
  std::vector<float> hidden;
  std::vector<float> squared_error;  // stated
  // For isolated points, the likely variance minus the stated one; may be negative (isolated.h).
  std::vector<float> variance_prior;

  // Predicts the squared error with `factor` times the samples at the point and around it.
  [[nodiscard]] double squared_error_with(std::size_t point, double factor) const;
  // The same prediction for each of [begin, end).
  void squared_errors_with(double factor, std::size_t begin, std::size_t end, float* errors) const;
  // Resizes for this number of points; existing points keep their values.
  void resize(std::size_t points);
};

// Gain of details: as above, or 1. With All, values stay as they are, and the noise is the mean
// noise of a sample in the window, over the point's samples (the halves of a point's own rounds may
// agree by chance).
enum class Keep { AsTold, All };

// Denoises the grid points, which come first in the estimate.
[[nodiscard]] Shared share(const Neighbours& neighbours, const Estimate& estimate,
                           Keep keep = Keep::AsTold);
// The same in the memory of estimate.sum, which becomes empty. Sums of off-grid points stay in
// Shared::radiance until add_off_grid_points() reads them.
[[nodiscard]] Shared share_in_place(const Neighbours& neighbours, Estimate& estimate,
                                    Keep keep = Keep::AsTold);

// The gain of a detail with mean squares s of signal and q of noise; inverse_dof: 1 / N. Chance
// makes s positive half of the time. Only an s well above its standard error, sqrt(2 / N) q,
// counts. The margins are the cheapest on the payload bay (docs/log/renderer.md).
[[nodiscard]] inline float wiener_gain(float s, float q, float inverse_dof) {
  const float sure =
      s - (tuning::noise_margin + tuning::chance_margin * std::sqrt(2.0F * inverse_dof)) * q;
  return sure > 0.0F ? sure / (sure + q) : 0.0F;
}

// Whether two points seen through nearby pixels lie on the same flat or gently curved surface:
// their normals are within 25 degrees, and neither point is further off the other's tangent plane
// than a circle bends away over such an angle. slack_m: tolerance for rounding.
[[nodiscard]] inline bool same_surface(const glm::vec3& from, const glm::vec3& normal,
                                       const glm::vec3& to, const glm::vec3& other_normal,
                                       float slack_m) {
  if (glm::dot(normal, other_normal) < tuning::least_surface_cosine) return false;
  const glm::vec3 offset = to - from;
  const float reach = tuning::most_surface_slope * glm::length(offset) + slack_m;
  return std::abs(glm::dot(offset, normal)) <= reach &&
         std::abs(glm::dot(offset, other_normal)) <= reach;
}

}  // namespace earthshine::raytrace
