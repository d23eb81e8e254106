// SPDX-License-Identifier: Apache-2.0
#include "raytrace/paths/path_tracer.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <numeric>
#include <string>

#include "base/ranks/ranks.h"
#include "raytrace/paths/path_walker.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t rgb = 3;
constexpr int stop_asked_after = 256;  // paths

void check(const PathOptions& options) {
  if (options.columns < 1 || options.rows < 1) {
    throw base::Error(base::Blame::Input, "path tracer",
                      "a picture of " + std::to_string(options.columns) + " x " +
                          std::to_string(options.rows) + " pixels",
                      "at least 1 x 1");
  }
  if (options.paths_per_pixel < 2) {
    throw base::Error(base::Blame::Input, "path tracer",
                      std::to_string(options.paths_per_pixel) + " paths per pixel",
                      "2 or more: fewer have no variance", "Raise quality.gather_rays");
  }
}

PathWorld make_world(const scenes::World& world, const LightSampler& lights,
                     const PathOptions& options) {
  PathWorld paths{world, lights, radiosity::emitter_is_explicit(world.scene), {}};
  for (std::size_t g = 0; g < world.groups.count(); ++g) {
    paths.layer.push_back(options.per_light ? g : 0);
  }
  if (options.per_light) paths.layers = std::max<std::size_t>(1, world.groups.count());
  paths.paths = options.paths;
  return paths;
}

base::Image make_image(const Window& window, const std::vector<std::string>& layers) {
  base::Image image = base::make_rgb_image(window.columns, window.rows);
  image.add("variance");
  for (const std::string& name : layers) {
    for (const char* channel : {".R", ".G", ".B"}) image.add("light_" + name + channel);
  }
  return image;
}

// Running mean and variance (Welford 1962).
struct Spread {
  double samples = 0.0, mean = 0.0, squares = 0.0;

  void add(double value) {
    samples += 1.0;
    const double off = value - mean;
    mean += off / samples;
    squares += off * (value - mean);
  }
  [[nodiscard]] double variance_of_mean() const { return squares / (samples - 1.0) / samples; }
};

struct PathSums {
  std::vector<Rgb> layers;
  Spread luminance, reflected;  // with and without sources that the camera sees itself
  SourceSeen source;

  void add(std::span<const Rgb> radiance, const PathWalker& walker) {
    Rgb all(0.0);
    for (std::size_t k = 0; k < layers.size(); ++k) {
      layers[k] += radiance[k];
      all += radiance[k];
    }
    luminance.add(base::luminance(all));
    reflected.add(base::luminance(all) - walker.source_luminance());
    source.add(walker.source_luminance());
    source.reflecting += walker.met_surface() ? 1.0 : 0.0;
  }
};

void store(const PathSums& sums, std::size_t pixel, Frame& frame) {
  base::Image& image = frame.image;
  const double paths = sums.luminance.samples;
  for (std::size_t c = 0; c < rgb; ++c) {
    float total = 0.0F;
    for (std::size_t layer = 0; layer < sums.layers.size(); ++layer) {
      const auto value = static_cast<float>(sums.layers[layer][static_cast<int>(c)] / paths);
      total += value;
      const std::size_t channel = rgb + 1 + rgb * layer + c;
      if (channel < image.channels.size()) image.channels[channel].values[pixel] = value;
    }
    image.channels[c].values[pixel] = total;
  }
  image.channels[rgb].values[pixel] = static_cast<float>(sums.luminance.variance_of_mean());
  frame.error.luminance[pixel] = static_cast<float>(sums.reflected.mean);
  frame.error.source[pixel] = static_cast<float>(sums.source.luminance / paths);
  frame.error.shows[pixel] = sums.source.shows(paths);
  const Spread& stated = frame.error.counts(pixel) ? sums.reflected : sums.luminance;
  frame.error.squared[pixel][static_cast<std::size_t>(ErrorPart::Camera)] =
      static_cast<float>(stated.variance_of_mean());
}

}  // namespace

Frame trace_paths(const scenes::World& world, const scenes::Camera& camera,
                  const PathOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  check(options);
  // As in the final gather, paths hit emitters that are a large part of the area; no shadow rays.
  const LightSampler lights(world, Indirect::Radiosity, 1, false, std::nullopt,
                            world.query.specular_paths().mirrors());
  const PathWorld paths = make_world(world, lights, options);
  const CameraModel model = make_camera_model(camera, options.columns, options.rows);

  Frame frame;
  const Window window =
      options.window.columns > 0 ? options.window : Window{0, 0, options.columns, options.rows};
  frame.window = window;
  frame.error = StatedError(window.pixel_count());
  frame.image =
      make_image(window, options.per_light ? world.groups.names : std::vector<std::string>{});
  const auto columns = static_cast<std::size_t>(window.columns);
  const auto rows = static_cast<std::size_t>(window.rows);
  std::vector<RayCounts> row_rays(rows);
  std::vector<std::uint32_t> finished(rows, 0);  // pixels
  std::size_t done = 0;
  std::mutex progress_mutex;
  const auto trace_row = [&](std::size_t y) {
    PathWalker walker(paths);
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t in_x = static_cast<std::size_t>(window.x) + x;
      const std::size_t in_y = static_cast<std::size_t>(window.y) + y;
      const base::Key key(options.seed, base::Stream::Path,
                          in_y * static_cast<std::size_t>(options.columns) + in_x);
      PathSums sums{std::vector<Rgb>(paths.layers, Rgb(0.0)), {}, {}, {}};
      for (int path = 0; path < options.paths_per_pixel; ++path) {
        // A pixel with many paths takes seconds.
        if (path % stop_asked_after == 0 && options.stop && options.stop()) {
          row_rays[y] = walker.rays();
          return;
        }
        base::Rng rng(key.with(static_cast<std::uint64_t>(path)));
        const double at_x = double(in_x) + rng.next();
        const double at_y = double(in_y) + rng.next();
        const double lens_u = rng.next();
        const double lens_v = rng.next();
        CameraModel moved;
        const CameraModel& then = camera_of_sample(
            model, at_y, [&] { return rng.next(); }, moved);
        sums.add(walker.walk(then.ray(at_x, at_y, lens_u, lens_v), rng), walker);
      }
      store(sums, y * columns + x, frame);
      ++finished[y];
    }
    row_rays[y] = walker.rays();
    const std::lock_guard lock(progress_mutex);
    ++done;
    if (progress) progress(done, rows);
  };
  base::share_loop(rows, trace_row, [&](std::size_t y, base::Parcel& parcel) {
    parcel.pass(row_rays[y]);
    parcel.pass(finished[y]);
    for (base::Channel& channel : frame.image.channels) {
      parcel.pass_range(&channel.values[y * columns], columns);
    }
    parcel.pass_range(&frame.error.luminance[y * columns], columns);
    parcel.pass_range(&frame.error.squared[y * columns], columns);
    parcel.pass_range(&frame.error.source[y * columns], columns);
    parcel.pass_range(&frame.error.shows[y * columns], columns);
  });
  for (const RayCounts& rays : row_rays) frame.report.rays += rays;
  const auto drawn = std::accumulate(finished.begin(), finished.end(), std::size_t{0});
  frame.report.finished_share =
      static_cast<double>(drawn) / static_cast<double>(window.pixel_count());
  frame.report.stopped = drawn < window.pixel_count();
  frame.report.camera_samples = options.paths_per_pixel;
  frame.report.most_camera_samples = options.paths_per_pixel;
  frame.report.relative_noise = std::sqrt(add_up(frame.error).squared_error());
  frame.report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return frame;
}

}  // namespace earthshine::raytrace
