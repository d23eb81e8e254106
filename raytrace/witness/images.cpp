// SPDX-License-Identifier: Apache-2.0
#include "raytrace/witness/images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers/sobol_set.h"
#include "raytrace/tuning.h"
#include "scenes/effects/shining.h"
#include "scenes/light/narrow_beams.h"
#include "scenes/reflect/brdf.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

using base::pi;

constexpr double far_m = 1e9;  // represents infinity
constexpr std::size_t stop_asked_after = 1024;
constexpr int facet_points = 64;                     // to estimate the part that shows a source
constexpr double least_share = 0.25 / facet_points;  // of a facet if only its nearest point shows
                                                     // the source

using Source = WitnessSource;

struct Facet {
  scenes::Corners corners;
  Vec3 normal{0.0};       // unit, on the camera's side
  double height_m = 0.0;  // height of the camera above it
  double area_m2 = 0.0, offset_m = 0.0;
  const scenes::Material* material = nullptr;
  bool is_mirror = false, is_glossy = false;
};

// The part of a facet that shows a disc of that angular radius around a direction of view, and the
// centre of the part.
struct ShownPart {
  double share = 0.0;
  Vec3 middle{0.0};
};

ShownPart shown_part(const scenes::Corners& corners, const Vec3& eye, const Vec3& view,
                     double angle) {
  const double least = std::cos(angle);
  ShownPart shown;
  double met = 0.0;
  for (int k = 0; k < facet_points; ++k) {
    // A low-discrepancy (additive) sequence, folded onto the triangle.
    double u = std::fmod(0.5 + k * base::r2_u, 1.0), v = std::fmod(0.5 + k * base::r2_v, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vec3 point = corners.a + u * (corners.b - corners.a) + v * (corners.c - corners.a);
    if (glm::dot(glm::normalize(point - eye), view) < least) continue;
    shown.middle += point;
    met += 1.0;
  }
  if (met > 0.0) shown.middle /= met;
  shown.share = met / facet_points;
  return shown;
}

class ImageFinder {
 public:
  ImageFinder(WitnessScene& scene, SpotMap& images, SpotMap& lit)
      : scene_(scene), shared_(scene.shared), camera_(scene.camera), images_(images), lit_(lit) {}
  void add_straight();
  void add_beams();
  void add_reflections();

 private:
  [[nodiscard]] std::vector<Facet> find_facets() const;
  void reflect(const Facet& facet, const Source& source);
  void add_highlight(const Facet& facet, const Source& source, const Vec3& at);
  void add_visible(const Facet& facet, const Source& source, const Vec3& at, Spot spot,
                   SpotMap& spots);
  [[nodiscard]] bool counts(const Spot& spot) const {
    return spot.area_px2 < tuning::large_px2 && spot.area_px2 * spot.luminance > scene_.least &&
           images_.contains(spot);
  }
  [[nodiscard]] double px2_per_sr(const Vec3& direction) const {
    return camera_.film_per_m2(camera_.position, camera_.position + direction, -direction);
  }
  [[nodiscard]] double visible_share(const Source& source);

  WitnessScene& scene_;
  const ShadingScene& shared_;
  const CameraModel& camera_;
  SpotMap &images_, &lit_;  // of sources; of surfaces
};

std::vector<Source> list_sources(const ShadingScene& shared) {
  std::vector<Source> sources;
  const scenes::Scene& scene = shared.scene;
  const auto add_sun = [&](const scenes::Sun& sun, double in_view) {
    Source source;
    source.middle = sun.direction;
    source.is_distant = true;
    source.angle_rad = base::radians(sun.angular_radius_deg);
    source.luminance = base::luminance(scenes::sun_radiance(sun));
    source.illuminance_lx = in_view * base::luminance(sun.illuminance_lx);
    sources.push_back(source);
  };
  using Kind = scenes::ShiningLight::Kind;
  for (const auto& [kind, group, k] : scenes::shining_lights(shared)) {
    if (kind == Kind::Sun) add_sun(*scene.sun, scenes::visible_sun_share(scene));
    if (kind == Kind::SunPart) add_sun(scene.sky_parts->suns[k], 1.0);
    if (kind == Kind::Lamp) {
      const scenes::Lamp& lamp = scene.lamps[k];
      Source source;
      source.lamp = &lamp;
      source.middle = lamp.is_distant() ? -lamp.axis : lamp.position;
      source.is_distant = lamp.is_distant();
      source.illuminance_lx = base::luminance(lamp.illuminance_lx);
      if (scenes::is_wide(lamp.kind)) {
        source.normal = lamp.axis;
        source.area_m2 = scenes::row_of(lamp.kind).area(lamp);
        source.radius_m = scenes::row_of(lamp.kind).radius(lamp);
        source.luminance = base::luminance(lamp.exitance) / pi;
      }
      sources.push_back(source);
    }
  }
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const scenes::Material& material = scene.materials[scene.triangles[t].material];
    if (!material.emits()) continue;
    const scenes::Corners corners = scenes::corners_of(scene, t);
    const double twice_area = glm::length(corners.normal());
    if (twice_area <= 0.0) continue;
    Source source;
    source.middle = (corners.a + corners.b + corners.c) / 3.0;
    source.normal = corners.normal() / twice_area;
    source.area_m2 = 0.5 * twice_area;
    source.radius_m =
        std::max({glm::length(corners.a - source.middle), glm::length(corners.b - source.middle),
                  glm::length(corners.c - source.middle)});
    source.luminance = base::luminance(material.emit) / pi;
    source.is_two_sided = material.two_sided;
    sources.push_back(source);
  }
  return sources;
}

