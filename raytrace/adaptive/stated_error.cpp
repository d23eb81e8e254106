// SPDX-License-Identifier: Apache-2.0
#include "raytrace/adaptive/stated_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr double rounding = 1e-6;  // relative, of sums in single precision

// Adds up the light that the pixel reads from gather points, and its errors. Errors of one kind are
// assumed fully correlated.
class FieldOfPixel {
 public:
  FieldOfPixel(const PixelSums& sums, const GatherField& field, std::size_t pixel) {
    for (const FieldTerm& term : sums.terms[pixel]) {
      const auto point = std::size_t{term.point};
      luminance += base::luminance(Rgb(field.diffuse_sum(point) * term.diffuse));
      const double diffuse = base::luminance(Rgb(term.diffuse));
      off_[0] += diffuse * field.error_of(Gathered::Solution, point);
      off_[1] += diffuse * field.error_of(Gathered::Residual, point);
      if (base::luminance(Rgb(term.lobe)) <= 0.0) continue;
      luminance += base::luminance(Rgb(field.lobe_sum(point) * term.lobe));
      off_[2] += base::luminance(Rgb(term.lobe)) * field.error_of(Gathered::Lobe, point);
    }
  }
  [[nodiscard]] float squared(std::size_t kind, double samples) const {
    return static_cast<float>(off_[kind] * off_[kind] / (samples * samples));
  }
  double luminance = 0.0;

 private:
  std::array<double, gathered_kinds> off_{};
};

}  // namespace

StatedError state_error(const PixelSums& sums, const GatherField* field) {
  const Window& window = sums.window;
  StatedError stated(window.pixel_count());
  const std::size_t layers = field != nullptr ? field->image_layers() : sums.image_layers;
  const auto state_row = [&](int y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t p = window.index(x, y);
      const double n = sums.samples[p];
      if (n == 0.0) continue;
      Rgb own(0.0);
      for (std::size_t k = 0; k < layers; ++k) own += Rgb(sums.radiance[p * sums.entries + k]);
      const double all = base::luminance(own), seen_source = sums.source[p].luminance;
      double luminance = std::abs(all - seen_source) > rounding * all ? all - seen_source : 0.0;
      std::array<float, error_parts>& squared = stated.squared[p];
      if (field != nullptr) {
        const FieldOfPixel read(sums, *field, p);
        luminance += read.luminance;
        for (std::size_t kind = 0; kind < gathered_kinds; ++kind) {
          squared[kind] = read.squared(kind, n);
        }
      }
      double camera = sums.squared_error(p);
      if (!sums.unexplained.empty()) camera += std::pow(double(sums.unexplained[p]), 2.0);
      squared[static_cast<std::size_t>(ErrorPart::Camera)] = static_cast<float>(camera);
      stated.luminance[p] = static_cast<float>(luminance / n);
      stated.source[p] = static_cast<float>(seen_source / n);
      stated.shows[p] = sums.source[p].shows(n);
    }
  };
  base::parallel_chunks(static_cast<std::size_t>(window.rows), 4,
                        [&](std::size_t begin, std::size_t end) {
                          for (std::size_t row = begin; row < end; ++row) {
                            state_row(window.y + static_cast<int>(row));
                          }
                        });
  return stated;
}

ErrorSums add_up(const StatedError& stated, std::span<const std::size_t> pixels) {
  ErrorSums sums;
  double sources = 0.0;
  std::size_t edges = 0;
  for (const std::size_t p : pixels) {
    if (stated.shows[p] == Shows::Nothing) continue;
    sources += double(stated.source[p]);
    edges += stated.counts(p) ? 0 : 1;
    if (!stated.counts(p)) continue;
    sums.luminance += double(stated.luminance[p]);
    ++sums.pixels;
  }
  if (sums.luminance == 0.0) sums.luminance = sources, sums.pixels += edges;
  if (sums.pixels == 0) return sums;
  sums.luminance /= static_cast<double>(sums.pixels);
  sums.reference_luminance = sums.luminance;
  if (sums.luminance < 0.0) {
    double square = 0.0;
    for (const std::size_t p : pixels) {
      if (stated.shows[p] == Shows::Nothing) continue;
      for (const float part : stated.squared[p]) square += double(part);
    }
    sums.reference_luminance = 0.5 * std::sqrt(square / static_cast<double>(sums.pixels));
  }
  if (sums.reference_luminance <= 0.0) return sums;
  const double scale = 1.0 / (static_cast<double>(sums.pixels) * sums.reference_luminance *
                              sums.reference_luminance);
  double fourths = 0.0;
  for (const std::size_t p : pixels) {
    if (stated.shows[p] == Shows::Nothing) continue;
    const double weight = stated.weight(p, sums.luminance);
    double of_pixel = 0.0;
    for (std::size_t part = 0; part < error_parts; ++part) {
      const double square = weight * weight * scale * double(stated.squared[p][part]);
      sums.squared[part] += square;
      of_pixel += square;
    }
    fourths += of_pixel * of_pixel;
  }
  const double square = sums.squared_error();
  if (square <= 0.0) return sums;
  sums.confidence_factor =
      std::sqrt(1.0 + tuning::one_sided_90 * std::sqrt(2.0 / 3.0 * fourths) / square);
  return sums;
}

ErrorSums add_up(const StatedError& stated) {
  std::vector<std::size_t> all(stated.shows.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return add_up(stated, all);
}

}  // namespace earthshine::raytrace
