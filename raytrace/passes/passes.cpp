// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes/passes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "raytrace/passes/pilot_pass.h"
#include "raytrace/passes/rounds.h"
#include "raytrace/tuning.h"
#include "raytrace/witness/witness.h"

namespace earthshine::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<Gathered, gathered_kinds> every_kind = {Gathered::Solution, Gathered::Residual,
                                                             Gathered::Lobe};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Window widened(const Window& window, int pixels, const CameraModel& camera) {
  const int x0 = std::max(0, window.x - pixels), y0 = std::max(0, window.y - pixels);
  const int x1 = std::min(camera.columns, window.x + window.columns + pixels);
  const int y1 = std::min(camera.rows, window.y + window.rows + pixels);
  return {x0, y0, x1 - x0, y1 - y0};
}

class Passes {
 public:
  Passes(ShadingScene& shared, const PathWorld& world, const CameraModel& camera,
         const RenderOptions& options, const Progress& progress, RenderReport& report)
      : shared_(shared),
        world_(world),
        camera_(camera),
        options_(options),
        progress_(progress),
        report_(report),
        window_(window_of(options)) {
    if (options.regions.empty()) return;
    noted_.assign(static_cast<std::size_t>(camera.columns) * static_cast<std::size_t>(camera.rows),
                  0U);
    for (const std::vector<std::uint32_t>& region : options.regions) {
      for (const std::uint32_t pixel : region) noted_[pixel] = 1U;
    }
  }

  Sampled run() {
    if (!options_.shared.on) {
      run_per_sample();
    } else if (options_.error > 0.0 || (options_.time_limit_s > 0.0 && options_.fills_time)) {
      run_to_error();
    } else {
      run_shared();
    }
    if (field_) report_.rays += field_->rays();
    return {std::move(*sums_), std::move(field_)};
  }

 private:
  [[nodiscard]] bool out_of_time() const {
    return options_.time_limit_s > 0.0 &&
           seconds_since(start_) > options_.time_limit_s - reserve_s_;
  }
  [[nodiscard]] bool stops() const { return options_.stop && options_.stop(); }
  [[nodiscard]] bool ends() const { return stops() || out_of_time(); }

  void run_per_sample() {
    const PixelSamples sampling = share_out(options_.gather_rays, shared_.gathers);
    shared_.diffuse = DiffuseSource::Gather;
    shared_.gather_rays = sampling.gather_rays;
    sums_.emplace(window_, shared_.layers, shared_.splits_parts, noted_, camera_.columns);
    expected_ =
        static_cast<double>(sampling.camera_samples) * static_cast<double>(window_.pixel_count());
    first_round(everywhere(sampling.camera_samples));
    shade_witnessed(0.0, 0.0);
    report_.gather_rays = sampling.camera_samples * sampling.gather_rays;
  }

  void run_shared() {
    const SharedGather& how = options_.shared;
    const PilotPass pilot =
        run_pilot_pass(shared_, camera_, how.least_samples, [this] { return ends(); });
    report_.rays.planning += pilot.rays.total();
    // n = deviation / c gives a mean squared error of c times the mean deviation.
    const double wanted_error = how.noise * pilot.luminance;
    const double per_deviation =
        pilot.deviation > 0.0 ? wanted_error * wanted_error / pilot.deviation : 1.0;
    // Rounds look at neighbours: a crop gets the same pixels as the whole picture only if what
    // surrounds it is worked out too.
    const Window around = widened(window_, 1 + tuning::most_rounds, camera_);
    const double samples = std::max(double(how.least_samples),
                                    per_deviation > 0.0 ? pilot.deviation / per_deviation : 0.0);
    const double gathers = shared_.gathers ? options_.gather_rays : 0;
    expected_ = static_cast<double>(around.pixel_count()) * samples + pixels() * 2.0 * gathers;
    if (shared_.gathers) {
      const auto start = Clock::now();
      begin_field();
      const auto rays = static_cast<std::uint32_t>(options_.gather_rays);
      const std::uint32_t fewest = GatherField::fewest_samples(Gathered::Solution);
      for (const Gathered kind : every_kind) {
        look_first(kind, kind == Gathered::Solution ? std::max(rays, fewest) : rays / 2, false);
        field_->share(kind, true);
      }
      count_gather_rays();
      report_.gather_seconds += seconds_since(start);
    }
    sums_.emplace(around, shared_.layers, shared_.splits_parts, noted_, camera_.columns);
    shared_.dimmest = pilot.dimmest;
    first_round(everywhere(how.least_samples));
    shared_.dimmest.clear();
    if (!ends())
      shade(wanted_for_the_eye(*sums_, sums_->scatter, tuning::dimmest_share * pilot.luminance));
    shade_witnessed(how.noise, pilot.luminance);
    for (int round = 1; round < tuning::most_rounds && !ends() && per_deviation > 0.0; ++round) {
      shade(wanted_samples(*sums_, per_deviation, pilot.bright(), how.least_samples,
                           how.most_samples));
    }
  }

