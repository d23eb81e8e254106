// SPDX-License-Identifier: Apache-2.0
#include "raytrace/passes/small_sources.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/light/lamp_light.h"
#include "scenes/light/narrow_beams.h"
#include "scenes/sky/sky_cells.h"
#include "scenes/triangle_point.h"

namespace earthshine::raytrace {
namespace {

constexpr double wanted_hits = 64.0;
constexpr double large_px2 = 1.0;   // from there on the first few samples meet it
constexpr double least_px2 = 1e-6;  // what sums leave of nothing is less
constexpr double most_for_one = 65536.0, least_budget = 1048576.0, budget_per_pixel = 4.0;
constexpr std::size_t stop_asked_after = 256;  // sources
constexpr double far_m = 1e9;                  // stands for infinity

struct Source {
  Vec3 middle{0.0}, normal{0.0};
  double area_m2 = 0.0, radius_m = 0.0;
};

// Of a source as a pinhole shows it, px.
struct Image {
  Source source;
  glm::dvec2 middle{0.0};
  double radius = 0.0, blur = 0.0;  // that a lens makes of each of its points
  double area_px2 = 0.0;
};

// Area per pixel of the picture. What is added to a rectangle is kept at its corners until it is
// summed up, since a lens spreads each of a million sources over thousands of pixels.
class AreaMap {
 public:
  AreaMap(int columns, int rows)
      : columns_(columns),
        rows_(rows),
        values_(static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1), 0.0) {}

  // To pixels whose centres are within `reach` of the place, across and down.
  void add(const glm::dvec2& middle, double reach, double area) {
    const int x0 = edge(middle.x - reach, columns_), x1 = edge(middle.x + reach, columns_);
    const int y0 = edge(middle.y - reach, rows_), y1 = edge(middle.y + reach, rows_);
    at(x0, y0) += area;
    at(x1, y1) += area;
    at(x1, y0) -= area;
    at(x0, y1) -= area;
  }
  void sum_up() {
    for (int y = 0; y < rows_; ++y) {
      for (int x = 1; x < columns_; ++x) at(x, y) += at(x - 1, y);
    }
    for (int y = 1; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) at(x, y) += at(x, y - 1);
    }
  }
  [[nodiscard]] double operator()(int x, int y) const { return values_[index(x, y)]; }
  // At a place of the picture and in the pixels beside it.
  [[nodiscard]] double most_about(const glm::dvec2& place) const {
    const int x = static_cast<int>(std::clamp(place.x, 0.0, columns_ - 1.0));
    const int y = static_cast<int>(std::clamp(place.y, 0.0, rows_ - 1.0));
    double most = 0.0;
    for (int ny = std::max(0, y - 1); ny <= std::min(rows_ - 1, y + 1); ++ny) {
      for (int nx = std::max(0, x - 1); nx <= std::min(columns_ - 1, x + 1); ++nx) {
        most = std::max(most, (*this)(nx, ny));
      }
    }
    return most;
  }

 private:
  // The first pixel whose centre lies behind it.
  static int edge(double film, int count) {
    return static_cast<int>(std::clamp(std::ceil(film - 0.5), 0.0, double(count)));
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_ + 1) +
           static_cast<std::size_t>(x);
  }
  double& at(int x, int y) { return values_[index(x, y)]; }

  int columns_, rows_;
  std::vector<double> values_;
};

class Finder {
 public:
  Finder(const ShadingScene& shared, const CameraModel& camera, const std::function<bool()>& stop)
      : shared_(shared), camera_(camera), seen_(camera.columns, camera.rows) {
    add_all();
    AreaMap sharp(camera.columns, camera.rows);
    for (const Image& image : images_) {
      sharp.add(image.middle, image.radius + 0.5, image.area_px2);
    }
    sharp.sum_up();
    const double width = std::max(1.0, shared.filter.width_px());
    for (std::size_t k = 0; k < images_.size(); ++k) {
      if (k % stop_asked_after == 0 && stop()) break;
      const Image& image = images_[k];
      // A fine mesh has millions that are small and together large.
      if (sharp.most_about(image.middle) >= large_px2 || is_hidden(image.source)) continue;
      const double spread_px2 = std::max(width * width, base::pi * image.blur * image.blur);
      seen_.add(image.middle, image.radius + image.blur + 0.5 * width, image.area_px2 / spread_px2);
    }
    seen_.sum_up();
  }

  // Of a pixel of the picture; 0: none more.
  [[nodiscard]] double wanted(int x, int y) const {
    const double area = seen_(x, y);
    return area < least_px2 || area >= large_px2 ? 0.0 : std::min(most_for_one, wanted_hits / area);
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
    for (const scenes::Beam& beam : scenes::narrow_beams(scene.lamps)) add_lit(beam);
  }

  // What a beam lights, a piece for each of its rays.
  void add_lit(const scenes::Beam& beam) {
    const scenes::Scene& scene = shared_.scene;
    for (const scenes::Beam::Ray& ray : beam.rays) {
      const scenes::Hit hit = shared_.query.closest(beam.origin, ray.direction);
      if (hit.missed()) continue;
      const Vec3 normal = (hit.front ? 1.0 : -1.0) *
                          glm::normalize(scenes::corners_of(scene, hit.triangle).normal());
      const Vec3 at = scenes::hit_position(scene, hit);
      const bool is_black =
          !hit.front && !scene.materials[scene.triangles[hit.triangle].material].two_sided;
      if (is_black || glm::dot(camera_.position - at, normal) <= 0.0) continue;
      const double area_m2 = ray.solid_angle_sr * hit.t * hit.t / -glm::dot(ray.direction, normal);
      add({at, normal, area_m2, std::sqrt(area_m2 / base::pi)});
    }
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

  void add(const Source& source) {
    const Vec3 way = source.middle - camera_.position;
    const double depth = glm::dot(way, camera_.forward);
    if (depth <= source.radius_m) return;
    Image image{source};
    image.area_px2 =
        source.area_m2 * camera_.film_per_m2(camera_.position, source.middle, source.normal);
    if (image.area_px2 >= large_px2) return;
    image.middle = camera_.film_from(camera_.position, source.middle);
    const Vec3 rim = camera_.position + camera_.lens_radius_m * camera_.right;
    image.blur = glm::length(camera_.film_from(rim, source.middle) - image.middle);
    // Across the line of sight a tangent grows by the square of the secant of the angle to the
    // axis.
    image.radius = source.radius_m * glm::length(way) / (depth * depth) * camera_.rows /
                   (2.0 * camera_.half_height);
    const double reach = image.radius + image.blur + shared_.filter.width_px();
    const glm::dvec2 beyond =
        glm::max(-image.middle, image.middle - glm::dvec2(camera_.columns, camera_.rows));
    if (std::max(beyond.x, beyond.y) <= reach) images_.push_back(image);
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
      if (hit.missed() || hit.t >= distance * (1.0 - 1e-6) - shared_.query.offset_m(hit.triangle)) {
        return false;
      }
      const scenes::Scene& scene = shared_.scene;
      if (scene.materials[scene.triangles[hit.triangle].material].passes_light_on()) return false;
    }
    return true;
  }

  const ShadingScene& shared_;
  const CameraModel& camera_;
  std::vector<Image> images_;
  AreaMap
      seen_;  // of what no surface hides, over what a pixel's samples and the lens spread it over
};

}  // namespace

std::vector<std::uint32_t> wanted_for_small_sources(const ShadingScene& shared,
                                                    const CameraModel& camera,
                                                    const PixelSums& sums,
                                                    const std::function<bool()>& stop) {
  const Finder finder(shared, camera, stop);
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
