// SPDX-License-Identifier: Apache-2.0
// Chains with one error each, for tests of the certificate.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include "base/numbers/random.h"
#include "base/units.h"
#include "degrade/certify/certificate.h"

namespace earthshine::test {

using degrade::Chain;
using degrade::Options;
using degrade::Result;

struct Call {
  const base::Image& chart;
  degrade::CctvCamera camera;
  degrade::Monitor monitor;
  Options options;

  [[nodiscard]] bool leaves_out(std::string_view name) const {
    return std::find(options.off.begin(), options.off.end(), name) != options.off.end();
  }
  [[nodiscard]] Result run() const { return degrade::still_chain(chart, camera, monitor, options); }
  [[nodiscard]] Result run_without(std::vector<std::string> names) const {
    Options fewer = options;
    for (std::string& name : names) {
      if (!leaves_out(name)) fewer.off.push_back(std::move(name));
    }
    return degrade::still_chain(chart, camera, monitor, fewer);
  }
};

// An error changes the call, the linear signal or the whole result.
struct Defect {
  std::string name, row;
  std::function<Result(Call)> chain;
};
inline std::ostream& operator<<(std::ostream& out, const Defect& defect) {
  return out << defect.name;
}

inline Defect changed(std::string name, std::string row, const std::function<void(Call&)>& change) {
  return {std::move(name), std::move(row), [change](Call call) {
            change(call);
            return call.run();
          }};
}

// Applies change(signal, resel) where the signal before gamma is measured.
inline Defect linear(std::string name, std::string row,
                     const std::function<double(double, std::size_t)>& change) {
  return {std::move(name), std::move(row), [change](const Call& call) {
            Result result = call.run();
            if (!call.leaves_out("camera-gamma")) return result;
            std::vector<float>& values = result.signal.channels[0].values;
            for (std::size_t i = 0; i < values.size(); ++i) {
              values[i] = static_cast<float>(change(static_cast<double>(values[i]), i));
            }
            return result;
          }};
}

inline double uniform(std::size_t i) {
  return base::uniform(base::Key(11, base::Stream::Test, 0), i);
}

// Quantises the line signal by rule(v in steps, resel).
inline Defect steps(std::string name, std::string row,
                    const std::function<double(double, std::size_t)>& rule) {
  return {std::move(name), std::move(row), [rule](const Call& call) {
            if (call.leaves_out("quantisation")) return call.run();
            Result result = call.run_without({"quantisation"});
            const double levels = std::ldexp(1.0, call.camera.bits) - 1.0;
            std::vector<float>& values = result.signal.channels[0].values;
            for (std::size_t i = 0; i < values.size(); ++i) {
              values[i] =
                  static_cast<float>(rule(static_cast<double>(values[i]) * levels, i) / levels);
            }
            return result;
          }};
}

inline Result noise_after_blur(const Call& call) {
  Result blurred = call.run_without({"signal-noise"});
  const Result noisy = call.run_without({"blur"});
  const Result clean = call.run_without({"blur", "signal-noise"});
  for (std::size_t i = 0; i < blurred.signal.channels[0].values.size(); ++i) {
    blurred.signal.channels[0].values[i] +=
        noisy.signal.channels[0].values[i] - clean.signal.channels[0].values[i];
  }
  return blurred;
}

inline Result power_of_negative(const Call& call) {
  if (call.leaves_out("camera-gamma")) return call.run();
  Result result = call.run_without({"black-clamp", "white-clip", "camera-gamma", "quantisation"});
  for (float& value : result.signal.channels[0].values) {
    value = std::pow(value, static_cast<float>(1.0 / call.camera.gamma));
  }
  return result;
}

inline Result divided_by_brightest(const Call& call) {
  Result result = call.run();
  std::vector<float>& values = result.signal.channels[0].values;
  const float most = *std::max_element(values.begin(), values.end());
  for (float& value : values) value = most > 0.0F ? value / most : value;
  return result;
}

// Error: the spot spreads the voltage, and gamma follows.
inline Result spread_before_gamma(Call call) {
  const degrade::Monitor monitor = call.monitor;
  if (call.leaves_out("screen")) return call.run();
  call.monitor.gamma = 1.0;
  call.monitor.black_luminance = 0.0;
  call.monitor.white_luminance = 1.0;
  call.monitor.room_illuminance = 0.0;
  Result result = call.run();
  const double veil = monitor.reflectance * monitor.room_illuminance / base::pi;
  for (float& value : result.viewed.channels[0].values) {
    value = static_cast<float>(monitor.black_luminance +
                               (monitor.white_luminance - monitor.black_luminance) *
                                   std::pow(static_cast<double>(value), monitor.gamma) +
                               veil);
  }
  return result;
}

// Error: drops every second pixel of a finer chart instead of averaging.
inline Result nearest_pixel(const Call& call) {
  const base::Image& in = call.chart;
  if (in.width != 2 * call.monitor.columns) return call.run();
  base::Image out{call.monitor.columns, call.monitor.rows, {}};
  std::vector<float>& values = out.add("Y");
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      values[static_cast<std::size_t>(y * out.width + x)] =
          in.channels[0].values[static_cast<std::size_t>(2 * y * in.width + 2 * x)];
    }
  }
  return degrade::still_chain(out, call.camera, call.monitor, call.options);
}

inline Defect never_the_same_twice() {
  const auto calls = std::make_shared<std::atomic<std::uint64_t>>(0);
  return {"WallClockInTheSeed", "differing values, same seed again", [calls](Call call) {
            call.options.seed += ++*calls;
            return call.run();
          }};
}

inline Chain chain_of(const Defect& defect) {
  return [&](const base::Image& chart, const degrade::CctvCamera& camera,
             const degrade::Monitor& monitor, const Options& options) {
    return defect.chain({chart, camera, monitor, options});
  };
}

}  // namespace earthshine::test
