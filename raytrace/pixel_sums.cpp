// SPDX-License-Identifier: Apache-2.0
#include "raytrace/pixel_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

constexpr int tile_edge_px = 16;

void shade_pixel(const ShadingScene& shared, const CameraModel& camera, int x, int y,
                 std::uint32_t first, std::uint32_t end, PixelShader& shader) {
  const std::uint64_t number =
      static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
      static_cast<std::uint64_t>(x);
  shader.begin_pixel(number, first, end - first);
  const base::SobolOwen4 points(base::Key(shared.seed, base::Stream::Pixel, number));
  scenes::RayPacket packet;
  scenes::HitPacket hits;
  std::array<Ray, scenes::RayPacket::width> rays;
  std::array<std::array<double, 2>, scenes::RayPacket::width> at;  // in the picture, px
  for (std::size_t from = first; from < end; from += rays.size()) {
    const std::size_t count = std::min<std::size_t>(rays.size(), end - from);
    for (std::size_t k = 0; k < count; ++k) {
      const auto p = points.point(static_cast<std::uint32_t>(from + k));
      const auto offset = shared.filter.offset(p[0], p[1]);
      at[k] = {x + 0.5 + offset[0], y + 0.5 + offset[1]};
      rays[k] = camera.ray(at[k][0], at[k][1], p[2], p[3]);
      shared.query.set(packet, k, rays[k].origin, rays[k].direction);
    }
    shared.query.closest(packet, count, hits);
    for (std::size_t k = 0; k < count; ++k) {
      shader.look_near(static_cast<int>(std::floor(at[k][0])),
                       static_cast<int>(std::floor(at[k][1])));
      shader.add_sample(from + k, rays[k],
                        {hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0});
    }
  }
  shader.end_pixel();
}

void store(const PixelShader& shader, std::uint32_t count, std::size_t pixel, PixelSums& sums) {
  for (std::size_t k = 0; k < sums.entries; ++k) {
    sums.radiance[pixel * sums.entries + k] += shader.sums()[k];
  }
  for (const double y : shader.sample_luminance()) {
    sums.luminance[pixel] += y;
    sums.luminance2[pixel] += y * y;
  }
  sums.field_error[pixel] += shader.field_error();
  sums.source_samples[pixel] += static_cast<std::uint32_t>(shader.source_samples());
  sums.samples[pixel] += count;
}

}  // namespace

PixelSums::PixelSums(const Window& of, std::size_t entries_per_pixel)
    : window(of),
      entries(entries_per_pixel),
      radiance(of.pixel_count() * entries_per_pixel, glm::dvec3(0.0)),
      samples(of.pixel_count(), 0U),
      source_samples(of.pixel_count(), 0U),
      luminance(of.pixel_count(), 0.0),
      luminance2(of.pixel_count(), 0.0),
      field_error(of.pixel_count(), 0.0) {}

double PixelSums::sample_variance(std::size_t pixel) const {
  const double n = samples[pixel];
  if (n < 2.0) return 0.0;
  const double sum = luminance[pixel];
  // Rounding leaves a few units of double precision where all samples are alike.
  const double spread = luminance2[pixel] - sum * sum / n;
  return spread > 1e-12 * luminance2[pixel] ? spread / (n - 1.0) / n : 0.0;
}

double PixelSums::deviation(std::size_t pixel, double bright) const {
  const double n = samples[pixel];
  if (n < 2.0) return 0.0;
  const double mean = luminance[pixel] / n;
  return std::sqrt(sample_variance(pixel) * n) * (mean > bright ? bright / mean : 1.0);
}

double PixelSums::squared_field_error(std::size_t pixel) const {
  if (samples[pixel] == 0) return 0.0;
  const double field = field_error[pixel] / samples[pixel];
  return field * field;
}

double PixelSums::squared_error(std::size_t pixel) const {
  return sample_variance(pixel) + squared_field_error(pixel);
}

void shade_samples(const ShadingScene& shared, const CameraModel& camera,
                   const std::vector<std::uint32_t>& wanted, PixelSums& sums, RayCounts& rays,
                   const std::function<bool()>& stop,
                   const std::function<void(std::uint64_t samples)>& progress) {
  const Window& window = sums.window;
  const int tiles_x = (window.columns + tile_edge_px - 1) / tile_edge_px;
  const int tiles_y = (window.rows + tile_edge_px - 1) / tile_edge_px;
  const auto tiles = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  std::mutex mutex;
  base::parallel_chunks(tiles, 1, [&](std::size_t tile, std::size_t) {
    if (stop && stop()) return;
    const int x0 = static_cast<int>(tile % static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    const int y0 = static_cast<int>(tile / static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    PixelShader shader(shared);
    std::uint64_t count = 0;
    for (int y = y0; y < std::min(y0 + tile_edge_px, window.rows); ++y) {
      for (int x = x0; x < std::min(x0 + tile_edge_px, window.columns); ++x) {
        const std::size_t pixel = window.index(window.x + x, window.y + y);
        const std::uint32_t first = sums.samples[pixel];
        if (wanted[pixel] <= first) continue;
        shade_pixel(shared, camera, window.x + x, window.y + y, first, wanted[pixel], shader);
        store(shader, wanted[pixel] - first, pixel, sums);
        count += wanted[pixel] - first;
      }
    }
    const std::lock_guard lock(mutex);
    rays += shader.rays();
    if (progress && count > 0) progress(count);
  });
}

std::vector<std::uint32_t> wanted_samples(const PixelSums& sums, double per_deviation,
                                          double bright, int least, int most) {
  const Window& window = sums.window;
  std::vector<double> deviation(sums.samples.size());
  for (std::size_t p = 0; p < deviation.size(); ++p) {
    deviation[p] = sums.deviation(p, bright);
  }
  std::vector<std::uint32_t> wanted(sums.samples.size());
  for (int y = 0; y < window.rows; ++y) {
    for (int x = 0; x < window.columns; ++x) {
      double noisiest = 0.0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int qx = window.x + x + dx, qy = window.y + y + dy;
          if ((dx == 0 && dy == 0) || !window.contains(qx, qy)) continue;
          noisiest = std::max(noisiest, deviation[window.index(qx, qy)]);
        }
      }
      const std::size_t p = window.index(window.x + x, window.y + y);
      const double ideal = std::clamp(noisiest / per_deviation, double(least), double(most));
      const auto rounded = std::bit_ceil(static_cast<std::uint32_t>(ideal));
      const std::uint32_t limit = std::max(static_cast<std::uint32_t>(least), 4 * sums.samples[p]);
      wanted[p] = std::min({rounded, limit, static_cast<std::uint32_t>(most)});
    }
  }
  return wanted;
}

}  // namespace earthshine::raytrace
