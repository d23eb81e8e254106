// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/narrow_beams.h"

#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "scenes/light/lamp_light.h"

namespace earthshine::scenes {
namespace {

constexpr int peak_rays = 64, beam_rays = 256;
// A diffuse luminaire has half of its flux within 45 degrees and 0.8 % within 5 degrees.
constexpr double peak_half_angle_deg = 5.0, peak_share = 1.0 / 12.0;
constexpr std::size_t neighbours = 8;

std::vector<Beam::Ray> rays_of(const Lamp& lamp, int count) {
  std::vector<Beam::Ray> rays;
  double all = 0.0;
  const base::SobolOwen4 sobol(base::Key(0, base::Stream::LampFlux, 0));
  for (int k = 0; k < count; ++k) {
    const auto p = sobol.point(static_cast<std::uint32_t>(k));
    const EmittedRay ray = emit_from_lamp(lamp, p[0], p[1], p[2], p[3]);
    if (ray.weight <= 0.0) continue;
    rays.push_back({ray.direction, ray.weight, 0.0});
    all += ray.weight;
  }
  for (Beam::Ray& ray : rays) ray.share /= all;
  return rays;
}

bool is_peaked(const std::vector<Beam::Ray>& rays) {
  const double within = std::cos(base::radians(peak_half_angle_deg));
  return std::any_of(rays.begin(), rays.end(), [&](const Beam::Ray& middle) {
    double share = 0.0;
    for (const Beam::Ray& ray : rays) {
      if (glm::dot(ray.direction, middle.direction) >= within) share += ray.share;
    }
    return share >= peak_share;
  });
}

// The cap out to the 8th nearest ray contains eight rays.
void find_solid_angles(std::vector<Beam::Ray>& rays) {
  std::vector<double> square(rays.size());  // of chords, which are more accurate than cosines
  const std::size_t k = std::min(neighbours, rays.size() - 1);
  for (Beam::Ray& ray : rays) {
    for (std::size_t n = 0; n < rays.size(); ++n) {
      const Vec3 chord = rays[n].direction - ray.direction;
      square[n] = glm::dot(chord, chord);
    }
    std::nth_element(square.begin(), square.begin() + static_cast<std::ptrdiff_t>(k), square.end());
    ray.solid_angle_sr = base::pi * square[k] / static_cast<double>(std::max<std::size_t>(1, k));
  }
}

}  // namespace

std::vector<Beam> narrow_beams(std::span<const Lamp> lamps) {
  std::vector<Beam> beams;
  for (const Lamp& lamp : lamps) {
    if (lamp.kind != LampKind::Spot && lamp.kind != LampKind::Measured) continue;
    if (!base::is_lit(lamp.intensity_cd) || !is_peaked(rays_of(lamp, peak_rays))) continue;
    Beam beam{lamp.position, Vec3(0.0), 0.0, rays_of(lamp, beam_rays)};
    find_solid_angles(beam.rays);
    for (const Beam::Ray& ray : beam.rays) beam.axis += ray.share * ray.direction;
    const double length = glm::length(beam.axis);
    beam.axis = length > 0.0 ? beam.axis / length : lamp.axis;
    for (const Beam::Ray& ray : beam.rays) {
      const double angle = std::acos(std::clamp(glm::dot(ray.direction, beam.axis), -1.0, 1.0));
      beam.half_angle_rad = std::max(beam.half_angle_rad, angle);
    }
    beams.push_back(std::move(beam));
  }
  return beams;
}

}  // namespace earthshine::scenes
