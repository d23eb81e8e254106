// SPDX-License-Identifier: Apache-2.0
// Final gather on a grid. The surface point behind the centre of each pixel estimates incident
// radiance, which all camera samples of the pixel and neighbouring points share (share.h). It has
// three estimates, each with its own number of samples:
//
//   solution  mean of L~, the radiance of the solution, along cosine-distributed rays that end on
//             patches or in the sky, or continue by mirrors and glass: T L~ / k_d
//   residual  mean of the residual L - L~, by paths that continue where such rays end:
//             T (L - L~) / k_d. The sum with `solution` has the right mean for any L~.
//   lobe      radiance along rays over a Phong lobe, for k_s = 1: solution and residual
//
// If a pixel shows further surfaces, each has an off-grid point of its own (share/off_grid.h). If
// the incident radiance varies within a pixel, the rays start at several places of the surface in
// the pixel's footprint, new ones for each half of a round, and the point estimates their mean.
// This is the case beside edges, where rays are short, and where the normal of a glossy surface
// varies.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/camera/camera.h"
#include "raytrace/gather/gather_rays.h"
#include "raytrace/incoming/incoming_light.h"
#include "raytrace/paths/path_walker.h"
#include "raytrace/share/off_grid.h"
#include "raytrace/share/share.h"

namespace earthshine::raytrace {

inline constexpr std::size_t no_point = static_cast<std::size_t>(-1);

// Where light is gathered: on the lit side of a diffuse or glossy surface.
struct GatherRequest {
  Vec3 position, normal;
  double reflectance = 1.0;  // luminance of k_d
  double lobe = 0.0;         // luminance of k_s; 0 for exponents of tuning::sharp_lobe or more
  std::uint32_t material = 0;
};
using GatherSurface = std::function<bool(const scenes::Hit&, GatherRequest&)>;

// A surface point as the camera sees it: at its virtual position if a mirror shows it.
struct Sighting {
  glm::vec3 position, normal;  // relative to RayQuery::near() of the camera, m; unit
  bool in_mirror = false;
};
[[nodiscard]] inline Sighting sighting_of(const GatherPoint& point) {
  return {point.position, point.normal, point.mirror != seen_straight};
}
// The plane of a mirror where a ray meets it.
struct MirrorPlane {
  Vec3 place, normal;
  [[nodiscard]] Vec3 image(const Vec3& position) const {
    return position - 2.0 * glm::dot(position - place, normal) * normal;
  }
};

// Whether the gather point lies on the surface that is seen at `place`.
[[nodiscard]] bool lies_on_surface(const GatherPoint& point, const Sighting& place);
// Also that its lobe, if any, may be read there: the normals agree.
[[nodiscard]] bool stands_for(const GatherPoint& point, const Sighting& place);

enum class Gathered { Solution, Residual, Lobe };
inline constexpr std::size_t gathered_kinds = 3;

class GatherField {
 public:
  struct Setting {
    std::size_t image_layers = 1;
    int step = 1;                  // pixels of the picture along the edge of a pixel of the field
    bool keeps_sky_apart = false;  // one more layer: light straight from the sky
    bool gathers_residual = true;
    bool shares = true;         // denoises between neighbours
    bool notes_layers = false;  // stores the half differences of all layers, round by round
    std::span<const std::uint8_t> noted = {};  // per pixel of the picture, 1: all of its points are
                                               // noted
    std::uint64_t seed = 1;
  };
  // Finds the points: one for each pixel of the field, row by row, then the off-grid points.
  // camera: of the picture, whose columns and rows are multiples of the step. `world` and
  // `incoming` must outlive the field.
  GatherField(const PathWorld& world, const IncomingLight& incoming, const GatherSurface& surface,
              const CameraModel& camera, const Setting& setting);

