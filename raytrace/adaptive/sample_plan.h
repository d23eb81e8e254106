// SPDX-License-Identifier: Apache-2.0
// Plans a round of samples: each point and pixel gets up to four times its samples if a ray there
// reduces the squared error by more than a common price (docs/renderer.md, section 7).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/adaptive/stated_error.h"
#include "raytrace/adaptive/sum_errors.h"
#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Cost of one more sample, in rays of a packet.
struct SampleCosts {
  std::array<double, gathered_kinds> field{1.0, 1.0, 1.0};
  double camera = 1.0;      // without its rays
  double camera_ray = 1.0;  // each ray; the pixel's samples so far predict their number
};

// Costs from the rays per sample so far. Rays are counted, not timed, so that all machines plan
// alike. field: nullptr without gather points.
[[nodiscard]] SampleCosts sample_costs(const GatherField* field);
// Cost of all samples so far.
[[nodiscard]] double spent(const PixelSums& sums, const GatherField* field,
                           const SampleCosts& costs);

struct SamplePlan {
  std::array<std::vector<std::uint32_t>, gathered_kinds> field;  // more samples per point
  std::vector<std::uint32_t> camera;                             // total samples per pixel
  double cost = 0.0, field_cost = 0.0;                           // whole cost, and cost of `field`
  double squared_error = 0.0;                                    // expected after the plan
};

class SamplePlanner {
 public:
  // field: nullptr without gather points. The arguments must outlive the planner unchanged.
  SamplePlanner(const PixelSums& sums, const GatherField* field, const SampleCosts& costs);
  // From here on all squared errors have these factors.
  void demand(ErrorDemand demand);
  [[nodiscard]] const ErrorSums& whole() const { return whole_; }

  // Of the current picture, relative to its mean luminance, squared.
  [[nodiscard]] double squared_error() const {
    return whole_.reference_luminance > 0.0 ? whole_.squared_error() : 0.0;
  }
  [[nodiscard]] double confidence_factor() const { return whole_.confidence_factor; }
  // The cheapest plan that is expected to reduce the squared error to `wanted`, at most_cost or
  // less.
  [[nodiscard]] SamplePlan plan(double wanted, double most_cost);
  // Four times the samples for the pixels whose stated deviation is visible (tuning.h), the worst
  // first, at most_cost or less: single specks that hardly count in the error of the picture.
  [[nodiscard]] SamplePlan plan_for_specks(double most_cost) const;

 private:
  // Gain of one point or pixel; no cost if more samples do not help. Members have no initial
  // values: otherwise one thread would touch all the memory first (base/parallel.h).
  struct Gain {
    std::uint32_t index;
    std::uint8_t kind;
    float samples;        // so far
    float cost;           // of doubling the samples
    float first, second;  // reduction of squared error by 2 times, and from 2 to 4 times
    float found;          // share of this reduction that the own samples confirm
    // Highest price of a ray, in squared error, at which the samples are doubled or quadrupled.
    static constexpr float none = -1.0F;
    float price_of_two, price_of_four;
    void find_prices();
    [[nodiscard]] int factor(float per_cost) const {
      return per_cost <= price_of_four ? 4 : per_cost <= price_of_two ? 2 : 1;
    }
  };
  [[nodiscard]] SamplePlan no_samples() const;
  // Computes the gains once a plan is needed; a picture that is accurate enough needs none.
  void find_gains();
  // Appends the gains of [0, count): fill(begin, end, gains) computes a part.
  template <class Fill>
  void append_gains(std::size_t count, const Fill& fill);
  void find_field_gains(double scale);
  void find_pixel_gains(double scale);
  struct Outcome {
    double squared_error = 0.0, cost = 0.0;
    Outcome& operator+=(const Outcome& other) {
      squared_error += other.squared_error;
      cost += other.cost;
      return *this;
    }
  };
  // Sum over the `gains` that are worth that price.
  [[nodiscard]] Outcome outcome(std::span<const Gain> gains, double per_cost) const;

  const PixelSums& sums_;
  const GatherField* field_;
  SampleCosts costs_;
  StatedError stated_;
  ErrorSums whole_;
  std::optional<ErrorDemand> demand_;
  bool has_gains_ = false;
  std::unique_ptr<Gain[]> gains_;
  std::size_t gain_count_ = 0;
};

}  // namespace earthshine::raytrace
