// SPDX-License-Identifier: Apache-2.0
// Synthetic situations: one target that is identified, and causes that are added one by one.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "raytrace/camera/camera.h"
#include "studies/why/why_not.h"
#include "tests/studies/discs.h"

namespace earthshine::tests {

// A disc of 60 cd/m^2 on a ground of 40, a resel for each of 120 x 120 pixels, white at 100.
struct Situation {
  static constexpr int edge = 120;

  std::vector<Disc> discs = {{60.0, 60.0, 16.0, 60.0}};
  double ground = 40.0;
  double light = 1.0;  // times the ground and the first `lit_discs` discs
  std::size_t lit_discs = 1;
  degrade::Setup cctv = with_noise(plain_cctv(edge, edge, 100.0), 1e-5);
  std::vector<studies::SourceOnTarget> sources;
  std::optional<scenes::Sun> sun;
  bool sun_in_picture = false, back_seen = false;
  double motion_px_s = 0.0;
};
using PutIn = std::function<void(Situation&)>;

inline DiscPicture picture_of(const Situation& made, double light) {
  std::vector<Disc> discs = made.discs;
  for (std::size_t k = 0; k < made.lit_discs; ++k) discs[k].luminance *= light;
  if (made.back_seen) discs[0].luminance = 0.0;
  DiscPicture picture = discs_on(made.ground * light, discs, Situation::edge, Situation::edge);
  for (std::size_t k = 0; k < discs.size(); ++k) {
    if (k > 0) picture.scene.objects[k].name = "pallet";
  }
  if (made.sun_in_picture) {
    picture.camera.filter_width_px = 4.0;
    // A disc of 0.27 degrees behind pixels of a third of a degree, with a filter that carries a
    // hundredth of it two pixels away.
    for (int y = 96; y < 104; ++y) {
      for (int x = 16; x < 24; ++x) {
        const double r = std::hypot(x - 19.5, y - 99.5);
        const float more = r < 1.0 ? 1.5e9F : r < 2.2 ? 1.5e7F : 0.0F;
        for (base::Channel& c : picture.image.channels) {
          c.values[static_cast<std::size_t>(y * Situation::edge + x)] += more;
        }
      }
    }
  }
  studies::TargetView& view = picture.plan.targets[0].view;
  if (made.back_seen) view.black_back = picture.plan.targets[0].seen;
  view.motion_px_s = {made.motion_px_s, 0.0};
  return picture;
}

struct Answer {
  studies::CameraSight sight;
  studies::WhyNot why;
};

inline Answer ask(const std::vector<PutIn>& causes) {
  Situation made;
  for (const PutIn& put_in : causes) put_in(made);
  const DiscPicture picture = picture_of(made, made.light), lit = picture_of(made, 1.0);
  for (studies::SourceOnTarget& source : made.sources) {
    if (source.off == "switched off") source.when_on = &lit.image;
  }
  Answer answer;
  answer.sight = measure_sight(picture.plan, picture.image, made.cctv);
  answer.why = why_not({picture.scene,
                        picture.camera,
                        picture.plan,
                        picture.image,
                        made.cctv,
                        answer.sight,
                        made.sun,
                        {}},
                       0, made.sources);
  return answer;
}

inline void dim(Situation& s, double light) { s.light *= light; }
inline void automatic(Situation& s) {
  s.cctv.camera.iris = degrade::IrisMode::Average;
  s.cctv.camera.iris_target = 0.5;
  s.cctv.camera.white_clip = 1.1;
}
inline studies::SourceOnTarget lamp_on(double luminance) {
  studies::SourceOnTarget lamp{"bay-6"};
  lamp.facing = lamp.lit = 1.0;
  lamp.luminance = lamp.direct = lamp.unshadowed = luminance;
  return lamp;
}
inline studies::SourceOnTarget without_light(const std::string& group, const std::string& off,
                                             double unshadowed) {
  studies::SourceOnTarget source{group, off};
  source.unshadowed = unshadowed;
  source.facing = 1.0;
  return source;
}

// The twenty causes.
inline void put_hidden(Situation& s) {
  // A disc as bright as the ground leaves a sliver of the target.
  const Disc& t = s.discs[0];
  s.discs.push_back({t.x + 1.5, t.y, t.radius + 1.0, s.ground, false});
  s.lit_discs = s.discs.size();
}
inline void put_lamp_off(Situation& s) {
  dim(s, 1e-4);
  s.sources.push_back(without_light("bay-6", "switched off", 0.0));
}
inline void put_lamp_too_far(Situation& s) {
  dim(s, 4e-3);
  s.cctv.camera.noise_a = std::max(s.cctv.camera.noise_a, 1e-3);
  s.sources.push_back(lamp_on(60.0 * s.light));
  s.sources.back().distance_m = 45.0;
}
inline void put_shadow(Situation& s) {
  dim(s, 1e-4);
  s.sources.push_back(without_light("sun", "", 60.0));
  s.sources.back().shadow_of = {"tail"};
}
inline void put_eclipse(Situation& s) {
  dim(s, 1e-4);
  s.sources.push_back(without_light("sun", "in the Earth's shadow", 60.0));
}
inline void put_night_side(Situation& s) {
  dim(s, 1e-4);
  s.sources.push_back(without_light("earth", "has its night side below", 60.0));
}
inline void put_iris_closed(Situation& s) {
  automatic(s);
  s.cctv.camera.noise_a = std::max(s.cctv.camera.noise_a, 1e-3);
  s.discs.push_back({100.0, 20.0, 15.0, 2e5, false});
}
inline void put_sun_in_frame(Situation& s) {
  automatic(s);
  s.cctv.camera.glare = 0.01;
  s.sun_in_picture = true;
  const scenes::Camera camera = discs_on(0.0, {}, Situation::edge, Situation::edge).camera;
  scenes::Sun sun;
  sun.direction = raytrace::make_camera_model(camera, Situation::edge, Situation::edge)
                      .ray(20.0, 100.0, 0.0, 0.0)
                      .direction;
  s.sun = sun;
}
inline void put_saturated(Situation& s) {
  dim(s, 25.0);
  s.cctv.camera.white_clip = 1.1;
}
inline void put_lens_blur(Situation& s) {
  s.discs[0].radius = 3.0;
  s.cctv.camera.lens_blur = 4.0;
}
inline void put_line_blur(Situation& s) {
  s.discs[0].radius = 3.0;
  s.discs[0].luminance = 45.0;
  s.cctv.camera.bandwidth_mhz = 0.05;
}
inline void put_monitor_blur(Situation& s) {
  s.discs[0].radius = 3.0;
  s.cctv.monitor.spread = degrade::Spread::Gaussian;
  s.cctv.monitor.spread_width = 12.0;
}
inline void put_noise(Situation& s) { s.cctv.camera.noise_a = 400.0; }
inline void put_out_of_view(Situation& s) { s.discs[0].x = -60.0; }
inline void put_small(Situation& s) { s.discs[0] = {60.5, 60.5, 0.6, 60.0}; }
inline void put_black_back(Situation& s) { s.back_seen = true; }
inline void put_no_contrast(Situation& s) { s.discs[0].luminance = s.ground; }
inline void put_glare(Situation& s) {
  // A fifth of the light of a bright disc over the whole picture: 1500 cd/m^2 on 60 against 40.
  s.cctv.camera.white_lux *= 50.0;
  s.cctv.camera.glare = 0.2;
  s.cctv.monitor.white_luminance = 4000.0;
  s.discs.push_back({100.0, 20.0, 15.0, 150000.0, false});
}
inline void put_lag(Situation& s) {
  s.cctv.camera.lag = 0.9;
  s.motion_px_s = 60.0 * 40.0;
  s.discs[0].radius = 8.0;
  s.discs[0].luminance = 45.0;
}
inline void put_room_light(Situation& s) {
  s.cctv.monitor.room_illuminance = 5e4;
  s.cctv.monitor.reflectance = 0.1;
}

}  // namespace earthshine::tests
