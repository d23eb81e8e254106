// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/surface_cuts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace earthshine::studies {
namespace {

using radiosity::Cut;

constexpr double kept_by_halves = 0.5;  // of a patch's part: an edge of shadow crosses one of two
// Standard errors, above which it is no noise. Where one of n points alone is lit, the mean is one.
constexpr double clear = 0.9;
// Few points miss much of what is uneven: what was expected counts as one more.
constexpr double expected_points = 1.0;
constexpr float most_kept_rays = 0.5F;

}  // namespace

CutChoice::CutChoice(const radiosity::Patches& patches, double spot_m2)
    : spot_m2_(spot_m2),
      uneven_(patches.count()),
      patch_m2_(patches.area_m2),
      kept_rays_(patches.count(), most_kept_rays) {
  area_m2_ = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
}

void CutChoice::see(const radiosity::Patches& patches, const SurfaceSamples& samples,
                    std::span<const std::uint32_t> which, std::span<const double> noise) {
  for (const std::uint32_t i : which) {
    const PatchResidual& r = samples.residual[i];
    radiosity::Unevenness& u = uneven_[i];
    if (!noise.empty()) kept_rays_[i] = most_kept_rays;
    if (r.taken == 0 || patches.area_m2[i] <= spot_m2_) {
      u = {};
      continue;
    }
    const double own = r.taken / (r.taken + (is_expected_ ? expected_points : 0.0));
    u = {(1.0 - own) * u.error, 0.0, 0.0};
    const double within = double(r.square) - (noise.empty() ? double(r.mean_square) : noise[i]);
    if (within <= clear * double(r.square_error)) continue;
    const double part = own * double(r.open) * patches.area_m2[i] / area_m2_;
    // What is uneven is off a piece's light as noise would be.
    if (!noise.empty()) {
      kept_rays_[i] = std::min(most_kept_rays, static_cast<float>(noise[i] / (noise[i] + within)));
    }
    u = {u.error + part * within, part * double(r.along_s), part * double(r.along_t)};
  }
  is_expected_ = true;
}

double CutChoice::total() const {
  double sum = 0.0;
  for (const radiosity::Unevenness& u : uneven_) sum += u.error;
  return sum;
}

std::vector<Cut> CutChoice::worst(const radiosity::Patches& patches, double enough, double most_of,
                                  std::size_t most) const {
  double left = total();
  if (left <= enough || patches.count() >= most) return {};
  const std::vector<radiosity::CutCandidate> candidates = radiosity::worst_first(patches, uneven_);
  const double last = left * (1.0 - (1.0 - kept_by_halves) * most_of);
  std::size_t count = 0;
  for (; count < candidates.size() && left > std::max(enough, last); ++count) {
    left -= (1.0 - kept_by_halves) * candidates[count].error;
  }
  std::vector<Cut> wanted = radiosity::cuts_within(patches, candidates, count, most);
  const bool any =
      std::any_of(wanted.begin(), wanted.end(), [](Cut cut) { return cut != Cut::None; });
  return any ? wanted : std::vector<Cut>();
}

std::vector<std::uint32_t> CutChoice::follow(const radiosity::Patches& patches,
                                             const std::vector<std::uint32_t>& parent) {
  std::vector<radiosity::Unevenness> inherited(parent.size());
  std::vector<float> kept_rays(parent.size());
  std::vector<std::uint32_t> fresh;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    inherited[i] = uneven_[parent[i]];
    kept_rays[i] = kept_rays_[parent[i]];
    if (patches.area_m2[i] < patch_m2_[parent[i]]) {
      fresh.push_back(i);
      inherited[i] = {
          kept_by_halves * uneven_[parent[i]].error * patches.area_m2[i] / patch_m2_[parent[i]],
          0.0, 0.0};
      kept_rays[i] = most_kept_rays;
    }
  }
  uneven_ = std::move(inherited);
  kept_rays_ = std::move(kept_rays);
  patch_m2_ = patches.area_m2;
  return fresh;
}

}  // namespace earthshine::studies
