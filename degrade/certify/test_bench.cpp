// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/test_bench.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::degrade {
namespace {

// Consecutive frames of a tube are correlated by lag, so that every second frame is skipped.
constexpr std::uint64_t frames_apart = 2;

Names names_of(bool (*belongs)(const Stage&)) {
  Names names;
  for (const Stage& stage : stages()) {
    if (belongs(stage)) names.emplace_back(stage.name);
  }
  return names;
}

}  // namespace

namespace stage {
const Names noise = names_of([](const Stage& stage) { return stage.is(Kind::Noise); });
const Names uneven = names_of([](const Stage& stage) { return stage.is(Kind::Uneven); });
const Names spatial = names_of([](const Stage& stage) { return stage.is(Kind::Spatial); });
const Names limits = names_of([](const Stage& stage) { return stage.is(Kind::Limit); });
const Names coding = names_of([](const Stage& stage) { return stage.is(Kind::Coding); });
const Names screen = names_of([](const Stage& stage) { return stage.part == Part::Monitor; });
}  // namespace stage

Names operator+(Names a, const Names& b) {
  for (const std::string& name : b) {
    if (std::find(a.begin(), a.end(), name) == a.end()) a.push_back(name);
  }
  return a;
}

Bench::Bench(const CctvCamera& camera, const Monitor& monitor, const CertifyOptions& options)
    : camera_(camera),
      held_(camera),
      monitor_(monitor),
      options_(options),
      noise_(line_noise(camera, monitor)) {
  if (monitor.rows < least_certified_resels || monitor.columns < least_certified_resels) {
    throw base::Error(
        base::Blame::Input, "monitor",
        std::to_string(monitor.rows) + " rows by " + std::to_string(monitor.columns) +
            " columns are too few to measure",
        "a certificate needs at least " + std::to_string(least_certified_resels) + " of each");
  }
  held_.iris = IrisMode::Fixed;
  held_.gain_db = 0.0;
  if (camera.iris != IrisMode::Fixed) held_.f_number = camera.f_number_min;
  const int radius =
      std::max(noise_.light_filter.radius(), filter_of(camera, monitor, Travels::Picture).radius());
  const int smallest = std::min(columns(), rows());
  if (radius > smallest / 4) {
    throw base::Error(base::Blame::Input, "camera",
                      "it spreads a point over " + std::to_string(radius) + " resels to each side",
                      "a quarter of the monitor's " + std::to_string(smallest) + " can be measured",
                      "Give it less blur, more bandwidth or a monitor with more resels");
  }
  margin_ = std::min(radius + 2, smallest / 6);
  blocks_ =
      cut_blocks(columns(), rows(), margin_, std::min(std::max(2 * radius, 12), smallest / 6));
}

double Bench::white_luminance() const {
  // S = pi tau L / (4 N^2 (1 + m)^2 E_white)
  const double n = held_.f_number * (1.0 + held_.magnification);
  return held_.white_lux * 4.0 * n * n / (base::pi * held_.transmittance);
}

base::Image Bench::flat(double signal) const {
  return chart([=](double, double) { return signal; });
}

Options Bench::options(Names off, std::uint64_t frame) const {
  Options result;
  result.seed = options_.seed;
  result.frame = frames_apart * frame;
  result.off = std::move(off);
  result.fov_deg = bench_fov_deg;
  return result;
}

Result Bench::run(const base::Image& chart, const CctvCamera& camera,
                  const Options& options) const {
  return options_.chain(chart, camera, monitor_, options);
}

Picture Bench::linear(const base::Image& chart, const Options& options) const {
  Options all = options;
  all.off = all.off + stage::limits + stage::coding + stage::screen + stage::uneven;
  return to_picture(run(chart, held_, all).signal);
}

Picture Bench::linear(const base::Image& chart, std::uint64_t frame, const Names& off) const {
  return linear(chart, options(off, frame));
}

Picture to_picture(const base::Image& image) {
  Picture picture{image.width, image.height, {}};
  for (const base::Channel& channel : image.channels) picture.planes.push_back(channel.values);
  return picture;
}

CertificateRow within(std::string_view name, std::string_view unit, double measured,
                      double expected, double tolerance, std::string_view law) {
  CertificateRow row;
  row.name = name;
  row.unit = unit;
  row.measured = measured;
  row.expected = expected;
  row.tolerance = tolerance;
  row.law = law;
  // In this form a NaN fails.
  row.verdict = std::abs(measured - expected) <= tolerance ? Verdict::Pass : Verdict::Fail;
  return row;
}

CertificateRow within_errors(std::string_view name, std::string_view unit, const Estimate& measured,
                             double expected, std::string_view law, double rounding) {
  CertificateRow row =
      within(name, unit, measured.value, expected, four_errors(measured) + rounding, law);
  row.statistical = true;
  return row;
}

CertificateRow absent(std::string_view name, std::string_view unit, std::string_view why) {
  CertificateRow row;
  row.name = name;
  row.unit = unit;
  row.why = why;
  return row;
}

double farther(double a, double b) { return std::isnan(a) || std::abs(b) <= std::abs(a) ? a : b; }

double largest_difference(const Plane& a, const Plane& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = farther(most, static_cast<double>(a[i]) - static_cast<double>(b[i]));
  }
  return std::abs(most);
}

}  // namespace earthshine::degrade
