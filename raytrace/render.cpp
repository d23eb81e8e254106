// SPDX-License-Identifier: Apache-2.0
#include "raytrace/render.h"

#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/frame/cryptomatte.h"
#include "raytrace/frame/first_hit.h"
#include "raytrace/frame/layers.h"
#include "raytrace/passes/passes.h"
#include "raytrace/passes/stated_error.h"
#include "raytrace/shade/shading_setup.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

// Image layers, then parts, of one pixel: its own sums and what it reads from gather points.
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
    for (std::size_t k = 0; k < layers; ++k) {
      out[k] += diffuse * Rgb(radiance[k]);
      if (by_part) part(Part::Indirect) += diffuse * Rgb(radiance[k]);
    }
    if (by_part) {  // what came straight from the sky is no interreflection
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

void fill_layers(const Sampled& sampled, const StatedError& error, const Layout& layout,
                 const Window& window, base::Image& image) {
  const auto put = [&](std::size_t first, std::size_t pixel, const Rgb& value) {
    for (int c = 0; c < 3; ++c) {
      image.channels[first + static_cast<std::size_t>(c)].values[pixel] =
          static_cast<float>(value[c]);
    }
  };
  const PixelSums& sums = sampled.sums;
  std::vector<Rgb> radiance(sums.entries);
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t from = sums.window.index(x, y), to = window.index(x, y);
      if (sums.samples[from] == 0) continue;
      pixel_radiance(sampled, from, radiance);
      glm::vec3 total(0.0F);
      for (std::size_t k = 0; k < sums.image_layers; ++k) {
        const glm::vec3 layer(radiance[k]);  // rounded first: the layers add up to the last bit
        total += layer;
        if (!layout.radiance.empty()) put(layout.radiance[k], to, Rgb(layer));
      }
      put(0, to, Rgb(total));
      for (std::size_t part = 0; part < layout.parts.size(); ++part) {
        if (layout.parts[part] == Layout::none_wanted) continue;
        put(layout.parts[part], to, radiance[sums.image_layers + part]);
      }
      if (layout.variance == Layout::none_wanted) continue;
      const auto& squared = error.squared[to];
      double variance = sums.sample_variance(from);
      for (std::size_t kind = 0; kind < gathered_kinds; ++kind) variance += double(squared[kind]);
      image.channels[layout.variance].values[to] = static_cast<float>(variance);
    }
  }
}

void summarise(const PixelSums& sums, const Window& window, Frame& frame) {
  RenderReport& report = frame.report;
  double samples = 0.0, finished = 0.0;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t p = sums.window.index(x, y);
      samples += sums.samples[p];
      report.most_camera_samples =
          std::max(report.most_camera_samples, static_cast<int>(sums.samples[p]));
      if (static_cast<int>(sums.samples[p]) >= report.least_camera_samples) finished += 1.0;
    }
  }
  const auto all = static_cast<double>(window.pixel_count());
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

  const Sampled sampled =
      sample_picture(shared, setup.world(), model, options, progress, frame.report);
  const PixelSums& sums = sampled.sums;
  frame.error = state_error(sums, sampled.field ? &*sampled.field : nullptr, window);
  // Not before: with many layers it is as large as what is sampled.
  frame.image = base::make_rgb_image(window.columns, window.rows);
  const Layout layout = with_layers(frame.image);
  fill_layers(sampled, frame.error, layout, window, frame.image);
  frame.report.rays.layers += fill_first_hit(world.scene, world.query, model, window, frame.image);
  frame.report.rays.layers += fill_cryptomatte(
      world.scene, world.query, model,
      {options.seed, window, sums.window, sums.samples, shared.filter}, frame.image);
  summarise(sums, window, frame);
  frame.report.stopped = options.stop && options.stop();
  frame.report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return frame;
}

}  // namespace earthshine::raytrace
