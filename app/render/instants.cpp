// SPDX-License-Identifier: Apache-2.0
#include "app/render/instants.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include "app/console.h"
#include "app/render/draw.h"
#include "app/render/light.h"
#include "base/numbers/random.h"
#include "raytrace/frame/first_hit.h"
#include "raytrace/frame/mean_frame.h"
#include "scenes/health/coincident.h"
#include "scenes/triangle_point.h"
#include "scenes/view/motion.h"

namespace earthshine::app {
namespace {

constexpr int most_instants = 64;
constexpr double least_motion_px = 0.1;
constexpr int scale_steps = 32;     // of the picture's sides
constexpr double most_error = 0.5;  // wanted of one instant
// Of the wanted error: instants are not equally bright, and their errors add up.
constexpr double share_of_error = 0.95;
constexpr int most_repeats = 2;

// The largest scale of the picture, px/rad, in cones about its axis.
class PictureScale {
 public:
  explicit PictureScale(const raytrace::CameraModel& camera) : camera_(camera) {
    for (int k = 0; k <= scale_steps; ++k) {
      for (int i = 0; i <= scale_steps; ++i) {
        const Vec3 there = camera.projection.direction(glm::dvec2(i, k) / double(scale_steps));
        sampled_.emplace_back(angle_of(there),
                              camera.projection.px_per_rad(there, camera.columns, camera.rows));
      }
    }
    std::ranges::sort(sampled_);
    for (std::size_t k = 1; k < sampled_.size(); ++k) {
      sampled_[k].second = std::max(sampled_[k].second, sampled_[k - 1].second);
    }
  }

  // In the part of the picture that the cone through these points contains.
  [[nodiscard]] double px_per_rad(std::initializer_list<Vec3> points) const {
    double angle = 0.0;
    for (const Vec3& point : points) angle = std::max(angle, angle_of(camera_.to_camera(point)));
    const auto beyond = std::ranges::lower_bound(sampled_, angle, {}, &Sample::first);
    return (beyond == sampled_.end() ? sampled_.back() : *beyond).second;
  }
  [[nodiscard]] double largest() const { return sampled_.back().second; }

 private:
  using Sample = std::pair<double, double>;  // rad from the axis, px/rad up to there
  static double angle_of(const Vec3& v) { return std::atan2(std::hypot(v.x, v.y), v.z); }

  const raytrace::CameraModel& camera_;
  std::vector<Sample> sampled_;
};

// The largest speed of surfaces and lamps in the picture, px/s: across the line of sight, of the
// fastest corner of each triangle at the triangle's nearest point.
double fastest_px_s(const scenes::Scene& scene, const raytrace::CameraModel& camera) {
  const PictureScale scale(camera);
  double fastest = 0.0;
  const auto add = [&](double speed_m_s, const Vec3& nearest, double px_per_rad) {
    const double distance = std::max(1e-9, glm::length(nearest - camera.position));
    fastest = std::max(fastest, px_per_rad * speed_m_s / distance);
  };
  for (const scenes::Object& object : scene.objects) {
    if (!object.motion.moves()) continue;
    const Vec3 about = scenes::spin_centre(scene, object);
    const Vec3 angular_velocity = base::radians(1.0) * object.motion.spin_deg_s;
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      const auto [a, b, c] = scenes::corners_of(scene, object.first_triangle + k);
      double speed = 0.0;
      for (const Vec3& corner : {a, b, c}) {
        speed = std::max(speed, glm::length(object.motion.velocity_m_s +
                                            glm::cross(angular_velocity, corner - about)));
      }
      add(speed, scenes::nearest_on_triangle(camera.position, a, b, c),
          scale.px_per_rad({a, b, c}));
    }
  }
  for (const scenes::Lamp& lamp : scene.lamps) {
    if (!lamp.motion.moves()) continue;
    add(glm::length(lamp.motion.velocity_m_s), lamp.position, scale.px_per_rad({lamp.position}));
    // What its beam lights moves as fast, seen from the lamp.
    fastest =
        std::max(fastest, scale.largest() * base::radians(glm::length(lamp.motion.spin_deg_s)));
  }
  return fastest;
}

// Shares of the instant [from, until) in the exposures of the window's rows.
std::vector<raytrace::RowShare> row_shares(const scenes::Shutter& shutter, int rows,
                                           const raytrace::Window& window, double from,
                                           double until) {
  std::vector<raytrace::RowShare> shares;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    const double middle = shutter.middle_s((y + 0.5) / rows);
    const bool has_middle = middle >= from && middle < until;
    const double overlap = std::min(until, middle + 0.5 * shutter.exposure_s) -
                           std::max(from, middle - 0.5 * shutter.exposure_s);
    const double weight = shutter.exposure_s > 0.0 ? std::max(0.0, overlap) / shutter.exposure_s
                                                   : (has_middle ? 1.0 : 0.0);
    shares.push_back({weight, has_middle});
  }
  return shares;
}

}  // namespace

int instants_of(const scenes::Scene& scene, const scenes::Camera& camera,
                const raytrace::RenderOptions& options) {
  const scenes::Shutter shutter(camera);
  if (!shutter.is_open() || !scenes::surfaces_or_lamps_move(scene)) return 1;
  const double px =
      shutter.all_s() *
      fastest_px_s(scene, raytrace::make_camera_model(camera, options.columns, options.rows));
  if (px < least_motion_px) return 1;
  return static_cast<int>(std::clamp(std::ceil(px), 2.0, double(most_instants)));
}

