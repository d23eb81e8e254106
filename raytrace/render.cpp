// SPDX-License-Identifier: Apache-2.0
#include "raytrace/render.h"

#include <chrono>
#include <cmath>

#include "base/free_memory.h"
#include "base/parallel.h"
#include "raytrace/adaptive/adaptive_render.h"
#include "raytrace/adaptive/stated_error.h"
#include "raytrace/adaptive/sum_errors.h"
#include "raytrace/frame/cryptomatte.h"
#include "raytrace/frame/first_hit.h"
#include "raytrace/frame/layers.h"
#include "raytrace/shade/shading_setup.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

// Image layers, then parts, of one pixel: its own sums and the light from gather points.
void pixel_radiance(const Sampled& sampled, std::size_t pixel, std::vector<Rgb>& out) {
  const PixelSums& sums = sampled.sums;
  const double n = sums.samples[pixel];
  for (std::size_t k = 0; k < sums.entries; ++k) {
    out[k] = Rgb(sums.radiance[pixel * sums.entries + k]) / n;
  }
  const std::size_t layers = sums.image_layers;
  const bool by_part = sums.entries > layers;
  const auto part = [&](Part which) -> Rgb& {
    return out[layers + static_cast<std::size_t>(which)];
  };
  for (const FieldTerm& term : sums.terms[pixel]) {
    const Rgb diffuse = Rgb(term.diffuse) / n, specular = Rgb(term.lobe) / n;
    const std::span<const glm::vec3> radiance = sampled.field->diffuse(term.point);
    const bool mirrored = sampled.field->points()[term.point].mirror != seen_straight;
    for (std::size_t k = 0; k < layers; ++k) {
      out[k] += diffuse * Rgb(radiance[k]);
      if (by_part) part(mirrored ? Part::Specular : Part::Indirect) += diffuse * Rgb(radiance[k]);
    }
    if (by_part && !mirrored) {  // light straight from the sky is direct
      part(Part::Direct) += diffuse * Rgb(radiance[layers]);
      part(Part::Indirect) -= diffuse * Rgb(radiance[layers]);
    }
    if (base::max_component(specular) <= 0.0) continue;
    const std::span<const glm::vec3> lobe = sampled.field->lobe(term.point);
    for (std::size_t k = 0; k < layers; ++k) {
      out[k] += specular * Rgb(lobe[k]);
      if (by_part) part(Part::Specular) += specular * Rgb(lobe[k]);
    }
  }
}

// Adds the light of gather points to the pixels' sums, which become means, and frees the points:
// with many layers they take as much memory as everything else.
void fold_field(Sampled& sampled) {
  PixelSums& sums = sampled.sums;
  const auto columns = static_cast<std::size_t>(sums.window.columns);
  base::parallel_chunks(sums.samples.size(), columns, [&](std::size_t begin, std::size_t end) {
    std::vector<Rgb> radiance(sums.entries);
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (sums.samples[pixel] == 0) continue;
      pixel_radiance(sampled, pixel, radiance);
      for (std::size_t k = 0; k < sums.entries; ++k) {
        sums.radiance[pixel * sums.entries + k] = glm::vec3(radiance[k]);
      }
    }
  });
  sampled.field.reset();
  base::give_back_freed_memory(sums.radiance.size() * sizeof(glm::vec3));
}

// The rows in the window, with places that are pixels of the window.
LayerNoise in_window(const LayerNoise& noise, const Window& window, int columns) {
  const std::size_t layers = noise.place.empty() ? 0 : noise.off.size() / noise.place.size();
  LayerNoise inside;
  inside.edge_px = noise.edge_px;
  for (std::size_t k = 0; k < noise.place.size(); ++k) {
    LayerNoise::Row row = noise.row(k);
    const int x = static_cast<int>(row.place) % columns, y = static_cast<int>(row.place) / columns;
    if (!window.contains(x, y)) continue;
    row.place = window.index(x, y);
    inside.add(row, {&noise.off[k * layers], layers});
  }
  return inside;
}

std::vector<LayerNoise> noise_in_window(const Sampled& sampled, const Window& window,
                                        const RenderOptions& options) {
  if (!sampled.field || sampled.sums.image_layers < 2) return {};
  std::vector<LayerNoise> noise = noise_by_part(sampled.sums, *sampled.field, options.columns, 1);
  for (LayerNoise& part : noise) part = in_window(part, window, options.columns);
  return noise;
}