  // Casts samples at every point: more[point], rounded down to fewest_samples(kind) times a power
  // of two. round: number of the call for that kind.
  void cast(Gathered kind, const std::vector<std::uint32_t>& more, std::uint32_t round,
            const std::function<bool()>& stop);
  // Initial samples: `each` at every point, or only at every second pixel of interior regions,
  // whose neighbours share them. If `each` is the fewest lobe rays, lobes above the mean get more.
  void sample_initial(Gathered kind, std::uint32_t each, bool every_second,
                      const std::function<bool()>& stop);
  // Fewest samples where a stop or the time limit left none of a kind. Where neighbours share, the
  // middle one of 25 pixels serves the surrounding pixels of the same surface; any other pixel is
  // served by a new point as far to the right and below as possible. In mirrors, all points with
  // fewer than four sampled mirror neighbours are sampled.
  void sample_sparse(Gathered kind);
  // Least number of samples per call: two halves of the fewest.
  [[nodiscard]] static std::uint32_t fewest_samples(Gathered kind);
  [[nodiscard]] bool gathers(Gathered kind) const;
  // Denoises the samples of a kind and updates diffuse_sum() and lobe_sum(). The residual comes
  // after the solution. last: no more samples of that kind follow; frees them and fills diffuse()
  // and lobe() layer by layer.
  void share(Gathered kind, bool last);

  // The point of pixel (x, y) of the picture whose values apply to the surface at `place`: on the
  // same surface and near, relative to its surroundings. no_point if there is none.
  [[nodiscard]] std::size_t find(int x, int y, const Sighting& place) const;
  // For slivers without a point in find(), and glossy surfaces with a varying normal: the nearest
  // point on the same surface in the pixel and the eight around it. For lobes the normals must
  // agree, too.
  [[nodiscard]] std::size_t find_beside(int x, int y, const Sighting& place, Gathered kind) const;
  // The points and weights for a place whose point is `own`. With one point for several pixels, the
  // weights are bilinear over the nearest points; weights of points that do not apply go to `own`.
  struct Reading {
    std::array<std::size_t, 4> point{};
    std::array<float, 4> weight{};
    std::size_t count = 0;
  };
  [[nodiscard]] Reading reading(int x, int y, const Sighting& place, std::size_t own,
                                Gathered kind) const;
  // Sums over the image layers.
  [[nodiscard]] const glm::vec3& diffuse_sum(std::size_t point) const { return sums_[0][point]; }
  [[nodiscard]] const glm::vec3& lobe_sum(std::size_t point) const { return sums_[1][point]; }
  // Incident radiance, to be multiplied by k_d, cd/m^2: image layers, then light straight from the
  // sky.
  [[nodiscard]] std::span<const glm::vec3> diffuse(std::size_t point) const {
    return {&diffuse_[point * layers_], layers_};
  }
  // Incident radiance, to be multiplied by k_s: image layers. Empty without a gathered lobe.
  [[nodiscard]] std::span<const glm::vec3> lobe(std::size_t point) const;

  [[nodiscard]] int step() const { return setting_.step; }
  // All pixels of the field, and the pixel of a point.
  [[nodiscard]] const Window& window() const { return window_; }
  [[nodiscard]] std::size_t pixel_of(std::size_t point) const {
    return point < grid_ ? point : off_grid_points_[point - grid_].pixel;
  }

