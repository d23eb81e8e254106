// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/target_signal.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "degrade/certify/slanted_edge.h"
#include "degrade/moments/point_moments.h"
#include "degrade/parts/transfer_law.h"
#include "degrade/twin.h"

namespace earthshine::studies {
namespace {

// A union of sets of resels.
class ReselUnion {
 public:
  explicit ReselUnion(std::size_t count) : has_(count, 0) {}
  void add(const WeightedResels& set) {
    for (const std::uint32_t resel : set.resel) has_[resel] = 1;
  }
  [[nodiscard]] std::vector<std::uint32_t> ascending() const {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < has_.size(); ++i) {
      if (has_[i] != 0) all.push_back(static_cast<std::uint32_t>(i));
    }
    return all;
  }

 private:
  std::vector<std::uint8_t> has_;
};

std::shared_ptr<const TargetResels> resels_of(const SightPlan& plan, const SightTarget& target,
                                              degrade::PlaneMap spread) {
  const int columns = spread.along.out(), rows = spread.across.out();
  const auto weigh_here = [&](const std::vector<std::uint32_t>& pixels) {
    return weigh(pixels, plan.map.columns, plan.map.rows, columns, rows);
  };
  auto at = std::make_shared<TargetResels>();
  at->measured = weigh_here(target.view.measured);
  at->seen = weigh_here(target.seen);
  at->surround = weigh_here(target.view.surround);
  at->measured_screen = screen_sources(spread, at->measured);
  at->surround_screen = screen_sources(spread, at->surround);
  for (const SightTarget::Part& part : target.parts) {
    at->parts.push_back({weigh_here(part.target), weigh_here(part.surround), part.share});
  }
  at->spread = std::move(spread);
  return at;
}

double mean_of(const std::vector<float>& values, const WeightedResels& set) {
  double sum = 0.0;
  for (std::size_t i = 0; i < set.resel.size(); ++i) {
    sum += set.weight[i] * static_cast<double>(values[set.resel[i]]);
  }
  return sum;
}

double over(double signal, double variance) {
  if (signal == 0.0) return 0.0;
  const double sigma = std::sqrt(std::max(variance, 0.0));
  return sigma * degrade::most_snr > std::abs(signal) ? signal / sigma
                                                      : std::copysign(degrade::most_snr, signal);
}

// Sum over the target of (v - b)^2 / variance, with the number of independent samples of its mean.
double ideal_observer(const ShownMoments& moments, const WeightedResels& seen, double surround,
                      double variance_of_mean) {
  double sum = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < seen.resel.size(); ++i) {
    const double v = static_cast<double>(moments.variance_in_time[seen.resel[i]]);
    const double delta = static_cast<double>(moments.mean[seen.resel[i]]) - surround;
    variance += seen.weight[i] * v;
    if (delta == 0.0) continue;
    if (!(v > 0.0)) return degrade::most_snr;
    sum += seen.weight[i] * delta * delta / v;
  }
  if (sum == 0.0) return 0.0;
  return std::min(degrade::most_snr, std::sqrt(sum * variance / variance_of_mean));
}

// A difference of two float means below this share of them is a rounding error.
constexpr double rounding = 1e-6;
double difference(double a, double b) {
  const double d = std::abs(a - b);
  return d <= rounding * (std::abs(a) + std::abs(b)) ? 0.0 : d;
}

// Root mean square over the target's parts; `whole` for a target of one part.
double difference_of_parts(const TargetResels& at, const std::vector<float>& values, double whole) {
  if (at.parts.empty()) return whole;
  double sum = 0.0;
  for (const TargetResels::Part& part : at.parts) {
    const double d = difference(mean_of(values, part.target), mean_of(values, part.surround));
    sum += part.share * d * d;
  }
  return std::sqrt(sum);
}

std::optional<double> weber_of(double target, double surround) {
  if (!(surround > 0.0)) return std::nullopt;
  return (target - surround) / surround;
}

