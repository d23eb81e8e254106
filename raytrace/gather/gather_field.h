// SPDX-License-Identifier: Apache-2.0
// The final gather on a grid: at the surface point behind every pixel's centre, what comes in,
// shared by all of the pixel's camera samples and by neighbouring points (share.h). Three things
// are estimated at each point, each with as many samples as it needs. Where the pixel shows other
// surfaces beside the one behind its centre, each of these has a point of its own, an off-grid point
// (off-grid points.h), which lies on no grid. Where what comes in changes within a pixel, as its
// rays' lengths tell, or a glossy surface turns from one pixel to the next, they start from several
// places of the point's surface in the pixel's footprint, other ones each time: the point stands
// for their mean. So they do beside edges.
//
//   solution  mean radiance that cosine-distributed rays read from the radiosity solution, the sky
//             and what mirrors and glass pass on: T L~ over k_d, L~ what the solution says
//   residual  the same of what the solution lacks, L - L~, by paths that go on from where such rays
//             end: T (L - L~) over k_d. Whatever the solution is like, the sum has the right mean.
//   lobe      of a Phong lobe, k_s apart: radiance along rays over it, solution and residual
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

// Where light is gathered: on a diffuse or glossy surface, on a side that shines.
struct GatherRequest {
  Vec3 position, normal;
  double reflectance = 1.0;  // luminance of k_d
  double lobe = 0.0;         // of k_s; 0 where the exponent is tuning::sharp_lobe or more
  std::uint32_t material = 0;
};
using GatherSurface = std::function<bool(const scenes::Hit&, GatherRequest&)>;

// A place of a surface as the camera sees it: what is seen in a mirror is behind it.
struct Sighting {
  glm::vec3 position, normal;  // relative to RayQuery::near() of the camera, m; unit
  bool in_mirror = false;
};
[[nodiscard]] inline Sighting sighting_of(const GatherPoint& point) {
  return {point.position, point.normal, point.mirror != seen_straight};
}
// The plane that a mirror is in where a ray meets it.
struct MirrorPlane {
  Vec3 place, normal;
  [[nodiscard]] Vec3 image(const Vec3& position) const {
    return position - 2.0 * glm::dot(position - place, normal) * normal;
  }
};

// Whether the point lies on the surface that is met at a place nearby.
[[nodiscard]] bool lies_on_surface(const GatherPoint& point, const Sighting& place);
// And what is seen from it by its lobe, if it has one, is alike.
[[nodiscard]] bool stands_for(const GatherPoint& point, const Sighting& place);

enum class Gathered { Solution, Residual, Lobe };
inline constexpr std::size_t gathered_kinds = 3;

class GatherField {
 public:
  struct Setting {
    std::size_t image_layers = 1;
    int step = 1;  // pixels of the picture along the edge of one of the field's pixels
    bool keeps_sky_apart = false;  // one more layer: what came straight from the sky
    bool gathers_residual = true;
    bool shares = true;         // between neighbours
    bool notes_layers = false;  // keeps how the layers' noise goes together, round by round
    std::span<const std::uint8_t> noted = {};  // per pixel of the picture, 1: all of its points
    std::uint64_t seed = 1;
  };
  // Finds the points: one for each pixel of the field, row by row, then the off-grid points.
  // camera: of the picture, whose columns and rows are multiples of the step. `world` and
  // `incoming` must outlive it.
  GatherField(const PathWorld& world, const IncomingLight& incoming, const GatherSurface& surface,
              const CameraModel& camera, const Setting& setting);

  // Casts samples at every point: more[point], rounded down to fewest_samples(kind) times a power
  // of two; the `round`-th time.
  void cast(Gathered kind, const std::vector<std::uint32_t>& more, std::uint32_t round,
            const std::function<bool()>& stop);
  // Initial samples: `each` everywhere, or, where neighbours share and the centres of a pixel and of
  // those about it lie on one surface, at every second pixel, which serves those beside it. Of the
  // fewest lobe rays more where a lobe peaks higher than their mean.
  void sample_initial(Gathered kind, std::uint32_t each, bool every_second,
                      const std::function<bool()>& stop);
  // Where a stop or the time limit left no samples of a kind: the fewest. Where neighbours share,
  // the middle one of 25 pixels serves those about it that show the same surface, and where none
  // does a point as far on as it may be; of what mirrors show any with fewer than four such mirror
  // neighbours.
  void sample_sparse(Gathered kind);
  // The least that can be asked for at once: two halves of the fewest.
  [[nodiscard]] static std::uint32_t fewest_samples(Gathered kind);
  [[nodiscard]] bool gathers(Gathered kind) const;
  // Denoises what was cast of a kind: diffuse_sum() and lobe_sum() follow it. The residual comes
  // after the solution. last: nothing more of that kind will be cast, its samples are let go, and
  // diffuse() and lobe() have each layer.
  void share(Gathered kind, bool last);

