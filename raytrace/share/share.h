// SPDX-License-Identifier: Apache-2.0
// What is estimated by chance at every gather point of a picture, shared between neighbours on the
// same surface as far as its own samples allow.
//
// The estimates are split into details of 1, 2, 4, 8 and 16 pixels and a rest (a wavelet transform
// with holes over the points of one surface; Dammertz et al. 2010). Every round of samples comes in
// two independent halves of as many, with sums a and b. (a - b)^2 has the variance of a + b, and
// added over the rounds that of the whole sum; its root over the samples has the noise of the mean,
// by whatever sign is drawn for each point: so many fields of noise as are wanted, whose means over
// small surfaces are known better than one (the wild bootstrap; Wu 1986). Of a detail d, means over
// its surroundings are, with e the noise that is expected of the samples that a detail is made of,
// relative to others,
//   noise  q = e <n^2 / e> over these fields' details n
//   signal s = (<d^2 / e> - <n^2 / e>) / <1 / e>,     energy D = s + q
// and the detail is kept by c = s / (s + q) or less (Wiener), which leaves, in the mean and with
// what choosing c by the same d makes it look better (Stein 1981; N: how many normal details the
// means are over),
//   (1 - c)^2 s + c^2 q + 4 q D c'(D) / N,   no more than D together.
// N is not told by how far the fields of noise are apart, since all are made of the same rounds: s
// is off by chance as a mean of (d^2 - n^2) / e with random signs is, whose square is 2 / N of q^2
// (with more rounds n is known better, and N larger).
// Where the s / q of a level differ by no more than that all over the picture, as where all is
// smooth, what each is off their mean says nothing and is left out of s (signals.h). Noise of
// single pixels is a hundred times all that is left: where nothing of a detail is kept, s is held
// between none and that of the next coarser ones. An edge has half of their signal, what is smooth
// a fourth or less.
// That sum over the levels, and the noise of the rest, is the squared error that is stated. It goes
// to nothing with more samples, and with it what sharing blurs.
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

// What is seen in a mirror lies where the camera sees it, behind the mirror.
struct GatherPoint {
  glm::vec3 position{0.0F};  // m, as of Sighting
  float reach_m =
      -1.0F;  // harmonic mean length of rays that end on surfaces; negative: none are cast
  glm::vec3 normal{0.0F};    // unit, on the camera's side
  float spacing_m = 0.0F;    // how far apart neighbouring pixels are there, across the view
  float reflectance = 0.0F;  // luminance of the surface's k_d, times the mirror's
  float lobe = 0.0F;         // and of its k_s, if its lobe is gathered for
  std::uint32_t material = 0, triangle = 0;  // of the scene
  std::uint32_t mirror = seen_straight;      // triangle of the mirror that it is seen in
};

inline constexpr std::size_t share_levels = 5;

// Sums of samples at every point.
struct Estimate {
  std::size_t layers = 0;        // per point
  std::size_t image_layers = 0;  // the first of them, whose sum the eye sees
  std::vector<glm::vec3> sum;    // point * layers + layer
  std::vector<glm::vec3> total;  // of the image layers; empty where there is one
  std::vector<float> luminance;  // of the image layers together
  std::vector<float> variance;   // of the luminance, as the halves of its rounds tell it
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
  // Sums of some samples, by layer.
  void add(std::size_t point, std::span<const Rgb> of_layers) {
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const glm::vec3 more(of_layers[layer]);
      sum[point * layers + layer] += more;
      if (!total.empty() && layer < image_layers) total[point] += more;
    }
  }
  // The same of the total alone.
  [[nodiscard]] Estimate of_total() const {
    Estimate one;
    one.layers = one.image_layers = 1;
    one.sum = total;
    one.luminance = luminance;
    one.variance = variance;
    one.samples = samples;
    return one;
  }
  // Of one round: what each half of the samples adds up to.
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
  // A point's sums.
  void pass(std::size_t point, base::Parcel& parcel) {
    parcel.pass_range(&sum[point * layers], layers);
    if (!total.empty()) parcel.pass(total[point]);
    parcel.pass(luminance[point]);
    parcel.pass(variance[point]);
    parcel.pass(samples[point]);
  }
};

// Which points share: those on the same surface, up to 2 steps of 1, 2, 4 ... pixels away in their
// column, and up to 2 away in the rows of these.
class Neighbours {
 public:
  // The points lie row by row in the window.
  Neighbours(const Window& window, const std::vector<GatherPoint>& points);
  // The same of those that have like material.
  [[nodiscard]] Neighbours of_like_material(const std::vector<GatherPoint>& points) const;

