// SPDX-License-Identifier: Apache-2.0
// Turns LightOnSurfaces into a solution.
#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/broadcast_solution.h"
#include "raytrace/surfaces/surface_light.h"

namespace earthshine::raytrace {
namespace {

constexpr double unexplained = 6.0;  // standard errors

}  // namespace

// Scales the indirect light so that energy is conserved: B = M + rho (E0 + k I), with one k per
// column that solves
//   sum A ((a - rho) k I + B (escape + lost)) = sum A (M + rho E0).
// A defect of the samples in this sum is noise. Without balanced rows, k is unknown and not
// applied. Returns the change of the mean radiosity by k, relative, in luminance.
double LightOnSurfaces::close_energy(radiosity::PatchLight& found) const {
  constexpr double most = 0.2;  // difference of k from 1
  const std::size_t columns = light_.columns();
  std::vector<double> lit(columns, 0.0), ended(columns, 0.0);
  const auto reflected = [&](std::size_t at) {
    return found.reflectance[at / columns * 3 + at % 3];
  };
  const auto known = [&](std::size_t at) {
    return found.emitted[at] + reflected(at) * found.direct[at];
  };
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const double area = light_.open_m2(i);
    const double gone = escape_[i] + lost_[i], kept = factors_.kept[coarse_[i]];
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t at = i * columns + k;
      const double rho = reflected(at);
      lit[k] += area * known(at) * (1.0 - gone);
      ended[k] += area * found.indirect[at] * (kept - rho + rho * gone);
    }
  }
  found.radiosity.resize(found.direct.size());
  const bool balanced = light_.solution.report.balance.balanced;
  Rgb added(0.0), all(0.0);
  for (std::size_t at = 0; at < found.radiosity.size(); ++at) {
    const std::size_t k = at % columns;
    const double scale = ended[k] > 0.0 ? lit[k] / ended[k] : 1.0;
    const double area = light_.open_m2(at / columns);
    const double flux = area * reflected(at) * found.indirect[at];
    added[static_cast<int>(k % 3)] += flux * (scale - 1.0);
    all[static_cast<int>(k % 3)] += flux * scale + area * known(at);
    if (balanced && std::abs(scale - 1.0) < most) found.indirect[at] *= scale;
    found.radiosity[at] = known(at) + reflected(at) * found.indirect[at];
  }
  const double mean = base::luminance(all);
  return balanced && mean > 0.0 ? std::abs(base::luminance(added)) / mean : 0.0;
}

// Scales the direct light of each group of lamps and sampled emitters to their flux. If no ray of
// the sources escaped or met a black back, all light lands, in each channel. Otherwise the samples,
// far more than the sources' rays, give the landed flux, limited to the emitted flux; the rest
// escapes. A difference beyond the noise of the rays remains in the ledger. Returns the flux that
// the samples added or lost, relative to all flux, in luminance.
double LightOnSurfaces::close_flux(radiosity::PatchLight& found,
                                   std::vector<radiosity::SourceFlux>& sources) const {
  const std::size_t columns = light_.columns(), groups = columns / 3;
  std::vector<Rgb> landed(groups, Rgb(0.0)), flux(groups, Rgb(0.0)), before(groups, Rgb(0.0)),
      expected(groups, Rgb(0.0)), scale(groups, Rgb(1.0));
  std::vector<double> variance(groups, 0.0);
  for (const radiosity::SourceFlux& source : sources) {
    flux[source.group] += source.emitted_lm;
    before[source.group] += source.landed_lm;
    expected[source.group] += source.expected_lm();
    variance[source.group] += std::pow(source.expected_error_lm(), 2);
  }
  Rgb all(0.0);
  for (std::size_t i = 0; i < light_.count(); ++i) {
    const Rgb ends = factors_.kept_direct.empty() ? Rgb(1.0) : factors_.kept_direct[coarse_[i]];
    for (std::size_t k = 0; k < columns; ++k) {
      const auto c = static_cast<int>(k % 3);
      const double area = light_.open_m2(i);
      landed[k / 3][c] += area * ends[c] * found.direct[i * columns + k];
      all[c] += area * (found.emitted[i * columns + k] + found.direct[i * columns + k]);
    }
  }
  const std::vector<bool> is_sky = radiosity::sky_groups(scene_);
  double off = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    const double given = base::luminance(flux[g]), lands = base::luminance(landed[g]);
    if (is_sky[g] || given <= 0.0) continue;
    const double apart = std::abs(lands - base::luminance(expected[g]));
    const bool closed = base::luminance(flux[g] - expected[g]) <= 0.0;
    if (closed || apart > unexplained * std::sqrt(variance[g])) off += apart;
    if (lands <= 0.0) continue;
    for (int c = 0; c < 3; ++c) {
      if (closed && landed[g][c] > 0.0) scale[g][c] = flux[g][c] / landed[g][c];
      if (!closed) scale[g][c] = std::min(1.0, given / lands);
    }
  }
  for (std::size_t at = 0; at < found.direct.size(); ++at) {
    found.direct[at] *= scale[at % columns / 3][static_cast<int>(at % 3)];
  }
  for (radiosity::SourceFlux& source : sources) {
    const std::size_t g = source.group;
    if (is_sky[g]) continue;
    for (int c = 0; c < 3; ++c) {
      source.landed_lm[c] = before[g][c] > 0.0
                                ? source.landed_lm[c] * (scale[g][c] * landed[g][c] / before[g][c])
                                : scale[g][c] * landed[g][c] * source.emitted_lm[c] /
                                      std::max(flux[g][c], std::numeric_limits<double>::min());
    }
  }
  const double in_all = base::luminance(all);
  return in_all > 0.0 ? off / in_all : off > 0.0 ? 1.0 : 0.0;
}