  // A point whose values may stand for the surface point that pixel (x, y) of the picture meets:
  // one of the pixel's own, on the same surface and near for its surroundings; no_point if there is
  // none.
  [[nodiscard]] std::size_t find(int x, int y, const Sighting& place) const;
  // For what find() has no point: slivers of a pixel, and where a glossy surface turns fast. The
  // nearest point of the pixel and those about it on the same surface; for lobes one whose lobe
  // sees alike, too.
  [[nodiscard]] std::size_t find_beside(int x, int y, const Sighting& place, Gathered kind) const;
  // What stands for a place whose point is `own`: with one point for several pixels, bilinear
  // weights of the points about the pixel's middle that stand for the place, too; those of others
  // go to `own`.
  struct Reading {
    std::array<std::size_t, 4> point{};
    std::array<float, 4> weight{};
    std::size_t count = 0;
  };
  [[nodiscard]] Reading reading(int x, int y, const Sighting& place, std::size_t own,
                                Gathered kind) const;
  // Of the image layers together.
  [[nodiscard]] const glm::vec3& diffuse_sum(std::size_t point) const { return sums_[0][point]; }
  [[nodiscard]] const glm::vec3& lobe_sum(std::size_t point) const { return sums_[1][point]; }
  // Radiance to be reflected by k_d, cd/m^2: image layers, then what came straight from the sky.
  [[nodiscard]] std::span<const glm::vec3> diffuse(std::size_t point) const {
    return {&diffuse_[point * layers_], layers_};
  }
  // Radiance to be reflected by k_s: image layers. Empty where no lobe is gathered for.
  [[nodiscard]] std::span<const glm::vec3> lobe(std::size_t point) const;

  [[nodiscard]] int step() const { return setting_.step; }
  // All of the field's pixels, and in which of them a point lies.
  [[nodiscard]] const Window& window() const { return window_; }
  [[nodiscard]] std::size_t pixel_of(std::size_t point) const {
    return point < grid_ ? point : off_grid_points_[point - grid_].pixel;
  }

  // The pixel of the picture in the middle of a point's pixel.
  [[nodiscard]] std::array<int, 2> picture_pixel(std::size_t point) const;
  [[nodiscard]] double cover_of(std::size_t point) const {
    return point < grid_ ? 1.0 : double(off_grid_points_[point - grid_].cover);
  }
  // Whether the centres of the field's pixel that holds (x, y) of the picture, and of those about
  // it, lie on one surface, or on none.
  [[nodiscard]] bool is_interior(int x, int y) const {
    return even_[window_.index(x / setting_.step, y / setting_.step)] != 0;
  }
  // Places that a point's rays start from, at most: 1, or all over its pixel.
  [[nodiscard]] std::size_t origins_at(std::size_t point) const {
    return over_pixel_[point] != 0 ? RayOrigins::most : 1;
  }
  [[nodiscard]] std::size_t image_layers() const { return image_layers_; }
  [[nodiscard]] const std::vector<GatherPoint>& points() const { return points_; }
  [[nodiscard]] const Shared& shared(Gathered kind) const { return shared_[number(kind)]; }
  [[nodiscard]] float samples(Gathered kind, std::size_t point) const {
    return estimate_[number(kind)].samples[point];
  }
  // Standard error of what is estimated there, before it is reflected.
  [[nodiscard]] double error_of(Gathered kind, std::size_t point) const;
  // The factor from what is estimated to what the camera sees: k_d or k_s.
  [[nodiscard]] double reflected(Gathered kind, std::size_t point) const;
  [[nodiscard]] LayerNoise layer_noise(Gathered kind) const;
  [[nodiscard]] RayCounts rays() const;  // all
  [[nodiscard]] const RayCounts& rays_of(Gathered kind) const { return rays_of_[number(kind)]; }

