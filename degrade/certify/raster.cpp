// SPDX-License-Identifier: Apache-2.0
// The monitor: drive, room light, phosphor. Each chart defines the line signal.
#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "base/units.h"
#include "degrade/certify/test_bench.h"

namespace earthshine::degrade {
namespace {

constexpr double screen_rounding = 2e-6;  // relative to the screen's white

class Screen {
 public:
  explicit Screen(const Bench& bench)
      : bench_(bench),
        options_(bench.options(stage::noise + stage::uneven + stage::spatial + stage::limits +
                               Names{"quantisation"})) {}

  // f(x, y), with x and y in resels, is the line signal.
  template <class F>
  [[nodiscard]] Result show(F f) const {
    const double gamma = bench_.camera().gamma;
    return bench_.run(bench_.chart([&](double x, double y) { return std::pow(f(x, y), gamma); }),
                      bench_.held(), options_);
  }
  [[nodiscard]] double veil() const {
    return bench_.monitor().reflectance * bench_.monitor().room_illuminance / base::pi;
  }
  // Expected luminance of a flat field of line signal v, with room light.
  [[nodiscard]] double luminance(double v) const {
    const Monitor& m = bench_.monitor();
    return m.black_luminance + (m.white_luminance - m.black_luminance) * std::pow(v, m.gamma) +
           veil();
  }
  [[nodiscard]] double slack() const {
    return screen_rounding *
           (bench_.monitor().white_luminance + bench_.monitor().black_luminance + veil());
  }

 private:
  const Bench& bench_;
  Options options_;
};

const Plane& viewed(const Result& result) { return result.viewed.channels[0].values; }

double mean(const Plane& plane) {
  double sum = 0.0;
  for (const float value : plane) sum += static_cast<double>(value);
  return sum / static_cast<double>(plane.size());
}

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

Rows level_rows(const Screen& screen) {
  Rows rows;
  const auto flat = [&](double v) { return screen.show([=](double, double) { return v; }); };
  const Result black = flat(0.0), half = flat(0.5), white = flat(1.0);
  rows.push_back(within("luminance of black", "cd/m2", mean(viewed(black)), screen.luminance(0.0),
                        screen.slack(), "I_b + reflectance E_room / pi"));
  rows.push_back(within("luminance of half drive", "cd/m2", mean(viewed(half)),
                        screen.luminance(0.5), screen.slack(),
                        "I_b + (I_w - I_b) / 2^gamma + room"));
  rows.push_back(within("luminance of white", "cd/m2", mean(viewed(white)), screen.luminance(1.0),
                        screen.slack(), "I_w + room"));
  if (screen.luminance(0.0) > 0.0) {
    const double law = screen.luminance(1.0) / screen.luminance(0.0);
    rows.push_back(
        within("contrast ratio", "1", mean(viewed(white)) / mean(viewed(black)), law,
               law * screen.slack() * (1.0 / screen.luminance(0.0) + 1.0 / screen.luminance(1.0)),
               "white over black, both under the room's light"));
  } else {
    rows.push_back(absent("contrast ratio", "1", "black is without any light"));
  }
  const auto [least, most] = std::minmax_element(viewed(half).begin(), viewed(half).end());
  rows.push_back(within("unevenness of a flat field, border and raster", "1",
                        static_cast<double>(*most - *least) / mean(viewed(half)), 0.0, 1e-5,
                        "0: light is held over the resel and mirrored at the border"));
  rows.push_back(within("code of half drive in the file", "1",
                        static_cast<double>(half.pixels.front()),
                        255.0 * srgb(screen.luminance(0.5) / screen.luminance(1.0)), 0.501,
                        "sRGB of the share of white, nearest whole number"));
  return rows;
}

CertificateRow checkerboard(const Bench& bench, const Screen& screen) {
  // A sinc makes negative light beside black. It would be clipped, which increases the mean.
  const double low =
      bench.monitor().spread == Spread::Sinc ? std::pow(0.7, 1.0 / bench.monitor().gamma) : 0.0;
  const auto is_bright = [](double x, double y) {
    return (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0;
  };
  double bright = 0.0;
  for (int y = 0; y < bench.rows(); ++y) {
    for (int x = 0; x < bench.columns(); ++x) bright += is_bright(x, y) ? 1.0 : 0.0;
  }
  const double share = bright / (static_cast<double>(bench.columns()) * bench.rows());
  const Result result =
      screen.show([&](double x, double y) { return is_bright(x, y) ? 1.0 : low; });
  return within("mean luminance of a checkerboard of resels", "cd/m2", mean(viewed(result)),
                share * screen.luminance(1.0) + (1.0 - share) * screen.luminance(low),
                4.0 * screen.slack(), "light adds: half of both (gamma before spread)");
}

CertificateRow light_sum(const Bench& bench, const Screen& screen) {
  const base::Key key(1, base::Stream::Test, 0);
  const auto drive = [&](double x, double y) {
    const auto n = static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint64_t>(x);
    return std::pow(0.7 + 0.3 * base::uniform(key, n), 1.0 / bench.monitor().gamma);
  };
  double law = 0.0;
  for (int y = 0; y < bench.rows(); ++y) {
    for (int x = 0; x < bench.columns(); ++x) law += screen.luminance(drive(x, y));
  }
  law /= static_cast<double>(bench.columns()) * bench.rows();
  return within("mean luminance of a speckled picture", "cd/m2", mean(viewed(screen.show(drive))),
                law, 4.0 * screen.slack(), "the phosphor's spread keeps the sum of light");
}

// An edge from black to white between two resels: I_b + (I_w - I_b) H(x) plus room light, H the
// integral of the point spread. Negative light is clipped.
CertificateRow phosphor(const Bench& bench, const Screen& screen, Axis axis) {
  const bool along = axis == Axis::Along;
  const int at = (along ? bench.columns() : bench.rows()) / 2;
  const Result result =
      screen.show([&](double x, double y) { return (along ? x : y) < at ? 0.0 : 1.0; });
  const int pixels = bench.monitor().pixels_per_resel;
  const double black = screen.luminance(0.0) - screen.veil();
  const double step = screen.luminance(1.0) - screen.luminance(0.0);
  double worst = 0.0;
  const int reach = 10 * pixels;
  for (int k = -reach; k < reach; ++k) {
    const double x = (k + 0.5) / pixels;
    const double law =
        std::max(0.0, black + step * phosphor_edge(bench.monitor(), x)) + screen.veil();
    const int column = along ? at * pixels + k : result.columns / 2;
    const int row = along ? result.rows / 2 : at * pixels + k;
    const double found = static_cast<double>(
        viewed(result)[static_cast<std::size_t>(row) * static_cast<std::size_t>(result.columns) +
                       static_cast<std::size_t>(column)]);
    worst = farther(worst, found - law);
  }
  return within(along ? "phosphor along the line: worst of an edge's profile"
                      : "phosphor across lines: worst of an edge's profile",
                "cd/m2", worst, 0.0, 1e-4 * (step + screen.slack()),
                "I_b + (I_w - I_b) times the integral of the point spread");
}

}  // namespace

Rows raster_rows(const Bench& bench) {
  const Screen screen(bench);
  Rows rows = level_rows(screen);
  rows.push_back(checkerboard(bench, screen));
  rows.push_back(light_sum(bench, screen));
  rows.push_back(phosphor(bench, screen, Axis::Along));
  rows.push_back(phosphor(bench, screen, Axis::Across));
  return rows;
}

}  // namespace earthshine::degrade