LightOnSurfaces::Finished LightOnSurfaces::finished() const {
  Finished finished;
  radiosity::Solution& solution = finished.solution;
  solution.patches = patches();
  solution.columns = light_.columns();
  solution.report = light_.solution.report;
  solution.report.patches = light_.count();
  if (factors_.shares.is_root()) finished.ledger_defect = fill(solution);
  factors_.shares.broadcast(&finished.ledger_defect, 1);
  radiosity::broadcast_solution(factors_.shares, solution);
  return finished;
}

double LightOnSurfaces::fill(radiosity::Solution& solution) const {
  const std::size_t columns = light_.columns(), count = light_.count();
  const std::size_t parts = count > 0 ? light_.sky.size() / count : 0;
  radiosity::PatchLight found;
  found.reflectance = radiosity::reflectances(scene_.scene, patches(), {0, count});
  found.emitted = radiosity::exitances(scene_.scene, scene_.groups, patches(), {0, count});
  found.direct.assign(light_.lamps.begin(), light_.lamps.end());
  found.indirect.assign(light_.gathered.begin(), light_.gathered.end());
  const double made = close_flux(found, solution.report.sources);
  for (std::size_t i = 0; i < count * parts; ++i) {
    const std::size_t at = (i / parts) * columns + 3 * (scene_.groups.earth + i % parts);
    for (std::size_t c = 0; c < 3; ++c) {
      found.direct[at + c] += light_.sky[i][static_cast<int>(c)];
      found.indirect[at + c] =
          std::max(0.0, found.indirect[at + c] - light_.sky[i][static_cast<int>(c)]);
    }
  }
  const double ledger_defect = std::hypot(made, close_energy(found));
  found.sky = light_.sky;
  radiosity::FormFactors ends;  // where light ends; patches have the values of their coarse patch
  ends.sky.assign(count, 0.0);  // sets the number of rows; entries are not read
  for (const std::uint32_t j : coarse_) {
    ends.kept.push_back(factors_.kept[j]);
    if (!factors_.kept_direct.empty()) ends.kept_direct.push_back(factors_.kept_direct[j]);
  }
  ends.escape = escape_;
  ends.lost = lost_;
  ends.open = {light_.open_share, factors_.open.bodies};
  std::vector<double> backs;
  for (const auto& object : solution.report.objects) backs.push_back(object.back_share);
  radiosity::fill_solution(scene_, ends, solution.report.balance.balanced, std::move(found),
                           solution);
  for (std::size_t o = 0; o < backs.size(); ++o) solution.report.objects[o].back_share = backs[o];
  return ledger_defect;
}

}  // namespace earthshine::raytrace
