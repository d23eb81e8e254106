// SPDX-License-Identifier: Apache-2.0
// The table. A new stage is a file with its function and a row here.
#include <cmath>

#include "degrade/chain.h"

namespace earthshine::degrade {
namespace {

NoiseKey noise_key(const Setup& setup) {
  return {setup.options.seed, setup.options.frame, setup.options.view};
}

// A stage that only replaces the picture.
template <class F>
Frame with_picture(Frame frame, F f) {
  frame.picture = f(std::move(frame.picture), frame.report);
  return frame;
}

constexpr auto always = [](const Setup&, const Report*) { return true; };

constexpr Stage table[] = {
    {"sensor-grid", Part::Camera, "cd/m^2", "cd/m^2", "area average onto 300 rows", always,
     [](Frame frame, const Setup& setup) {
       const Picture& in = frame.picture;
       const Grid grid = picture_grid(in.columns, in.rows, setup.monitor);
       frame.report.sensor = grid;
       frame.picture =
           apply(in, area_average(in.columns, grid.columns), area_average(in.rows, grid.rows));
       return frame;
     }},
    {"iris", Part::Camera, "cd/m^2", "cd/m^2", "finds N and the gain; the picture passes", always,
     [](Frame frame, const Setup& setup) {
       frame.report.exposure = expose(setup.camera, metered_luminance(frame.picture, setup.camera));
       return frame;
     }},
    {"lens", Part::Camera, "cd/m^2", "lx", "E = pi tau L / (4 N^2)", always,
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report& report) {
         return through_lens(std::move(p), setup.camera, report.exposure.f_number);
       });
     }},
    {"glare", Part::Camera, "lx", "lx", "E = (1 - g) E + g mean(E)",
     [](const Setup& setup, const Report*) { return setup.camera.glare > 0.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return add_glare(std::move(p), setup.camera.glare);
       });
     }},
    {"conversion", Part::Camera, "lx", "signal", "S = E / E_white", always,
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return to_signal(std::move(p), setup.camera.white_lux);
       });
     }},
    {"saturation", Part::Camera, "signal", "signal", "S = min(S, S_most)",
     [](const Setup& setup, const Report*) { return setup.camera.saturation > 0.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return limit_above(std::move(p), setup.camera.saturation);
       });
     }},
    {"signal-noise", Part::Camera, "signal", "signal", "variance b S + c S^2",
     [](const Setup& setup, const Report*) {
       const NoiseLaw law = noise_law(setup.camera);
       return law.b > 0.0 || law.c > 0.0;
     },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report& report) {
         return add_signal_noise(std::move(p), report.noise, noise_key(setup));
       });
     }},
    {"blur", Part::Camera, "signal", "signal",
     "discrete Gaussian, sigma_h along and sigma_v across lines",
     [](const Setup& setup, const Report*) {
       return setup.camera.blur_h > 0.0 || setup.camera.blur_v > 0.0;
     },
     [](Frame frame, const Setup& setup) {
       const Picture& in = frame.picture;
       frame.picture = apply(in, gaussian_blur(in.columns, setup.camera.blur_h),
                             gaussian_blur(in.rows, setup.camera.blur_v));
       return frame;
     }},
    {"read-noise", Part::Camera, "signal", "signal", "variance a",
     [](const Setup& setup, const Report*) { return noise_law(setup.camera).a > 0.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report& report) {
         return add_read_noise(std::move(p), report.noise, noise_key(setup));
       });
     }},
    {"black-clamp", Part::Camera, "signal", "signal", "S = max(S, 0)",
     [](const Setup& setup, const Report*) { return setup.camera.black_clamp; },
     [](Frame frame, const Setup&) {
       return with_picture(std::move(frame),
                           [](Picture p, const Report&) { return limit_below_zero(std::move(p)); });
     }},
    {"gain", Part::Camera, "signal", "signal", "S = G S",
     [](const Setup& setup, const Report* found) {
       if (found != nullptr) return found->exposure.gain != 1.0;
       return setup.camera.iris == IrisMode::Fixed ? setup.camera.gain_db > 0.0
                                                   : setup.camera.gain_max_db > 0.0;
     },
     [](Frame frame, const Setup&) {
       return with_picture(std::move(frame), [](Picture p, const Report& report) {
         return amplify(std::move(p), report.exposure.gain);
       });
     }},
    {"levels", Part::Camera, "signal", "signal",
     "counts white and black resels; the picture passes", always,
     [](Frame frame, const Setup&) {
       const double black_noise = frame.report.exposure.gain * std::sqrt(frame.report.noise.a);
       frame.report.levels = measure_levels(frame.picture, black_noise);
       return frame;
     }},
    {"white-clip", Part::Camera, "signal", "signal", "S = min(S, S_clip)",
     [](const Setup& setup, const Report*) { return setup.camera.white_clip > 0.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return limit_above(std::move(p), setup.camera.white_clip);
       });
     }},
    {"camera-gamma", Part::Camera, "signal", "line signal", "v = S^(1/gamma)",
     [](const Setup& setup, const Report*) { return setup.camera.gamma != 1.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return encode_gamma(std::move(p), setup.camera.gamma);
       });
     }},
    {"quantisation", Part::Camera, "line signal", "line signal", "nearest of 2^bits levels",
     [](const Setup& setup, const Report*) { return setup.camera.bits > 0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return quantise(std::move(p), setup.camera.bits);
       });
     }},
    {"screen", Part::Monitor, "line signal", "cd/m^2", "I = I_b + (I_w - I_b) v^gamma", always,
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         return drive_screen(std::move(p), setup.monitor);
       });
     }},
    {"spread", Part::Monitor, "cd/m^2", "cd/m^2", "point spread, on the finer grid of pixels",
     [](const Setup& setup, const Report*) {
       return setup.monitor.spread != Spread::None || setup.monitor.pixels_per_resel > 1;
     },
     [](Frame frame, const Setup& setup) {
       frame.picture =
           spread_on_screen(frame.picture, setup.monitor, frame.report.clipped_negative_light);
       return frame;
     }},
    {"room-light", Part::Monitor, "cd/m^2", "cd/m^2", "I = I + reflectance E_room / pi",
     [](const Setup& setup, const Report*) { return room_luminance(setup.monitor) > 0.0; },
     [](Frame frame, const Setup& setup) {
       return with_picture(std::move(frame), [&](Picture p, const Report&) {
         const double veil = room_luminance(setup.monitor);
         return transform(std::move(p), [&](double i) { return i + veil; });
       });
     }},
};

}  // namespace

std::span<const Stage> stages() { return table; }

}  // namespace earthshine::degrade
