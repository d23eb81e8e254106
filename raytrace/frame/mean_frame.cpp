// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/mean_frame.h"

#include <algorithm>
#include <cmath>

namespace earthshine::raytrace {
namespace {

bool has_mean(const std::string& channel) { return !channel.starts_with("Crypto"); }

}  // namespace

void MeanFrame::add(const Frame& frame, const std::vector<RowShare>& rows) {
  if (mean_.image.channels.empty()) {
    mean_.window = window_;
    mean_.report = frame.report;
    mean_.report.rays = {};
    mean_.report.seconds = mean_.report.gather_seconds = 0.0;
    mean_.report.gather_rays = 0;
    mean_.report.unexplained_pixels = 0;
    mean_.image = {window_.columns, window_.rows, {}};
    for (const base::Channel& channel : frame.image.channels) mean_.image.add(channel.name);
    mean_.error = StatedError(window_.pixel_count());
  }
  const auto columns = static_cast<std::size_t>(window_.columns);
  for (int y = frame.window.y; y < frame.window.y + frame.window.rows; ++y) {
    const auto row = static_cast<std::size_t>(y - window_.y);
    const auto [weight, middle] = rows[row];
    if (!(weight > 0.0)) continue;
    sum_[row] += weight;
    const std::size_t from = frame.window.index(frame.window.x, y), to = row * columns;
    for (base::Channel& channel : mean_.image.channels) {
      const std::vector<float>& values = frame.image.find(channel.name)->values;
      const double share = channel.name == "variance" ? weight * weight : weight;
      for (std::size_t x = 0; x < columns; ++x) {
        float& mean = channel.values[to + x];
        if (has_mean(channel.name)) {
          mean = static_cast<float>(double(mean) + share * double(values[from + x]));
        } else if (middle) {
          mean = values[from + x];
        }
      }
    }
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t in = from + x, out = to + x;
      StatedError& error = mean_.error;
      error.luminance[out] += static_cast<float>(weight) * frame.error.luminance[in];
      error.source[out] += static_cast<float>(weight) * frame.error.source[in];
      for (std::size_t part = 0; part < error_parts; ++part) {
        error.squared[out][part] +=
            static_cast<float>(weight * weight) * frame.error.squared[in][part];
      }
      error.shows[out] = std::max(error.shows[out], frame.error.shows[in]);
    }
  }
  RenderReport& report = mean_.report;
  const RenderReport& more = frame.report;
  report.rays += more.rays;
  report.seconds += more.seconds;
  report.gather_seconds += more.gather_seconds;
  report.gather_rays += more.gather_rays;
  report.most_camera_samples = std::max(report.most_camera_samples, more.most_camera_samples);
  report.finished_share = std::min(report.finished_share, more.finished_share);
  report.unexplained_pixels += more.unexplained_pixels;
  report.growth = std::max(report.growth, more.growth);
  report.gave_up = report.gave_up || more.gave_up;
  report.stopped = report.stopped || more.stopped;
  samples_ += more.camera_samples * static_cast<double>(frame.window.pixel_count());
}

Frame MeanFrame::take() {
  const auto columns = static_cast<std::size_t>(window_.columns);
  for (std::size_t row = 0; row < sum_.size(); ++row) {
    if (!(sum_[row] > 0.0)) continue;
    const double scale = 1.0 / sum_[row];
    for (std::size_t p = row * columns; p < (row + 1) * columns; ++p) {
      for (base::Channel& channel : mean_.image.channels) {
        if (!has_mean(channel.name)) continue;
        const double by = channel.name == "variance" ? scale * scale : scale;
        channel.values[p] = static_cast<float>(by * double(channel.values[p]));
      }
      mean_.error.luminance[p] *= static_cast<float>(scale);
      mean_.error.source[p] *= static_cast<float>(scale);
      for (float& part : mean_.error.squared[p]) part *= static_cast<float>(scale * scale);
    }
  }
  mean_.report.camera_samples = samples_ / static_cast<double>(window_.pixel_count());
  mean_.report.relative_noise = std::sqrt(add_up(mean_.error).squared_error());
  return std::move(mean_);
}

}  // namespace earthshine::raytrace
