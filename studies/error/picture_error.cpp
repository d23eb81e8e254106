// SPDX-License-Identifier: Apache-2.0
#include "studies/error/picture_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "raytrace/frame/frame.h"
#include "raytrace/light/light_sampler.h"
#include "scenes/sky/sky.h"
#include "scenes/surface_texture.h"

namespace earthshine::studies {
namespace {

struct Variances {
  double first = 0.0, second = 0.0;
};

// Sums over the counted pixels of products and their variance.
struct Sums {
  std::size_t pixels = 0;
  double product = 0.0, variance = 0.0, difference = 0.0, right = 0.0;

  double whole_mean = 0.0;  // of the truth, for the weights

  // d1, d2: one difference found twice, with independent noise; v1, v2: its variances, or none.
  void add(double d1, double d2, double truth, std::optional<Variances> v) {
    ++pixels;
    const double weight = std::pow(raytrace::error_weight(truth, whole_mean), 2);
    product += weight * d1 * d2;
    difference += (d1 + d2) / 2.0;
    right += truth;
    if (v) {
      const double v1 = weight * v->first, v2 = weight * v->second;
      variance += weight * d1 * d2 * (v1 + v2) + v1 * v2;
      // The square of the difference is known from the product alone, which may come out negative.
      least_ += v1 * v2;
    } else {
      variance += std::pow(weight * (d1 + d2) / 2.0 * (d1 - d2), 2);
    }
  }

  [[nodiscard]] PictureError error() const {
    PictureError result;
    result.pixels = pixels;
    if (pixels == 0 || !(right > 0.0)) return result;
    const auto n = static_cast<double>(pixels);
    const double mean = right / n, square = product / n;
    const double spread = std::sqrt(std::max(variance, least_)) / n;
    const auto relative = [&](double of) { return std::sqrt(std::max(0.0, of)) / mean; };
    result.error = relative(square);
    result.low = relative(square - 2.0 * spread);
    result.high = relative(square + 2.0 * spread);
    result.standard_error = relative(std::max(0.0, square) + spread) - result.error;
    result.bias = difference / right;
    return result;
  }

 private:
  double least_ = 0.0;
};

double middle(const ReferencePair& pair, std::size_t p) {
  return (pair.first.luminance[p] + pair.second.luminance[p]) / 2.0;
}

constexpr int places = 4;  // along each side of a pixel

struct Look {
  const scenes::World& study;
  const raytrace::LightSampler& lamps;
  const raytrace::CameraModel& camera;

  void see(double x, double y, raytrace::SourceSeen& seen) const {
    const raytrace::Ray ray = camera.ray(x, y, 0.0, 0.0);
    const scenes::Hit hit = study.query.closest(ray.origin, ray.direction);
    const double range = hit.missed() ? std::numeric_limits<double>::infinity() : hit.t;
    if (const auto lamp = lamps.seen_lamp(ray.origin, ray.direction, range)) {
      return seen.add(base::luminance(lamp->hit.radiance));
    }
    if (hit.missed()) {
      return seen.add(base::luminance(scenes::sky_radiance(study.scene, ray.direction)));
    }
    const scenes::Material& material =
        study.scene.materials[study.scene.triangles[hit.triangle].material];
    const bool shines = hit.front || material.two_sided;
    if ((shines && material.reflects()) || material.passes_light_on()) seen.reflecting += 1.0;
    if (shines) seen.add(base::luminance(scenes::emit_at(study.scene, material, hit)) / base::pi);
  }
  // The luminance of sources there, if the pixel counts.
  [[nodiscard]] std::optional<double> source_where_counted(int column, int row) const {
    const raytrace::Ray ray = camera.ray(column + 0.5, row + 0.5, 0.0, 0.0);
    if (study.query.closest(ray.origin, ray.direction).missed()) return std::nullopt;
    constexpr int all = places * places;
    raytrace::SourceSeen seen;
    for (int k = 0; k < all; ++k) {
      const int across = k % places, down = k / places;
      see(column + (across + 0.5) / places, row + (down + 0.5) / places, seen);
    }
    if (!seen.counts(all)) return std::nullopt;
    return seen.luminance / all;
  }
};

}  // namespace

PictureError picture_error(const std::vector<float>& luminance, const ReferencePair& truth,
                           const std::vector<bool>& counted) {
  const NoisyPicture picture{{luminance.begin(), luminance.end()},
                             std::vector<double>(luminance.size(), 0.0)};
  return limit_error({picture, picture}, truth, counted);
}

PictureError limit_error(const ReferencePair& limit, const ReferencePair& truth,
                         const std::vector<bool>& counted) {
  Sums sums;
  sums.whole_mean = mean_luminance(truth, counted);
  const bool known = limit.has_variances() && truth.has_variances();
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    std::optional<Variances> noise;
    if (known) {
      noise = {limit.first.variance[p] + truth.first.variance[p],
               limit.second.variance[p] + truth.second.variance[p]};
    }
    sums.add(limit.first.luminance[p] - truth.first.luminance[p],
             limit.second.luminance[p] - truth.second.luminance[p], middle(truth, p), noise);
  }
  return sums.error();
}

