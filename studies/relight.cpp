// SPDX-License-Identifier: Apache-2.0
#include "studies/relight.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace earthshine::studies {
namespace {

using base::Blame;
using base::Error;

constexpr std::string_view prefix = "light_";
constexpr std::array<const char*, 3> colours = {"R", "G", "B"};
constexpr double rounding = 1e-4;  // of the mean: floats of many layers

base::Channel* channel(base::Image& image, const std::string& name) {
  for (base::Channel& one : image.channels) {
    if (one.name == name) return &one;
  }
  return nullptr;
}

std::string layer_name(const std::string& group, std::size_t colour) {
  return std::string(prefix) + group + "." + colours[colour];
}

std::vector<double> sum_of_layers(const base::Image& image, const std::vector<std::string>& groups,
                                  std::size_t colour) {
  std::vector<double> sum(image.pixel_count(), 0.0);
  for (const std::string& group : groups) {
    const std::vector<float>& values = image.find(layer_name(group, colour))->values;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += double(values[p]);
  }
  return sum;
}

bool is_untrue_when_dimmed(const std::string& name) {
  return name == "variance" || name.starts_with("direct.") || name.starts_with("indirect.") ||
         name.starts_with("specular.");
}

void check(const base::Image& image, const std::vector<std::string>& groups,
           const std::string& source) {
  if (groups.empty()) {
    throw Error(Blame::Input, source, "has no layers of light groups (light_<group>.R, .G, .B)", {},
                "Render it with --per-light");
  }
  for (std::size_t c = 0; c < colours.size(); ++c) {
    const base::Channel* whole = image.find(colours[c]);
    if (whole == nullptr) {
      throw Error(Blame::Input, source, fmt::format("has no channel {}", colours[c]), {},
                  "Give a picture that \"earthshine render --per-light\" wrote");
    }
    const std::vector<double> sum = sum_of_layers(image, groups, c);
    double off = 0.0, mean = 0.0;
    for (std::size_t p = 0; p < sum.size(); ++p) {
      off =
          std::max(off, std::abs(sum[p] - double(whole->values[p])) - rounding * std::abs(sum[p]));
      mean += std::abs(sum[p]) / double(sum.size());
    }
    // Not "off > ...": NaN must fail, too.
    if (off <= rounding * mean) continue;
    throw Error(Blame::Input, source,
                fmt::format("its light layers do not add up to {}: {:.3g} cd/m2 are missing",
                            colours[c], off),
                {}, "Give a picture as \"earthshine render --per-light\" wrote it");
  }
}

}  // namespace

std::vector<std::string> lit_groups(const base::Image& image) {
  std::vector<std::string> groups;
  for (const base::Channel& one : image.channels) {
    if (!one.name.starts_with(prefix)) continue;
    const std::size_t dot = one.name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string group = one.name.substr(prefix.size(), dot - prefix.size());
    if (std::find(groups.begin(), groups.end(), group) != groups.end()) continue;
    const bool whole = image.find(layer_name(group, 0)) != nullptr &&
                       image.find(layer_name(group, 1)) != nullptr &&
                       image.find(layer_name(group, 2)) != nullptr;
    if (whole) groups.push_back(group);
  }
  return groups;
}

void relight(base::Image& image, const std::map<std::string, Rgb>& factors,
             const std::string& source) {
  const std::vector<std::string> groups = lit_groups(image);
  check(image, groups, source);
  bool changes = false;
  for (const auto& [group, factor] : factors) {
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) {
      throw Error(Blame::Input, source, fmt::format("has no light group \"{}\"", group),
                  fmt::format("it has {}", fmt::join(groups, ", ")), "Name one of them");
    }
    for (std::size_t c = 0; c < colours.size(); ++c) {
      const double f = factor[static_cast<int>(c)];
      if (f == 1.0) continue;
      changes = true;
      for (float& value : channel(image, layer_name(group, c))->values) {
        value = static_cast<float>(f * double(value));
      }
    }
  }
  if (!changes) return;
  for (std::size_t c = 0; c < colours.size(); ++c) {
    const std::vector<double> sum = sum_of_layers(image, groups, c);
    std::transform(sum.begin(), sum.end(), channel(image, colours[c])->values.begin(),
                   [](double value) { return static_cast<float>(value); });
  }
  std::erase_if(image.channels,
                [](const base::Channel& one) { return is_untrue_when_dimmed(one.name); });
}

std::map<int, ObjectLight> light_of_objects(const base::Image& image) {
  std::map<int, ObjectLight> objects;
  const base::Channel* numbers = image.find("object");
  if (numbers == nullptr) return objects;
  const auto luminance = [&](const std::string& before, std::size_t p) {
    Rgb rgb;
    for (std::size_t c = 0; c < colours.size(); ++c) {
      rgb[static_cast<int>(c)] = double(image.find(before + colours[c])->values[p]);
    }
    return base::luminance(rgb);
  };
  const std::vector<std::string> groups = lit_groups(image);
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const int number = static_cast<int>(std::lround(numbers->values[p]));
    if (number < 0) continue;
    ObjectLight& object = objects[number];
    ++object.pixels;
    object.luminance += luminance("", p);
    for (const std::string& group : groups) {
      object.by_group[group] += luminance(std::string(prefix) + group + ".", p);
    }
  }
  for (auto& [number, object] : objects) {
    const auto pixels = static_cast<double>(object.pixels);
    object.luminance /= pixels;
    for (auto& [group, light] : object.by_group) light /= pixels;
  }
  return objects;
}

}  // namespace earthshine::studies