  // The pixel of the picture in the middle of a point's pixel.
  [[nodiscard]] std::array<int, 2> picture_pixel(std::size_t point) const;
  [[nodiscard]] double cover_of(std::size_t point) const {
    return point < grid_ ? 1.0 : double(off_grid_points_[point - grid_].cover);
  }
  // Whether the centres of the field's pixel that holds (x, y) of the picture, and of the pixels
  // around it, lie on one surface, or on none.
  [[nodiscard]] bool is_interior(int x, int y) const {
    return interior_[window_.index(x / setting_.step, y / setting_.step)] != 0;
  }
  // Number of ray origins: 1, or several all over the pixel.
  [[nodiscard]] std::size_t origins_at(std::size_t point) const {
    return over_pixel_[point] != 0 ? RayOrigins::most : 1;
  }
  [[nodiscard]] std::size_t image_layers() const { return image_layers_; }
  [[nodiscard]] const std::vector<GatherPoint>& points() const { return points_; }
  [[nodiscard]] const Shared& shared(Gathered kind) const { return shared_[number(kind)]; }
  [[nodiscard]] float samples(Gathered kind, std::size_t point) const {
    return estimate_[number(kind)].samples[point];
  }
  // Standard error of the estimate, before reflection.
  [[nodiscard]] double error_of(Gathered kind, std::size_t point) const;
  // The factor from the estimate to the visible radiance: k_d or k_s.
  [[nodiscard]] double reflected(Gathered kind, std::size_t point) const;
  // one_in: LayerNoise::selects().
  [[nodiscard]] LayerNoise layer_noise(Gathered kind, std::size_t one_in = 1) const;
  // Sums of the samples so far, before denoising, by layer.
  [[nodiscard]] std::span<const glm::vec3> sampled(Gathered kind, std::size_t point) const {
    return {&estimate_[number(kind)].sum[point * estimate_[number(kind)].layers], image_layers_};
  }
  [[nodiscard]] RayCounts rays() const;  // all kinds
  [[nodiscard]] const RayCounts& rays_of(Gathered kind) const { return rays_of_[number(kind)]; }

 private:
  [[nodiscard]] double mean_lobe() const;  // over points with a lobe
  static std::size_t number(Gathered kind) { return static_cast<std::size_t>(kind); }
  struct Found {
    OffGridPoint off_grid_point;
    GatherPoint point;
    RayStart start;
  };
  // Finds the points behind the pixels' centres. Returns the points in mirrors, which are off-grid.
  std::vector<Found> find_points();
  void find_off_grid_points(const std::vector<Found>& mirrored);
  void append_off_grid_points(const std::vector<std::vector<Found>>& found);  // by tile
  // Whether a pixel's centre and the centres around it lie on one surface, or on none.
  [[nodiscard]] bool one_surface_around(std::size_t pixel) const;
  // Other surfaces than at the centre that eight rays through the pixel meet, with their bases.
  [[nodiscard]] std::vector<Found> points_beside(std::size_t pixel) const;
  // Finds the neighbours of points in mirrors.
  void find_mirror_neighbours();
  // Points whose rays start all over their pixel from the initial samples on: points next to other
  // surfaces (on the payload bay the rays' lengths would select three in four of them), and glossy
  // points whose neighbours have another normal.
  void find_first_origins();
  // The gather point at a camera ray's hit; false if no light is gathered there.
  bool place(const Ray& ray, const scenes::Hit& hit, GatherPoint& point, RayStart& start) const;
  // The same for the surface in a flat or curved mirror without transmission.
  bool place_mirrored(const Ray& ray, const scenes::Hit& hit, GatherPoint& point,
                      RayStart& start) const;
  // Hits of rays through some places of a pixel, at most eight.
  using Places = std::array<double, scenes::RayPacket::width>;
  struct Met {
    Ray ray;
    scenes::Hit hit;
  };
  [[nodiscard]] std::array<Met, scenes::RayPacket::width> trace_pixel(
      std::size_t pixel, const Places& x, const Places& y, std::size_t first = 0,
      std::size_t end = scenes::RayPacket::width) const;
  // Finds further points whose rays must start all over their pixel, by the lengths of all their
  // rays, and replaces their samples by as many new ones.
  void classify_origins(std::uint32_t round, const std::function<bool()>& stop);
  // find() by a pixel of the field.
  [[nodiscard]] std::size_t find_in(int x, int y, const Sighting& place) const;
  // Distance of the corners of a pixel's footprint on the surface from its point, m.
  [[nodiscard]] float footprint_radius(const GatherPoint& point) const;
  // Distance up to which a point always applies to its surface, m.
  [[nodiscard]] float own_radius(std::size_t point) const;
  // Origins of this number of rays of a point, other places for each `stream`.
  [[nodiscard]] RayOrigins draw_origins(Gathered kind, std::size_t point, std::uint32_t stream,
                                        std::uint32_t rays, RayCounts& counts) const;
  // Column and row, in the field, of a pixel of the window.
  [[nodiscard]] std::array<int, 2> place_of(std::size_t pixel) const;
  // All points of a tile, pixel by pixel.
  [[nodiscard]] std::vector<std::size_t> points_of_tile(std::size_t tile) const;
  // Key of a point's random numbers, independent of the crop.
  [[nodiscard]] std::uint64_t random_number_of(std::size_t point) const;
  // Whether the layers' noise is noted at a point, and how many points it represents.
  [[nodiscard]] bool notes(std::size_t point) const { return noted_weight(point) > 0.0F; }
  [[nodiscard]] float noted_weight(std::size_t point) const;
  // The difference of the sums of a round's halves, at noted points.
  struct Notes {
    std::vector<std::uint32_t> point;
    std::vector<float> off;  // row * layers
    void add(std::size_t at, std::span<const float> off_by);
  };
  static void note_half(std::uint32_t half, std::span<const Rgb> sum, std::span<float> off);
  void add_notes(Gathered kind, const std::vector<Notes>& of_tiles);
  void drop_notes(Gathered kind, const std::vector<std::uint32_t>& anew);
  [[nodiscard]] Shared share_among(Gathered kind, Estimate& estimate, bool in_place);
  void add_totals(Gathered kind);  // into sums_, from total_
  void add_layers(Gathered kind);  // into sums_, from all layers
  void cast_solution(const std::vector<std::uint32_t>& more, std::uint32_t round,
                     const std::function<bool()>& stop);
  void cast_paths(Gathered kind, const std::vector<std::uint32_t>& more, std::uint32_t round,
                  const std::function<bool()>& stop);
  void lobe_sample(std::uint32_t material, const RayStart& start, const std::array<float, 2>& u,
                   PathWalker& walker, base::Rng& rng, std::vector<Rgb>& sum,
                   RayCounts& counts) const;

