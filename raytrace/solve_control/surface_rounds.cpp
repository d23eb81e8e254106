// SPDX-License-Identifier: Apache-2.0
#include "raytrace/solve_control/surface_rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "raytrace/surfaces/residual_error.h"

namespace earthshine::raytrace {
namespace {

constexpr int most_rounds = 24;
// The remaining unevenness must fall to this share within gain_rounds; otherwise it is noise.
constexpr double least_gain = 0.8;
constexpr int gain_rounds = 4;
constexpr double fewest_fresh = 1e-3;  // new patches of a round, over all patches, that justify
                                       // another round
// A round divides the patches with this share of the unevenness. Shadow rays measure it accurately;
// with cosine rays, the largest values are partly due to chance.
constexpr double shadow_cuts = 0.5, gather_cuts = 0.8;
constexpr double shadow_share = 0.4, gather_share = 0.7;  // of a time limit
// Growth of the number of patches per call: estimates from few points need new samples before
// further divisions.
constexpr double most_gather_growth = 1.5, most_shadow_growth = 2.0;
// With few patches, sampling them again is cheap.
constexpr double few_patches = 1 << 16, few_growth = 8.0;
constexpr std::size_t first_shadow_cut = 3 << 15;
// Over all surfaces.
constexpr double first_shadow_points = 1 << 17, most_shadow_points = 1 << 18;

}  // namespace

SurfaceRounds::SurfaceRounds(const scenes::World& scene, const Wanted& wanted, std::uint64_t seed,
                             LightOnSurfaces& light, std::size_t most,
                             const StageListener& progress)
    : wanted_(wanted),
      sampler_(scene, seed),
      light_(light),
      first_(light.patches().count()),
      most_(most),
      progress_(progress),
      shadow_points_(first_shadow_points) {}

double SurfaceRounds::time_gone() const {
  return wanted_.seconds > 0.0 && wanted_.now ? wanted_.now() / wanted_.seconds : 0.0;
}

SurfaceSamples SurfaceRounds::sample(std::span<const std::uint32_t> which,
                                     std::span<const SampleBudget> budget, const std::string& name,
                                     SamplesOf of) {
  // If a stop interrupts this, nothing has changed yet.
  const base::StopInForce stop(wanted_.stop);
  SurfaceSamples samples =
      sampler_.sample(light_.light(), which, budget, ++pass_, mean_, light_.bodies(),
                      progress_ ? progress_(name) : Progress(), of, light_.shares().receivers());
  rays_ += samples.rays;
  return samples;
}

std::vector<radiosity::Cut> SurfaceRounds::worst(const SurfaceRefiner& choice, const How& how) {
  std::vector<radiosity::Cut> cuts;
  if (is_root()) {
    cuts = choice.worst(light_.patches(),
                        {how.enough, how.share, std::min(most_, std::max(first_, how.limit))});
  }
  light_.shares().broadcast([&](base::Parcel& parcel) { parcel.pass(cuts); });
  return cuts;
}

void SurfaceRounds::update(SurfaceRefiner& choice, std::span<const std::uint32_t> which,
                           const How& how) {
  std::vector<SampleBudget> budget;
  if (is_root()) budget = how.budget(which);
  light_.shares().broadcast([&](base::Parcel& parcel) { parcel.pass(budget); });
  const std::string stage = fmt::format("{}, {} patches", how.name, light_.patches().count());
  const SurfaceSamples samples = sample(which, budget, stage, SamplesOf::Light);
  if (is_root()) {
    std::vector<double> noise;
    if (budget.front().rays > 0) {
      noise =
          noise_of(light_, ray_variance(light_.patches(), samples, which, budget), samples).all();
    }
    choice.see(light_.patches(), samples, which, noise);
  }
  light_.correct(samples, which, budget);
}

bool SurfaceRounds::cut(SurfaceRefiner& choice, const How& how, std::vector<std::uint32_t>& parent,
                        SurfaceRefiner* also) {
  const std::size_t before = light_.patches().count();
  const auto left_on_all_ranks = [&] {
    double left = is_root() ? choice.total() : 0.0;
    light_.shares().broadcast(&left, 1);
    return left;
  };
  double last_left = left_on_all_ranks();
  for (int k = 0; k < most_rounds && time_gone() <= how.until; ++k) {
    if (k > 0 && k % gain_rounds == 0) {
      const double left = left_on_all_ranks();
      if (left > least_gain * last_left) break;
      last_left = left;
    }
    const std::vector<radiosity::Cut> cuts = worst(choice, how);
    if (cuts.empty()) break;
    std::vector<std::uint32_t> of = light_.cut(cuts, choice.kept_rays());
    const std::vector<std::uint32_t> fresh = choice.follow(light_.patches(), of);
    if (also != nullptr) also->follow(light_.patches(), of);
    for (std::uint32_t& i : of) i = parent[i];
    parent = std::move(of);
    if (fresh.empty()) break;
    update(choice, fresh, how);
    if (static_cast<double>(fresh.size()) < fewest_fresh * double(light_.patches().count())) break;
  }
  return light_.patches().count() > before;
}

bool SurfaceRounds::cut_gathered(SurfaceRefiner& choice, double enough, double points,
                                 std::vector<std::uint32_t>& parent) {
  const auto count = static_cast<double>(light_.patches().count());
  const double limit =
      std::max(most_gather_growth * count, std::min(few_growth * count, few_patches));
  const How how{enough,
                gather_cuts,
                static_cast<std::size_t>(limit),
                gather_share,
                [&](std::span<const std::uint32_t> which) {
                  return budget_where_uneven(light_.patches(), which, choice, points);
                },
                "uneven light"};
  return cut(choice, how, parent, nullptr);
}

SurfaceRounds::How SurfaceRounds::for_shadows(double enough) const {
  const auto limit =
      static_cast<std::size_t>(most_shadow_growth * static_cast<double>(light_.patches().count()));
  return {enough,
          shadow_cuts,
          std::max(first_shadow_cut, limit),
          shadow_share,
          [&](std::span<const std::uint32_t> which) {
            return shadow_budget(light_.patches(), which, shadow_points_);
          },
          "shadows"};
}

void SurfaceRounds::find_light() {
  std::vector<std::uint32_t> all(light_.patches().count());
  std::iota(all.begin(), all.end(), 0U);
  SurfaceRefiner choice(light_.patches(), light_.light().spot_m2);
  update(choice, all, for_shadows(0.0));
  mean_ = light_.mean_on_all_ranks();
}

bool SurfaceRounds::cut_shadows(double enough, std::vector<std::uint32_t>& parent,
                                SurfaceRefiner* also) {
  if (shadow_points_ <= 0.0 || time_gone() > shadow_share) return false;
  std::vector<std::uint32_t> large;  // spots are not divided
  for (std::uint32_t i = 0; i < light_.patches().count(); ++i) {
    if (!light_.is_spot(i)) large.push_back(i);
  }
  if (large.empty()) return false;
  SurfaceRefiner choice(light_.patches(), light_.light().spot_m2);
  const How how = for_shadows(enough);
  update(choice, large, how);
  const bool is_cut = cut(choice, how, parent, also);
  shadow_points_ = is_cut ? std::min(2.0 * shadow_points_, most_shadow_points) : 0.0;
  return is_cut;
}

}  // namespace earthshine::raytrace
