// SPDX-License-Identifier: Apache-2.0
// Which samples a picture gets: the initial ones and, unless their numbers are fixed, those of each
// round until the stated error is as wanted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/adaptive/sample_plan.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

struct InitialSampling {
  // Per gather point.
  std::uint32_t gather_rays = tuning::initial_gather_rays;
  std::uint32_t paths = tuning::initial_paths, lobe_rays = tuning::initial_lobe_rays;
  bool every_second = false;  // GatherField::sample_initial()
  // Camera samples of a pixel at an edge, and of one whose surroundings show one surface.
  int camera = tuning::initial_camera_samples, interior = tuning::initial_camera_samples / 2;
  // By Gathered.
  [[nodiscard]] std::array<std::uint32_t, gathered_kinds> field() const {
    return {gather_rays, paths, lobe_rays};
  }
};

// Fraction of the wanted error at which rounds end, once there was one: samples go where errors
// look largest, so that those which look too small by chance stay so (measured values in tuning.h).
// A coarse error has the larger fraction: a further round for a hundredth of the samples takes a
// twentieth of the time.
[[nodiscard]] double stop_fraction(double wanted);

class Allocator {
 public:
  // wanted: relative to the mean luminance; 0: as small as can be.
  [[nodiscard]] static Allocator to_error(double wanted) { return Allocator(wanted); }
  // The same numbers everywhere and no rounds. Half as many paths and lobe rays as gather rays.
  [[nodiscard]] static Allocator fixed(int gather_rays, int camera_samples);

  [[nodiscard]] bool has_rounds() const { return !fixed_; }
  // Above an error of 4 %, or without one, half as many gather rays and paths, and no samples at
  // every second point of smooth regions: that suffices for smooth pictures, and for others it
  // directs further samples as well (payload bay, 5 %; at 3 % it does not). A picture of few
  // `points` gets more paths, for light that few of them find.
  [[nodiscard]] InitialSampling initial(std::size_t points) const;
  // The next round. so_far, affordable: cost of the samples so far, and what more may cost (rays of
  // a packet). Empty: the numbers are fixed, the error is reached, no samples can be afforded, or
  // gave_up().
  [[nodiscard]] std::optional<SamplePlan> next(SamplePlanner& planner, double so_far,
                                               double affordable);
  // Far more samples than the error should have taken have not brought it much down.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  // Samples in all, over those so far, by the last statement alone.
  [[nodiscard]] double growth() const;
  // The same by where they would go.
  [[nodiscard]] double growth(SamplePlanner& planner, double so_far) const;

  // A statement after samples of that cost, with its confidence factor (ErrorSums).
  struct Statement {
    double cost = 0.0, error = 0.0, confidence_factor = 1.0;
  };
  // Whether the last statement comes after 1024 times the samples of one whose error it has not
  // halved: known noise would fall to a thirty-second, but initial samples may miss most of it.
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
