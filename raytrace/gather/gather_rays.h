// SPDX-License-Identifier: Apache-2.0
// The rays of the final gather from a tile's points: cosine-distributed, Owen-Sobol per point,
// eight at a time from neighbouring points into the same cell of the hemisphere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/numbers/random.h"
#include "base/numbers/sobol_set.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

inline constexpr int gather_tile_px = 8;
inline constexpr std::size_t most_tile_points =
    static_cast<std::size_t>(gather_tile_px) * gather_tile_px;

// The points of one tile, side by side for the vector units.
struct TilePoints {
  std::array<std::size_t, most_tile_points> index;
  std::array<std::uint64_t, most_tile_points> pixel;
  std::array<Vec3, most_tile_points> origin, normal;
  alignas(32) float origin_x[most_tile_points], origin_y[most_tile_points],
      origin_z[most_tile_points];
  alignas(32) float tangent_x[most_tile_points], tangent_y[most_tile_points],
      tangent_z[most_tile_points];
  alignas(32) float bitangent_x[most_tile_points], bitangent_y[most_tile_points],
      bitangent_z[most_tile_points];
  alignas(32) float normal_x[most_tile_points], normal_y[most_tile_points],
      normal_z[most_tile_points];
  std::size_t count = 0;

  void add(std::size_t at, std::uint64_t of_pixel, const Vec3& lifted, const Vec3& up,
           const Vec3& centre) {
    const std::size_t k = count++;
    const base::Frame3 frame = base::frame_around(up);
    const glm::vec3 o(lifted - centre), t(frame.tangent), b(frame.bitangent), n(up);
    index[k] = at;
    pixel[k] = of_pixel;
    origin[k] = lifted;
    normal[k] = up;
    origin_x[k] = o.x, origin_y[k] = o.y, origin_z[k] = o.z;
    tangent_x[k] = t.x, tangent_y[k] = t.y, tangent_z[k] = t.z;
    bitangent_x[k] = b.x, bitangent_y[k] = b.y, bitangent_z[k] = b.z;
    normal_x[k] = n.x, normal_y[k] = n.y, normal_z[k] = n.z;
  }
};

// The samples of all points of a batch, in cells.
class GatherRays {
 public:
  // rays: per point, a power of two, 8 or more.
  explicit GatherRays(std::uint32_t rays);
  [[nodiscard]] std::size_t rays() const { return set_.count(); }
  // Points that a batch may have, so that its samples stay in cache.
  [[nodiscard]] std::size_t batch() const;

  // Samples of a batch: [cell][sample in the cell][point], the points padded to whole packets.
  struct Samples {
    std::size_t padded = 0;
    std::vector<float> u, v;
  };
  void draw(const TilePoints& points, std::size_t first, std::size_t count, std::uint64_t seed,
            Samples& samples) const;

  // Ray j, below rays(), of the eight points from first + offset on; their cosines.
  static void make(const TilePoints& points, std::size_t first, std::size_t offset, std::size_t j,
                   const Samples& samples, scenes::RayPacket& rays,
                   std::array<float, scenes::RayPacket::width>& cosine);

 private:
  void fill(std::size_t point, base::Key key, Samples& samples) const;

  base::SobolSet4 set_;
  std::size_t cells_ = 1;
  float columns_ = 1.0F, rows_ = 1.0F;
};

}  // namespace earthshine::raytrace
