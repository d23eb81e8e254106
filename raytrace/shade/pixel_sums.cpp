// SPDX-License-Identifier: Apache-2.0
#include "raytrace/shade/pixel_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/ranks/ranks.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr int tile_edge_px = 16;

void shade_pixel(const ShadingScene& shared, const CameraModel& camera, int x, int y,
                 std::uint32_t first, std::uint32_t end, bool by_layer, PixelShader& shader) {
  const std::uint64_t number =
      static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
      static_cast<std::uint64_t>(x);
  shader.begin_pixel(camera, x, y, first, end - first, by_layer);
  const PixelPoints points(shared.seed, number);
  scenes::RayPacket packet;
  scenes::HitPacket hits;
  std::array<Ray, scenes::RayPacket::width> rays;
  std::array<glm::dvec2, scenes::RayPacket::width> at;  // in the picture, px
  std::array<CameraModel, scenes::RayPacket::width> moved;
  std::array<const CameraModel*, scenes::RayPacket::width> cameras;
  CameraModel in_middle;
  const CameraModel& middle = camera_of_sample(
      camera, y, [] { return 0.5; }, in_middle);
  for (std::size_t from = first; from < end; from += rays.size()) {
    const std::size_t count = std::min<std::size_t>(rays.size(), end - from);
    for (std::size_t k = 0; k < count; ++k) {
      const auto p = points.point(from + k);
      const auto offset = shared.filter.offset(p[0], p[1]);
      at[k] = {x + 0.5 + offset[0], y + 0.5 + offset[1]};
      cameras[k] = &camera_of_sample(
          camera, y, [&] { return points.time(from + k, camera.lens_radius_m > 0.0); }, moved[k]);
      rays[k] = cameras[k]->ray(at[k].x, at[k].y, p[2], p[3]);
      shared.query.set(packet, k, rays[k].origin, rays[k].direction);
    }
    shared.query.closest(packet, count, hits);
    for (std::size_t k = 0; k < count; ++k) {
      const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
      if (camera.moves() && !hit.missed()) {
        // Where the gather points of the picture, in the middle of the exposure, show the hit.
        at[k] = middle.film_from(middle.position, rays[k].origin + hit.t * rays[k].direction);
      }
      shader.set_gather_pixel(static_cast<int>(std::floor(at[k].x)),
                              static_cast<int>(std::floor(at[k].y)));
      shader.add_sample(from + k, *cameras[k], rays[k], hit);
    }
  }
  shader.end_pixel();
}

}  // namespace

PixelSums::PixelSums(const Window& of, std::size_t layers, bool splits_parts,
                     std::span<const std::uint8_t> noted, int columns)
    : window(of),
      image_layers(layers),
      entries(layers + (splits_parts ? part_count : 0)),
      radiance(of.pixel_count() * entries, glm::vec3(0.0F)),
      terms(of.pixel_count()),
      samples(of.pixel_count(), 0U),
      luminance(of.pixel_count(), 0.0),
      luminance2(of.pixel_count(), 0.0),
      half_difference(of.pixel_count(), 0.0),
      source(of.pixel_count()),
      rays(of.pixel_count(), 0.0F) {
  if (layers < 2) return;
  const std::size_t step = layer_noise_step(samples.size());
  const Window picture{0, 0, columns, 0};
  noted_row.assign(samples.size(), 0U);
  for (int y = of.y; y < of.y + of.rows; ++y) {
    for (int x = of.x; x < of.x + of.columns; ++x) {
      const std::size_t pixel = of.index(x, y);
      const bool all = !noted.empty() && noted[picture.index(x, y)] != 0;
      if (!all && pixel % step != 0) continue;
      stands_for.push_back(all ? 1.0F : static_cast<float>(step));
      noted_row[pixel] = static_cast<std::uint32_t>(stands_for.size());
    }
  }
  layers_differ.assign(stands_for.size() * layers, 0.0F);
}

std::span<float> PixelSums::layers_of(std::size_t pixel) {
  if (noted_row.empty() || noted_row[pixel] == 0) return {};
  return {&layers_differ[(noted_row[pixel] - 1U) * image_layers], image_layers};
}

LayerNoise PixelSums::layer_noise(int columns, std::size_t one_in) const {
  LayerNoise noise;
  const Window picture{0, 0, columns, 0};
  std::vector<float> off(image_layers);
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t pixel = window.index(x, y);
      if (noted_row[pixel] == 0 || !counts(pixel)) continue;
      const std::size_t row = noted_row[pixel] - 1U;
      LayerNoise::Row place{picture.index(x, y), 1.0F, stands_for[row]};
      if (!LayerNoise::selects(place, one_in)) continue;
      for (std::size_t layer = 0; layer < image_layers; ++layer) {
        off[layer] = layers_differ[row * image_layers + layer] / static_cast<float>(samples[pixel]);
      }
      noise.add(place, off);
    }
  }
  return noise;
}

