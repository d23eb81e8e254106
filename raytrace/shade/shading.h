// SPDX-License-Identifier: Apache-2.0
// Radiance along camera rays. render.h has the table of light paths and their strategies.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/numbers/random.h"
#include "raytrace/camera/pixel_filter.h"
#include "raytrace/frame/frame.h"
#include "raytrace/frame/options.h"
#include "raytrace/gather/gather_field.h"
#include "raytrace/light/light_sampler.h"
#include "scenes/light/shadow_queue.h"
#include "scenes/reflect/brdf.h"

namespace earthshine::raytrace {

// Data that all pixels share; read only.
struct ShadingScene : scenes::World {
  const LightSampler& lights;
  const IncomingLight& incoming;        // radiance along gather rays
  std::vector<std::size_t> layer = {};  // per light group: its image layer
  std::size_t layers = 1;
  bool splits_parts = false;  // also sums by Part
  Indirect indirect = Indirect::Radiosity;
  bool gathers = false;  // gather rays carry light in this picture
  // For residual paths from the ends of gather and lobe rays; nullptr: no solution.
  const PathWorld* world = nullptr;
  const GatherField* field = nullptr;      // nullptr if `gathers` is false
  Vec3 sighting_origin{0.0};               // of Sighting::position
  PixelFilter filter{scenes::Camera{}};    // for camera samples
  std::uint64_t seed = 1;                  // of camera and gather rays
  std::uint64_t lamp_seed = 1;             // of shadow and lobe rays
  std::vector<bool> sampled_emitter = {};  // per material: shadow rays carry its light
};

// Whether light is gathered at a camera ray's hit, and for which reflectances.
[[nodiscard]] bool gathers_at(const scenes::Scene& scene, const scenes::Hit& hit,
                              GatherRequest& request);

// Sums over a pixel's samples of k_d and k_s at a gather point.
struct FieldTerm {
  std::uint32_t point = 0;
  glm::vec3 diffuse{0.0F}, lobe{0.0F};
};

// Shades the samples of one pixel after another; one object per thread. Samples with even and odd
// numbers form two independent halves.
class PixelShader {
 public:
  explicit PixelShader(const ShadingScene& shared);

  // Keys all random numbers to the pixel (its number in the whole picture) and clears the sums for
  // samples first .. first + count - 1 of the pixel. by_layer: fills halves_differ().
  void begin_pixel(const CameraModel& camera, int x, int y, std::size_t first, std::size_t count,
                   bool by_layer);
  // Sets the pixel that the next sample falls into (a wide pixel filter displaces samples), for
  // look-ups in the gather field.
  void set_gather_pixel(int x, int y) {
    x_ = x;
    y_ = y;
  }
  // camera: at the sample's time.
  void add_sample(std::size_t sample, const CameraModel& camera, const Ray& ray,
                  const scenes::Hit& hit);
  void end_pixel();  // traces the queued rays

  // Sum over samples of radiance, per image layer; then, with splits_parts, per Part.
  [[nodiscard]] std::span<const Rgb> sums() const { return sums_; }
  // Luminance of each sample, sum of all layers.
  [[nodiscard]] std::span<const double> sample_luminance() const { return sample_luminance_; }
  // Sums over samples of light straight from a source that the camera sees.
  [[nodiscard]] const SourceSeen& source() const { return source_; }
  // Per layer, the luminance of the first half's samples minus that of the second half's.
  [[nodiscard]] std::span<const double> halves_differ() const { return halves_differ_; }
  // Light that the samples read from gather points: in sample_luminance(), but not in sums().
  [[nodiscard]] std::span<const FieldTerm> field_terms() const { return terms_; }
  [[nodiscard]] RayCounts rays() const;  // all rays cast so far

 private:
  // Kind of the ray; it decides which sources the ray may see.
  enum class Seen { ByCamera, ByLobe };
  struct Surface {
    scenes::Brdf brdf;
    Vec3 position;
    Vec3 outward;     // unit normal of the front
    double offset_m;  // of rays that leave the surface
    [[nodiscard]] const scenes::Material& material() const { return brdf.material; }
    [[nodiscard]] Vec3 lifted() const { return position + offset_m * brdf.normal; }
  };