  // As many of each as the wanted error takes, round by round, told by what is there.
  void run_to_error() {
    sums_.emplace(window_, shared_.layers, shared_.splits_parts, noted_, camera_.columns);
    expected_ = 1.0;
    bool covered = true;  // all over the picture there are as many samples as a first look takes
    if (shared_.gathers) {
      const auto start = Clock::now();
      begin_field();
      reserve_s_ = tuning::after_points * seconds_since(start);
      const FirstLook first =
          first_look(options_.error, std::max(field_->points().size(), options_.first_look_pixels));
      look_first(Gathered::Solution, first.gather_rays, first.every_second);
      look_first(Gathered::Residual, first.paths, first.every_second);
      look_first(Gathered::Lobe, first.lobe_rays, first.every_second);
      covered = !ends();
      share();
      report_.gather_seconds += seconds_since(start);
      reserve_s_ *= tuning::after_sharing / tuning::after_points;
    }
    const int least = options_.shared.least_samples;
    first_round(by_edges(least, std::max(std::min(2, least), least / 2)));
    reserve_s_ = 0.0;
    if (!ends() && shared_.layers <= tuning::most_layers_for_eye) {
      const double dimmest = tuning::dimmest_share * sums_->mean_luminance();
      shade(wanted_for_the_eye(*sums_, scatter_of_samples(*sums_, dimmest), dimmest));
    }
    shade_witnessed(options_.error, sums_->mean_luminance());
    covered = covered && !ends();
    Rounds rounds(options_.error);
    reserve_s_ = sharing_s_;
    for (std::uint32_t round = 1; !ends(); ++round) {
      const SampleCosts each = sample_costs(field());
      SamplePlanner planner(*sums_, field(), each);
      const double so_far = spent(*sums_, field(), each);
      const std::optional<SamplePlan> plan = rounds.next(planner, so_far, affordable(so_far));
      if (!plan) break;
      expected_ = done_ + std::max(plan->cost, done_ * (rounds.growth() - 1.0));
      if (field_) {
        const auto start = Clock::now();
        for (std::size_t k = 0; k < gathered_kinds && !ends(); ++k) {
          field_->cast(static_cast<Gathered>(k), plan->field[k], round, [this] { return ends(); });
        }
        tell(plan->field_cost);
        share();
        report_.gather_seconds += seconds_since(start);
      }
      reserve_s_ = 0.0;
      shade(plan->camera);
      reserve_s_ = sharing_s_;
    }
    report_.gave_up = rounds.gave_up();
    finish_layers();
    if (witness_) {
      sums_->unexplained = witness_->unexplained(*sums_);
      report_.unexplained_pixels = static_cast<std::size_t>(
          std::ranges::count_if(sums_->unexplained, [](float light) { return light > 0.0F; }));
    }
    if (!covered || options_.error <= 0.0 || !(ends() || report_.gave_up)) return;
    const SampleCosts each = sample_costs(field());
    SamplePlanner planner(*sums_, field(), each);
    report_.growth = rounds.growth(planner, spent(*sums_, field(), each));
  }

  // What the time that is left buys; infinite without a limit.
  [[nodiscard]] double affordable(double so_far) const {
    if (options_.time_limit_s <= 0.0) return std::numeric_limits<double>::infinity();
    const double gone = seconds_since(start_);
    return std::max(0.0, options_.time_limit_s - reserve_s_ - gone) * so_far / std::max(gone, 1e-3);
  }

  [[nodiscard]] const GatherField* field() const { return field_ ? &*field_ : nullptr; }
  [[nodiscard]] double pixels() const {
    return static_cast<double>(camera_.columns) * camera_.rows;
  }

  void begin_field() {
    const GatherSurface surface = [&scene = shared_.scene](const scenes::Hit& hit,
                                                           GatherRequest& request) {
      return gathers_at(scene, hit, request);
    };
    const bool even =
        camera_.columns % options_.gather_step == 0 && camera_.rows % options_.gather_step == 0;
    const int step = even ? options_.gather_step : 1;
    field_.emplace(
        world_, shared_.incoming, surface, camera_,
        GatherField::Setting{shared_.layers, step, shared_.splits_parts, shared_.world != nullptr,
                             options_.shared.smooth_share > 0.0, shared_.layers > 1, noted_,
                             options_.seed});
    shared_.diffuse = DiffuseSource::Field;
    shared_.field = &*field_;
  }

  void look_first(Gathered kind, std::uint32_t each, bool every_second) {
    field_->look_first(kind, each, every_second, [this] { return ends(); });
    tell(pixels() * each * (every_second ? 0.5 : 1.0));
    if (ends()) field_->look_quickly(kind);
  }

  void share() {
    const auto start = Clock::now();
    for (const Gathered kind : every_kind) field_->share(kind, false);
    sharing_s_ = seconds_since(start);
    count_gather_rays();
  }

  // Rounds go by the sum of all layers; each of them follows at the end.
  void finish_layers() {
    if (!field_ || shared_.layers < 2) return;
    for (const Gathered kind : every_kind) field_->share(kind, true);
  }