// To be called after fold_field().
std::vector<double> layer_luminance(const PixelSums& sums, const StatedError& error) {
  std::vector<double> mean(sums.image_layers, 0.0);
  double pixels = 0.0;
  for (std::size_t p = 0; p < error.shows.size(); ++p) {
    if (!error.counts(p)) continue;
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k] += base::luminance(Rgb(sums.radiance[p * sums.entries + k]));
    }
    pixels += 1.0;
  }
  for (double& of_layer : mean) of_layer /= std::max(1.0, pixels);
  return mean;
}

void fill_layers(const PixelSums& sums, const StatedError& error, const Layout& layout,
                 base::Image& image) {
  const auto put = [&](std::size_t first, std::size_t pixel, const Rgb& value) {
    for (int c = 0; c < 3; ++c) {
      image.channels[first + static_cast<std::size_t>(c)].values[pixel] =
          static_cast<float>(value[c]);
    }
  };
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    if (sums.samples[p] == 0) continue;
    const glm::vec3* radiance = &sums.radiance[p * sums.entries];
    glm::vec3 total(0.0F);
    for (std::size_t k = 0; k < sums.image_layers; ++k) {
      total += radiance[k];
      if (!layout.radiance.empty()) put(layout.radiance[k], p, Rgb(radiance[k]));
    }
    put(0, p, Rgb(total));
    for (std::size_t part = 0; part < layout.parts.size(); ++part) {
      if (layout.parts[part] == Layout::none_wanted) continue;
      put(layout.parts[part], p, Rgb(radiance[sums.image_layers + part]));
    }
    if (layout.variance == Layout::none_wanted) continue;
    double variance = sums.sample_variance(p);
    for (std::size_t kind = 0; kind < gathered_kinds; ++kind) {
      variance += double(error.squared[p][kind]);
    }
    image.channels[layout.variance].values[p] = static_cast<float>(variance);
  }
}

void summarise(const PixelSums& sums, Frame& frame) {
  RenderReport& report = frame.report;
  double samples = 0.0, finished = 0.0;
  for (const std::uint32_t of_pixel : sums.samples) {
    const auto count = static_cast<int>(of_pixel);
    samples += count;
    report.most_camera_samples = std::max(report.most_camera_samples, count);
    if (count >= report.least_camera_samples) finished += 1.0;
  }
  const auto all = static_cast<double>(sums.samples.size());
  report.camera_samples = samples / all;
  report.finished_share = finished / all;
  report.relative_noise = std::sqrt(add_up(frame.error).squared_error());
}

}  // namespace

Frame render(const scenes::World& world, const radiosity::Solution& solution,
             const scenes::Camera& camera, const RenderOptions& options, const Progress& progress) {
  const auto start = Clock::now();
  Frame frame;
  ShadingSetup setup(world, solution, camera, options);
  ShadingScene& shared = setup.shared();
  const CameraModel& model = setup.camera();
  const Window window = window_of(options);
  frame.window = window;
  const auto with_layers = [&](base::Image& image) {
    return add_layers(image, options.per_light ? world.groups.names : std::vector<std::string>{},
                      options.aovs);
  };
  base::Image planned = base::make_rgb_image(0, 0);
  shared.splits_parts = with_layers(planned).splits_parts();

  Sampled sampled = sample_picture(shared, setup.world(), model, options, progress, frame.report);
  const PixelSums& sums = sampled.sums;
  frame.error = state_error(sums, sampled.field ? &*sampled.field : nullptr);
  if (options.per_light) frame.layers.noise = noise_in_window(sampled, window, options);
  if (!options.regions.empty()) {
    frame.regions =
        RegionNoise(frame.layers, options.regions, static_cast<std::size_t>(options.columns));
    frame.layers.thin(layer_noise_step(window.pixel_count()));
  }
  fold_field(sampled);
  // Allocated late: with many layers the image is as large as the samples.
  frame.image = base::make_rgb_image(window.columns, window.rows);
  const Layout layout = with_layers(frame.image);
  fill_layers(sums, frame.error, layout, frame.image);
  if (!frame.layers.noise.empty()) {
    frame.layers.luminance = layer_luminance(sums, frame.error);
    frame.layers.see(frame.image, world.groups.names);
    const ErrorSums all = add_up(frame.error);
    frame.layers.scale_to(all.squared, all.reference_luminance);
  }
  frame.report.rays.layers += fill_first_hit(world.scene, world.query, model, window, frame.image);
  frame.report.rays.layers +=
      fill_cryptomatte(world.scene, world.query, model,
                       {options.seed, window, sums.samples, shared.filter}, frame.image);
  summarise(sums, frame);
  frame.report.stopped = options.stop && options.stop();
  frame.report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return frame;
}

}  // namespace earthshine::raytrace
