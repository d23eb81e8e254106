// SPDX-License-Identifier: Apache-2.0
#include "raytrace/adaptive/adaptive_render.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "raytrace/adaptive/allocator.h"
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

bool draws_sums(const RenderOptions& options, std::size_t layers) {
  return !options.sums.empty() && layers > 1 && options.error > 0.0 && options.crop.columns == 0;
}

Allocator allocator_of(const RenderOptions& options, std::size_t layers) {
  const double share = draws_sums(options, layers) ? tuning::share_of_the_sum : 1.0;
  return options.has_rounds() ? Allocator::to_error(share * options.error)
                              : Allocator::fixed(options.gather_rays, options.camera_samples);
}

class AdaptiveRender {
 public:
  AdaptiveRender(ShadingScene& shared, const PathWorld& world, const CameraModel& camera,
                 const RenderOptions& options, const Progress& progress, RenderReport& report)
      : shared_(shared),
        world_(world),
        camera_(camera),
        options_(options),
        progress_(progress),
        report_(report),
        allocator_(allocator_of(options, shared.layers)) {
    if (options.regions.empty()) return;
    noted_.assign(static_cast<std::size_t>(camera.columns) * static_cast<std::size_t>(camera.rows),
                  0U);
    for (const std::vector<std::uint32_t>& region : options.regions) {
      for (const std::uint32_t pixel : region) noted_[pixel] = 1U;
    }
  }

  Sampled run() {
    sums_.emplace(window_of(options_), shared_.layers, shared_.splits_parts, noted_,
                  camera_.columns);
    covered_ = sample_initial();
    if (is_for_eye() && !ends()) {
      const double dimmest = tuning::dimmest_share * sums_->mean_luminance();
      shade(wanted_for_the_eye(*sums_, scatter_of_samples(*sums_, dimmest), dimmest));
    }
    shade_witnessed();
    covered_ = covered_ && !ends();
    reserve_s_ = denoising_s_;
    std::uint32_t round = 1;
    const bool by_sums = field_ && draws_sums(options_, shared_.layers);
    while (allocator_.has_rounds() && !ends() && sample_round(round)) ++round;
    while (by_sums && !ends() && sample_for_sums(round)) ++round;
    for (std::uint32_t k = 0; is_for_eye() && k < tuning::speck_rounds && !ends(); ++k) {
      if (!sample_specks(round + k)) break;
    }
    finish();
    return {std::move(*sums_), std::move(field_)};
  }

 private:
  [[nodiscard]] bool out_of_time() const {
    return options_.time_limit_s > 0.0 &&
           seconds_since(start_) > options_.time_limit_s - reserve_s_;
  }
  [[nodiscard]] bool stops() const { return options_.stop && options_.stop(); }
  [[nodiscard]] bool ends() const { return stops() || out_of_time(); }

  // Returns whether all gather points have initial samples.
  bool sample_initial() {
    const auto start = Clock::now();
    if (shared_.gathers) begin_field();
    reserve_s_ = tuning::after_points * seconds_since(start);
    const std::size_t points = field_ ? field_->points().size() : 0;
    const InitialSampling initial =
        allocator_.initial(std::max(points, options_.initial_sampling_pixels));
    const double share = initial.every_second ? 0.5 : 1.0;
    const auto cost = [&](Gathered kind) {
      const auto k = static_cast<std::size_t>(kind);
      return tuning::usual_cost_of_point[k] * share * initial.field()[k] * double(points);
    };
    for (const Gathered kind : every_kind) expected_ += cost(kind);
    const double pixels = static_cast<double>(sums_->samples.size());
    expected_ += tuning::usual_cost_of_camera * initial.camera * pixels;
    if (options_.error > 0.0) {
      expected_ *= std::max(tuning::least_usual_growth,
                            std::pow(tuning::usual_initial_error / options_.error, 2.0));
    }
    bool covered = true;
    if (field_) {
      for (const Gathered kind : every_kind) {
        const std::uint32_t each = initial.field()[static_cast<std::size_t>(kind)];
        field_->sample_initial(kind, each, initial.every_second, [this] { return ends(); });
        add_progress(cost(kind));
        if (ends()) field_->sample_sparse(kind);
      }
      covered = !ends();
      denoise(!allocator_.has_rounds());
      report_.gather_seconds += seconds_since(start);
      reserve_s_ *= tuning::after_denoising / tuning::after_points;
    }
    shade_initial(by_edges(initial.camera, initial.interior));
    reserve_s_ = 0.0;
    return covered;
  }