void PixelSums::add(std::size_t pixel, const PixelShader& shader, std::uint32_t first,
                    std::uint32_t count) {
  for (std::size_t k = 0; k < entries; ++k) {
    glm::vec3& sum = radiance[pixel * entries + k];
    sum = glm::vec3(Rgb(sum) + shader.sums()[k]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double y = shader.sample_luminance()[k];
    luminance[pixel] += y;
    luminance2[pixel] += y * y;
    half_difference[pixel] += (first + k) % 2 == 0 ? y : -y;
  }
  const std::span<float> differ = layers_of(pixel);
  for (std::size_t k = 0; k < differ.size(); ++k) {
    differ[k] += static_cast<float>(shader.halves_differ()[k]);
  }
  source[pixel].luminance += shader.source().luminance;
  source[pixel].luminance2 += shader.source().luminance2;
  source[pixel].reflecting += shader.source().reflecting;
  samples[pixel] += count;
  std::vector<FieldTerm>& of_pixel = terms[pixel];
  for (const FieldTerm& more : shader.field_terms()) {
    const auto same = std::find_if(of_pixel.begin(), of_pixel.end(),
                                   [&](const FieldTerm& term) { return term.point == more.point; });
    if (same == of_pixel.end()) {
      of_pixel.push_back(more);
    } else {
      same->diffuse += more.diffuse;
      same->lobe += more.lobe;
    }
  }
}

bool PixelSums::counts(std::size_t pixel) const {
  return samples[pixel] > 0 && source[pixel].counts(samples[pixel]);
}

std::size_t PixelSums::corner_of(std::size_t pixel) const {
  const auto columns = static_cast<std::size_t>(window.columns);
  const std::size_t x = pixel % columns, y = pixel / columns;
  return (y - y % 2) * columns + x - x % 2;
}

double PixelSums::sample_variance(std::size_t pixel) const {
  const double n = samples[pixel];
  if (n < 2.0) return 0.0;
  const double sum = luminance[pixel];
  // Equal samples leave a rounding error of a few units of double precision.
  const double spread = luminance2[pixel] - sum * sum / n;
  return spread > 1e-12 * luminance2[pixel] ? spread / (n - 1.0) / n : 0.0;
}

double PixelSums::squared_error(std::size_t pixel) const {
  if (samples[pixel] == 1) {
    const std::size_t corner = corner_of(pixel);
    return corner != pixel ? samples[corner] * squared_error(corner) : 0.0;
  }
  if (samples[pixel] == 0) return 0.0;
  // The halves of few pixels are too uncertain; the spread of their samples is an upper bound.
  if (window.pixel_count() < tuning::few_pixels) return sample_variance(pixel);
  const double n = samples[pixel], off = half_difference[pixel] / n;
  if (spot_luminance.empty() || spot_luminance[pixel] <= 0.0F) return off * off;
  const double edge = error_of_edge * std::pow(n, -0.75) * double(spot_luminance[pixel]);
  return std::max(off * off, std::min(edge * edge, sample_variance(pixel)));
}

void shade_samples(const ShadingScene& shared, const CameraModel& camera,
                   const std::vector<std::uint32_t>& wanted, PixelSums& sums, RayCounts& rays,
                   const std::function<bool()>& stop,
                   const std::function<void(std::uint64_t samples)>& progress) {
  const Window& window = sums.window;
  const int tiles_x = (window.columns + tile_edge_px - 1) / tile_edge_px;
  const int tiles_y = (window.rows + tile_edge_px - 1) / tile_edge_px;
  const auto tiles = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  std::vector<RayCounts> rays_of(tiles);
  std::mutex mutex;
  // visit(x, y, pixel) for the pixels of a tile.
  const auto for_each_pixel = [&](std::size_t tile, const auto& visit) {
    const int x0 = static_cast<int>(tile % static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    const int y0 = static_cast<int>(tile / static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    for (int y = y0; y < std::min(y0 + tile_edge_px, window.rows); ++y) {
      for (int x = x0; x < std::min(x0 + tile_edge_px, window.columns); ++x) {
        visit(window.x + x, window.y + y, window.index(window.x + x, window.y + y));
      }
    }
  };
  const auto shade_tile = [&](std::size_t tile) {
    PixelShader shader(shared);
    std::uint64_t count = 0;
    for_each_pixel(tile, [&](int x, int y, std::size_t pixel) {
      const std::uint32_t first = sums.samples[pixel];
      if (wanted[pixel] <= first || (stop && stop())) return;
      const std::uint64_t before = shader.rays().total();
      shade_pixel(shared, camera, x, y, first, wanted[pixel], !sums.layers_of(pixel).empty(),
                  shader);
      sums.rays[pixel] += static_cast<float>(shader.rays().total() - before);
      sums.add(pixel, shader, first, wanted[pixel] - first);
      count += wanted[pixel] - first;
    });
    rays_of[tile] = shader.rays();
    const std::lock_guard lock(mutex);
    if (progress && count > 0) progress(count);
  };
  base::share_loop(tiles, shade_tile, [&](std::size_t tile, base::Parcel& parcel) {
    parcel.pass(rays_of[tile]);
    for_each_pixel(tile, [&](int, int, std::size_t pixel) { sums.pass(pixel, parcel); });
  });
  for (const RayCounts& tile : rays_of) rays += tile;
}

void PixelSums::pass(std::size_t pixel, base::Parcel& parcel) {
  parcel.pass_range(&radiance[pixel * entries], entries);
  parcel.pass(terms[pixel]);
  parcel.pass(samples[pixel]);
  parcel.pass(luminance[pixel]);
  parcel.pass(luminance2[pixel]);
  parcel.pass(half_difference[pixel]);
  parcel.pass(source[pixel]);
  parcel.pass(rays[pixel]);
  parcel.pass_range(layers_of(pixel).data(), layers_of(pixel).size());
}

namespace {

// Samples for an edge of this contrast until its error, relative to the brighter side, is
// edge_for_eye.
std::uint32_t samples_for_edge(double contrast) {
  return std::bit_ceil(static_cast<std::uint32_t>(
      std::pow(error_of_edge / tuning::edge_for_eye * contrast, 4.0 / 3.0)));
}

// The greatest value of a pixel's eight neighbours in the window.
std::vector<float> greatest_around(const Window& window, std::span<const float> values) {
  std::vector<float> greatest(values.size(), std::numeric_limits<float>::lowest());
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      float& of_pixel = greatest[window.index(x, y)];
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if ((dx == 0 && dy == 0) || !window.contains(x + dx, y + dy)) continue;
          of_pixel = std::max(of_pixel, values[window.index(x + dx, y + dy)]);
        }
      }
    }
  }
  return greatest;
}

}  // namespace

