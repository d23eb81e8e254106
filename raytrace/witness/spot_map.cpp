// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/spot_map.h"

#include <algorithm>
#include <cmath>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {

SpotMap::SpotMap(const CameraModel& camera, double filter_px)
    : columns_(camera.columns),
      rows_(camera.rows),
      filter_px_(std::max(1.0, filter_px)),
      pixels_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

bool SpotMap::contains(const Spot& spot) const {
  const glm::dvec2 beyond = glm::max(-spot.film, spot.film - glm::dvec2(columns_, rows_));
  return std::max(beyond.x, beyond.y) <= spot.radius_px + spot.blur_px + 0.5 * filter_px_;
}

double SpotMap::most_around(const glm::dvec2& film) const {
  const int x = static_cast<int>(std::clamp(film.x, 0.0, columns_ - 1.0));
  const int y = static_cast<int>(std::clamp(film.y, 0.0, rows_ - 1.0));
  double most = 0.0;
  for (int ny = std::max(0, y - 1); ny <= std::min(rows_ - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(columns_ - 1, x + 1); ++nx) {
      most = std::max(most, at(nx, ny).light);
    }
  }
  return most;
}

void SpotMap::add(const Spot& spot) {
  const double half = std::max(spot.radius_px + spot.blur_px, 1e-6), reach = 0.5 * filter_px_;
  const double largest = std::min(1.0, reach / half);
  // Share of the spot within the filter's support around a pixel's centre, along an axis.
  const auto part = [&](double film, int pixel) {
    const double low = std::max(film - half, pixel + 0.5 - reach);
    const double high = std::min(film + half, pixel + 0.5 + reach);
    const double share = std::max(0.0, high - low) / (2.0 * half);
    return share < tuning::least_part * largest ? 0.0 : share / filter_px_;
  };
  const auto first = [&](double film, int count) {
    return static_cast<int>(std::clamp(std::floor(film - half - reach), 0.0, double(count)));
  };
  const auto end = [&](double film, int count) {
    return static_cast<int>(std::clamp(std::ceil(film + half + reach), 0.0, double(count)));
  };
  for (int y = first(spot.film.y, rows_); y < end(spot.film.y, rows_); ++y) {
    const double down = part(spot.film.y, y);
    if (down <= 0.0) continue;
    for (int x = first(spot.film.x, columns_); x < end(spot.film.x, columns_); ++x) {
      const double light = spot.area_px2 * down * part(spot.film.x, x) * spot.luminance;
      Pixel& pixel = pixels_[index(x, y)];
      pixel.light += light;
      pixel.square += light * spot.luminance;
    }
  }
}

}  // namespace earthshine::raytrace