  // Means over each point's neighbours that are `1 << level` pixels apart, with B-spline weights
  // times `weight` (nullptr: 1), of some values a point: values[k] and means[k] hold the k-th of
  // all points.
  using Planes = std::vector<std::vector<float>>;
  [[nodiscard]] Planes planes(std::size_t number) const;  // all 0
  [[nodiscard]] std::size_t count() const { return masks_.front().size(); }
  // Without neighbours at any distance.
  [[nodiscard]] bool is_alone(std::size_t point) const;
  void blur(std::size_t level, const Planes& values, const std::vector<float>* weight,
            Planes& means) const;

 private:
  void blur_chain(std::size_t level, std::size_t first, const Planes& values,
                  const std::vector<float>* weight, Planes& means) const;
  void blur_along(std::size_t level, std::size_t y, const Planes& values,
                  const std::vector<float>* weight, float* sums) const;
  // Tells every point's neighbours apart: keep(p, q) of those of `mask`.
  template <class Keep>
  void sift(std::size_t level, const Keep& keep);

  int columns_, rows_;
  std::vector<std::vector<std::uint16_t>> masks_;  // per level and point
};

struct Shared {
  std::size_t layers = 0;
  std::vector<glm::vec3> radiance;  // as Estimate::sum, the shared means
  // By level and point, of its luminance: mean squares of signal (found by chance: it may be
  // negative) and noise, and 1 / N.
  std::array<std::vector<float>, share_levels> signal, noise, inverse_dof;
  std::vector<float> rest;  // noise of it
  // Of off-grid points, the signal that noise may hide: less cannot be told from none. Empty
  // without off-grid points.
  std::vector<float> hidden;
  std::vector<float> squared_error;  // stated
  // Of points that stand alone, noise that is likely beyond it, or less than none (alone.h).
  std::vector<float> variance_prior;

  // What the squared error would be with `factor` times the samples here and around.
  [[nodiscard]] double squared_error_with(std::size_t point, double factor) const;
  // The same of each of [begin, end).
  void squared_errors_with(double factor, std::size_t begin, std::size_t end, float* errors) const;
  // For so many points; those there are keep theirs.
  void resize(std::size_t points);
};

// What is kept of details: as told above, or all of them: values stay as they are, and their noise
// is that of a sample around, over the samples there (the halves of a point's own rounds may
// agree by chance).
enum class Keep { AsTold, All };

// The points of the grid, which come first in the estimate.
[[nodiscard]] Shared share(const Neighbours& neighbours, const Estimate& estimate,
                           Keep keep = Keep::AsTold);
// The same where the estimate's sums are: it is left without, and those of off-grid points stay in
// Shared::radiance until add_off_grid_points() has them.
[[nodiscard]] Shared share_in_place(const Neighbours& neighbours, Estimate& estimate,
                                    Keep keep = Keep::AsTold);

// The share of a detail of signal s and noise q that is kept, mean squares; few: 1 / N. Noise that
// is found by chance looks like signal half of the time: only what is well above it counts, the
// more so the fewer details tell s, which is off by sqrt(2 / N) q by chance. Both shares of q are
// what cost least on the payload bay (docs/log/renderer.md).
[[nodiscard]] inline float wiener_gain(float s, float q, float inverse_dof) {
  const float sure =
      s - (tuning::noise_margin + tuning::chance_margin * std::sqrt(2.0F * inverse_dof)) * q;
  return sure > 0.0F ? sure / (sure + q) : 0.0F;
}

// Whether two points seen through nearby pixels lie on the same surface, flat or gently curved.

// Normals within 25 degrees, and neither point further off the other's tangent plane than a circle
// bends away over such an angle. slack_m: what rounding may do.
[[nodiscard]] inline bool same_surface(const glm::vec3& from, const glm::vec3& normal,
                                       const glm::vec3& to, const glm::vec3& other_normal,
                                       float slack_m) {
  if (glm::dot(normal, other_normal) < tuning::least_surface_cosine) return false;
  const glm::vec3 way = to - from;
  const float reach = tuning::most_surface_slope * glm::length(way) + slack_m;
  return std::abs(glm::dot(way, normal)) <= reach && std::abs(glm::dot(way, other_normal)) <= reach;
}

}  // namespace earthshine::raytrace
