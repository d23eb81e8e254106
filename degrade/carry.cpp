// SPDX-License-Identifier: Apache-2.0
#include "degrade/carry.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "degrade/moments/point_moments.h"
#include "degrade/parts/electronics.h"
#include "degrade/parts/sensor.h"

namespace earthshine::degrade {
namespace {

// of(value) for every pixel of the plane.
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

Moments filter(Moments m, const AxisMap& along, const AxisMap& across) {
  m = settled(std::move(m));
  m.mean = apply(m.mean, along, across);
  for (Covariance& noise : m.grain) noise = filtered(noise, along, across);
  for (Covariance& noise : m.pattern) noise = filtered(noise, along, across);
  return m;
}

template <class Step>
Moments point(Moments m, Step step) {
  step(m.pending);
  m.is_pending = true;
  return m;
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
    // What two frames share; the rest differs from frame to frame.
    m.pattern[p] = shared(m.pattern[p], after);
    m.grain[p] = plus(all, times(m.pattern[p], -1.0));
    m.mean.planes[p] = std::move(after.mean);
  }
  m.pending = PointMap();
  m.is_pending = false;
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

Moments carry_blur(Moments m, const StageContext& at) {
  const AxisMap along = gaussian_blur(m.mean.columns, at.setup.camera.blur_h),
                across = gaussian_blur(m.mean.rows, at.setup.camera.blur_v);
  return filter(std::move(m), along, across);
}

Moments carry_bloom(Moments m, const StageContext& at) {
  const CctvCamera& camera = at.setup.camera;
  // Mean of what lies above: S - min(S, S_most).
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
  return settled(
      point(std::move(m), [&](PointMap& map) { map.limit_above(at.setup.camera.saturation); }));
}

Moments carry_read_noise(Moments m, const StageContext& at) {
  m = settled(std::move(m));
  for (std::size_t p = 0; p < m.mean.planes.size(); ++p) {
    add_white(m, m.grain, p, at.report.noise.a);
    add_white(m, m.pattern, p, at.report.noise.black_pattern);
  }
  return m;
}

Moments carry_bandwidth(Moments m, const StageContext& at) {
  const CctvCamera& camera = at.setup.camera;
  const AxisMap along = line_filter(m.mean.columns, camera.bandwidth_mhz,
                                    camera.aperture_correction, at.setup.monitor.columns),
                across = gaussian_blur(m.mean.rows, 0.0);
  return filter(std::move(m), along, across);
}

Moments carry_black_clamp(Moments m, const StageContext&) {
  return point(std::move(m), [](PointMap& map) { map.limit_below(0.0); });
}

Moments carry_gain(Moments m, const StageContext& at) {
  return point(std::move(m), [&](PointMap& map) { map.amplify(at.report.exposure.gain); });
}

Moments carry_white_clip(Moments m, const StageContext& at) {
  return point(std::move(m), [&](PointMap& map) { map.limit_above(at.setup.camera.white_clip); });
}

Moments carry_camera_gamma(Moments m, const StageContext& at) {
  return point(std::move(m), [&](PointMap& map) { map.power(1.0 / at.setup.camera.gamma); });
}

Moments carry_quantisation(Moments m, const StageContext& at) {
  return point(std::move(m), [&](PointMap& map) { map.quantise(at.setup.camera.bits); });
}

Moments carry_interlace(Moments m, const StageContext& at) {
  // Both fields have the same moments; a pending map is the same for all rows.
  for (Covariance& noise : m.grain) noise = weave(std::move(noise), at.setup.camera.lag);
  return m;
}

Moments carry_screen(Moments m, const StageContext& at) {
  const Monitor& monitor = at.setup.monitor;
  return point(std::move(m), [&](PointMap& map) {
    map.screen(monitor.black_luminance, monitor.white_luminance, monitor.gamma);
  });
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
