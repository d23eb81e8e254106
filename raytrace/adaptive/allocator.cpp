// SPDX-License-Identifier: Apache-2.0
#include "raytrace/adaptive/allocator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
double stop_fraction(double wanted) {
  return wanted > tuning::fine_error ? tuning::stop_fraction_of_coarse
                                     : tuning::stop_fraction_of_fine;
}

Allocator Allocator::fixed(int gather_rays, int camera_samples) {
  Allocator allocator(0.0);
  const auto rays = static_cast<std::uint32_t>(gather_rays);
  const std::uint32_t fewest = GatherField::fewest_samples(Gathered::Solution);
  allocator.fixed_ = {std::max(rays, fewest), rays / 2,      rays / 2, false,
                      camera_samples,         camera_samples};
  return allocator;
}

InitialSampling Allocator::initial(std::size_t points) const {
  if (fixed_) return *fixed_;
  InitialSampling initial;
  if (wanted_ <= 0.0 || wanted_ > tuning::fine_error) {
    initial.gather_rays /= 2, initial.paths /= 2;
    initial.every_second = initial.paths * points / 2 >= tuning::least_paths;
  }
  const std::size_t each = tuning::least_paths / std::max<std::size_t>(1, points);
  initial.paths = std::max(initial.paths, std::bit_floor(static_cast<std::uint32_t>(each)));
  return initial;
}

std::optional<SamplePlan> Allocator::next(SamplePlanner& planner, double so_far,
                                          double affordable) {
  if (fixed_) return {};
  const bool first = statements_.empty();
  const double now = planner.squared_error(), error = std::sqrt(now),
               factor = planner.confidence_factor();
  const double aimed = squared_aim(factor);
  statements_.push_back({so_far, error, factor});
  if (wanted_ > 0.0 && factor * error <= (first ? 1.0 : stop_fraction(wanted_)) * wanted_)
    return {};
  if (wanted_ > 0.0 && is_hopeless(statements_)) {
    gave_up_ = true;
    return {};
  }
  // Small steps, because predictions from few samples are rough.
  const double step = std::max(aimed, now / tuning::most_step);
  // At most the cost by the law error^2 ~ 1/samples with the current distribution.
  const double most =
      std::min(affordable, std::max(tuning::least_step, now / aimed - 1.0) * so_far);
  SamplePlan plan = planner.plan(step, most);
  // A plan for a few noisy points costs next to nothing: add the next worst ones up to `fewest`.
  const double fewest = std::min(most, tuning::least_step * so_far);
  if (plan.cost < 0.5 * fewest) plan = planner.plan(aimed, fewest);
  // The next step of a single point may cost more.
  if (plan.cost <= 0.0) plan = planner.plan(aimed, affordable);
  if (plan.cost <= 0.0) return {};
  return plan;
}

// A plan at most quadruples a point's samples; beyond, samples grow as the squared error falls.
double Allocator::predicted_cost(const SamplePlanner& planner, const SamplePlan& plan,
                                 double so_far) const {
  if (wanted_ <= 0.0) return so_far + plan.cost;
  const double aimed = squared_aim(planner.confidence_factor());
  return (so_far + plan.cost) * std::max(1.0, plan.squared_error / aimed);
}

double Allocator::growth(SamplePlanner& planner, double so_far) const {
  const double now = planner.squared_error(), aimed = squared_aim(planner.confidence_factor());
  if (now <= aimed || so_far <= 0.0) return 1.0;
  const SamplePlan plan = planner.plan(aimed, std::numeric_limits<double>::infinity());
  return predicted_cost(planner, plan, so_far) / so_far;
}

bool Allocator::is_hopeless(const std::vector<Statement>& statements) {
  const auto before =
      std::find_if(statements.rbegin(), statements.rend(), [&](const Statement& earlier) {
        return earlier.cost <= statements.back().cost / tuning::hopeless_growth;
      });
  return before != statements.rend() &&
         statements.back().error > tuning::hopeless_share * before->error;
}

}  // namespace earthshine::raytrace
