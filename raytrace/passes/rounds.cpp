// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes/rounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
double sure_share(double wanted) {
  return wanted > tuning::fine_error ? tuning::sure_share_of_coarse : tuning::sure_share_of_fine;
}

FirstLook first_look(double wanted, std::size_t points) {
  FirstLook first;
  if (wanted <= 0.0 || wanted > tuning::fine_error) {
    first.gather_rays /= 2, first.paths /= 2;
    first.every_second = first.paths * points / 2 >= tuning::least_paths;
  }
  const std::size_t each = tuning::least_paths / std::max<std::size_t>(1, points);
  first.paths = std::max(first.paths, std::bit_floor(static_cast<std::uint32_t>(each)));
  return first;
}

PixelSamples share_out(int rays_per_pixel, bool gathers) {
  const auto rays = std::bit_ceil(static_cast<std::uint32_t>(std::max(1, rays_per_pixel)));
  const int log2 = static_cast<int>(std::bit_width(rays)) - 1;
  const int samples = 1 << std::min((log2 + 1) / 2, 6);
  return {samples, gathers ? static_cast<int>(rays) / samples : 0};
}

std::optional<SamplePlan> Rounds::next(SamplePlanner& planner, double so_far, double affordable) {
  const bool first = looks_.empty();
  const double now = planner.squared_error(), error = std::sqrt(now), doubt = planner.doubt();
  const double aimed = squared_aim(doubt);
  looks_.push_back({so_far, error, doubt});
  if (wanted_ > 0.0 && doubt * error <= (first ? 1.0 : sure_share(wanted_)) * wanted_) return {};
  if (wanted_ > 0.0 && is_hopeless(looks_)) {
    gave_up_ = true;
    return {};
  }
  // Step by step: what few samples say of more of them is rough.
  const double step = std::max(aimed, now / tuning::most_step);
  // No more than samples that are spread as so far would take.
  const double most =
      std::min(affordable, std::max(tuning::least_step, now / aimed - 1.0) * so_far);
  SamplePlan plan = planner.plan(step, most);
  // A few points that turned out bad cost next to nothing: what is worst beside them goes along.
  const double fewest = std::min(most, tuning::least_step * so_far);
  if (plan.cost < 0.5 * fewest) plan = planner.plan(aimed, fewest);
  // A single point's next step may be larger than that.
  if (plan.cost <= 0.0) plan = planner.plan(aimed, affordable);
  if (plan.cost <= 0.0) return {};
  return plan;
}

double Rounds::growth() const {
  const Look last = looks_.empty() ? Look() : looks_.back();
  return last.error * last.error / std::max(squared_aim(last.doubt), 1e-12);
}

double Rounds::growth(SamplePlanner& planner, double so_far) const {
  const double now = planner.squared_error(), aimed = squared_aim(planner.doubt());
  if (now <= aimed || so_far <= 0.0) return 1.0;
  const SamplePlan plan = planner.plan(aimed, std::numeric_limits<double>::infinity());
  // A plan gives a point four times its samples at most: beyond, as the square of the error.
  return (1.0 + plan.cost / so_far) * std::max(1.0, plan.squared_error / aimed);
}

bool Rounds::is_hopeless(const std::vector<Look>& looks) {
  const auto before = std::find_if(looks.rbegin(), looks.rend(), [&](const Look& look) {
    return look.cost <= looks.back().cost / tuning::hopeless_growth;
  });
  return before != looks.rend() && looks.back().error > tuning::hopeless_share * before->error;
}

}  // namespace earthshine::raytrace