void ImageFinder::add_straight() {
  struct Image {
    Spot spot;
    Source source;
  };
  std::vector<Image> images;
  SpotMap sharp(camera_, 1.0);  // total image areas, as luminance 1
  for (Source source : scene_.sources()) {
    if (source.luminance <= 0.0 || (source.is_distant && source.angle_rad <= 0.0)) continue;
    if (source.is_distant) {
      source.radius_m = far_m * std::tan(source.angle_rad);
      source.area_m2 = pi * source.radius_m * source.radius_m;
      source.normal = -source.middle;
      source.middle = camera_.position + far_m * source.middle;
    }
    const Vec3 offset = source.middle - camera_.position;
    if (glm::dot(offset, camera_.forward) <= source.radius_m) continue;
    if (!source.is_two_sided && glm::dot(offset, source.normal) >= 0.0) continue;
    Spot spot = scene_.spot_at(source.middle, source.radius_m);
    spot.area_px2 =
        source.area_m2 * camera_.film_per_m2(camera_.position, source.middle, source.normal);
    spot.luminance = source.luminance;
    if (!counts(spot)) continue;
    images.push_back({spot, source});
    sharp.add({spot.film, spot.radius_px, 0.0, spot.area_px2, 1.0});
  }
  std::size_t asked = 0;
  for (const Image& image : images) {
    if (++asked % stop_asked_after == 0 && scene_.stops()) return;
    // The triangles of a fine mesh may be small and together large.
    if (sharp.most_around(image.spot.film) >= tuning::large_px2) continue;
    Spot spot = image.spot;
    spot.area_px2 *= visible_share(image.source);
    if (spot.area_px2 > 0.0) images_.add(spot);
  }
}