double noise_of_mean(const ReferencePair& truth, const std::vector<bool>& counted) {
  const double mean = mean_luminance(truth, counted);
  double squares = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    const double apart = truth.first.luminance[p] - truth.second.luminance[p];
    squares += std::pow(raytrace::error_weight(middle(truth, p), mean) * apart / 2.0, 2);
    pixels += 1.0;
  }
  return mean > 0.0 ? std::sqrt(squares / pixels) / mean : 0.0;
}

double mean_luminance(const ReferencePair& truth, const std::vector<bool>& counted) {
  double sum = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    sum += middle(truth, p);
    pixels += 1.0;
  }
  return pixels > 0.0 ? sum / pixels : 0.0;
}

double resolution(const ReferencePair& truth, const std::vector<bool>& counted) {
  const double mean = mean_luminance(truth, counted);
  double squares = 0.0, pixels = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    if (!counted[p]) continue;
    const double weight = std::pow(raytrace::error_weight(middle(truth, p), mean), 4);
    squares += weight * truth.first.variance[p] * truth.second.variance[p];
    pixels += 1.0;
  }
  if (!(mean > 0.0)) return 0.0;
  return std::sqrt(2.0 * std::sqrt(squares) / pixels) / mean;
}

CountedPixels counted_pixels(const scenes::World& study, const raytrace::CameraModel& camera) {
  const raytrace::LightSampler lamps(study, raytrace::Indirect::None, 2);
  const Look look{study, lamps, camera};
  const auto columns = static_cast<std::size_t>(camera.columns);
  const auto rows = static_cast<std::size_t>(camera.rows);
  CountedPixels result;
  result.source.resize(columns * rows);
  std::vector<char> found(columns * rows);  // bits of a vector<bool> cannot be owned by threads
  base::parallel_chunks(rows, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin * columns; p < end * columns; ++p) {
      const auto source =
          look.source_where_counted(static_cast<int>(p % columns), static_cast<int>(p / columns));
      found[p] = source ? 1 : 0;
      result.source[p] = source.value_or(0.0);
    }
  });
  result.counted.assign(found.begin(), found.end());
  return result;
}

void take_source_off(const CountedPixels& pixels, std::vector<float>& luminance) {
  for (std::size_t p = 0; p < luminance.size(); ++p) {
    luminance[p] = static_cast<float>(double(luminance[p]) - pixels.source[p]);
  }
}

void take_source_off(const CountedPixels& pixels, ReferencePair& pair) {
  for (NoisyPicture* picture : {&pair.first, &pair.second}) {
    for (std::size_t p = 0; p < pixels.source.size(); ++p) {
      picture->luminance[p] -= pixels.source[p];
    }
  }
}

}  // namespace earthshine::studies
