// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int find_pixels = 2;     // how far GatherField::find looks beyond the pixel
constexpr int most_rounds = 6;     // of camera samples, each at most four times the one before
constexpr int planning_grid = 48;  // pixels along the shorter edge that are looked at for planning

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Window widened(const Window& window, int pixels, const CameraModel& camera) {
  const int x0 = std::max(0, window.x - pixels), y0 = std::max(0, window.y - pixels);
  const int x1 = std::min(camera.columns, window.x + window.columns + pixels);
  const int y1 = std::min(camera.rows, window.y + window.rows + pixels);
  return {x0, y0, x1 - x0, y1 - y0};
}

struct Sampling {
  int camera_samples = 16;  // per pixel
  int gather_rays = 16;     // per camera sample
};

// Rays per pixel shared out so that the pixel's edge and the hemisphere get about equal attention.
// Without gather rays the samples serve edges, lamps and lenses alone.
Sampling share_out(int rays_per_pixel, bool gathers) {
  const auto rays = std::bit_ceil(static_cast<std::uint32_t>(std::max(1, rays_per_pixel)));
  const int log2 = static_cast<int>(std::bit_width(rays)) - 1;
  const int samples = 1 << std::min((log2 + 1) / 2, 6);
  return {samples, gathers ? static_cast<int>(rays) / samples : 0};
}

// What a coarse look at the whole picture tells, read from the solution: the mean luminance of what
// is lit, and the mean deviation of a camera sample from its pixel. Sources that the camera sees
// themselves are left out of the former.
struct Outlook {
  double luminance = 0.0, deviation = 0.0;
};

Outlook look_ahead(ShadingScene shared, const CameraModel& camera, int samples) {
  shared.diffuse = DiffuseSource::Solution;
  shared.splits_parts = false;
  const int step = std::max(1, std::min(camera.columns, camera.rows) / planning_grid);
  const int columns = (camera.columns + step - 1) / step, rows = (camera.rows + step - 1) / step;
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  struct Sums {
    double luminance = 0.0, deviation = 0.0, pixels = 0.0;
    Sums& operator+=(const Sums& other) {
      luminance += other.luminance;
      deviation += other.deviation;
      pixels += other.pixels;
      return *this;
    }
  };
  const Sums sums =
      base::ordered_sum<Sums>(count, 16, Sums{}, [&](std::size_t begin, std::size_t end) {
        Sums part;
        RayCounts rays;
        for (std::size_t k = begin; k < end; ++k) {
          const Window pixel{
              std::min(camera.columns - 1, static_cast<int>(k) % columns * step + step / 2),
              std::min(camera.rows - 1, static_cast<int>(k) / columns * step + step / 2), 1, 1};
          PixelSums one(pixel, shared.layers);
          shade_samples(shared, camera, {static_cast<std::uint32_t>(samples)}, one, rays, {}, {});
          part.deviation += std::sqrt(one.sample_variance(0) * samples);
          if (one.source_samples[0] > 0) continue;
          part.luminance += one.luminance[0] / samples;
          part.pixels += 1.0;
        }
        return part;
      });
  return {sums.luminance / std::max(1.0, sums.pixels), sums.deviation / static_cast<double>(count)};
}

class Passes {
 public:
  Passes(ShadingScene& shared, const CameraModel& camera, const RenderOptions& options,
         const Progress& progress)
      : shared_(shared),
        camera_(camera),
        options_(options),
        progress_(progress),
        window_(window_of(options)) {}

  PixelSums run(RenderReport& report) {
    return options_.shared.on ? run_shared(report) : run_per_sample(report);
  }

 private:
  [[nodiscard]] std::size_t entries() const {
    return shared_.layers + (shared_.splits_parts ? part_count : 0);
  }
  [[nodiscard]] bool out_of_time() const {
    return options_.time_limit_s > 0.0 && seconds_since(start_) > options_.time_limit_s;
  }
  [[nodiscard]] bool stops() const { return options_.stop && options_.stop(); }

  PixelSums run_per_sample(RenderReport& report) {
    const Sampling sampling = share_out(options_.gather_rays, shared_.gathers);
    shared_.diffuse = DiffuseSource::Gather;
    shared_.gather_rays = sampling.gather_rays;
    PixelSums sums(window_, entries());
    const auto count = static_cast<std::uint32_t>(sampling.camera_samples);
    expected_ = static_cast<std::uint64_t>(sampling.camera_samples) * window_.pixel_count();
    shade(std::vector<std::uint32_t>(window_.pixel_count(), count), sums, report);
    report.gather_rays = sampling.camera_samples * sampling.gather_rays;
    return sums;
  }

  PixelSums run_shared(RenderReport& report) {
    const SharedGather& how = options_.shared;
    const Outlook outlook = look_ahead(shared_, camera_, how.least_samples);
    // n = deviation / c gives a mean squared error of c times the mean deviation.
    const double wanted_error = how.noise * outlook.luminance;
    double per_deviation =
        outlook.deviation > 0.0 ? wanted_error * wanted_error / outlook.deviation : 1.0;
    const double mean_samples = std::max(
        double(how.least_samples), per_deviation > 0.0 ? outlook.deviation / per_deviation : 0.0);
    // Rounds look at neighbours, the gather at more of them: a crop gets the same pixels as the
    // whole picture only if what surrounds it is worked out too.
    PixelSums sums(widened(window_, most_rounds, camera_), entries());
    if (shared_.gathers) gather(sums.window, mean_samples, report);
    std::vector<std::uint32_t> wanted(sums.samples.size(),
                                      static_cast<std::uint32_t>(how.least_samples));
    shade(wanted, sums, report);
    for (int round = 1; round < most_rounds && !stops() && !out_of_time(); ++round) {
      if (per_deviation <= 0.0) break;
      wanted = wanted_samples(sums, per_deviation, how.least_samples, how.most_samples);
      shade(wanted, sums, report);
    }
    while (options_.time_limit_s > 0.0 && per_deviation > 0.0 && !stops() && !out_of_time()) {
      per_deviation *= 0.5;
      wanted = wanted_samples(sums, per_deviation, how.least_samples, 16 * how.most_samples);
      const std::uint64_t before = report.rays.camera;
      shade(wanted, sums, report);
      if (report.rays.camera == before && per_deviation < 1e-30) break;
    }
    return sums;
  }

