// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes/small_sources.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/light/lamp_light.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/triangle_point.h"

namespace earthshine::raytrace {
namespace {

constexpr double wanted_hits = 64.0;
constexpr double large_px2 = 1.0;  // from there on the first few samples meet it
constexpr double most_for_one = 65536.0, least_budget = 1048576.0, budget_per_pixel = 4.0;
constexpr double far_m = 1e9;  // stands for infinity

struct Source {
  Vec3 middle{0.0}, normal{0.0};
  double area_m2 = 0.0, radius_m = 0.0;
};

// Of a source, px: its middle, and how far about it pixels' centres show some of it.
struct Image {
  Source source;
  glm::dvec2 film{0.0};
  double reach = 0.0;
  float area_px2 = 0.0F;
};

class Finder {
 public:
  Finder(const ShadingScene& shared, const CameraModel& camera)
      : shared_(shared),
        camera_(camera),
        all_px2_(static_cast<std::size_t>(camera.columns) * static_cast<std::size_t>(camera.rows),
                 0.0F),
        seen_px2_(all_px2_.size(), 0.0F) {
    add_all();
    // A fine mesh has millions that are small: rays go to those alone that others do not make
    // large.
    for (const Image& image : images_) {
      const auto x = static_cast<int>(std::clamp(image.film.x, 0.0, camera_.columns - 1.0));
      const auto y = static_cast<int>(std::clamp(image.film.y, 0.0, camera_.rows - 1.0));
      if (!is_of_large(x, y) && !is_hidden(image.source)) spread(image, seen_px2_);
    }
  }

  // Of a pixel of the picture; 0: none more.
  [[nodiscard]] double wanted(int x, int y) const {
    const double area = double(seen_px2_[index(x, y)]);
    if (area <= 0.0 || is_of_large(x, y)) return 0.0;
    return std::min(most_for_one, wanted_hits / area);
  }

