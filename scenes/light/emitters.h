// SPDX-License-Identifier: Apache-2.0
// Flat elements of emitting surface, separately and as the surfaces of one light.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/light/lamp_light.h"
#include "scenes/light/light_tree.h"

namespace earthshine::scenes {

enum class FlatShape { Triangle, Parallelogram };

// corner + s edge1 + t edge2 with s, t in [0, 1], s + t <= 1 in a triangle. Lambertian.
struct FlatEmitter {
  Vec3 corner{0.0}, edge1{0.0}, edge2{0.0};
  Vec3 normal{0.0};  // unit: the emitting side, unless two_sided
  double area_m2 = 0.0;
  Rgb exitance{0.0};  // lm/m^2, per side
  bool two_sided = false;
  FlatShape shape = FlatShape::Triangle;
  std::uint32_t textured_triangle = none;  // in the scene, if the exitance is a mean
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  double offset_m = 0.0;  // for rays that leave it (surface_offset.h)
};

[[nodiscard]] Vec3 point_on(const FlatEmitter& emitter, double u, double v);

// Spread::Best: near the emitter uniform in its solid angle, farther away uniform over its area. At
// a distance equal to its size solid-angle sampling has a fifteenth of the variance and takes 0.15
// us longer, less than a shadow ray; beyond three sizes the noise is negligible. Parallelograms
// that are not rectangles are always sampled over their area.
[[nodiscard]] LightSample sample_flat(const FlatEmitter& emitter, const Vec3& point, double u,
                                      double v, Spread spread);

// Sample at a point of a Lambertian emitter of exitance M that represents the area A: E_normal = (M
// / pi) cos(theta') A / r^2.
[[nodiscard]] LightSample toward_area(const Vec3& point, const Vec3& on_source, const Vec3& normal,
                                      bool two_sided, const Rgb& exitance, double area_m2);

// The emitting triangles of one light. Rectangles are merged. Sheets emit from both sides.
class EmitterSet {
 public:
  EmitterSet() = default;
  // The emitting triangles of a material. If it has a texture, the scene must outlive the set.
  EmitterSet(const Scene& scene, std::size_t material);

  [[nodiscard]] Rgb flux_lm() const { return flux_lm_; }
  // u selects the element, by its estimated light at the point (Spread::Best) or by its flux, and
  // then, rescaled, the position on it together with v. Zero illuminance if the point is on the
  // dark side.
  [[nodiscard]] LightSample sample(const Vec3& point, double u, double v,
                                   Spread spread = Spread::Best) const;
  // Elements are selected in proportion to their flux.
  [[nodiscard]] EmittedRay emit(double u, double v, double x, double y) const;

 private:
  void add(const Scene& scene, std::uint32_t triangle);
  [[nodiscard]] const FlatEmitter& choose(double& u, double& probability) const;
  static void lift(LightSample& sample, const FlatEmitter& emitter);
  void vary(LightSample& sample, const FlatEmitter& emitter, const Vec3& seen_from) const;
  [[nodiscard]] Rgb relative_exitance(const FlatEmitter& emitter, const Vec3& point) const;

  const Scene* scene_ = nullptr;
  Vec3 centre_{0.0};  // centre of detail
  std::vector<FlatEmitter> pieces_;
  std::vector<double> cumulative_;  // luminous flux, cumulative
  LightTree tree_{{}};
  Rgb flux_lm_{0.0};
};

}  // namespace earthshine::scenes