// Spots lit by narrow beams, one for each of their rays.
void ImageFinder::add_beams() {
  const scenes::Scene& scene = shared_.scene;
  for (const scenes::Beam& beam : scenes::narrow_beams(scene.lamps)) {
    const auto lamp = std::ranges::find_if(
        scene.lamps, [&](const scenes::Lamp& one) { return one.position == beam.origin; });
    if (lamp == scene.lamps.end()) continue;
    for (const scenes::Beam::Ray& ray : beam.rays) {
      const scenes::Hit hit = scene_.closest(beam.origin, ray.direction);
      if (hit.missed()) continue;
      const scenes::Material& material = scene.materials[scene.triangles[hit.triangle].material];
      const Vec3 normal = (hit.front ? 1.0 : -1.0) * scenes::triangle_normal(scene, hit.triangle);
      const Vec3 at = scenes::hit_position(scene, hit);
      if (!hit.front && !material.two_sided) continue;
      if (glm::dot(camera_.position - at, normal) <= 0.0) continue;
      if (glm::dot(at - camera_.position, camera_.forward) <= 0.0) continue;
      const double cosine = -glm::dot(ray.direction, normal);
      const double area_m2 = ray.solid_angle_sr * hit.t * hit.t / cosine;
      Spot spot = scene_.spot_at(at, std::sqrt(area_m2 / pi));
      spot.area_px2 = area_m2 * camera_.film_per_m2(camera_.position, at, normal);
      const Rgb light = scenes::sample_lamp(*lamp, at, 0.5, 0.5).normal_illuminance_lx * cosine;
      spot.luminance = base::luminance(light * material.diffuse) / pi;
      if (!counts(spot)) continue;
      const Vec3 start = at + shared_.query.offset_m(hit.triangle) * normal;
      const Vec3 offset = camera_.position - start;
      if (scene_.share(start, glm::normalize(offset), glm::length(offset)) > 0.0) lit_.add(spot);
    }
  }
}

void ImageFinder::add_reflections() {
  const scenes::Scene& scene = shared_.scene;
  std::vector<Facet> facets;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const scenes::Material& material = scene.materials[scene.triangles[t].material];
    Facet facet;
    facet.is_mirror = base::is_lit(material.mirror);
    facet.is_glossy =
        base::is_lit(material.specular) && material.shininess >= tuning::least_shininess;
    if (!facet.is_mirror && !facet.is_glossy) continue;
    facet.corners = scenes::corners_of(scene, t);
    const Vec3 normal = facet.corners.normal();
    facet.height_m = glm::dot(camera_.position - facet.corners.a, normal);
    const bool both = material.two_sided || scenes::is_straight_glass(material);
    const double twice_area = glm::length(normal);
    if (facet.height_m == 0.0 || (facet.height_m < 0.0 && !both) || twice_area <= 0.0) continue;
    const double side = facet.height_m > 0.0 ? 1.0 : -1.0;
    facet.normal = side / twice_area * normal;
    facet.height_m *= side / twice_area;
    facet.area_m2 = 0.5 * twice_area;
    facet.offset_m = shared_.query.offset_m(t);
    facet.material = &material;
    facets.push_back(facet);
  }
  const bool too_many =
      double(facets.size()) * double(scene_.sources().size()) > tuning::most_pairs;
  std::size_t asked = 0;
  for (const Facet& facet : facets) {
    if (++asked % stop_asked_after == 0 && scene_.stops()) return;
    for (const Source& source : scene_.sources()) {
      // Lamps and Suns come first.
      if (too_many && source.lamp == nullptr && !source.is_distant) break;
      reflect(facet, source);
    }
  }
}

