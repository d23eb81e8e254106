// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/surface_cuts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace earthshine::studies {
namespace {

using radiosity::Cut;

constexpr double thinnest = 4.0;  // a cell longer than this times its width is halved across
constexpr double undirected_share = 0.1;
constexpr double kept_by_halves = 0.5;  // of a patch's part: an edge of shadow crosses one of two
// Standard errors, above which it is no noise. Where one of n points alone is lit, the mean is one.
constexpr double clear = 0.9;

std::uint32_t other_side(const radiosity::Patches& patches, std::uint32_t patch) {
  const radiosity::Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.first_back == radiosity::no_patch) return radiosity::no_patch;
  return patches.is_back[patch] != 0 ? patch - facet.first_back + facet.first_front
                                     : patch - facet.first_front + facet.first_back;
}

}  // namespace

CutChoice::CutChoice(const radiosity::Patches& patches)
    : uneven_(patches.count()), patch_m2_(patches.area_m2) {
  area_m2_ = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
}

void CutChoice::see(const radiosity::Patches& patches, const SurfaceSamples& samples,
                    std::span<const std::uint32_t> which, std::span<const double> noise) {
  for (const std::uint32_t i : which) {
    const PatchResidual& r = samples.residual[i];
    Uneven& u = uneven_[i];
    u = {};
    if (r.taken == 0) continue;
    const double within = double(r.square) - (noise.empty() ? 0.0 : noise[i]);
    if (within <= clear * double(r.square_error)) continue;
    const double part = double(r.open) * patches.area_m2[i] / area_m2_;
    u = {part * within, part * double(r.along_s), part * double(r.along_t)};
  }
}

double CutChoice::total() const {
  double sum = 0.0;
  for (const Uneven& u : uneven_) sum += u.error;
  return sum;
}

std::vector<Cut> CutChoice::worst(const radiosity::Patches& patches, double enough, double most_of,
                                  std::size_t most) const {
  struct Choice {
    std::uint32_t patch;
    Cut cut;
    double error, urgency;
  };
  double left = total();
  if (left <= enough || patches.count() >= most) return {};
  std::vector<Choice> choices;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (patches.is_back[i] != 0) continue;
    Uneven sum = uneven_[i];
    const std::uint32_t back = other_side(patches, i);
    if (back != radiosity::no_patch) {
      sum.error += uneven_[back].error;
      sum.along_s += uneven_[back].along_s;
      sum.along_t += uneven_[back].along_t;
    }
    if (sum.error <= 0.0) continue;
    const bool s_can = radiosity::can_cut(patches, i, Cut::S),
               t_can = radiosity::can_cut(patches, i, Cut::T);
    if (!s_can && !t_can) continue;
    const radiosity::CellSize size = radiosity::cell_size(patches, i);
    Cut cut = s_can ? Cut::S : Cut::T;
    if (s_can && t_can) {
      const double s2 = size.s_m * size.s_m, t2 = size.t_m * size.t_m;
      const double by_shape = undirected_share * sum.error * (s2 - t2) / (s2 + t2);
      cut = sum.along_s - sum.along_t + by_shape >= 0.0 ? Cut::S : Cut::T;
      if (size.s_m > thinnest * size.t_m) cut = Cut::S;
      if (size.t_m > thinnest * size.s_m) cut = Cut::T;
    }
    choices.push_back({i, cut, sum.error, sum.error / (back != radiosity::no_patch ? 2.0 : 1.0)});
  }
  std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.patch < b.patch;
  });
  std::vector<Cut> wanted(patches.count(), Cut::None);
  std::size_t count = patches.count();
  bool any = false;
  const double all = left, last = all * (1.0 - (1.0 - kept_by_halves) * most_of);
  for (const Choice& choice : choices) {
    if (left <= std::max(enough, last) || count + 2 > most) break;
    wanted[choice.patch] = choice.cut;
    any = true;
    count += other_side(patches, choice.patch) != radiosity::no_patch ? 2 : 1;
    left -= (1.0 - kept_by_halves) * choice.error;
  }
  if (!any) return {};
  radiosity::grade(patches, wanted);
  return wanted;
}

std::vector<std::uint32_t> CutChoice::follow(const radiosity::Patches& patches,
                                             const std::vector<std::uint32_t>& parent) {
  std::vector<Uneven> inherited(parent.size());
  std::vector<std::uint32_t> fresh;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    if (patches.area_m2[i] < patch_m2_[parent[i]]) {
      fresh.push_back(i);
    } else {
      inherited[i] = uneven_[parent[i]];
    }
  }
  uneven_ = std::move(inherited);
  patch_m2_ = patches.area_m2;
  return fresh;
}

}  // namespace earthshine::studies
