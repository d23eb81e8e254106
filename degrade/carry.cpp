// SPDX-License-Identifier: Apache-2.0
#include "degrade/carry.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "degrade/moments/point_moments.h"

namespace earthshine::degrade {
namespace {

// Applies `of` to every value of the plane.
template <class F>
Plane map_plane(const Plane& in, F of) {
  Plane out(in.size());
  base::parallel_chunks(in.size(), 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      out[i] = static_cast<float>(of(static_cast<double>(in[i])));
    }
  });
  return out;
}

Covariance white_of(const Moments& m, Plane variance) {
  return white(m.mean.columns, m.mean.rows, std::move(variance));
}

void add_white(Moments& m, std::vector<Covariance>& to, std::size_t plane, double variance) {
  if (!(variance > 0.0)) return;
  Plane level(m.mean.pixel_count(), static_cast<float>(variance));
  to[plane] = plus(std::move(to[plane]), white_of(m, std::move(level)));
}

}  // namespace

Moments still(Picture picture) {
  Moments m;
  const Plane none(picture.pixel_count());
  m.grain.assign(picture.planes.size(), white(picture.columns, picture.rows, none));
  m.pattern = m.grain;
  m.mean = std::move(picture);
  return m;
}

Plane variance(const Moments& m, std::size_t plane) {
  Plane sum = m.grain[plane].variance();
  const Plane& pattern = m.pattern[plane].variance();
  std::transform(sum.begin(), sum.end(), pattern.begin(), sum.begin(), std::plus<>());
  return sum;
}

Moments settled(Moments m) {
  if (!m.is_pending) return m;
  for (std::size_t p = 0; p < m.mean.planes.size(); ++p) {
    MomentPlanes after = through(m.pending, m.mean.planes[p], variance(m, p));
    const Covariance all = mapped(plus(m.grain[p], m.pattern[p]), after);
    // The part that two frames share is the pattern; the rest is the grain.
    m.pattern[p] = shared(m.pattern[p], after);
    m.grain[p] = plus(all, times(m.pattern[p], -1.0));
    m.mean.planes[p] = std::move(after.mean);
  }
  m.pending = PointMap();
  m.is_pending = false;
  return m;
}

Moments carry(Moments m, const Stage& stage, const StageContext& at) {
  if (stage.carry != nullptr) return stage.carry(std::move(m), at);
  if (stage.law.points != nullptr) {
    stage.law.points(m.pending, at);
    m.is_pending = true;
  } else if (stage.law.filter != nullptr) {
    m = settled(std::move(m));
    const PlaneMap map = stage.law.filter(m.mean, at);
    m.mean = apply(m.mean, map.along, map.across);
    for (Covariance& noise : m.grain) noise = filtered(noise, map.along, map.across);
    for (Covariance& noise : m.pattern) noise = filtered(noise, map.along, map.across);
  } else if (!m.is_pending) {
    m.mean = stage.law.picture(std::move(m.mean), at);
  }
  return m;
}

Moments carry_signal_noise(Moments m, const StageContext& at) {
  const NoiseLaw& law = at.report.noise;
  for (std::size_t p = 0; p < m.mean.planes.size(); ++p) {
    const double c_grain = law.c_is_fixed_pattern ? 0.0 : law.c;
    Plane grain = map_plane(m.mean.planes[p], [&](double s) {
      return law.dark + (law.b + c_grain * s) * std::max(s, 0.0);
    });
    m.grain[p] = plus(std::move(m.grain[p]), white_of(m, std::move(grain)));
    if (!law.c_is_fixed_pattern || !(law.c > 0.0)) continue;
    Plane pattern = map_plane(m.mean.planes[p], [&](double s) { return law.c * s * s; });
    m.pattern[p] = plus(std::move(m.pattern[p]), white_of(m, std::move(pattern)));
  }
  return m;
}

Moments carry_lag(Moments m, const StageContext& at) {
  const double lag = lag_of(at);
  for (Covariance& noise : m.grain) {
    noise = times(std::move(noise), (1.0 - lag) / (1.0 + lag));
  }
  return m;
}

Moments carry_bloom(Moments m, const StageContext& at) {
  const CctvCamera& camera = at.setup.camera;
  // Mean excess above saturation: S - min(S, S_most).
  Picture excess = m.mean;
  Moments cut = carry_saturation(std::move(m), at);
  for (std::size_t p = 0; p < excess.planes.size(); ++p) {
    std::transform(excess.planes[p].begin(), excess.planes[p].end(), cut.mean.planes[p].begin(),
                   excess.planes[p].begin(), [&](float all, float kept) {
                     return static_cast<float>(camera.bloom) * std::max(all - kept, 0.0F);
                   });
  }
  const Picture halo = apply(excess, gaussian_blur(excess.columns, camera.bloom_radius),
                             gaussian_blur(excess.rows, camera.bloom_radius));
  for (std::size_t p = 0; p < halo.planes.size(); ++p) {
    Plane& mean = cut.mean.planes[p];
    std::transform(mean.begin(), mean.end(), halo.planes[p].begin(), mean.begin(), std::plus<>());
  }
  return cut;
}

Moments carry_saturation(Moments m, const StageContext& at) {
  m.pending.limit_above(at.setup.camera.saturation);
  m.is_pending = true;
  return settled(std::move(m));
}

Moments carry_read_noise(Moments m, const StageContext& at) {
  m = settled(std::move(m));
  for (std::size_t p = 0; p < m.mean.planes.size(); ++p) {
    add_white(m, m.grain, p, at.report.noise.a);
    add_white(m, m.pattern, p, at.report.noise.black_pattern);
  }
  return m;
}

Moments carry_interlace(Moments m, const StageContext& at) {
  // Both fields have the same moments; a pending map is the same for all rows.
  for (Covariance& noise : m.grain) noise = weave(std::move(noise), at.setup.camera.lag);
  return m;
}

Moments carry_spread(Moments m, const StageContext& at) {
  const Monitor& monitor = at.setup.monitor;
  m = settled(std::move(m));
  const auto map = [&](int resels) {
    return spread_map(monitor.spread, monitor.spread_width, resels, monitor.pixels_per_resel);
  };
  const AxisMap along = map(m.mean.columns), across = map(m.mean.rows);
  m.mean = apply(m.mean, along, across);
  const auto spread = [&](const Covariance& noise) {
    return white(along.out(), across.out(), variance_after(noise, along, across));
  };
  for (Covariance& noise : m.grain) noise = spread(noise);
  for (Covariance& noise : m.pattern) noise = spread(noise);
  return m;
}

Moments carry_room_light(Moments m, const StageContext& at) {
  m = settled(std::move(m));
  m.mean = add_light(std::move(m.mean), room_luminance(at.setup.monitor));
  return m;
}

}  // namespace earthshine::degrade