 private:
  void add_all() {
    const scenes::Scene& scene = shared_.scene;
    for (const scenes::Lamp& lamp : scene.lamps) {
      const scenes::LampRow& row = scenes::row_of(lamp.kind);
      if (!scenes::is_wide(lamp.kind) || !base::is_lit(lamp.exitance)) continue;
      if (glm::dot(camera_.position - lamp.position, lamp.axis) <= 0.0) continue;
      add({lamp.position, lamp.axis, row.area(lamp), row.radius(lamp)});
    }
    if (scene.sun) add_sun(*scene.sun);
    if (scene.sky_parts) {
      for (const scenes::Sun& sun : scene.sky_parts->suns) add_sun(sun);
    }
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const scenes::Material& material = scene.materials[scene.triangles[t].material];
      if (material.emits()) add_triangle(t, material.two_sided);
    }
  }

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.columns) +
           static_cast<std::size_t>(x);
  }

  void add_sun(const scenes::Sun& sun) {
    const double radius = far_m * std::tan(base::radians(sun.angular_radius_deg));
    add({camera_.position + far_m * sun.direction, -sun.direction, base::pi * radius * radius,
         radius});
  }

  void add_triangle(std::uint32_t t, bool two_sided) {
    const scenes::Corners corners = scenes::corners_of(shared_.scene, t);
    const Vec3 middle = (corners.a + corners.b + corners.c) / 3.0, normal = corners.normal();
    const double twice_area = glm::length(normal);
    if (twice_area <= 0.0) return;
    if (!two_sided && glm::dot(camera_.position - middle, normal) <= 0.0) return;
    const double radius =
        std::max({glm::length(corners.a - middle), glm::length(corners.b - middle),
                  glm::length(corners.c - middle)});
    add({middle, normal / twice_area, 0.5 * twice_area, radius});
  }

  // Its image's area to all pixels that show some of it.
  void add(const Source& source) {
    const Vec3 way = source.middle - camera_.position;
    const double depth = glm::dot(way, camera_.forward);
    if (depth <= source.radius_m) return;
    const double seen_px2 =
        source.area_m2 * camera_.film_per_m2(camera_.position, source.middle, source.normal);
    const Vec3 rim = camera_.lens_radius_m * camera_.right;
    const glm::dvec2 film = camera_.film_from(camera_.position, source.middle);
    const double blur =
        glm::length(camera_.film_from(camera_.position + rim, source.middle) - film);
    const double width = std::max(1.0, shared_.filter.width_px());
    const double area = seen_px2 / std::max(width * width, base::pi * blur * blur);
    if (area <= 0.0 || area >= large_px2) return;
    // Across the line of sight a tangent grows by the square of the secant of the angle to the
    // axis.
    const double radius = source.radius_m * glm::length(way) / (depth * depth) * camera_.rows /
                          (2.0 * camera_.half_height);
    const double reach = radius + blur + 0.5 * width;
    if (end(film.x + reach, camera_.columns) <= first(film.x - reach)) return;
    if (end(film.y + reach, camera_.rows) <= first(film.y - reach)) return;
    const Image image{source, film, reach, static_cast<float>(area)};
    images_.push_back(image);
    spread(image, all_px2_);
  }

  void spread(const Image& image, std::vector<float>& area_px2) const {
    const auto& [source, film, reach, area] = image;
    for (int y = first(film.y - reach); y < end(film.y + reach, camera_.rows); ++y) {
      for (int x = first(film.x - reach); x < end(film.x + reach, camera_.columns); ++x) {
        area_px2[index(x, y)] += area;
      }
    }
  }

  // Pixels whose centres lie there.
  static int first(double film) {
    return static_cast<int>(std::clamp(std::ceil(film - 0.5), 0.0, 1e6));
  }
  static int end(double film, int count) {
    return static_cast<int>(std::clamp(std::floor(film - 0.5) + 1.0, 0.0, double(count)));
  }

  [[nodiscard]] bool is_of_large(int x, int y) const {
    for (int ny = std::max(0, y - 1); ny <= std::min(camera_.rows - 1, y + 1); ++ny) {
      for (int nx = std::max(0, x - 1); nx <= std::min(camera_.columns - 1, x + 1); ++nx) {
        if (double(all_px2_[index(nx, ny)]) >= large_px2) return true;
      }
    }
    return false;
  }

  // By five rays, to the middle and to what is about it.
  [[nodiscard]] bool is_hidden(const Source& source) const {
    const base::Frame3 frame = base::frame_around(source.normal);
    constexpr double about = 0.7;
    for (const auto& [u, v] :
         {std::pair{0.0, 0.0}, {about, 0.0}, {-about, 0.0}, {0.0, about}, {0.0, -about}}) {
      const Vec3 to = source.middle + source.radius_m * (u * frame.tangent + v * frame.bitangent);
      const Vec3 way = to - camera_.position;
      const double distance = glm::length(way);
      const scenes::Hit hit = shared_.query.closest(camera_.position, way / distance);
      if (hit.missed() || hit.t >= distance * (1.0 - 1e-6) - shared_.query.surface_offset_m())
        return false;
      const scenes::Scene& scene = shared_.scene;
      if (scene.materials[scene.triangles[hit.triangle].material].passes_light_on()) return false;
    }
    return true;
  }

  const ShadingScene& shared_;
  const CameraModel& camera_;
  std::vector<Image> images_;
  // Of all that is in front of the camera and of what no surface hides, over what a pixel's samples
  // and the lens spread it over; per pixel of the picture.
  std::vector<float> all_px2_, seen_px2_;
};

}  // namespace

std::vector<std::uint32_t> wanted_for_small_sources(const ShadingScene& shared,
                                                    const CameraModel& camera,
                                                    const PixelSums& sums) {
  const Finder finder(shared, camera);
  // Of the whole picture, so that a crop's pixels get as many.
  double all = 0.0;
  for (int y = 0; y < camera.rows; ++y) {
    for (int x = 0; x < camera.columns; ++x) all += finder.wanted(x, y);
  }
  const double pixels = double(camera.columns) * double(camera.rows);
  const double share =
      std::min(1.0, std::max(least_budget, budget_per_pixel * pixels) / std::max(all, 1.0));
  std::vector<std::uint32_t> wanted = sums.samples;
  const Window& window = sums.window;
  for (int y = window.y; y < window.y + window.rows; ++y) {
    for (int x = window.x; x < window.x + window.columns; ++x) {
      std::uint32_t& of_pixel = wanted[window.index(x, y)];
      of_pixel = std::max(of_pixel, static_cast<std::uint32_t>(share * finder.wanted(x, y)));
    }
  }
  return wanted;
}

}  // namespace earthshine::raytrace
