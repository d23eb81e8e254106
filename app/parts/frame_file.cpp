// SPDX-License-Identifier: Apache-2.0
#include "app/parts/frame_file.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace earthshine::app {
namespace {

using raytrace::Frame;

constexpr const char* stated_luminance = "stated.luminance";
constexpr const char* stated_source = "stated.source";
constexpr const char* stated_shows = "stated.shows";
constexpr std::array<const char*, raytrace::error_parts> stated_squares = {
    "stated.gather", "stated.residual", "stated.lobe", "stated.camera"};

template <class Rays, class Visit>
void visit_rays(Rays& rays, const Visit& visit) {
  for (auto* count : {&rays.camera, &rays.shadow, &rays.gather, &rays.lobe, &rays.mirror,
                      &rays.refraction, &rays.planning, &rays.layers}) {
    visit(*count);
  }
  for (auto& count : rays.to_light) visit(count);
}

std::vector<float> take(base::Image& image, const char* name) {
  const auto found =
      std::find_if(image.channels.begin(), image.channels.end(),
                   [&](const base::Channel& channel) { return channel.name == name; });
  if (found == image.channels.end()) return {};
  std::vector<float> values = std::move(found->values);
  image.channels.erase(found);
  return values;
}

}  // namespace

CachedResult kept_frame(const Frame& frame, const raytrace::Window& picture) {
  CachedResult kept{{}, frame.image};
  kept.header.whole = {picture.columns, picture.rows, frame.window.x, frame.window.y};
  const raytrace::RenderReport& report = frame.report;
  Json rays = Json::array(), layers = Json::array();
  visit_rays(report.rays, [&](std::uint64_t count) { rays.push_back(count); });
  for (const base::Channel& channel : frame.image.channels) layers.push_back(channel.name);
  const raytrace::Window& window = frame.window;
  kept.facts = {{"window", {window.x, window.y, window.columns, window.rows}},
                {"layers", layers},
                {"rays", rays},
                {"seconds", report.seconds},
                {"gather_seconds", report.gather_seconds},
                {"camera_samples", report.camera_samples},
                {"most_camera_samples", report.most_camera_samples},
                {"gather_rays", report.gather_rays},
                {"least_camera_samples", report.least_camera_samples},
                {"finished_share", report.finished_share},
                {"unexplained_pixels", report.unexplained_pixels},
                {"gave_up", report.gave_up}};
  const raytrace::StatedError& stated = frame.error;
  kept.image.add(stated_luminance) = stated.luminance;
  kept.image.add(stated_source) = stated.source;
  std::vector<float>& shows = kept.image.add(stated_shows);
  std::transform(stated.shows.begin(), stated.shows.end(), shows.begin(),
                 [](raytrace::Shows what) { return static_cast<float>(what); });
  for (std::size_t part = 0; part < raytrace::error_parts; ++part) {
    std::vector<float>& squares = kept.image.add(stated_squares[part]);
    std::transform(stated.squared.begin(), stated.squared.end(), squares.begin(),
                   [part](const auto& squared) { return squared[part]; });
  }
  return kept;
}

Frame frame_of(CachedResult kept) {
  Frame frame;
  const Json& facts = kept.facts;
  const auto window = facts.at("window").get<std::array<int, 4>>();
  frame.window = {window[0], window[1], window[2], window[3]};
  raytrace::RenderReport& report = frame.report;
  std::size_t next = 0;
  visit_rays(report.rays, [&](std::uint64_t& count) { facts.at("rays").at(next++).get_to(count); });
  facts.at("seconds").get_to(report.seconds);
  facts.at("gather_seconds").get_to(report.gather_seconds);
  facts.at("camera_samples").get_to(report.camera_samples);
  facts.at("most_camera_samples").get_to(report.most_camera_samples);
  facts.at("gather_rays").get_to(report.gather_rays);
  facts.at("least_camera_samples").get_to(report.least_camera_samples);
  facts.at("finished_share").get_to(report.finished_share);
  report.unexplained_pixels = facts.value("unexplained_pixels", std::size_t{0});
  report.gave_up = facts.value("gave_up", false);
  raytrace::StatedError& stated = frame.error;
  stated.luminance = take(kept.image, stated_luminance);
  stated.source = take(kept.image, stated_source);
  const std::vector<float> shows = take(kept.image, stated_shows);
  stated.shows.resize(shows.size());
  std::transform(shows.begin(), shows.end(), stated.shows.begin(),
                 [](float what) { return static_cast<raytrace::Shows>(what); });
  stated.squared.assign(shows.size(), {});
  for (std::size_t part = 0; part < raytrace::error_parts; ++part) {
    const std::vector<float> squares = take(kept.image, stated_squares[part]);
    for (std::size_t pixel = 0; pixel < squares.size(); ++pixel) {
      stated.squared[pixel][part] = squares[pixel];
    }
  }
  report.relative_noise = std::sqrt(raytrace::add_up(stated).squared_error());
  // Files store layers sorted by name.
  frame.image = {kept.image.width, kept.image.height, {}};
  for (const Json& layer : facts.at("layers")) {
    const auto name = layer.get<std::string>();
    frame.image.add(name) = take(kept.image, name.c_str());
  }
  return frame;
}

}  // namespace earthshine::app