// Replaces infinity for upper bounds of a zero difference.
constexpr double most_factor = 1e6;

// Data for the least visible modulation.
struct Needed {
  double delta = 0.0;       // of the line signal
  double of_target = 0.0;   // } variances in the eye's time: of the target's mean
  double of_resel = 0.0;    // } and of a resel
  double of_the_eye = 1.0;  // threshold over the difference, on the screen
  double lines = 0.0;       // across the target
};

// C0 MTF(u) = 3 / SNR, with the SNR of one bar, but at least the SNR of a resel. A bar is half a
// period wide and as long as the target, so that it has 1 / (2 u lines) of its resels.
double least_modulation(const Needed& needed, double frequency) {
  const double bars = std::max(1.0, 2.0 * frequency * needed.lines);
  const double variance = std::min(needed.of_resel, needed.of_target * bars);
  return std::max(3.0 * std::sqrt(std::max(variance, 0.0)) / needed.delta, needed.of_the_eye);
}

double limiting_frequency(const degrade::Setup& setup, const Trail& trail, double direction,
                          const Needed& needed) {
  if (!(needed.delta > 0.0) || least_modulation(needed, 0.0) >= 1.0) return 0.0;
  constexpr double nyquist = 0.5;
  return degrade::frequency_at(
      [&](double f) {
        return chain_modulation(setup, direction, f) * trail.modulation(direction, f) -
               least_modulation(needed, f);
      },
      0.0, nyquist);
}

// Shares of the seen pixels whose resel is at white, or within the noise of black.
void count_levels(const SightPlan& plan, const SightTarget& target, const CctvSignal& line,
                  TargetSignal& out) {
  const double black = line.report.exposure.gain * std::sqrt(line.report.noise.at_black());
  const auto along = [](std::uint32_t at, int of, int onto) {
    return static_cast<std::size_t>((at + 0.5) * onto / of);
  };
  const auto width = static_cast<std::uint32_t>(plan.map.columns);
  double saturated = 0.0, crushed = 0.0;
  for (const std::uint32_t pixel : target.seen) {
    const double level =
        static_cast<double>(line.level[along(pixel / width, plan.map.rows, line.rows) *
                                           static_cast<std::size_t>(line.columns) +
                                       along(pixel % width, plan.map.columns, line.columns)]);
    if (level >= degrade::white_signal) saturated += 1.0;
    if (level <= black) crushed += 1.0;
  }
  out.saturated = saturated / static_cast<double>(target.seen.size());
  out.crushed = crushed / static_cast<double>(target.seen.size());
}

