// SPDX-License-Identifier: Apache-2.0
// Readings of a range sensor (structured light, time of flight, scanning laser), from the exact
// distances of a rendered picture.
//   r      distance along the ray, m
//   theta  angle of incidence, between the ray and the surface normal
//   rho    diffuse reflectance: luminance of the layer albedo
//   sigma(r) = noise_m + noise_m_per_m r + noise_m_per_m2 r^2: standard deviation, Gaussian
// Triangulation: disparity has constant noise, hence sigma = (m / f b) r^2 (Khoshelham and Elberink
// 2012, Sensors 12(2)). The Kinect fits 0.0012 + 0.0019 (z - 0.4)^2 m between 10 and 60 degrees of
// incidence and rarely reads beyond (Nguyen, Izadi and Lovell 2012, 3DIMPVT). Time of flight: the
// returned signal, rho cos(theta) / r^2 for a Lambertian surface wider than the beam, must exceed a
// minimum.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/image.h"
#include "base/units.h"
#include "degrade/stage/fields.h"
#include "scenes/scene.h"

namespace earthshine::degrade {

// The defaults are a sensor without faults.
struct RangeSensor {
  double noise_m = 0.0;
  double noise_m_per_m = 0.0;
  double noise_m_per_m2 = 0.0;
  double max_incidence_deg = 90.0;
  double min_signal_per_m2 = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double dropout = 0.0;
  double quantum_m = 0.0;
};

template <class Sensor, class Visitor>
void visit_range_fields(Sensor& s, Visitor&& field) {
  field("noise_m", s.noise_m, Limits{0.0, 1000.0}, "m", "standard deviation at any range");
  field("noise_m_per_m", s.noise_m_per_m, Limits{0.0, 1.0}, "m/m", "and what each metre adds");
  field("noise_m_per_m2", s.noise_m_per_m2, Limits{0.0, 1000.0}, "m/m2",
        "and what each square metre of range squared adds");
  field("max_incidence_deg", s.max_incidence_deg, Limits{0.0, 90.0}, "deg",
        "no return from surfaces seen at more than this from their normal");
  field("min_signal_per_m2", s.min_signal_per_m2, Limits{0.0, 1000.0}, "1/m2",
        "no return below this albedo x cos(incidence) / range^2");
  field("min_range_m", s.min_range_m, Limits{0.0, 100000.0}, "m", "no return nearer");
  field("max_range_m", s.max_range_m, Limits{0.0, 100000.0}, "m",
        "no return farther; 0: any range");
  field("dropout", s.dropout, Limits{0.0, 1.0}, "1", "share of readings lost at random");
  field("quantum_m", s.quantum_m, Limits{0.0, 1000.0}, "m", "step of the reading; 0: none");
}

struct RangeKey {
  std::uint64_t seed = 1;
  std::uint64_t view = 0;  // distinguishes the cameras of a run
};

// Reasons for missing returns. Each pixel counts once, under the first reason that applies.
struct RangeReport {
  std::uint64_t returned = 0, empty = 0, grazing = 0, dim = 0, lost = 0, out_of_range = 0;
};

struct RangeView {
  base::Image image;  // range (m along the ray; 0: no return), valid (1 or 0)
  RangeReport report;
};

// layers: range, N and P of one camera at `position` as in raytrace/frame/layers.h, and albedo if
// min_signal_per_m2 > 0. Range limits apply to the noisy distance, before it is rounded to
// quantum_m. Equal bytes for any number of threads; a pixel's noise does not depend on the size of
// the picture. Throws base::Error (Work) if a layer is missing.
[[nodiscard]] RangeView sense_range(const base::Image& layers, const Vec3& position,
                                    const RangeSensor& sensor, const RangeKey& key = {});

// Reads [[range_sensor]] tables of a scene. docs/scene-format.md lists the keys.

// The [[range_sensor]] of this name. Throws base::Error (Input) for an unknown name or key (with
// the nearest one), a value of the wrong type or out of range, and contradictory limits. of,
// named_at: the camera that names it and the position, for messages.
[[nodiscard]] RangeSensor resolve_range_sensor(const scenes::Scene& scene, const std::string& name,
                                               const std::string& of = {},
                                               const std::optional<base::Location>& named_at = {});

// Throws the errors of resolve_range_sensor for all tables and all cameras of the scene.
void check_range_sensors(const scenes::Scene& scene);

}  // namespace earthshine::degrade