  // counter: counts this kind of ray.
  void trace(const Ray& ray, const Rgb& weight, int depth, Seen seen, std::uint64_t& counter);
  void shade(const Ray& ray, const scenes::Hit& hit, const Rgb& weight, int depth, Seen seen);
  // The half of the current sample, and its number in it.
  [[nodiscard]] std::size_t half() const { return sample_ % 2; }
  [[nodiscard]] std::uint32_t in_half() const { return static_cast<std::uint32_t>(sample_ / 2); }

  void see_source(std::size_t group, const Rgb& radiance, int depth);
  void see_sky(const Vec3& direction, const Rgb& weight, int depth, Seen seen);
  bool see_lamp(const Ray& ray, double nearer_than_m, const Rgb& weight, int depth);
  void direct(const Ray& ray, const Surface& surface, const Rgb& weight, int depth);
  void diffuse(const Surface& surface, const Rgb& weight, int depth);
  // Whether gather points exist for a hit after so many mirrors and panes.
  [[nodiscard]] bool has_points(int depth) const {
    return shared_.field != nullptr && depth == (mirror_ ? 1 : 0);
  }
  [[nodiscard]] GatherField::Reading read_points(const Surface& surface, Gathered kind) const;
  void count_read(const glm::vec3& sum, const Rgb& weight);
  bool read_field(const Surface& surface, const Rgb& weight);
  bool read_lobe(const Surface& surface, const Rgb& weight);
  FieldTerm& term_of(std::size_t point);
  void gather(const Surface& surface, const Rgb& weight, int depth);
  void lobe(const Surface& surface, const Rgb& weight, int depth);
  void mirror_and_glass(const Ray& ray, const Surface& surface, const Rgb& weight, int depth,
                        Seen seen);

  // Light of a shadow ray that nothing blocks.
  struct Arriving {
    Rgb radiance{0.0};
    Rgb specular{0.0};  // its highlight
    std::size_t layer = 0, sample = 0;
    bool by_camera = true;  // at a surface that the camera sees directly
    scenes::LightKind kind = scenes::LightKind::Sun;
  };
  void take(const Arriving& light, const Rgb& share);
  struct GatherRay {
    Vec3 direction{0.0};
    Rgb weight{0.0};
    MisContext share;
    Part part = Part::Indirect;
    std::size_t sample = 0;
    std::uint64_t number = 0;      // number in the sample: key of the residual path
    double residual_weight = 1.0;  // of the residual path; 0: none
  };
  void queue_gather(const Vec3& origin, const GatherRay& ray);
  void add_residual(const GatherRay& ray, const scenes::Hit& hit);
  void flush_gather();
  void add(std::size_t layer, std::size_t sample, Part part, const Rgb& radiance);
  void count_luminance(std::size_t layer, std::size_t sample, const Rgb& radiance) {
    const double luminance = base::luminance(radiance);
    sample_luminance_[sample - first_sample_] += luminance;
    if (!halves_differ_.empty()) {
      halves_differ_[layer] += sample % 2 == 0 ? luminance : -luminance;
    }
  }

  const ShadingScene& shared_;
  RayCounts rays_;
  std::vector<Rgb> sums_;
  std::vector<Rgb> scratch_;  // one per layer, then light straight from the sky
  std::vector<double> sample_luminance_, halves_differ_;
  std::size_t sample_ = 0, first_sample_ = 0;
  SourceSeen source_;
  double source_of_sample_ = 0.0;
  std::vector<FieldTerm> terms_;
  std::optional<PathWalker> walker_;
  int x_ = 0, y_ = 0;
  std::optional<MirrorPlane> mirror_;  // mirror of the first hit, while shading its reflection
  const CameraModel* camera_ = nullptr;
  int pixel_x_ = 0, pixel_y_ = 0;
  std::uint64_t pixel_ = 0, gathered_ = 0;
  std::array<base::SobolOwen4, 2> gather_points_;  // per half
  std::vector<scenes::LightChoice> chosen_;
  base::Rng rng_;

  static constexpr std::size_t width = scenes::RayPacket::width;
  scenes::ShadowQueue<Arriving> shadows_;
  scenes::RayPacket gather_packet_;
  std::array<GatherRay, width> gather_rays_;
  std::size_t gather_count_ = 0;
};

}  // namespace earthshine::raytrace
