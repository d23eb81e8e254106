// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/light/emitters.h"
#include "scenes/light/photometry.h"
#include "scenes/reflect/brdf.h"

namespace earthshine::scenes {
namespace {

using base::pi;

double beam_cosine(const Lamp& lamp) { return std::cos(base::radians(lamp.beam_deg / 2)); }

Vec3 disk_point(const Lamp& lamp, double u, double v) {
  const base::Frame3 frame = base::frame_around(lamp.axis);
  const double r = lamp.radius_m * std::sqrt(u), phi = 2.0 * pi * v;
  return lamp.position + r * (std::cos(phi) * frame.tangent + std::sin(phi) * frame.bitangent);
}

double surface_area(const Lamp& lamp) { return row_of(lamp.kind).area(lamp); }

FlatEmitter rectangle(const Lamp& lamp) {
  return {lamp.position - 0.5 * (lamp.edge_u + lamp.edge_v),
          lamp.edge_u,
          lamp.edge_v,
          lamp.axis,
          surface_area(lamp),
          lamp.exitance,
          false,
          FlatShape::Parallelogram};
}

// Near a disk, points uniform over its area have unbounded noise: on a floor a thousandth of the
// radius away, one in a million of them gives half of the light. There the samples are uniform in
// the solid angle of the square around the disk, and samples beside the disk give 0. On the axis
// both methods have equal noise where the height equals the radius (a sixth of the mean square).
LightSample sample_disk(const Lamp& lamp, const Vec3& point, double u, double v, Spread spread) {
  const Vec3 offset = lamp.position - point;
  const double radius2 = lamp.radius_m * lamp.radius_m;
  if (spread == Spread::OverArea || glm::dot(offset, offset) > radius2) {
    return toward_area(point, disk_point(lamp, u, v), lamp.axis, false, lamp.exitance,
                       surface_area(lamp));
  }
  const base::Frame3 frame = base::frame_around(lamp.axis);
  const Vec3 along = lamp.radius_m * frame.tangent, across = lamp.radius_m * frame.bitangent;
  const FlatEmitter square{lamp.position - along - across,
                           2.0 * along,
                           2.0 * across,
                           lamp.axis,
                           4.0 * radius2,
                           lamp.exitance,
                           false,
                           FlatShape::Parallelogram};
  const LightSample sample = sample_flat(square, point, u, v, spread);
  const Vec3 from_centre = sample.distance_m * sample.direction - offset;
  return glm::dot(from_centre, from_centre) > radius2 ? LightSample{} : sample;
}

// Intensity in a unit direction from the lamp, relative to intensity_cd.
double relative_intensity(const Lamp& lamp, const Vec3& direction) {
  if (lamp.kind == LampKind::Point) return 1.0;
  const double cosine = glm::dot(direction, lamp.axis);
  if (lamp.kind == LampKind::Spot) return spot_profile(lamp, cosine);
  const double along_c0 = glm::dot(direction, lamp.c0);
  const double along_c90 = glm::dot(direction, glm::cross(lamp.c0, lamp.axis));
  // By the tangent: near the axis the cosine has lost half of the angle's digits.
  return lamp.photometry->relative(std::atan2(std::hypot(along_c0, along_c90), cosine),
                                   std::atan2(along_c90, along_c0));
}

}  // namespace

ShadowSegment shadow_segment(const LightSample& sample, const Vec3& point, const Vec3& origin) {
  constexpr double short_of_it = 1e-5;
  if (!std::isfinite(sample.distance_m)) return {sample.direction, sample.distance_m};
  const Vec3 offset = point + sample.distance_m * sample.direction + sample.lift_m - origin;
  const double length_m = glm::length(offset);
  // The source lies between the offsets of both surfaces: they touch.
  if (glm::dot(offset, sample.direction) <= 0.0) return {sample.direction, 0.0};
  return {offset / length_m, length_m * (1.0 - short_of_it)};
}

double field_cosine(const Lamp& lamp) { return std::cos(base::radians(lamp.field_deg / 2)); }

SpotCone spot_cone(const Lamp& lamp) { return {beam_cosine(lamp), field_cosine(lamp)}; }

double SpotCone::profile(double cos_angle) const {
  if (cos_angle >= beam_cosine) return 1.0;
  if (cos_angle <= field_cosine) return 0.0;
  const double x = (cos_angle - field_cosine) / (beam_cosine - field_cosine);
  return x * x * (3.0 - 2.0 * x);
}

double spot_profile(const Lamp& lamp, double cos_angle) {
  return spot_cone(lamp).profile(cos_angle);
}

namespace {

// Sample of a lamp without size; relative(direction): its intensity relative to intensity_cd.
template <class Relative>
LightSample sample_point(const Lamp& lamp, const Vec3& point, const Relative& relative) {
  LightSample sample;
  const Vec3 offset = lamp.position - point;
  const double distance2 = glm::dot(offset, offset);
  if (distance2 <= 0.0) return sample;
  sample.distance_m = std::sqrt(distance2);
  sample.direction = offset / sample.distance_m;
  sample.normal_illuminance_lx = lamp.intensity_cd * (relative(-sample.direction) / distance2);
  return sample;
}

}  // namespace

LightSample sample_spot(const Lamp& lamp, const SpotCone& cone, const Vec3& point) {
  return sample_point(lamp, point, [&](const Vec3& direction) {
    return cone.profile(glm::dot(direction, lamp.axis));
  });
}

LightSample sample_lamp(const Lamp& lamp, const Vec3& point, double u, double v, Spread spread) {
  if (lamp.is_distant()) {
    return {-lamp.axis, std::numeric_limits<double>::infinity(), lamp.illuminance_lx};
  }
  if (lamp.kind == LampKind::Rectangle) return sample_flat(rectangle(lamp), point, u, v, spread);
  if (lamp.kind == LampKind::Disk) return sample_disk(lamp, point, u, v, spread);
  return sample_point(lamp, point,
                      [&](const Vec3& direction) { return relative_intensity(lamp, direction); });
}

Rgb lamp_flux_lm(const Lamp& lamp) {
  switch (lamp.kind) {
    case LampKind::Point:
      return lamp.intensity_cd * (4.0 * pi);
    case LampKind::Spot:
      return lamp.intensity_cd *
             (2.0 * pi * (1.0 - 0.5 * (beam_cosine(lamp) + field_cosine(lamp))));
    case LampKind::Measured:
      return lamp.intensity_cd * lamp.photometry->solid_angle_sr();
    case LampKind::Distant:
      return Rgb(0.0);
    case LampKind::Rectangle:
    case LampKind::Disk:
      break;
  }
  return lamp.exitance * surface_area(lamp);
}

EmittedRay emit_from_lamp(const Lamp& lamp, double u, double v, double x, double y) {
  if (is_wide(lamp.kind)) {
    const Vec3 origin =
        lamp.kind == LampKind::Disk ? disk_point(lamp, u, v) : point_on(rectangle(lamp), u, v);
    return {origin, cosine_direction(base::frame_around(lamp.axis), x, y), 1.0};
  }
  if (lamp.kind == LampKind::Measured) {
    const Photometry::Angles angles = lamp.photometry->sample(x, y);
    const Vec3 across = std::cos(angles.phi_rad) * lamp.c0 +
                        std::sin(angles.phi_rad) * glm::cross(lamp.c0, lamp.axis);
    return {lamp.position,
            glm::normalize(std::cos(angles.theta_rad) * lamp.axis +
                           std::sin(angles.theta_rad) * across),
            1.0};
  }
  const double half_angle = lamp.kind == LampKind::Spot ? base::radians(lamp.field_deg / 2) : pi;
  const Vec3 direction = sample_cone(lamp.axis, half_angle, x, y);
  if (lamp.kind == LampKind::Point) return {lamp.position, direction, 1.0};
  const double mean_profile = (1.0 - 0.5 * (beam_cosine(lamp) + field_cosine(lamp))) /
                              std::max(1.0 - field_cosine(lamp), 1e-300);
  return {lamp.position, direction,
          spot_profile(lamp, glm::dot(direction, lamp.axis)) / std::max(mean_profile, 1e-300)};
}

std::optional<LampHit> hit_lamp(const Lamp& lamp, const Vec3& origin, const Vec3& direction) {
  if (!is_wide(lamp.kind)) return std::nullopt;
  const double cosine = -glm::dot(direction, lamp.axis);
  if (cosine <= 0.0) return std::nullopt;
  const double t = glm::dot(origin - lamp.position, lamp.axis) / cosine;
  if (t <= 0.0) return std::nullopt;
  const Vec3 from_centre = origin + t * direction - lamp.position;
  if (lamp.kind == LampKind::Disk) {
    if (glm::dot(from_centre, from_centre) > lamp.radius_m * lamp.radius_m) return std::nullopt;
  } else {
    // Coordinates along the two edges, which need not be perpendicular.
    const Vec3 cross = glm::cross(lamp.edge_u, lamp.edge_v);
    const double area2 = glm::dot(cross, cross);
    const double a = glm::dot(glm::cross(from_centre, lamp.edge_v), cross) / area2;
    const double b = glm::dot(glm::cross(lamp.edge_u, from_centre), cross) / area2;
    if (std::abs(a) > 0.5 || std::abs(b) > 0.5) return std::nullopt;
  }
  return LampHit{t, lamp.exitance / pi};
}

// 2 sin^2 avoids the cancellation of 1 - cos for the Sun's small disc.
Cone::Cone(const Vec3& axis, double half_angle_rad)
    : frame_(base::frame_around(axis)), most_(2.0 * std::pow(std::sin(half_angle_rad / 2), 2)) {}

Vec3 Cone::sample(double u, double v) const { return glm::normalize(at(local(u, v))); }

Vec3 Cone::local(double u, double v) const {
  const double one_minus_cos = u * most_;
  const double sine = std::sqrt(std::max(0.0, one_minus_cos * (2.0 - one_minus_cos)));
  const double phi = 2.0 * pi * v;
  return {sine * std::cos(phi), sine * std::sin(phi), 1.0 - one_minus_cos};
}

double cone_solid_angle_sr(double half_angle_rad) {
  const double s = std::sin(half_angle_rad / 2);
  return 4.0 * pi * s * s;
}

bool has_light_outside(const Scene& scene) {
  return scene.sun || scene.earth ||
         std::any_of(scene.lamps.begin(), scene.lamps.end(),
                     [](const Lamp& lamp) { return lamp.is_distant(); });
}

LightSample thrown(const LightSample& sample, const FlatMirror& mirror, std::uint32_t number,
                   const Vec3& point) {
  const double height = mirror.height_m(point);
  const double rise = glm::dot(sample.direction, mirror.normal);
  if (height <= 0.0 || rise <= 0.0) return {};
  const double to_mirror = height / rise;
  if (to_mirror >= sample.distance_m) return {};  // the source is on the other side
  const Vec3 from_centre = mirror.image(point) + to_mirror * sample.direction - mirror.centre;
  if (glm::dot(from_centre, from_centre) > mirror.radius_m * mirror.radius_m * (1.0 + 1e-9)) {
    return {};
  }
  return {mirror.reflected(sample.direction), sample.distance_m, sample.normal_illuminance_lx,
          number, mirror.reflected(sample.lift_m)};
}

// Light from d, within the angle a of the disc's middle s, meets the mirror's plane at h d / (d n)
// from the image of a point at the height h. This is at most 2 a h / ((s n) (s n - a)) from the
// intersection for the middle.
bool disc_may_be_thrown(const Vec3& direction, double angle, const FlatMirror& mirror,
                        const Vec3& point) {
  const double height = mirror.height_m(point), rise = glm::dot(direction, mirror.normal);
  if (height <= 0.0 || rise <= -angle) return false;
  if (rise <= 2.0 * angle) return true;
  const Vec3 off = mirror.image(point) + height / rise * direction - mirror.centre;
  const double margin = 2.0 * angle * height / (rise * (rise - angle));
  const double farthest = (mirror.radius_m + margin) * (1.0 + 1e-6);
  return glm::dot(off, off) <= farthest * farthest;
}

}  // namespace earthshine::scenes