 private:
  [[nodiscard]] double mean_lobe() const;  // of the points that have one
  static std::size_t number(Gathered kind) { return static_cast<std::size_t>(kind); }
  struct Found {
    OffGridPoint off_grid_point;
    GatherPoint point;
    RayStart start;
  };
  // Those behind the pixels' centres; what mirrors show there is an off-grid point, and returned.
  std::vector<Found> find_points();
  void find_off_grid_points(const std::vector<Found>& mirrored);
  // Of points that mirrors show, which others share with them.
  void find_mirror_neighbours();
  // Points whose rays start all over their pixel from the initial samples on: centres about which not
  // all lie on one surface (on the payload bay the rays' lengths tell so of three in four), and
  // glossy ones beside which their material has another normal.
  void find_first_origins();
  // Of what a camera ray met: true where light is gathered there.
  bool place(const Ray& ray, const scenes::Hit& hit, GatherPoint& point, RayStart& start) const;
  // The same of what is shown there by a flat or curved mirror that lets nothing through.
  bool place_mirrored(const Ray& ray, const scenes::Hit& hit, GatherPoint& point,
                      RayStart& start) const;
  // What rays through some places of a pixel meet, eight at most.
  using Places = std::array<double, scenes::RayPacket::width>;
  struct Met {
    Ray ray;
    scenes::Hit hit;
  };
  [[nodiscard]] std::array<Met, scenes::RayPacket::width> trace_pixel(
      std::size_t pixel, const Places& x, const Places& y, std::size_t first = 0,
      std::size_t end = scenes::RayPacket::width) const;
  // Finds more points whose rays must start all over their pixel, by the length of all their rays,
  // and casts anew there as many as they had.
  void classify_origins(std::uint32_t round, const std::function<bool()>& stop);
  // find() by a pixel of the field.
  [[nodiscard]] std::size_t find_in(int x, int y, const Sighting& place) const;
  // How far the corners of a pixel's footprint on the surface are from its point, m.
  [[nodiscard]] float footprint_radius(const GatherPoint& point) const;
  // How far about a point its surface is its pixel's, whatever is near, m.
  [[nodiscard]] float own_radius(std::size_t point) const;
  // Where so many rays of a point start, other places for each `turn`.
  [[nodiscard]] RayOrigins draw_origins(Gathered kind, std::size_t point, std::uint32_t turn,
                                        std::uint32_t rays, RayCounts& counts) const;
  // Of a pixel of the window, in the picture.
  [[nodiscard]] std::array<int, 2> place_of(std::size_t pixel) const;
  // All points of a tile, pixel by pixel.
  [[nodiscard]] std::vector<std::size_t> points_of_tile(std::size_t tile) const;
  // Tells each point's random numbers apart, whatever the crop.
  [[nodiscard]] std::uint64_t random_number_of(std::size_t point) const;
  // Whether the layers' noise is noted at a point, and for how many points it stands.
  [[nodiscard]] bool notes(std::size_t point) const { return noted_weight(point) > 0.0F; }
  [[nodiscard]] float noted_weight(std::size_t point) const;
  // The difference of the sums of a round's halves, at points that are noted.
  struct Notes {
    std::vector<std::uint32_t> point;
    std::vector<float> off;  // row * layers
    void add(std::size_t at, std::span<const float> off_by);
  };
  static void note_half(std::uint32_t half, std::span<const Rgb> sum, std::span<float> off);
  void add_notes(Gathered kind, const std::vector<Notes>& of_tiles);
  void drop_notes(Gathered kind, const std::vector<std::uint32_t>& anew);
  [[nodiscard]] Shared share_among(Gathered kind, Estimate& estimate, bool in_place);
  void add_totals(Gathered kind);  // into sums_
  void add_layers(Gathered kind);  // the same
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
  glm::vec3 eye_;  // the camera, relative to it
  Window window_;
  Setting setting_;
  std::size_t grid_;  // points that are pixels' centres
  std::size_t image_layers_, layers_;
  std::vector<GatherPoint> points_;
  std::vector<OffGridPoint> off_grid_points_;  // those after the grid
  std::vector<std::uint32_t> first_off_grid_;  // of a pixel, and behind its last
  std::vector<RayStart> start_;
  std::vector<RayLengths> lengths_;       // of the rays that read the solution
  std::vector<std::uint8_t> even_;        // per pixel, 1: is_interior()
  std::vector<std::uint8_t> over_pixel_;  // per point, 1: rays start all over its pixel
  std::array<Estimate, gathered_kinds> estimate_;
  std::array<Shared, gathered_kinds> shared_;
  std::vector<glm::vec3> diffuse_;                            // point * layers
  std::array<std::vector<glm::vec3>, gathered_kinds> total_;  // denoised, of several layers
  std::array<std::vector<glm::vec3>, 2> sums_;  // of the image layers: of diffuse_, of lobes
  std::array<RayCounts, gathered_kinds> rays_of_;
  std::array<Notes, gathered_kinds> notes_;
  std::vector<std::uint64_t>
      mirror_neighbours_;  // of an off-grid point (MirrorNeighbourhood::masks)
  std::uint64_t camera_rays_ = 0;
  bool any_lobe_ = false;
  std::optional<Neighbours> of_surface_, of_material_;  // who shares diffuse light, and lobes
};

}  // namespace earthshine::raytrace