// The remaining values, if there is a surround.
void compare(TargetSignal& out, const TargetResels& at, const ShownMoments& moments,
             const CctvSignal& line, const degrade::Setup& setup, const SightOptions& options,
             int frames, const Extent& extent, const Trail& trail, const ContrastBounds& bounds) {
  SignalSight& s = out.signal;
  MonitorSight& m = out.monitor;
  s.surround = mean_of(moments.mean, at.surround);
  m.surround = screen_mean(line, moments, at.surround_screen);
  const double left = trail.share(out.lines);
  if (left < 1.0) {
    s.mean = *s.surround + left * (s.mean - *s.surround);
    m.luminance = *m.surround + left * (m.luminance - *m.surround);
  }
  s.weber = weber_of(s.mean, *s.surround);
  m.weber = weber_of(m.luminance, *m.surround);
  const double delta = difference(s.mean, *s.surround);
  const double own = mean_of(moments.variance, at.measured),
               both = 0.5 * (own + mean_of(moments.variance, at.surround));
  s.snr = over(s.mean, own);
  const MeanNoise noise = mean_noise(line, moments, at.seen, at.surround, frames);
  s.cnr = over(delta, both);
  // CNR sqrt(N n / sum r), where N n / sum r is the variance of a resel over the variance of the
  // mean.
  const double mean_variance = own > 0.0 ? both * noise.variance_a / own : noise.variance_a;
  s.rose = over(delta, mean_variance);
  const double difference_variance = noise.variance_a + noise.variance_b - 2.0 * noise.covariance;
  s.snr_d = over(delta, difference_variance);
  s.dprime = left * ideal_observer(moments, at.seen, *s.surround, noise.variance_a);

  // Parts are large, so that the phosphor's spread hardly changes their means.
  const double of_parts = at.parts.empty() ? 1.0 : left;
  const double light =
      of_parts * difference_of_parts(at, moments.luminance, difference(m.luminance, *m.surround));
  s.difference = of_parts * difference_of_parts(at, moments.mean, delta);
  const double least = options.eye.threshold_factor *
                       threshold_difference(std::max(line.screen_luminance, *m.surround));
  if (*m.surround > 0.0) m.threshold = least / *m.surround;

  const double in_time = 0.5 * (mean_of(moments.variance_in_time, at.measured) +
                                mean_of(moments.variance_in_time, at.surround));
  // With the difference between target and surround times a factor.
  struct Seen {
    double limiting_frequency;
    Probability probability;
  };
  const auto seen_at = [&](double factor) -> Seen {
    const double signal = factor * *s.difference, shown = factor * light;
    const Needed needed{signal, mean_variance, in_time, shown > 0.0 ? least / shown : 1.0,
                        out.lines};
    const double frequency = limiting_frequency(setup, trail, extent.direction_rad, needed);
    // For all parts together: each has its share of the whole's samples.
    const double snr_d = over(signal, difference_variance);
    const double most = std::min(degrade::normal_probability(snr_d - options.even_chance_snr),
                                 seeing_probability(shown / least, options.eye));
    const Probability johnson = johnson_probability(out.lines * frequency, options.cycles);
    return {frequency,
            {std::min(johnson.detect, most), std::min(johnson.recognise, most),
             std::min(johnson.identify, most)}};
  };
  const Seen seen = seen_at(1.0);
  s.limiting_frequency = seen.limiting_frequency;
  out.cycles = out.lines * seen.limiting_frequency;
  out.probability = seen.probability;
  const auto at_bound = [&](double factor) {
    return factor == 1.0 ? seen.probability : seen_at(std::min(factor, most_factor)).probability;
  };
  out.probability_low = at_bound(bounds.low);
  out.probability_high = at_bound(bounds.high);
}

Trail trail_of(const SightPlan& plan, const TargetView& view, const CctvSignal& line,
               const SightOptions& options) {
  const double along = view.motion_px_s[0] * line.columns / plan.map.columns,
               across = view.motion_px_s[1] * line.rows / plan.map.rows;
  return {line.lag_per_field,
          0.5 * std::hypot(along, across) * options.frame_s,  // lag acts per field
          std::atan2(across, along)};
}

}  // namespace

double Trail::share(double extent) const {
  if (!(speed > 0.0) || !(lag > 0.0)) return 1.0;
  double sum = 0.0, weight = 1.0 - lag;
  for (double behind = 0.0; behind < extent && weight > 1e-9; behind += speed, weight *= lag) {
    sum += weight * (1.0 - behind / extent);
  }
  return sum;
}

double Trail::modulation(double direction, double frequency) const {
  if (!(speed > 0.0) || !(lag > 0.0)) return 1.0;
  const double phase = 2.0 * base::pi * frequency * speed * std::cos(direction - direction_rad);
  return (1.0 - lag) / std::sqrt(1.0 - 2.0 * lag * std::cos(phase) + lag * lag);
}