void ImageFinder::reflect(const Facet& facet, const Source& source) {
  const Vec3& n = facet.normal;
  Vec3 view(0.0);  // unit, from the camera toward the source's image
  double image_m = std::numeric_limits<double>::infinity();
  if (source.is_distant) {
    const double cosine = glm::dot(source.middle, n);
    if (cosine <= 0.0) return;
    view = source.middle - 2.0 * cosine * n;
  } else {
    const double height = glm::dot(source.middle - facet.corners.a, n);
    if (height <= 0.0) return;
    const Vec3 offset = source.middle - 2.0 * height * n - camera_.position;
    image_m = glm::length(offset);
    view = offset / image_m;
  }
  const Vec3 crossing = camera_.position - facet.height_m / glm::dot(view, n) * view;
  const Vec3 at =
      scenes::nearest_on_triangle(crossing, facet.corners.a, facet.corners.b, facet.corners.c);
  const Vec3 offset = at - camera_.position;
  if (glm::dot(offset, camera_.forward) <= 0.0) return;
  if (facet.is_glossy) add_highlight(facet, source, at);
  if (!facet.is_mirror || source.luminance <= 0.0) return;
  const double angle = source.is_distant ? source.angle_rad : source.radius_m / image_m;
  const double off = glm::length(glm::cross(offset, view)) / glm::length(offset);
  if (off > angle || glm::dot(offset, view) <= 0.0) return;
  double image_px2 = 0.0;
  if (source.is_distant) {
    image_px2 = pi * angle * angle * px2_per_sr(view);
  } else {
    const Vec3 reflected = source.normal - 2.0 * glm::dot(source.normal, n) * n;
    if (!source.is_two_sided && glm::dot(view, reflected) >= 0.0) return;
    image_px2 = source.area_m2 *
                camera_.film_per_m2(camera_.position, camera_.position + image_m * view, reflected);
  }
  const ShownPart shown = shown_part(facet.corners, camera_.position, view, angle);
  const Vec3 on_facet = shown.share > 0.0 ? shown.middle : at;
  Spot spot = scene_.spot_at(on_facet, 0.0);
  const double facet_px2 =
      facet.area_m2 * camera_.film_per_m2(camera_.position, on_facet, facet.normal);
  spot.area_px2 = std::min(image_px2, std::max(shown.share, least_share) * facet_px2);
  spot.radius_px = std::sqrt(spot.area_px2 / pi);
  spot.luminance = source.luminance * base::luminance(facet.material->mirror);
  add_visible(facet, source, on_facet, spot, images_);
}

// The lobe cos^n as a Gaussian of variance 1 / n, widened by the source's disc of angular radius r,
// whose variance along an axis is r^2 / 4.
void ImageFinder::add_highlight(const Facet& facet, const Source& source, const Vec3& at) {
  const Vec3 to_camera = camera_.position - at;
  const double camera_m = glm::length(to_camera);
  const Vec3 out = to_camera / camera_m;
  const double seen = glm::dot(out, facet.normal);
  const scenes::Brdf brdf{*facet.material, Rgb(0.0), facet.normal, 2.0 * seen * facet.normal - out,
                          seen};
  const Vec3 offset = source.is_distant ? source.middle : source.middle - at;
  const double source_m =
      source.is_distant ? std::numeric_limits<double>::infinity() : glm::length(offset);
  const Vec3 in = source.is_distant ? offset : offset / source_m;
  const double angle = source.is_distant ? source.angle_rad : source.radius_m / source_m;
  const double lobe_variance = 1.0 / facet.material->shininess;
  const double variance = lobe_variance + 0.25 * angle * angle;
  const double off2 = 2.0 * (1.0 - glm::dot(in, brdf.mirrored));  // squared angle from the lobe's
                                                                  // centre
  const double cosine = glm::dot(in, facet.normal);
  if (off2 > tuning::most_deviations2 * variance || cosine <= 0.0) return;
  const double lobe = lobe_variance / variance * std::exp(-0.5 * off2 / variance) *
                      base::luminance(brdf.eval_specular(brdf.mirrored, cosine));
  Spot spot = scene_.spot_at(at, 0.0);
  // A turn of the view by an angle turns the direction in the lobe by a larger one.
  const double turn = 1.0 + camera_m / source_m;
  const double lobe_px2 = 2.0 * pi * variance / (turn * turn) * px2_per_sr(-out);
  spot.area_px2 =
      std::min(lobe_px2, facet.area_m2 * camera_.film_per_m2(camera_.position, at, facet.normal));
  spot.radius_px = std::sqrt(spot.area_px2 / pi);
  spot.luminance = source.illuminance(at) * cosine / pi * lobe;
  add_visible(facet, source, at, spot, lit_);
}

