// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "raytrace/outlook.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int find_pixels = 2;  // how far GatherField::find looks beyond the pixel
constexpr int most_rounds = 6;  // of camera samples, each at most four times the one before
constexpr int most_gather_rays = 1 << 16;

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
    first_round(count, sums, report);
    report.gather_rays = sampling.camera_samples * sampling.gather_rays;
    return sums;
  }

  PixelSums run_shared(RenderReport& report) {
    const SharedGather& how = options_.shared;
    const Outlook outlook = look_ahead(shared_, camera_, how.least_samples);
    report.rays.planning += outlook.rays.total();
    // n = deviation / c gives a mean squared error of c times the mean deviation.
    const double wanted_error = how.noise * outlook.luminance;
    double per_deviation =
        outlook.deviation > 0.0 ? wanted_error * wanted_error / outlook.deviation : 1.0;
    const double mean_samples = std::max(
        double(how.least_samples), per_deviation > 0.0 ? outlook.deviation / per_deviation : 0.0);
    // Rounds look at neighbours, the gather at more of them: a crop gets the same pixels as the
    // whole picture only if what surrounds it is worked out too.
    PixelSums sums(widened(window_, most_rounds, camera_), entries());
    if (shared_.gathers) gather(sums.window, outlook.luminance, mean_samples, report);
    first_round(static_cast<std::uint32_t>(how.least_samples), sums, report);
    std::vector<std::uint32_t> wanted;
    for (int round = 1; round < most_rounds && !stops() && !out_of_time(); ++round) {
      if (per_deviation <= 0.0) break;
      wanted = wanted_samples(sums, per_deviation, outlook.bright(), how.least_samples,
                              how.most_samples);
      shade(wanted, sums, report);
    }
    while (options_.time_limit_s > 0.0 && options_.fills_time && per_deviation > 0.0 && !stops() &&
           !out_of_time()) {
      per_deviation *= 0.5;
      wanted = wanted_samples(sums, per_deviation, outlook.bright(), how.least_samples,
                              16 * how.most_samples);
      const std::uint64_t before = report.rays.camera;
      shade(wanted, sums, report);
      if (report.rays.camera == before && per_deviation < 1e-30) break;
    }
    return sums;
  }

  void gather(const Window& around, double luminance, double mean_samples, RenderReport& report) {
    const auto start = Clock::now();
    const SharedGather& sharing = options_.shared;
    GatherOptions how;
    how.rays = static_cast<int>(std::bit_ceil(
        static_cast<std::uint32_t>(std::clamp(options_.gather_rays, 8, most_gather_rays))));
    how.seed = options_.seed;
    how.image_layers = shared_.layers;
    how.keeps_sky_apart = shared_.splits_parts;
    const GatherSurface surface = [this](const scenes::Hit& hit, GatherRequest& request) {
      return gathers_at(shared_.scene, hit, request);
    };
    const auto cast = [&](const Window& window) {
      return gather_field(shared_.query, shared_.incoming, surface, camera_, window, how);
    };
    const bool limited = options_.time_limit_s > 0.0;
    // Points look at neighbours twice: to find out who needs more rays, and to share.
    const Window wide = widened(
        around, 2 * sharing.smooth_pixels + find_pixels + shared_.filter.reach_px(), camera_);
    if (limited) {
      const int wanted = how.rays;
      how.rays = 8;
      how.rays = affordable_rays(wide, cast);
      if (!options_.fills_time) how.rays = std::min(how.rays, wanted);
    }
    how.stop = [this] { return stops() || out_of_time(); };
    const auto pixels = static_cast<double>(around.pixel_count());
    const double rays = pixels * how.rays, samples = pixels * mean_samples;
    expected_ = static_cast<std::uint64_t>(
        rays + samples * (1.0 + static_cast<double>(shared_.lights.count())));
    how.progress = [&](std::size_t, std::size_t total) {
      tell(static_cast<std::uint64_t>(rays / static_cast<double>(total)));
    };
    GatherField plain = cast(wide);
    field_ = plain;
    smooth(field_, sharing.smooth_share, sharing.smooth_pixels);
    report.gather_rays = how.rays;
    if (sharing.gather_noise > 0.0 && !(limited && options_.fills_time)) {
      how.progress = {};
      bool again = false;
      const int first_rays = how.rays;
      for (const int factor : {4, 16}) {
        how.rays = factor * first_rays;
        const auto marks = noisy_points(field_, factor, luminance);
        if (how.rays > most_gather_rays || how.stop() || marks.empty()) continue;
        gather_again(plain, marks, shared_.query, shared_.incoming, surface, camera_, how);
        again = true;
      }
      if (again) {
        field_ = std::move(plain);
        smooth(field_, sharing.smooth_share, sharing.smooth_pixels);
      }
    }
    shared_.diffuse = DiffuseSource::Field;
    shared_.field = &field_;
    report.rays.gather += field_.gather_rays;
    report.rays += field_.onward;
    report.rays.camera += field_.camera_rays;
    report.gather_seconds = seconds_since(start);
  }

  // Points whose share in the picture is less exact than wanted, by more than the sharing can
  // mend: those for which `factor` times as many rays are about right. Empty if there are none.
  [[nodiscard]] std::vector<std::uint8_t> noisy_points(const GatherField& field, int factor,
                                                       double luminance) const {
    const double wanted = options_.shared.gather_noise;
    std::vector<std::uint8_t> marks(field.points.size(), 0);
    bool any = false;
    for (std::size_t p = 0; p < marks.size(); ++p) {
      const GatherPoint& point = field.points[p];
      if (point.reach_m <= 0.0F) continue;
      Rgb gathered(0.0);
      for (std::size_t k = 0; k < field.image_layers; ++k) {
        gathered += Rgb(field.radiance[p * field.layers + k]);
      }
      const double reflectance = double(point.reflectance);
      const double scale = wanted * std::max(luminance, reflectance * base::luminance(gathered));
      const double excess =
          reflectance * reflectance * double(field.squared_error[p]) / (scale * scale);
      const bool many = excess > 6.0;
      if (excess <= 1.0 || many != (factor > 4)) continue;
      marks[p] = 1;
      any = true;
    }
    return any ? marks : std::vector<std::uint8_t>{};
  }

  // As many as half of the time that is left allows, from the time that a few rays take in four
  // small windows.
  template <class Cast>
  int affordable_rays(const Window& wide, const Cast& cast) const {
    constexpr int probe_px = 16;
    const auto start = Clock::now();
    double rays = 1.0;
    for (const double x : {0.3, 0.7}) {
      for (const double y : {0.3, 0.7}) {
        const Window probe{wide.x + static_cast<int>(x * std::max(0, wide.columns - probe_px)),
                           wide.y + static_cast<int>(y * std::max(0, wide.rows - probe_px)),
                           std::min(wide.columns, probe_px), std::min(wide.rows, probe_px)};
        const GatherField field = cast(probe);
        rays += static_cast<double>(field.gather_rays + field.camera_rays);
      }
    }
    const double per_ray = seconds_since(start) / rays;
    const double left = options_.time_limit_s - seconds_since(start_);
    const double count = 0.5 * left / (per_ray * static_cast<double>(wide.pixel_count()));
    return static_cast<int>(std::bit_floor(
        static_cast<std::uint32_t>(std::clamp(count, 8.0, double(most_gather_rays)))));
  }

  // What was not reached when it was stopped gets a single sample all the same: a quick look.
  void first_round(std::uint32_t samples, PixelSums& sums, RenderReport& report) {
    report.least_camera_samples = static_cast<int>(samples);
    const std::size_t pixels = sums.samples.size();
    shade(std::vector<std::uint32_t>(pixels, samples), sums, report);
    if (!stops() && !out_of_time()) return;
    shade_samples(shared_, camera_, std::vector<std::uint32_t>(pixels, 1U), sums, report.rays, {},
                  {});
  }

  void shade(const std::vector<std::uint32_t>& wanted, PixelSums& sums, RenderReport& report) {
    shade_samples(
        shared_, camera_, wanted, sums, report.rays, [&] { return stops() || out_of_time(); },
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
