// SPDX-License-Identifier: Apache-2.0
// Distribution of samples over a picture: initial samples, then rounds until the stated error is
// reached. Fixed numbers need no rounds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/adaptive/sample_plan.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

struct InitialSampling {
  // Samples per gather point.
  std::uint32_t gather_rays = tuning::initial_gather_rays;
  std::uint32_t paths = tuning::initial_paths, lobe_rays = tuning::initial_lobe_rays;
  bool every_second = false;  // GatherField::sample_initial()
  // Camera samples of a pixel at an edge, and of an interior pixel.
  int camera = tuning::initial_camera_samples, interior = tuning::initial_camera_samples / 2;
  // Indexed by Gathered.
  [[nodiscard]] std::array<std::uint32_t, gathered_kinds> field() const {
    return {gather_rays, paths, lobe_rays};
  }
};

// Fraction of the wanted error at which rounds end after the first one. It corrects a selection
// effect: samples go where errors look largest, and errors that look too small by chance remain
// (measured values in tuning.h). Coarse errors have the larger fraction, because a further round
// for a hundredth of the samples takes a twentieth of the time.
[[nodiscard]] double stop_fraction(double wanted);

class Allocator {
 public:
  // wanted: RMS error relative to the mean luminance; 0: as small as possible.
  [[nodiscard]] static Allocator to_error(double wanted) { return Allocator(wanted); }
  // The same numbers everywhere and no rounds. Half as many paths and lobe rays as gather rays.
  [[nodiscard]] static Allocator fixed(int gather_rays, int camera_samples);

  [[nodiscard]] bool has_rounds() const { return !fixed_; }
  // Above an error of 4 %, or without one, half as many gather rays and paths, and no samples at
  // every second point of smooth regions. This suffices for smooth pictures and directs further
  // samples well in others (payload bay: at 5 %, but not at 3 %). A picture with few `points` gets
  // more paths per point, because too few paths may miss light.
  [[nodiscard]] InitialSampling initial(std::size_t points) const;
  // The next round. so_far, affordable: cost of the samples so far, and the most that further
  // samples may cost (rays of a packet). Empty if the numbers are fixed, the error is reached, no
  // samples can be afforded, or gave_up().
  [[nodiscard]] std::optional<SamplePlan> next(SamplePlanner& planner, double so_far,
                                               double affordable);
  // Whether far more samples than the error should take have hardly reduced it.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  // Predicted cost of all samples, if this plan of the planner is the next.
  [[nodiscard]] double predicted_cost(const SamplePlanner& planner, const SamplePlan& plan,
                                      double so_far) const;
  // Predicted ratio of all samples to the samples so far, from the plan of the next samples.
  [[nodiscard]] double growth(SamplePlanner& planner, double so_far) const;

  // Stated error after samples of that cost, with its confidence factor (ErrorSums).
  struct Statement {
    double cost = 0.0, error = 0.0, confidence_factor = 1.0;
  };
  // Whether 1024 times the samples have not halved a stated error. Noise alone would fall to 1/32,
  // but the initial samples may have missed most of it.
  [[nodiscard]] static bool is_hopeless(const std::vector<Statement>& statements);

 private:
  explicit Allocator(double wanted) : wanted_(wanted) {}
  [[nodiscard]] double squared_aim(double confidence_factor) const {
    const double aim = tuning::planned_share * wanted_ / confidence_factor;
    return aim * aim;
  }

  double wanted_;
  std::optional<InitialSampling> fixed_;
  std::vector<Statement> statements_;
  bool gave_up_ = false;
};

}  // namespace earthshine::raytrace