  const PathWorld& world_;
  const IncomingLight& incoming_;
  GatherSurface surface_;
  CameraModel camera_;
  Vec3 origin_;    // of the points' positions: RayQuery::near() of the camera
  glm::vec3 eye_;  // position of the camera, relative to origin_
  Window window_;
  Setting setting_;
  std::size_t grid_;  // number of grid points
  std::size_t image_layers_, layers_;
  std::vector<GatherPoint> points_;
  std::vector<OffGridPoint> off_grid_points_;  // after the grid points
  std::vector<std::uint32_t> first_off_grid_;  // per pixel, and one past the last
  std::vector<RayStart> start_;
  std::vector<RayLengths> lengths_;       // of the rays that read the solution
  std::vector<std::uint8_t> interior_;    // per pixel, 1: is_interior()
  std::vector<std::uint8_t> over_pixel_;  // per point, 1: rays start all over its pixel
  std::array<Estimate, gathered_kinds> estimate_;
  std::array<Shared, gathered_kinds> shared_;
  std::vector<glm::vec3> diffuse_;                            // point * layers
  std::array<std::vector<glm::vec3>, gathered_kinds> total_;  // denoised sum of several layers
  std::array<std::vector<glm::vec3>, 2> sums_;                // of the image layers: diffuse, lobe
  std::array<RayCounts, gathered_kinds> rays_of_;
  std::array<Notes, gathered_kinds> notes_;
  std::vector<std::uint64_t> mirror_neighbours_;  // per off-grid point (MirrorNeighbourhood::masks)
  std::uint64_t camera_rays_ = 0;
  bool any_lobe_ = false;
  std::optional<Neighbours> of_surface_, of_material_;  // neighbourhoods for diffuse light and for
                                                        // lobes
};

}  // namespace earthshine::raytrace