  void count_gather_rays() {
    if (!field_->gathers(Gathered::Solution)) return;
    double rays = 0.0, points = 0.0;
    for (std::size_t p = 0; p < field_->points().size(); ++p) {
      const float samples = field_->samples(Gathered::Solution, p);
      rays += double(samples);
      points += field_->reflected(Gathered::Solution, p) > 0.0 ? 1.0 : 0.0;
    }
    report_.gather_rays = static_cast<int>(std::lround(rays / std::max(1.0, points)));
  }

  [[nodiscard]] std::vector<std::uint32_t> everywhere(int samples) const {
    return std::vector<std::uint32_t>(sums_->samples.size(), static_cast<std::uint32_t>(samples));
  }

  // Fewer where no edge is near: only shadows and highlights vary there.
  [[nodiscard]] std::vector<std::uint32_t> by_edges(int near, int elsewhere) const {
    std::vector<std::uint32_t> samples = everywhere(near);
    const Window& window = sums_->window;
    for (int y = window.y; field_ && y < window.y + window.rows; ++y) {
      for (int x = window.x; x < window.x + window.columns; ++x) {
        if (!field_->is_even(x, y)) continue;
        samples[window.index(x, y)] = static_cast<std::uint32_t>(elsewhere);
      }
    }
    return samples;
  }

  // What was not reached when it was stopped gets two samples all the same, which tell what they
  // are off by. Where no edge is near, that is one pixel of four; the others get one sample, and
  // what that is off by is told by the pixel with two (PixelSums::squared_error).
  void first_round(const std::vector<std::uint32_t>& samples) {
    report_.least_camera_samples = static_cast<int>(*std::ranges::min_element(samples));
    shade(samples);
    if (!ends()) return;
    if (!field_) shared_.gather_rays = std::max(1, shared_.gather_rays / tuning::hasty_share);
    std::vector<std::uint32_t> least = field_ ? by_edges(2, 1) : everywhere(2);
    const auto columns = static_cast<std::size_t>(sums_->window.columns);
    for (std::size_t p = 0; p < least.size(); ++p) {
      if (p % columns % 2 == 0 && p / columns % 2 == 0) least[p] = 2;
    }
    shade_samples(shared_, camera_, least, *sums_, report_.rays, {}, {});
  }

  void shade(const std::vector<std::uint32_t>& wanted) {
    shade_samples(
        shared_, camera_, wanted, *sums_, report_.rays, [&] { return ends(); },
        [&](std::uint64_t samples) { tell(static_cast<double>(samples)); });
  }

  // Samples. A picture without a wanted error or a time limit has no bound, so that a crop has the
  // pixels of the whole.
  [[nodiscard]] double most_for_witness() const {
    double most = options_.error > 0.0
                      ? std::max(tuning::witness_samples, tuning::witness_per_pixel * pixels())
                      : 0.0;
    if (options_.time_limit_s <= 0.0) return most;
    const SampleCosts each = sample_costs(field());
    double samples = 0.0, cost = 0.0;
    for (std::size_t p = 0; p < sums_->samples.size(); ++p) {
      samples += sums_->samples[p];
      cost += each.camera * sums_->samples[p] + each.camera_ray * double(sums_->rays[p]);
    }
    const double left = affordable(spent(*sums_, field(), each));
    const double in_time = tuning::time_for_witness * left * samples / std::max(cost, 1.0);
    return std::max(1.0, most > 0.0 ? std::min(most, in_time) : in_time);
  }

  // Light that few samples find. luminance: of the picture; error: wanted of it.
  void shade_witnessed(double error, double luminance) {
    if (ends()) return;
    witness_.emplace(shared_, camera_,
                     WitnessOptions{error, luminance, most_for_witness(), !options_.shared.on,
                                    [this] { return ends(); }});
    report_.rays.planning += witness_->rays();
    sums_->spot_luminance = witness_->spot_luminance(*sums_);
    shade(witness_->wanted(*sums_));
  }

  void tell(double more) {
    done_ += more;
    if (!progress_) return;
    progress_(static_cast<std::size_t>(std::min(done_, expected_)),
              static_cast<std::size_t>(std::max(1.0, expected_)));
  }

  ShadingScene& shared_;
  const PathWorld& world_;
  const CameraModel& camera_;
  const RenderOptions& options_;
  const Progress& progress_;
  RenderReport& report_;
  Window window_;
  std::vector<std::uint8_t> noted_;  // of the picture's pixels: 1 in the regions
  std::optional<GatherField> field_;
  std::optional<PixelSums> sums_;
  std::optional<Witness> witness_;
  Clock::time_point start_ = Clock::now();
  double reserve_s_ = 0.0;  // of the time limit, for what has to follow
  double sharing_s_ = 0.0;  // what it took the last time
  double done_ = 0.0, expected_ = 1.0;
};

}  // namespace

Sampled sample_picture(ShadingScene& shared, const PathWorld& world, const CameraModel& camera,
                       const RenderOptions& options, const Progress& progress,
                       RenderReport& report) {
  return Passes(shared, world, camera, options, progress, report).run();
}

}  // namespace earthshine::raytrace
