// SPDX-License-Identifier: Apache-2.0
// The sources that are reached by shadow rays, in one list.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "raytrace/render.h"
#include "scenes/lamp_light.h"

namespace earthshine::raytrace {

// A source with one shadow ray per sample; (u, v) choose the point on it where it has extent.
class LightSampler {
 public:
  // Radiosity and None: each source once, sampled at random. Distributed: wide sources are replaced
  // by `distributed_lights` fixed points or directions of equal share, the same for every pixel;
  // the Earth by points of earth_area (distributed_area.h), or by directions to its disc.
  LightSampler(const scenes::Scene& scene, const scenes::LightGroups& groups,
               const scenes::Effects& effects, Indirect indirect, int distributed_lights,
               std::optional<scenes::Lamp> earth_area = std::nullopt);

  [[nodiscard]] std::size_t count() const { return lights_.size(); }
  [[nodiscard]] std::size_t group(std::size_t light) const { return lights_[light].group; }
  [[nodiscard]] scenes::LightSample sample(std::size_t light, const Vec3& point, double u,
                                           double v) const;

 private:
  enum class Kind { Sun, Earth, EarthArea, Lamp, Emitters };
  struct Light {
    Kind kind;
    std::size_t group;
    std::size_t index = 0;  // of the lamp or emitter set
    bool fixed = false;     // distributed: always the same (u, v)
    double u = 0.5, v = 0.5;
    double share = 1.0;  // of the source's light
  };
  void add(Light light, int copies);

  const scenes::Scene& scene_;
  bool distributed_;
  std::optional<scenes::Lamp> earth_area_;
  std::vector<Light> lights_;
  std::vector<scenes::EmitterSet> emitters_;
  Rgb sun_illuminance_lx_{0.0};
  double sun_radius_rad_ = 0.0;
  double earth_half_angle_rad_ = 0.0;
  double earth_solid_angle_sr_ = 0.0;
};

}  // namespace earthshine::raytrace
