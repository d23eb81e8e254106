// SPDX-License-Identifier: Apache-2.0
// Radiance along camera rays. The table of who carries which light path stands in render.h.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/random.h"
#include "raytrace/gather_field.h"
#include "raytrace/light_sampler.h"
#include "raytrace/pixel_filter.h"
#include "raytrace/render.h"

namespace earthshine::raytrace {

// Where the light of a surface that the camera sees itself is read from.
enum class DiffuseSource {
  Field,    // the pixel's gather point; gather rays of its own where there is none
  Gather,   // gather rays of every camera sample
  Solution  // the radiosity solution: noise-free and coarse, for planning
};

// What all pixels share; read only.
struct ShadingScene {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const scenes::Effects& effects;
  const scenes::RayQuery& query;
  const LightSampler& lights;
  const RadianceTable& soft_radiance;   // what surfaces seen in mirrors read
  const IncomingLight& incoming;        // along gather rays
  std::vector<std::size_t> layer = {};  // of a light group: its image layer
  std::size_t layers = 1;
  bool splits_parts = false;  // sums also by Part
  Indirect indirect = Indirect::Radiosity;
  bool gathers = false;  // cosine rays carry light in this render
  DiffuseSource diffuse = DiffuseSource::Gather;
  const GatherField* field = nullptr;  // with DiffuseSource::Field
  Vec3 camera_position{0.0};
  PixelFilter filter{scenes::Camera{}};    // of the camera samples
  int gather_rays = 16;                    // per camera sample
  std::uint64_t seed = 1;                  // of camera and gather rays
  std::uint64_t lamp_seed = 1;             // of shadow and lobe rays
  std::vector<bool> sampled_emitter = {};  // per material: shadow rays carry its light
};

// How light reached the camera, by the last surface before it.
enum class Part {
  Direct,    // seen itself, or diffusely reflected straight from a source
  Indirect,  // diffusely reflected after at least one other surface
  Specular   // by a highlight, a glossy reflection, a mirror or glass
};
inline constexpr std::size_t part_count = 3;

// Whether a surface that the camera meets there reflects diffusely, and where to gather for it.
[[nodiscard]] bool gathers_at(const scenes::Scene& scene, const scenes::Hit& hit,
                              GatherRequest& request);

// Shades the samples of one pixel after another; one object per thread.
class PixelShader {
 public:
  explicit PixelShader(const ShadingScene& shared);

  // Keys all random numbers to the pixel (its number in the whole picture) and clears the sums.
  // Samples first .. first + count - 1 of the pixel follow.
  void begin_pixel(std::uint64_t pixel, std::size_t first, std::size_t count);
  // The pixel that the next sample falls into (a wide pixel filter puts some beside their own):
  // there the gather field is looked up.
  void look_near(int x, int y) {
    x_ = x;
    y_ = y;
  }
  void add_sample(std::size_t sample, const Ray& ray, const scenes::Hit& hit);
  void end_pixel();  // traces what is still queued

  // Sum over samples of radiance, per image layer; then, with splits_parts, per Part.
  [[nodiscard]] std::span<const Rgb> sums() const { return sums_; }
  // Luminance of each sample, all layers together.
  [[nodiscard]] std::span<const double> sample_luminance() const { return sample_luminance_; }
  // How many samples saw a source itself.
  [[nodiscard]] std::size_t source_samples() const { return source_samples_; }
  // Sum over samples of the standard error of luminance that their gather points carry.
  [[nodiscard]] double field_error() const { return field_error_; }
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

  // counter: the kind of ray it is.
  void trace(const Ray& ray, const Rgb& weight, int depth, Seen seen, std::uint64_t& counter);
  void shade(const Ray& ray, const scenes::Hit& hit, const Rgb& weight, int depth, Seen seen);
  void see_source(std::size_t group, const Rgb& radiance, int depth);
  void see_sky(const Vec3& direction, const Rgb& weight, int depth, Seen seen);
  bool see_lamp(const Ray& ray, double nearer_than_m, const Rgb& weight, int depth);
  void direct(const Surface& surface, const Rgb& weight, int depth);
  void diffuse(const Surface& surface, const scenes::Hit& hit, const Rgb& weight, int depth);
  bool read_field(const Surface& surface, const Rgb& weight);
  void read_solution(const scenes::Hit& hit, const Rgb& weight, int depth);
  void gather(const Surface& surface, const Rgb& weight, int depth);
  void lobe(const Surface& surface, const Rgb& weight, int depth);
  void mirror_and_glass(const Ray& ray, const Surface& surface, const Rgb& weight, int depth,
                        Seen seen);

  struct ShadowRay {
    Rgb value{0.0};     // what it brings if nothing is in its way
    Rgb specular{0.0};  // the part of it by a highlight
    std::size_t layer = 0, sample = 0;
    bool by_camera = true;  // at a surface that the camera sees itself
    scenes::LightKind kind = scenes::LightKind::Sun;
  };
  void queue_shadow(const Vec3& origin, const Vec3& direction, double reach_m,
                    const ShadowRay& ray);
  struct GatherRay {
    Vec3 direction{0.0};
    Rgb weight{0.0};
    RayShare share;
    Part part = Part::Indirect;
    std::size_t sample = 0;
  };
  void queue_gather(const Vec3& origin, const GatherRay& ray);
  void flush_shadow();
  void flush_gather();
  void add(std::size_t layer, std::size_t sample, Part part, const Rgb& radiance);

  const ShadingScene& shared_;
  RayCounts rays_;
  std::vector<Rgb> sums_;
  std::vector<Rgb> scratch_;  // one per layer, and what came straight from the sky
  std::vector<double> sample_luminance_;
  std::size_t sample_ = 0, first_sample_ = 0, source_samples_ = 0;
  double field_error_ = 0.0;
  int x_ = 0, y_ = 0;
  std::uint64_t pixel_ = 0;
  base::SobolOwen4 gather_points_;
  std::vector<scenes::LightChoice> chosen_;
  base::Rng rng_;

  static constexpr std::size_t width = scenes::RayPacket::width;
  scenes::RayPacket shadow_packet_, gather_packet_;
  std::array<ShadowRay, width> shadow_rays_;
  std::array<GatherRay, width> gather_rays_;
  std::size_t shadow_count_ = 0, gather_count_ = 0;
};

}  // namespace earthshine::raytrace