void ImageFinder::add_visible(const Facet& facet, const Source& source, const Vec3& at, Spot spot,
                              SpotMap& spots) {
  if (!counts(spot)) return;
  // Away from the edge, where the nearest point of a facet often is.
  const Vec3 middle = (facet.corners.a + facet.corners.b + facet.corners.c) / 3.0;
  const Vec3 start = at + 1e-3 * (middle - at) + facet.offset_m * facet.normal;
  const Vec3 back = camera_.position - start;
  const Vec3 on = source.is_distant ? far_m * source.middle : source.middle - start;
  const double reach = glm::length(on) * (1.0 - 1e-6) - facet.offset_m;
  const double seen = scene_.share(start, glm::normalize(back), glm::length(back));
  if (seen <= 0.0) return;
  spot.luminance *= seen * scene_.share(start, glm::normalize(on), reach);
  if (spot.luminance > 0.0) spots.add(spot);
}

// By five rays: to the centre and around it.
double ImageFinder::visible_share(const Source& source) {
  const base::Frame3 frame = base::frame_around(source.normal);
  constexpr double about = 0.7;
  double visible = 0.0;
  for (const auto& [u, v] :
       {std::pair{0.0, 0.0}, {about, 0.0}, {-about, 0.0}, {0.0, about}, {0.0, -about}}) {
    const Vec3 to = source.middle + source.radius_m * (u * frame.tangent + v * frame.bitangent);
    const Vec3 offset = to - camera_.position;
    const double distance = glm::length(offset);
    const scenes::Hit hit = scene_.closest(camera_.position, offset / distance);
    const scenes::Scene& scene = shared_.scene;
    const bool is_open = hit.missed() ||
                         hit.t >= distance * (1.0 - 1e-6) - shared_.query.offset_m(hit.triangle) ||
                         scene.materials[scene.triangles[hit.triangle].material].passes_light_on();
    visible += is_open ? 0.2 : 0.0;
  }
  return visible;
}

}  // namespace

WitnessScene::WitnessScene(const ShadingScene& of, const CameraModel& through, double least_light,
                           std::function<bool()> stop)
    : shared(of),
      camera(through),
      least(least_light),
      stop_(std::move(stop)),
      sources_(list_sources(of)) {}

Spot WitnessScene::spot_at(const Vec3& point, double radius_m) const {
  Spot spot;
  const Vec3 offset = point - camera.position;
  spot.film = camera.film_from(camera.position, point);
  const Vec3 rim = camera.position + camera.lens_radius_m * camera.right;
  spot.blur_px = glm::length(camera.film_from(rim, point) - spot.film);
  spot.radius_px = radius_m / glm::length(offset) *
                   camera.projection.film_per_rad(camera.to_camera(point)) * camera.rows /
                   (2.0 * camera.projection.half_height);
  return spot;
}

double WitnessSource::illuminance(const Vec3& point) const {
  if (is_distant) return illuminance_lx;
  if (lamp != nullptr) {
    return base::luminance(scenes::sample_lamp(*lamp, point, 0.5, 0.5).normal_illuminance_lx);
  }
  const Vec3 offset = middle - point;
  const double distance2 = glm::dot(offset, offset);
  const double cosine = -glm::dot(offset, normal) / std::sqrt(distance2);
  return luminance * area_m2 / distance2 *
         (is_two_sided ? std::abs(cosine) : std::max(0.0, cosine));
}

double WitnessScene::share(const Vec3& from, const Vec3& direction, double reach_m,
                           std::uint32_t mirror) {
  scenes::RayPacket packet;
  shared.query.set(packet, 0, from, direction, reach_m);
  Rgb found(0.0);
  shared.query.light_shares(packet, &mirror, 1, &found);
  ++rays_;
  return base::luminance(found);
}

void add_images(WitnessScene& scene, SpotMap& images, SpotMap& lit) {
  ImageFinder finder(scene, images, lit);
  finder.add_straight();
  finder.add_beams();
  finder.add_reflections();
}

}  // namespace earthshine::raytrace