  // False if no further samples are needed or affordable.
  bool sample_round(std::uint32_t round) {
    const SampleCosts each = sample_costs(field());
    SamplePlanner planner(*sums_, field(), each);
    const double so_far = spent(*sums_, field(), each);
    const std::optional<SamplePlan> plan = allocator_.next(planner, so_far, affordable(so_far));
    if (!plan) return false;
    sample(*plan, round, so_far, allocator_.predicted_cost(planner, *plan, so_far));
    return true;
  }

  // The same for options.sums.
  bool sample_for_sums(std::uint32_t round) {
    const SampleCosts each = sample_costs(field());
    const double so_far = spent(*sums_, field(), each);
    if (most_for_sums_ <= 0.0) most_for_sums_ = tuning::most_growth_for_sums * so_far;
    SamplePlanner planner(*sums_, field(), each);
    const SumErrors errors(*sums_, *field_, planner.whole(), options_.sums, camera_.columns);
    const double aim = std::pow(stop_fraction(options_.error) * options_.error, 2.0);
    double worst = 0.0;
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < errors.squared().size(); ++k) {
      const double square = errors.squared()[k];
      if (square <= aim || square > tuning::most_gain_for_sums * aim) continue;
      open.push_back(k);
      worst = std::max(worst, square);
    }
    const double most = std::min(affordable(so_far), most_for_sums_ - so_far);
    if (open.empty() || most <= 0.0) return false;
    planner.demand(errors.demand(open));
    const double step = std::min(worst / aim / tuning::planned_share, tuning::most_step);
    SamplePlan plan = planner.plan(planner.squared_error() / step, most);
    const double fewest = std::min(most, tuning::least_step * so_far);
    if (plan.cost < fewest) plan = planner.plan(0.0, fewest);
    if (plan.cost <= 0.0) return false;
    sample(plan, round, so_far, so_far + plan.cost);
    return true;
  }

  // Whether pixels get samples that only the eye needs: not where the layers make them dear.
  [[nodiscard]] bool is_for_eye() const {
    return allocator_.has_rounds() && shared_.layers <= tuning::most_layers_for_eye;
  }

  // False: no pixel is visibly noisy.
  bool sample_specks(std::uint32_t round) {
    const SampleCosts each = sample_costs(field());
    const double so_far = spent(*sums_, field(), each);
    const double most = std::min(tuning::speck_cost * so_far, affordable(so_far));
    const SamplePlan plan = SamplePlanner(*sums_, field(), each).plan_for_specks(most);
    if (plan.cost <= 0.0) return false;
    sample(plan, round, so_far, so_far + plan.cost);
    return true;
  }

  // predicted: cost of all samples of the picture.
  void sample(const SamplePlan& plan, std::uint32_t round, double so_far, double predicted) {
    done_ = so_far;
    expected_ = tuning::usual_rest * predicted;
    double samples = 0.0;
    for (std::size_t p = 0; p < plan.camera.size(); ++p) {
      samples += plan.camera[p] - std::min(plan.camera[p], sums_->samples[p]);
    }
    cost_of_sample_ = (plan.cost - plan.field_cost) / std::max(1.0, samples);
    if (field_) {
      const auto start = Clock::now();
      for (std::size_t k = 0; k < gathered_kinds && !ends(); ++k) {
        field_->cast(static_cast<Gathered>(k), plan.field[k], round, [this] { return ends(); });
      }
      add_progress(plan.field_cost);
      denoise(false);
      report_.gather_seconds += seconds_since(start);
    }
    reserve_s_ = 0.0;
    shade(plan.camera);
    reserve_s_ = denoising_s_;
  }

  void finish() {
    report_.gave_up = allocator_.gave_up();
    // Rounds denoise the sum of all layers only; now each layer.
    if (field_ && allocator_.has_rounds() && shared_.layers > 1) denoise(true);
    if (field_) report_.rays += field_->rays();
    if (witness_) {
      sums_->unexplained = witness_->unexplained(*sums_, state_error(*sums_, field()).luminance);
      report_.unexplained_pixels = static_cast<std::size_t>(
          std::ranges::count_if(sums_->unexplained, [](float light) { return light > 0.0F; }));
    }
    if (!covered_ || options_.error <= 0.0 || !(ends() || report_.gave_up)) return;
    const SampleCosts each = sample_costs(field());
    SamplePlanner planner(*sums_, field(), each);
    report_.growth = allocator_.growth(planner, spent(*sums_, field(), each));
  }

  // Cost of the samples that the remaining time allows; infinite without a limit.
  [[nodiscard]] double affordable(double so_far) const {
    if (options_.time_limit_s <= 0.0) return std::numeric_limits<double>::infinity();
    const double gone = seconds_since(start_);
    return std::max(0.0, options_.time_limit_s - reserve_s_ - gone) * so_far / std::max(gone, 1e-3);
  }

  [[nodiscard]] const GatherField* field() const { return field_ ? &*field_ : nullptr; }

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
                             options_.denoise, shared_.layers > 1, noted_, options_.seed});
    shared_.field = &*field_;
  }

  void denoise(bool by_layer) {
    const auto start = Clock::now();
    for (const Gathered kind : every_kind) field_->share(kind, by_layer);
    denoising_s_ = seconds_since(start);
    count_gather_rays();
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

  // Interior pixels get fewer samples: only shadows and highlights vary there.
  [[nodiscard]] std::vector<std::uint32_t> by_edges(int near, int interior) const {
    const Window& window = sums_->window;
    std::vector<std::uint32_t> samples(sums_->samples.size(), static_cast<std::uint32_t>(near));
    for (int y = window.y; field_ && y < window.y + window.rows; ++y) {
      for (int x = window.x; x < window.x + window.columns; ++x) {
        if (!field_->is_interior(x, y)) continue;
        samples[window.index(x, y)] = static_cast<std::uint32_t>(interior);
      }
    }
    return samples;
  }

  // After a stop, pixels without samples get two, which give an error estimate. In interior regions
  // one pixel of four gets two; the others get one sample and take the error of that pixel
  // (PixelSums::squared_error).
  void shade_initial(const std::vector<std::uint32_t>& samples) {
    report_.least_camera_samples = static_cast<int>(*std::ranges::min_element(samples));
    shade(samples);
    if (!ends()) return;
    std::vector<std::uint32_t> least = by_edges(2, field_ ? 1 : 2);
    const auto columns = static_cast<std::size_t>(sums_->window.columns);
    for (std::size_t p = 0; p < least.size(); ++p) {
      if (p % columns % 2 == 0 && p / columns % 2 == 0) least[p] = 2;
    }
    shade_samples(shared_, camera_, least, *sums_, report_.rays, {}, {});
  }

  void shade(const std::vector<std::uint32_t>& wanted) {
    shade_samples(
        shared_, camera_, wanted, *sums_, report_.rays, [&] { return ends(); },
        [&](std::uint64_t samples) {
          add_progress(cost_of_sample_ * static_cast<double>(samples));
        });
  }

  // Most samples for the witness. Fixed numbers have no limit, so that a crop has the pixels of the
  // whole picture.
  [[nodiscard]] double most_for_witness() const {
    const double pixels = static_cast<double>(camera_.columns) * camera_.rows;
    double most = options_.error > 0.0
                      ? std::max(tuning::witness_samples, tuning::witness_per_pixel * pixels)
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

  // Samples for light that few samples find. With fixed numbers, only light that a crop finds
  // alike.
  void shade_witnessed() {
    if (ends() || camera_.moves()) return;  // its features have places in a still picture
    const bool fixed = !allocator_.has_rounds();
    witness_.emplace(shared_, camera_,
                     WitnessOptions{options_.error, fixed ? 0.0 : sums_->mean_luminance(),
                                    most_for_witness(), fixed, [this] { return ends(); }});
    report_.rays.planning += witness_->rays();
    sums_->spot_luminance = witness_->spot_luminance(*sums_);
    shade(witness_->wanted(*sums_));
  }

  void add_progress(double more) {
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
  Allocator allocator_;
  std::vector<std::uint8_t> noted_;  // per pixel of the picture: 1 in the regions
  std::optional<GatherField> field_;
  std::optional<PixelSums> sums_;
  std::optional<Witness> witness_;
  Clock::time_point start_ = Clock::now();
  double reserve_s_ = 0.0;      // share of the time limit for the remaining steps
  double most_for_sums_ = 0.0;  // cost of all samples
  double denoising_s_ = 0.0;    // duration of the last denoising
  bool covered_ = true;         // the initial samples are complete
  // Cost of the samples so far and of all that are expected (SampleCosts); of a camera sample.
  double done_ = 0.0, expected_ = 0.0, cost_of_sample_ = tuning::usual_cost_of_camera;
};

}  // namespace

Sampled sample_picture(ShadingScene& shared, const PathWorld& world, const CameraModel& camera,
                       const RenderOptions& options, const Progress& progress,
                       RenderReport& report) {
  return AdaptiveRender(shared, world, camera, options, progress, report).run();
}

}  // namespace earthshine::raytrace
