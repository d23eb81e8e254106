// SPDX-License-Identifier: Apache-2.0
// Where more samples of a picture help most for their price: every point and pixel gets up to four
// times what it has, as long as a ray spent there takes more off the squared error than elsewhere.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raytrace/adaptive/stated_error.h"
#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// Of one more sample, in rays of a packet.
struct SampleCosts {
  std::array<double, gathered_kinds> field{1.0, 1.0, 1.0};
  double camera = 1.0;      // without its rays
  double camera_ray = 1.0;  // each of these; the pixel's samples so far tell how many
};

// From the rays that samples have taken so far; counted, so that every machine chooses alike.
// field: nullptr where nothing is gathered.
[[nodiscard]] SampleCosts sample_costs(const GatherField* field);
// Of all samples so far.
[[nodiscard]] double spent(const PixelSums& sums, const GatherField* field,
                           const SampleCosts& costs);

struct SamplePlan {
  std::array<std::vector<std::uint32_t>, gathered_kinds> field;  // more, per point
  std::vector<std::uint32_t> camera;                             // in all, per pixel
  double cost = 0.0, field_cost = 0.0;  // of it, and of the field's part of it
  double squared_error = 0.0;           // expected after it
};

class SamplePlanner {
 public:
  // field: as above. All must outlive it, and stay as they are.
  SamplePlanner(const PixelSums& sums, const GatherField* field, const SampleCosts& costs);

  // Of the picture as it is: relative to its mean luminance, squared.
  [[nodiscard]] double squared_error() const {
    return whole_.reference_luminance > 0.0 ? whole_.squared_error() : 0.0;
  }
  [[nodiscard]] double confidence_factor() const { return whole_.confidence_factor; }
  // The cheapest that is expected to bring the squared error down to `wanted`, at no more than
  // most_cost.
  [[nodiscard]] SamplePlan plan(double wanted, double most_cost);

 private:
  // Of one point or pixel; no cost where more samples help nothing. Members have no initial values:
  // one thread would touch the memory of all first (base/parallel.h).
  struct Gain {
    std::uint32_t index;
    std::uint8_t kind;
    float samples;        // that it has
    float cost;           // of as many again
    float first, second;  // squared error that twice, four times as many take off
    float found;          // of what they promise, as much as the point or pixel itself has shown
    // Up to which price of a ray, in squared error, that many are cast.
    static constexpr float none = -1.0F;
    float price_of_two, price_of_four;
    void find_prices();
    [[nodiscard]] int factor(float per_cost) const {
      return per_cost <= price_of_four ? 4 : per_cost <= price_of_two ? 2 : 1;
    }
  };
  // At the gain of every point and pixel, once a plan is asked for: a picture that is exact enough
  // needs none.
  void find_gains();
  // Appends the gains of [0, count): fill(begin, end, gains) fills in those of each part.
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
  // Of those of `gains` that are worth that price.
  [[nodiscard]] Outcome outcome(std::span<const Gain> gains, double per_cost) const;

  const PixelSums& sums_;
  const GatherField* field_;
  SampleCosts costs_;
  StatedError stated_;
  ErrorSums whole_;
  bool has_gains_ = false;
  std::unique_ptr<Gain[]> gains_;
  std::size_t gain_count_ = 0;
};

}  // namespace earthshine::raytrace