void check_instants(const RenderCall& call, const scenes::Scene& scene,
                    const scenes::Camera& camera, const raytrace::RenderOptions& options) {
  if (instants_of(scene, camera, options) < 2) return;
  const char* option = !call.solution.empty() ? "--solution"
                       : call.part.in_parts() ? "--part"
                       : call.probe           ? "--probe"
                                              : nullptr;
  if (option == nullptr) return;
  throw base::Error(base::Blame::Input, option,
                    fmt::format("holds the light of one instant, and something moves during the "
                                "exposure of camera \"{}\"",
                                camera.name),
                    {}, fmt::format("Leave {} out, or set exposure_s = 0 and line_s = 0", option));
}

namespace {

// error: wanted of the mean.
raytrace::Frame mean_of_instants(const RenderContext& context, const scenes::Camera& camera,
                                 const raytrace::RenderOptions& options, int instants,
                                 double error) {
  const scenes::Shutter shutter(camera);
  const raytrace::Window window = raytrace::window_of(options);
  const double length = shutter.all_s() / instants, begin = -0.5 * shutter.all_s();
  // As many instants as a row's exposure has share its samples and its error.
  const double of_row = std::max(1.0, shutter.exposure_s / length);
  raytrace::RenderOptions own = options;
  own.error = std::min(most_error, error * std::sqrt(of_row));
  own.gather_rays = std::max(1, static_cast<int>(std::ceil(options.gather_rays / of_row)));
  own.camera_samples = std::max(2, static_cast<int>(std::ceil(options.camera_samples / of_row)));
  const auto start = std::chrono::steady_clock::now();
  own.initial_sampling_pixels = window.pixel_count();
  raytrace::MeanFrame mean(window);
  for (int k = 0; k < instants; ++k) {
    const double from = begin + k * length, until = k + 1 < instants ? from + length : 2.0 * -begin;
    const auto shares = row_shares(shutter, options.rows, window, from, until);
    const auto is_open = [](const raytrace::RowShare& row) { return row.weight > 0.0; };
    const auto first = std::ranges::find_if(shares, is_open);
    if (first == shares.end()) continue;
    const auto last = std::find_if(shares.rbegin(), shares.rend(), is_open).base();
    own.crop = {window.x, window.y + static_cast<int>(first - shares.begin()), window.columns,
                static_cast<int>(last - first)};
    own.seed = base::mix64(options.seed ^ base::mix64(static_cast<std::uint64_t>(k))) >> 11U;
    LoadedScene moved = context.loaded;
    scenes::move_surfaces_and_lamps(moved.scene, from + 0.5 * length);
    std::vector<bool> is_moved;
    for (const scenes::Object& object : moved.scene.objects) {
      is_moved.push_back(object.motion.moves());
    }
    scenes::find_coincident_faces_again(moved.scene, is_moved);
    if (moved.scene.quality.error) {
      moved.scene.quality.error =
          std::min(most_error, *moved.scene.quality.error * std::sqrt(of_row));
    }
    scenes::Camera open = camera;
    open.open_from_s = from;
    open.open_until_s = until;
    moved.asked.cameras = {&open};
    moved.groups = scenes::find_light_groups(moved.scene);  // culled lamps may come into view
    moved.effects = scenes::find_effects(moved.scene, moved.groups, moved.asked);
    const scenes::RayQuery query(moved.scene);
    StageTimes within;  // of the picture
    Common common = context.common;
    common.seed = own.seed;
    // Of the time that is left an equal share, half of it for the solution.
    RenderCall call = context.call;
    if (options.time_limit_s > 0.0) {
      const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
      own.time_limit_s =
          std::max(1e-3, 0.5 * (options.time_limit_s - gone.count()) / (instants - k));
      call.time_limit_s = own.time_limit_s;
    }
    const Solved light = find_light({call, common, moved, query, {}, Interrupt::asked}, within);
    const RenderContext instant{call, common, moved, query, light};
    mean.add(draw_frame(instant, open, own), shares);
    if (options.stop && options.stop()) break;
  }
  return mean.take();
}

}  // namespace

raytrace::Frame draw_instants(const RenderContext& context, const scenes::Camera& camera,
                              const raytrace::RenderOptions& options, int instants) {
  const raytrace::Window window = raytrace::window_of(options);
  // Where bright edges move, pixels of the mean weigh more in its error than those of an instant.
  double error = share_of_error * options.error;
  raytrace::Frame frame = mean_of_instants(context, camera, options, instants, error);
  for (int again = 0; again < most_repeats; ++again) {
    const double stated = frame.report.relative_noise;
    if (options.error <= 0.0 || stated <= options.error || frame.report.stopped ||
        options.time_limit_s > 0.0) {
      break;
    }
    error *= share_of_error * options.error / stated;
    frame = mean_of_instants(context, camera, options, instants, error);
  }
  frame.report.stopped = frame.report.stopped || (options.stop && options.stop());
  frame.report.rays.layers += raytrace::fill_first_hit(
      context.loaded.scene, context.query,
      raytrace::make_camera_model(camera, options.columns, options.rows), window, frame.image);
  return frame;
}

}  // namespace earthshine::app