double chain_modulation(const degrade::Setup& setup, double direction_rad, double frequency) {
  degrade::CctvCamera camera = setup.camera;
  degrade::Monitor monitor = setup.monitor;
  for (const std::string& name : setup.options.off) {
    if (name == "lens-spread") camera.lens_blur = 0.0;
    if (name == "blur") camera.blur_h = camera.blur_v = 0.0;
    if (name == "bandwidth") camera.bandwidth_mhz = camera.aperture_correction = 0.0;
    if (name == "spread") monitor.spread = degrade::Spread::None;
  }
  const auto sinc = [](double x) {
    return x == 0.0 ? 1.0 : std::sin(base::pi * x) / (base::pi * x);
  };
  const auto phosphor = [&](double f) {
    switch (monitor.spread) {
      case degrade::Spread::Gaussian: {
        const double sigma = monitor.spread_width / (2.0 * std::sqrt(2.0 * std::log(2.0)));
        return std::exp(-2.0 * std::pow(base::pi * sigma * f, 2.0));
      }
      case degrade::Spread::Triangle:
        return std::pow(sinc(monitor.spread_width * f), 2.0);
      case degrade::Spread::Sinc:  // without its window
        return 2.0 * monitor.spread_width * f < 1.0 ? 1.0 : 0.0;
      case degrade::Spread::None:
        break;
    }
    return 1.0;
  };
  const auto axis = [&](degrade::Axis which, double f) {
    return transfer(camera, monitor, degrade::Travels::Picture, which, f) * std::pow(sinc(f), 2.0) *
           phosphor(f);
  };
  return axis(degrade::Axis::Along, std::abs(frequency * std::cos(direction_rad))) *
         axis(degrade::Axis::Across, std::abs(frequency * std::sin(direction_rad)));
}

void place_targets(SightPlan& plan, const degrade::Setup& cctv) {
  const degrade::Grid grid = degrade::picture_grid(plan.map.columns, plan.map.rows, cctv.monitor);
  const degrade::PlaneMap spread = screen_spread(cctv, grid.columns, grid.rows);
  for (SightTarget& target : plan.targets) {
    if (!target.seen.empty()) target.resels = resels_of(plan, target, spread);
  }
}

std::vector<std::optional<TargetSignal>> target_signals(const SightPlan& plan,
                                                        const CctvSignal& line,
                                                        const degrade::Setup& setup,
                                                        const SightOptions& options,
                                                        std::span<const ContrastBounds> bounds) {
  const int frames =
      std::max(1, static_cast<int>(std::lround(options.eye_integration_s / options.frame_s)));
  const degrade::PlaneMap spread{line.spread_along, line.spread_across};
  std::vector<std::shared_ptr<const TargetResels>> at(plan.targets.size());
  ReselUnion resels(line.resel_count()), screen(line.resel_count());
  for (std::size_t t = 0; t < at.size(); ++t) {
    const SightTarget& target = plan.targets[t];
    if (target.seen.empty()) continue;
    const bool placed = target.resels && target.resels->spread == spread;
    at[t] = placed ? target.resels : resels_of(plan, target, spread);
    for (const WeightedResels* set : {&at[t]->seen, &at[t]->surround}) resels.add(*set);
    for (const WeightedResels* set : {&at[t]->measured_screen, &at[t]->surround_screen}) {
      screen.add(*set);
    }
  }
  const ShownMoments moments = moments_at(line, resels.ascending(), screen.ascending(), frames);
  std::vector<std::optional<TargetSignal>> signals(plan.targets.size());
  for (std::size_t t = 0; t < at.size(); ++t) {
    const SightTarget& target = plan.targets[t];
    if (target.seen.empty()) continue;
    TargetSignal& out = signals[t].emplace();
    out.signal.mean = mean_of(moments.mean, at[t]->measured);
    out.signal.snr = over(out.signal.mean, mean_of(moments.variance, at[t]->measured));
    out.monitor.luminance = screen_mean(line, moments, at[t]->measured_screen);
    out.lines = target.extent.pixels * line.rows / plan.map.rows;
    count_levels(plan, target, line, out);
    if (at[t]->surround.empty()) continue;
    compare(out, *at[t], moments, line, setup, options, frames, target.extent,
            trail_of(plan, target.view, line, options), bounds[t]);
  }
  return signals;
}

}  // namespace earthshine::studies
