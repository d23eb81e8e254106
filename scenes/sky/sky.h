// SPDX-License-Identifier: Apache-2.0
// Sun and Earth as the spacecraft sees them: radiance of a direction, the Sun behind the limb.
#pragma once

#include <optional>

#include "scenes/light/lamp_light.h"
#include "scenes/scene.h"
#include "scenes/sky/two_discs.h"

namespace earthshine::scenes {

// Half angle of the Earth's disc from altitude h: asin(R / (R + h)).
[[nodiscard]] double earth_half_angle_rad(double altitude_m);

// The law of Earth::by_latitude at a latitude, and the most that it gives anywhere.
[[nodiscard]] double albedo_at(const LatitudeAlbedo& law, double sin_latitude);
[[nodiscard]] double largest_albedo(const LatitudeAlbedo& law);

// Radiance of the Earth in a unit direction, cd/m^2; 0 off its disc. Lambert: L = (a / pi) E_sun
// max(0, cos theta_s), theta_s the Sun's zenith angle where the direction meets the sphere; a is
// Earth::albedo, by latitude times albedo_at that place. Of a scene that has an Earth and outlives
// it, for many directions; what changes in the scene later is not seen.
class EarthRadiance {
 public:
  explicit EarthRadiance(const Scene& scene);
  [[nodiscard]] Rgb operator()(const Vec3& direction) const;
  [[nodiscard]] bool covers(const Vec3& direction) const {
    return glm::dot(direction, scene_.earth->direction) >= limb_cosine_;
  }

 private:
  // The zenith, unit, of the point of the sphere seen in `direction`; nothing beside the disc.
  [[nodiscard]] std::optional<Vec3> surface_zenith(const Vec3& direction) const;

  const Scene& scene_;
  double limb_cosine_, distance_;  // of the Earth's centre, in its radii
};
// The same in one direction.
[[nodiscard]] Rgb earth_radiance(const Scene& scene, const Vec3& direction);

// The Earth as a source that shadow rays go to: a direction spread uniformly over the solid angle
// of its disc, and all the light that would come if the disc were as bright there. Of a scene as
// above.
class EarthLight {
 public:
  explicit EarthLight(const Scene& scene);
  [[nodiscard]] LightSample sample(double u, double v) const;

 private:
  Cone disc_;
  EarthRadiance radiance_;
  double solid_angle_sr_;
};

// Whether any part of the disc shines.
[[nodiscard]] bool earth_is_lit(const Scene& scene);

// Share of the Sun's disc that the Earth does not cover, 0 to 1, by solid angle (two_discs.h).
[[nodiscard]] double visible_sun_share(const Scene& scene);

// Directions spread uniformly, for u and v in [0, 1), over what the Earth leaves of the disc of the
// Sun that the scene has now.
class SunDirections {
 public:
  explicit SunDirections(const Scene& scene);
  [[nodiscard]] Vec3 operator()(double u, double v) const;

 private:
  [[nodiscard]] Vec3 beside_earth(double u, double v) const;

  Cone disc_;
  Vec3 sun_;
  // Where the Earth hides some of it: both discs, and from the Sun's middle the way to the Earth's.
  std::optional<SunAndEarth> partly_;
  Vec3 toward_{0.0};
};

// What directions spread so must each carry so that a plate that faces
// it gets illuminance_lx times the share in view: the mean cosine over the disc is (1 + cos r) / 2.
[[nodiscard]] Rgb sun_sample_illuminance(const Scene& scene);
// The same over the whole disc of a Sun that nothing in the sky hides.
[[nodiscard]] Rgb sun_sample_illuminance(const Sun& sun);

// Radiance of the Sun's disc, cd/m^2: E / (pi sin^2 r); 0 for a point Sun.
[[nodiscard]] Rgb sun_radiance(const Sun& sun);

// Radiance of everything behind the scene in a direction: the Sun's disc (not where the Earth hides
// it) and the Earth.
[[nodiscard]] Rgb sky_radiance(const Scene& scene, const Vec3& direction);

}  // namespace earthshine::scenes