double PixelSums::mean_luminance() const {
  double sum = 0.0, counted = 0.0;
  for (std::size_t p = 0; p < samples.size(); ++p) {
    if (!counts(p)) continue;
    sum += reflected(p);
    counted += 1.0;
  }
  return sum > 0.0 ? sum / counted : 0.0;
}

std::vector<float> scatter_of_samples(const PixelSums& sums, double dimmest) {
  std::vector<float> scatter(sums.samples.size(), 0.0F);
  if (dimmest <= 0.0) return scatter;
  for (std::size_t p = 0; p < scatter.size(); ++p) {
    const double n = sums.samples[p];
    if (n < 2.0) continue;
    scatter[p] = static_cast<float>(std::sqrt(sums.sample_variance(p) * n) /
                                    std::max(sums.luminance[p] / n, dimmest));
  }
  return scatter;
}

std::vector<std::uint32_t> wanted_for_the_eye(const PixelSums& sums, std::span<const float> scatter,
                                              double dimmest) {
  const std::vector<float> around = greatest_around(sums.window, scatter);
  std::vector<float> mean(around.size()), darkness(around.size());
  for (std::size_t p = 0; p < mean.size(); ++p) {
    mean[p] = static_cast<float>(sums.luminance[p] / std::max(1U, sums.samples[p]));
    darkness[p] = -mean[p];
  }
  const std::vector<float> high = greatest_around(sums.window, mean);
  const std::vector<float> low = greatest_around(sums.window, darkness);
  std::vector<std::uint32_t> wanted = sums.samples;
  for (std::size_t p = 0; p < wanted.size(); ++p) {
    if (double(around[p]) > tuning::most_scatter)
      wanted[p] *= double(around[p]) > tuning::most_of_eight ? 4U : 2U;
    if (wanted[p] == 0 || dimmest <= 0.0) continue;
    const double contrast = double(high[p] + low[p]) / std::max(double(high[p]), dimmest);
    if (contrast > tuning::most_scatter)
      wanted[p] = std::max(wanted[p], samples_for_edge(contrast));
  }
  return wanted;
}

}  // namespace earthshine::raytrace
