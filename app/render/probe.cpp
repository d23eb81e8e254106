// SPDX-License-Identifier: Apache-2.0
#include "app/render/probe.h"

#include <fmt/format.h>

#include <algorithm>

#include "studies/why/last_bounce.h"

namespace earthshine::app {
namespace {

constexpr int probe_rays = 16384;

std::string share_text(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

}  // namespace

Json probe_json(const Studio& studio, const scenes::Camera& camera,
                const raytrace::RenderOptions& options, const raytrace::Frame& frame) {
  const scenes::Scene& scene = studio.loaded.scene;
  const auto luminance_of = [&frame](const std::string& layer) {
    Rgb colour(0.0);
    for (int c = 0; c < 3; ++c) {
      const base::Channel* channel =
          frame.image.find(layer + (layer.empty() ? "" : ".") + "RGB"[c]);
      if (channel != nullptr) colour[c] = static_cast<double>(channel->values.front());
    }
    return base::luminance(colour);
  };
  const double luminance = luminance_of("");
  std::vector<std::pair<double, std::string>> groups;
  for (const std::string& name : studio.loaded.groups.names) {
    groups.emplace_back(luminance_of("light_" + name), name);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Json by = Json::array(), from = Json::array();
  for (const auto& [light, name] : groups) {
    by.push_back({{"group", name},
                  {"luminance_cd_m2", light},
                  {"share", luminance > 0.0 ? Json(light / luminance) : Json()}});
  }
  const std::uint32_t pixel =
      static_cast<std::uint32_t>(frame.window.y) * static_cast<std::uint32_t>(options.columns) +
      static_cast<std::uint32_t>(frame.window.x);
  const std::vector<studies::SeenPoint> points = studies::seen_points(
      scene, studio.query, camera, options.columns, options.rows, {&pixel, 1}, 1);
  double rest = 1.0, others = 0.0;
  if (luminance > 0.0 && !points.empty()) {
    for (const studies::LightShare& share :
         studies::light_shares(scene, studio.loaded.groups, studio.query, studio.light.solution,
                               points, luminance, probe_rays)) {
      rest -= share.share;
      if (share.share < studies::least_light_share) {
        others += share.share;
        continue;
      }
      from.push_back(
          {{"from", share.from}, {"reflected", share.reflected}, {"share", share.share}});
    }
  }
  const bool is_lit = luminance > 0.0;
  return {{"light_by", by},
          {"light_from", from},
          {"others", is_lit ? Json(others) : Json()},
          {"left_over", is_lit ? Json(rest) : Json()}};
}

std::string probe_text(const Json& probe) {
  std::string text = "light by source, all its paths together (luminance):\n";
  for (const Json& entry : probe["light_by"]) {
    text += fmt::format("  {:<24} {:>10.4g} cd/m2 {:>8}\n", entry["group"].get<std::string>(),
                        entry["luminance_cd_m2"].get<double>(),
                        entry["share"].is_null() ? "-" : share_text(entry["share"].get<double>()));
  }
  text += "light by where it comes from last (diffuse, at the pixel's centre; of the luminance):\n";
  for (const Json& entry : probe["light_from"]) {
    text += fmt::format("  {:<24} {:>8}\n",
                        (entry["reflected"].get<bool>() ? "by way of " : "straight from ") +
                            entry["from"].get<std::string>(),
                        share_text(entry["share"].get<double>()));
  }
  if (!probe["left_over"].is_null()) {
    text += fmt::format("  {:<24} {:>8}\n", "others, below 1 % each",
                        share_text(probe["others"].get<double>()));
    text += fmt::format("  {:<24} {:>8}\n", "highlights, mirrors, rest",
                        share_text(probe["left_over"].get<double>()));
  }
  return text;
}

}  // namespace earthshine::app
