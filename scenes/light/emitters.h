// SPDX-License-Identifier: Apache-2.0
// Flat pieces of emitting surface, one by one and as the surfaces of one light.
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
  Vec3 normal{0.0};  // unit: where it shines, unless two_sided
  double area_m2 = 0.0;
  Rgb exitance{0.0};  // lm/m^2, of each side
  bool two_sided = false;
  FlatShape shape = FlatShape::Triangle;
  std::uint32_t textured_triangle = none;  // of the scene, where the exitance is a mean
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  double offset_m = 0.0;  // of rays that leave it (surface_offset.h)
};

[[nodiscard]] Vec3 point_on(const FlatEmitter& emitter, double u, double v);

// Spread::Best: near the emitter even over the solid angle it fills, further off over its area. At
// a point whose distance is its size the solid angle leaves a fifteenth of the variance and takes
// 0.15 us longer, less than a shadow ray; from three sizes on there is no noise to speak of.
// Parallelograms that are no rectangles are always spread over their area.
[[nodiscard]] LightSample sample_flat(const FlatEmitter& emitter, const Vec3& point, double u,
                                      double v, Spread spread);

// A point of a Lambertian emitter of exitance M that stands for the area A:
// E_normal = (M / pi) cos(theta') A / r^2.
[[nodiscard]] LightSample toward_area(const Vec3& point, const Vec3& on_source, const Vec3& normal,
                                      bool two_sided, const Rgb& exitance, double area_m2);

// The emitting triangles of one light. Rectangles are kept as such. Sheets shine from both sides.
class EmitterSet {
 public:
  EmitterSet() = default;
  // The emitting triangles of a material. The scene must outlive the set if the material has a
  // texture.
  EmitterSet(const Scene& scene, std::size_t material);

  [[nodiscard]] Rgb flux_lm() const { return flux_lm_; }
  // u chooses the piece, by what it may give the point (Spread::Best) or by its flux, and,
  // rescaled, the place on it together with v. Zero illuminance if the point sees the dark side.
  [[nodiscard]] LightSample sample(const Vec3& point, double u, double v,
                                   Spread spread = Spread::Best) const;
  // Pieces are chosen in proportion to their flux.
  [[nodiscard]] EmittedRay emit(double u, double v, double x, double y) const;

 private:
  void add(const Scene& scene, std::uint32_t triangle);
  [[nodiscard]] const FlatEmitter& choose(double& u, double& probability) const;
  static void lift(LightSample& sample, const FlatEmitter& emitter);
  void vary(LightSample& sample, const FlatEmitter& emitter, const Vec3& seen_from) const;
  [[nodiscard]] Rgb relative_exitance(const FlatEmitter& emitter, const Vec3& point) const;

  const Scene* scene_ = nullptr;
  Vec3 centre_{0.0};  // of detail
  std::vector<FlatEmitter> pieces_;
  std::vector<double> cumulative_;  // luminous flux, running sum
  LightTree tree_{{}};
  Rgb flux_lm_{0.0};
};

}  // namespace earthshine::scenes
