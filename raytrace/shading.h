// SPDX-License-Identifier: Apache-2.0
// Radiance along camera rays. The table of who carries which light path stands in render.h.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/random.h"
#include "raytrace/bright_patches.h"
#include "raytrace/camera.h"
#include "raytrace/light_sampler.h"
#include "raytrace/radiance_table.h"
#include "raytrace/render.h"

namespace earthshine::raytrace {

// What all pixels share; read only.
struct ShadingScene {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const scenes::Effects& effects;
  const scenes::RayQuery& query;
  const LightSampler& lights;
  const RadianceTable& all_radiance;    // what gather rays read; empty without interreflection
  const RadianceTable& soft_radiance;   // what surfaces seen in mirrors read
  const BrightPatches& bright;          // of all_radiance
  std::vector<std::size_t> layer = {};  // of a light group: its image layer
  std::size_t layers = 1;
  Indirect indirect = Indirect::Radiosity;
  bool follows_specular = false;  // gather rays may meet mirrors or glass
  bool gathers = false;           // cosine rays carry light in this render
  int gather_rays = 16;           // per camera sample
  std::uint64_t seed = 1;
  std::vector<bool> sampled_emitter = {};  // per material: shadow rays carry its light
};

// Shades the samples of one pixel after another; one object per thread.
class PixelShader {
 public:
  explicit PixelShader(const ShadingScene& shared);

  // Keys all random numbers to the pixel and clears the sums.
  void begin_pixel(std::uint64_t pixel, std::size_t samples);
  void add_sample(std::size_t sample, const Ray& ray, const scenes::Hit& hit);
  void end_pixel();  // traces what is still queued

  // Sum over samples of radiance, per image layer.
  [[nodiscard]] std::span<const Rgb> sums() const { return sums_; }
  // Luminance of each sample, all layers together.
  [[nodiscard]] std::span<const double> sample_luminance() const { return sample_luminance_; }
  [[nodiscard]] const RayCounts& rays() const { return rays_; }

 private:
  // What kind of ray asks, which decides what it may see of the sources themselves.
  enum class Seen { ByCamera, ByLobe };
  struct Surface {
    const scenes::Material& material;
    Vec3 position;
    Vec3 outward;  // unit normal of the front
    Vec3 normal;   // the same on the side of the viewer
    Vec3 view;     // unit, toward the viewer
  };

  void trace(const Ray& ray, const Rgb& weight, int depth, Seen seen);
  void shade(const Ray& ray, const scenes::Hit& hit, const Rgb& weight, int depth, Seen seen);
  void see_sky(const Vec3& direction, const Rgb& weight, Seen seen);
  bool see_lamp(const Ray& ray, double nearer_than_m, const Rgb& weight);
  void direct(const Surface& surface, const Rgb& weight);
  void gather(const Surface& surface, const Rgb& weight, int depth);
  void lobe(const Surface& surface, const Rgb& weight, int depth);
  void mirror_and_glass(const Ray& ray, const Surface& surface, const Rgb& weight, int depth,
                        Seen seen);

  void queue_shadow(const Vec3& origin, const Vec3& direction, double reach_m, const Rgb& value,
                    std::size_t layer);
  // cosine: at the surface, of a ray that shares its work with rays aimed at bright patches, else
  // 0. aimed_at: the patch such a ray must meet to count.
  void queue_gather(const Vec3& origin, const Vec3& direction, const Rgb& weight,
                    double cosine = 0.0, std::uint32_t aimed_at = radiosity::no_patch);
  void aim_at_bright(const Surface& surface, const Vec3& origin, const Rgb& weight);
  [[nodiscard]] double gather_share(const scenes::Hit& hit, std::size_t lane) const;
  // What a gather ray that met a mirror or glass brings from beyond it.
  void gather_sky(const Vec3& direction, const Rgb& weight);
  void follow_specular(scenes::Hit hit, Vec3 direction, Rgb weight);
  void flush_shadow();
  void flush_gather();
  void add(std::size_t layer, std::size_t sample, const Rgb& radiance);

  const ShadingScene& shared_;
  RayCounts rays_;
  std::vector<Rgb> sums_;
  std::vector<Rgb> scratch_;
  std::vector<double> sample_luminance_;
  std::size_t sample_ = 0;
  std::uint64_t pixel_ = 0;
  base::SobolOwen4 gather_points_;
  std::vector<scenes::LightChoice> chosen_;
  base::Rng rng_;

  static constexpr std::size_t width = scenes::RayPacket::width;
  scenes::RayPacket shadow_rays_, gather_rays_;
  std::array<Rgb, width> shadow_value_, gather_weight_;
  std::array<std::size_t, width> shadow_layer_, shadow_sample_, gather_sample_;
  std::array<Vec3, width> gather_direction_;
  std::array<double, width> gather_cosine_;
  std::array<std::uint32_t, width> aimed_at_;
  std::size_t shadow_count_ = 0, gather_count_ = 0;
};

// Point of a hit, found from the triangle's corners (more exact than origin + t direction).
[[nodiscard]] Vec3 hit_position(const scenes::Scene& scene, const scenes::Hit& hit);

}  // namespace earthshine::raytrace
