// SPDX-License-Identifier: Apache-2.0
#include "raytrace/render.h"

#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/cryptomatte.h"
#include "raytrace/first_hit.h"
#include "raytrace/layers.h"
#include "raytrace/passes.h"
#include "raytrace/shading_setup.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

void fill_layers(const PixelSums& sums, const Layout& layout, std::size_t image_layers,
                 const Window& window, base::Image& image) {
  const auto put = [&](std::size_t first, std::size_t pixel, const Rgb& value) {
    for (int c = 0; c < 3; ++c) {
      image.channels[first + static_cast<std::size_t>(c)].values[pixel] =
          static_cast<float>(value[c]);
    }
  };
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t from = sums.window.index(x, y), to = window.index(x, y);
      if (sums.samples[from] == 0) continue;
      const double n = sums.samples[from];
      const glm::dvec3* radiance = &sums.radiance[from * sums.entries];
      glm::vec3 total(0.0F);
      for (std::size_t k = 0; k < image_layers; ++k) {
        const glm::vec3 layer(radiance[k] / n);  // rounded first: the layers add up to the last bit
        total += layer;
        if (!layout.radiance.empty()) put(layout.radiance[k], to, Rgb(layer));
      }
      put(0, to, Rgb(total));
      for (std::size_t part = 0; part < layout.parts.size(); ++part) {
        if (layout.parts[part] == Layout::none_wanted) continue;
        put(layout.parts[part], to, radiance[image_layers + part] / n);
      }
      if (layout.variance != Layout::none_wanted) {
        image.channels[layout.variance].values[to] = static_cast<float>(sums.squared_error(from));
      }
    }
  }
}

void summarise(const PixelSums& sums, const Window& window, Frame& frame) {
  RenderReport& report = frame.report;
  frame.squared_error.assign(window.pixel_count(), shows_source);
  double error = 0.0, field_error = 0.0, mean = 0.0, pixels = 0.0, samples = 0.0, finished = 0.0;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      const std::size_t p = sums.window.index(x, y);
      samples += sums.samples[p];
      report.most_camera_samples =
          std::max(report.most_camera_samples, static_cast<int>(sums.samples[p]));
      if (static_cast<int>(sums.samples[p]) >= report.least_camera_samples) finished += 1.0;
      if (sums.source_samples[p] > 0) continue;
      frame.squared_error[window.index(x, y)] = static_cast<float>(sums.squared_error(p));
      error += sums.squared_error(p);
      field_error += sums.squared_field_error(p);
      mean += sums.luminance[p] / sums.samples[p];
      pixels += 1.0;
    }
  }
  const auto all = static_cast<double>(window.pixel_count());
  report.camera_samples = samples / all;
  report.finished_share = finished / all;
  if (mean <= 0.0) return;
  report.relative_noise = std::sqrt(error / pixels) / (mean / pixels);
  report.gather_noise = std::sqrt(field_error / pixels) / (mean / pixels);
}

}  // namespace

RenderOptions render_options(const scenes::QualityKnobs& knobs) {
  RenderOptions options;
  options.gather_rays = knobs.gather_rays;
  options.shared.on = knobs.share_gather;
  options.shared.smooth_share = knobs.smooth_share;
  options.shared.noise = knobs.picture_noise;
  options.shared.gather_noise = knobs.gather_noise;
  return options;
}

Frame render(const scenes::Scene& scene, const scenes::LightGroups& groups,
             const scenes::Effects& effects, const scenes::RayQuery& query,
             const radiosity::Solution& solution, const scenes::Camera& camera,
             const RenderOptions& options, const Progress& progress) {
  const auto start = Clock::now();
  Frame frame;
  ShadingSetup setup(scene, groups, effects, query, solution, camera, options);
  ShadingScene& shared = setup.shared();
  const CameraModel& model = setup.camera();
  const std::size_t layers = shared.layers;
  const Window window = window_of(options);
  frame.window = window;
  frame.image = base::make_rgb_image(window.columns, window.rows);
  const Layout layout = add_layers(
      frame.image, options.per_light ? groups.names : std::vector<std::string>{}, options.aovs);
  shared.splits_parts = layout.splits_parts();

  const PixelSums sums = sample_picture(shared, model, options, progress, frame.report);
  fill_layers(sums, layout, layers, window, frame.image);
  frame.report.rays.layers += fill_first_hit(scene, query, model, window, frame.image);
  frame.report.rays.layers += fill_cryptomatte(
      scene, query, model, {options.seed, window, sums.window, sums.samples, shared.filter},
      frame.image);
  summarise(sums, window, frame);
  frame.report.stopped = options.stop && options.stop();
  frame.report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return frame;
}

}  // namespace earthshine::raytrace