  void gather(const Window& around, double mean_samples, RenderReport& report) {
    const auto start = Clock::now();
    GatherOptions how;
    how.rays = static_cast<int>(
        std::bit_ceil(static_cast<std::uint32_t>(std::clamp(options_.gather_rays, 8, 1 << 16))));
    how.seed = options_.seed;
    how.image_layers = shared_.layers;
    how.keeps_sky_apart = shared_.splits_parts;
    const auto surface = [this](const scenes::Hit& hit, GatherRequest& request) {
      return gathers_at(shared_.scene, hit, request);
    };
    const auto cast = [&](const Window& window) {
      return gather_field(shared_.query, shared_.incoming, surface, camera_, window, how);
    };
    const Window wide = widened(
        around, options_.shared.smooth_pixels + find_pixels + shared_.filter.reach_px(), camera_);
    if (options_.time_limit_s > 0.0) how.rays = affordable_rays(wide, cast, how.rays);
    how.stop = [this] { return stops() || out_of_time(); };
    const auto pixels = static_cast<double>(around.pixel_count());
    const double rays = pixels * how.rays, samples = pixels * mean_samples;
    expected_ = static_cast<std::uint64_t>(
        rays + samples * (1.0 + static_cast<double>(shared_.lights.count())));
    how.progress = [&](std::size_t done, std::size_t total) {
      tell(static_cast<std::uint64_t>(rays * static_cast<double>(done) /
                                      static_cast<double>(total)));
    };
    field_ = cast(wide);
    smooth(field_, options_.shared.smooth_share, options_.shared.smooth_pixels);
    done_ = static_cast<std::uint64_t>(rays);
    shared_.diffuse = DiffuseSource::Field;
    shared_.field = &field_;
    report.rays.gather += field_.gather_rays;
    report.rays.mirror += field_.mirror_rays;
    report.rays.camera += field_.camera_rays;
    report.gather_rays = how.rays;
    report.gather_seconds = seconds_since(start);
  }

  // As many as half of the time that is left allows, from the time that a few pixels take.
  template <class Cast>
  int affordable_rays(const Window& wide, const Cast& cast, int rays) const {
    constexpr int probe_px = 24;
    const Window probe{wide.x + (wide.columns - std::min(wide.columns, probe_px)) / 2,
                       wide.y + (wide.rows - std::min(wide.rows, probe_px)) / 2,
                       std::min(wide.columns, probe_px), std::min(wide.rows, probe_px)};
    const auto start = Clock::now();
    static_cast<void>(cast(probe));
    const double per_ray = seconds_since(start) / (static_cast<double>(probe.pixel_count()) * rays);
    const double left = options_.time_limit_s - seconds_since(start_);
    const double count = 0.5 * left / (per_ray * static_cast<double>(wide.pixel_count()));
    return static_cast<int>(
        std::bit_floor(static_cast<std::uint32_t>(std::clamp(count, 8.0, 65536.0))));
  }

  void shade(const std::vector<std::uint32_t>& wanted, PixelSums& sums, RenderReport& report) {
    // Whatever the limit, every pixel gets a first sample.
    const bool first = report.camera_samples == 0.0;
    report.camera_samples = 1.0;
    shade_samples(
        shared_, camera_, wanted, sums, report.rays,
        [&] { return stops() || (!first && out_of_time()); },
        [&](std::uint64_t samples) { tell(samples * (1 + shared_.lights.count())); });
  }

  void tell(std::uint64_t more) {
    if (!progress_) return;
    done_ += more;
    progress_(static_cast<std::size_t>(std::min(done_, expected_)),
              static_cast<std::size_t>(expected_));
  }

  ShadingScene& shared_;
  const CameraModel& camera_;
  const RenderOptions& options_;
  const Progress& progress_;
  Window window_;
  GatherField field_;
  Clock::time_point start_ = Clock::now();
  std::uint64_t done_ = 0, expected_ = 1;
};

}  // namespace

Window window_of(const RenderOptions& options) {
  const Window& crop = options.crop;
  if (crop.columns == 0) return {0, 0, options.columns, options.rows};
  const bool inside = crop.x >= 0 && crop.y >= 0 && crop.columns > 0 && crop.rows > 0 &&
                      crop.columns <= options.columns - crop.x &&
                      crop.rows <= options.rows - crop.y;
  if (inside) return crop;
  throw base::Error(base::Blame::Input, "crop", "the window leaves the picture",
                    "a window within " + std::to_string(options.columns) + " x " +
                        std::to_string(options.rows) + " pixels");
}

PixelSums sample_picture(ShadingScene& shared, const CameraModel& camera,
                         const RenderOptions& options, const Progress& progress,
                         RenderReport& report) {
  return Passes(shared, camera, options, progress).run(report);
}

}  // namespace earthshine::raytrace
