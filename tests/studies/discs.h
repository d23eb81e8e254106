// SPDX-License-Identifier: Apache-2.0
// Uniform discs on a uniform ground, one resel per pixel: pictures with known values.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "degrade/parts/iris.h"
#include "studies/sight/sight.h"

namespace earthshine::tests {

struct Disc {
  double x = 0.0, y = 0.0, radius = 0.0;  // pixels
  double luminance = 0.0;                 // cd/m^2
  bool target = true;
};

struct DiscPicture {
  scenes::Scene scene;  // an object per disc, "disc-0" and on; no geometry
  scenes::Camera camera;
  studies::SightPlan plan;
  base::Image image;
};

// Later discs are in front of earlier ones. The ground has no object.
inline DiscPicture discs_on(double ground, const std::vector<Disc>& discs, int columns, int rows) {
  DiscPicture picture;
  picture.camera.look_at = Vec3(1.0, 0.0, 0.0);
  picture.image = base::make_rgb_image(columns, rows);
  studies::ObjectMap map{columns, rows, {}};
  std::vector<std::size_t> alone(discs.size(), 0);
  std::vector<std::vector<std::uint32_t>> covered(discs.size());
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      std::int32_t shown = studies::no_object;
      for (std::size_t k = 0; k < discs.size(); ++k) {
        const double dx = x + 0.5 - discs[k].x, dy = y + 0.5 - discs[k].y;
        if (dx * dx + dy * dy >= discs[k].radius * discs[k].radius) continue;
        shown = static_cast<std::int32_t>(k);
        covered[k].push_back(static_cast<std::uint32_t>(y * columns + x));
      }
      map.object.push_back(shown);
    }
  }
  for (base::Channel& channel : picture.image.channels) {
    for (std::size_t i = 0; i < map.object.size(); ++i) {
      const std::int32_t k = map.object[i];
      channel.values[i] =
          static_cast<float>(k < 0 ? ground : discs[static_cast<std::size_t>(k)].luminance);
    }
  }
  std::vector<studies::TargetView> views;
  for (std::size_t k = 0; k < discs.size(); ++k) {
    scenes::Object object;
    object.name = "disc-" + std::to_string(k);
    object.target = discs[k].target;
    picture.scene.objects.push_back(object);
    if (!discs[k].target) continue;
    studies::TargetView view = studies::find_target(map, static_cast<std::uint32_t>(k));
    view.object = static_cast<std::uint32_t>(k);
    view.name = object.name;
    view.pixels_alone = covered[k].size();
    std::vector<std::size_t> blockers(discs.size(), 0);
    for (const std::uint32_t pixel : covered[k]) {
      const std::int32_t shown = map.object[pixel];
      if (shown == static_cast<std::int32_t>(k)) continue;
      view.hidden.push_back(pixel);
      ++blockers[static_cast<std::size_t>(shown)];
    }
    for (std::uint32_t b = 0; b < blockers.size(); ++b) {
      if (blockers[b] > 0) view.hidden_by.push_back({b, blockers[b]});
    }
    views.push_back(std::move(view));
  }
  picture.plan = studies::plan_sight(picture.camera, std::move(map), std::move(views));
  return picture;
}

// A disc of 60 on a ground of 40 cd/m^2, white at 100: S = 0.6 and 0.4.
inline constexpr int disc_edge = 120;
inline DiscPicture bright_disc(double radius = 20.0) {
  return discs_on(40.0, {{60.0, 60.0, radius, 60.0}}, disc_edge, disc_edge);
}

// A linear camera without faults and with a fixed iris, white at `white_luminance`, on a linear
// monitor of one pixel per resel without spread in a dark room: black 0, white 100 cd/m^2.
inline degrade::Setup plain_cctv(int columns, int rows, double white_luminance) {
  degrade::Setup setup;
  setup.camera.iris = degrade::IrisMode::Fixed;
  setup.camera.white_lux = white_luminance * degrade::lens_transfer(setup.camera, 4.0);
  setup.camera.gamma = 1.0;
  setup.camera.black_clamp = false;
  setup.camera.white_clip = 0.0;
  setup.monitor.columns = columns;
  setup.monitor.rows = rows;
  setup.monitor.pixels_per_resel = 1;
  setup.monitor.spread = degrade::Spread::None;
  setup.monitor.gamma = 1.0;
  setup.monitor.black_luminance = 0.0;
  setup.monitor.room_illuminance = 0.0;
  return setup;
}

// The noise law a + b S + c S^2.
inline degrade::Setup with_noise(degrade::Setup setup, double a, double b = 0.0, double c = 0.0) {
  setup.camera.noise = degrade::NoiseMode::Law;
  setup.camera.noise_a = a;
  setup.camera.noise_b = b;
  setup.camera.noise_c = c;
  return setup;
}

inline studies::Sight sight_of(const DiscPicture& picture,
                               const std::optional<degrade::Setup>& cctv,
                               const studies::SightOptions& options = {}) {
  return studies::measure_sight(picture.plan, picture.image, cctv, options).targets.front();
}

}  // namespace earthshine::tests
