// SPDX-License-Identifier: Apache-2.0
#include "raytrace/blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace earthshine::raytrace {
namespace {

bool is_colour(std::string_view name) { return name == "R" || name == "G" || name == "B"; }

bool is_light(std::string_view name) { return name.starts_with("light_"); }

bool is_radiance(std::string_view name) {
  constexpr std::array<std::string_view, 3> parts = {"direct.", "indirect.", "specular."};
  return is_colour(name) || is_light(name) ||
         std::any_of(parts.begin(), parts.end(),
                     [name](std::string_view part) { return name.starts_with(part); });
}

void mix(std::vector<float>& a, const std::vector<float>& b, double of_a, double of_b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = static_cast<float>(of_a * double(a[i]) + of_b * double(b[i]));
  }
}

// R, G and B anew, in the order of the layers.
void add_up_lights(base::Image& image) {
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> sum(image.pixel_count(), 0.0F);
    bool any = false;
    for (const base::Channel& channel : image.channels) {
      if (!is_light(channel.name) || channel.name.back() != "RGB"[c]) continue;
      any = true;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += channel.values[i];
    }
    if (any) image.channels[c].values = std::move(sum);
  }
}

}  // namespace

Frame blend(Frame a, const Frame& b, double share) {
  const double rest = 1.0 - share;
  for (base::Channel& channel : a.image.channels) {
    const std::vector<float>& other = b.image.find(channel.name)->values;
    if (is_radiance(channel.name)) mix(channel.values, other, rest, share);
    if (channel.name == "variance") mix(channel.values, other, rest * rest, share * share);
  }
  add_up_lights(a.image);
  for (std::size_t i = 0; i < a.squared_error.size(); ++i) {
    const bool source = a.squared_error[i] == shows_source || b.squared_error[i] == shows_source;
    a.squared_error[i] = source ? shows_source
                                : static_cast<float>(rest * rest * double(a.squared_error[i]) +
                                                     share * share * double(b.squared_error[i]));
  }
  RenderReport& report = a.report;
  const RenderReport& other = b.report;
  report.rays += other.rays;
  report.seconds += other.seconds;
  report.gather_seconds += other.gather_seconds;
  report.relative_noise = std::hypot(rest * report.relative_noise, share * other.relative_noise);
  report.gather_noise = std::hypot(rest * report.gather_noise, share * other.gather_noise);
  report.camera_samples += other.camera_samples;
  report.most_camera_samples += other.most_camera_samples;
  report.least_camera_samples += other.least_camera_samples;
  report.gather_rays += other.gather_rays;
  report.finished_share = std::min(report.finished_share, other.finished_share);
  report.stopped = report.stopped || other.stopped;
  return a;
}

}  // namespace earthshine::raytrace
