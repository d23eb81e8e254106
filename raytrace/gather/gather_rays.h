// SPDX-License-Identifier: Apache-2.0
// The rays of the final gather from the points of a tile: cosine-distributed, Owen-scrambled Sobol
// per point. Eight neighbouring points cast rays into the same cell of the hemisphere together.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/numbers/random.h"
#include "base/numbers/sobol_set.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

inline constexpr std::size_t packet_width = scenes::RayPacket::width;
inline constexpr int gather_tile_px = 8;
inline constexpr std::size_t most_tile_points =
    static_cast<std::size_t>(gather_tile_px) * gather_tile_px;

// Start of rays on a surface: position off the surface, unit normal on that side, and direction of
// the camera ray that met it.
struct RayStart {
  Vec3 position{0.0};
  glm::vec3 normal{0.0F}, along{0.0F};
};

// The start points of a point's rays: one behind its pixel's centre, or several in its pixel.
struct RayOrigins {
  static constexpr std::size_t most = packet_width;
  std::size_t count = 0;
  std::array<RayStart, most> start;
  void add(const RayStart& one) { start[count++] = one; }
};

// Lengths of rays that end on a surface. Misses are far and vary little nearby.
struct RayLengths {
  double inverse = 0.0, count = 0.0;        // sum of 1 / m, number of rays
  double light_inverse = 0.0, light = 0.0;  // the same, weighted by luminance, cd/m^2
  void add(double length_m, double luminance) {
    const double near = 1.0 / std::max(length_m, 1e-6);
    inverse += near, count += 1.0;
    add_light(length_m, luminance);
  }
  // Adds a ray aimed at a bright patch at that distance.
  void add_light(double length_m, double luminance) {
    light_inverse += luminance / std::max(length_m, 1e-6), light += luminance;
  }
  void operator+=(const RayLengths& more) {
    inverse += more.inverse, count += more.count;
    light_inverse += more.light_inverse, light += more.light;
  }
  [[nodiscard]] double harmonic_mean() const { return count / inverse; }
  // Harmonic mean distance of the light: a small bright surface may be near where most is far.
  [[nodiscard]] double harmonic_mean_of_light() const {
    return light > 0.0 ? light / light_inverse : harmonic_mean();
  }
};

// The points of one tile, side by side for SIMD; all have the same number of ray origins.
struct TilePoints {
  struct OriginSet {
    std::array<Vec3, most_tile_points> origin, normal;
    alignas(32) float origin_x[most_tile_points], origin_y[most_tile_points],
        origin_z[most_tile_points];
    alignas(32) float tangent_x[most_tile_points], tangent_y[most_tile_points],
        tangent_z[most_tile_points];
    alignas(32) float bitangent_x[most_tile_points], bitangent_y[most_tile_points],
        bitangent_z[most_tile_points];
    alignas(32) float normal_x[most_tile_points], normal_y[most_tile_points],
        normal_z[most_tile_points];
  };
  std::array<std::size_t, most_tile_points> index;
  std::array<std::uint64_t, most_tile_points> pixel;
  std::vector<OriginSet> sets;
  std::size_t count = 0;

  explicit TilePoints(std::size_t origins) : sets(origins) {}
  // Repeats the origins of a point if it has fewer than there are sets.
  void add(std::size_t at, std::uint64_t of_pixel, const RayOrigins& of_point, const Vec3& centre) {
    const std::size_t k = count++;
    index[k] = at;
    pixel[k] = of_pixel;
    for (std::size_t s = 0; s < sets.size(); ++s) {
      OriginSet& to = sets[s];
      const RayStart& start = of_point.start[s % of_point.count];
      const Vec3 &lifted = start.position, up(start.normal);
      const base::Frame3 frame = base::frame_around(up);
      const glm::vec3 o(lifted - centre), t(frame.tangent), b(frame.bitangent), n(up);
      to.origin[k] = lifted;
      to.normal[k] = up;
      to.origin_x[k] = o.x, to.origin_y[k] = o.y, to.origin_z[k] = o.z;
      to.tangent_x[k] = t.x, to.tangent_y[k] = t.y, to.tangent_z[k] = t.z;
      to.bitangent_x[k] = b.x, to.bitangent_y[k] = b.y, to.bitangent_z[k] = b.z;
      to.normal_x[k] = n.x, to.normal_y[k] = n.y, to.normal_z[k] = n.z;
    }
  }
  // Origins of ray j: rays in a row or column of the hemisphere's cells use all origins in turn.
  [[nodiscard]] const OriginSet& set_of(std::size_t j) const {
    return sets[(j + j / RayOrigins::most) % sets.size()];
  }
};

// The samples of all points of a batch, by cells.
class GatherRays {
 public:
  // rays: per point, a power of two, 4 or more.
  explicit GatherRays(std::uint32_t rays);
  [[nodiscard]] std::size_t rays() const { return set_.count(); }
  // Most points of a batch whose samples stay in cache.
  [[nodiscard]] std::size_t batch() const;

  // Samples of a batch: [cell][sample in the cell][point], the points padded to whole packets.
  struct Samples {
    std::size_t padded = 0;
    std::vector<float> u, v;
  };
  void draw(const TilePoints& points, std::size_t first, std::size_t count, std::uint64_t seed,
            Samples& samples) const;

  // Ray j, below rays(), of the eight points from first + offset on, and its cosines.
  static void make(const TilePoints& points, std::size_t first, std::size_t offset, std::size_t j,
                   const Samples& samples, scenes::RayPacket& rays,
                   std::array<float, packet_width>& cosine);

 private:
  void fill(std::size_t point, base::Key key, Samples& samples) const;

  base::SobolSet4 set_;
  std::size_t cells_ = 1;
  float columns_ = 1.0F, rows_ = 1.0F;
};

}  // namespace earthshine::raytrace
