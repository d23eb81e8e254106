// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather/gather_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/azimuth.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t most_cells = 64;

}  // namespace

GatherRays::GatherRays(std::uint32_t rays) : set_(rays) {
  cells_ = std::min<std::size_t>(rays, most_cells);
  const int log2 = std::countr_zero(static_cast<std::uint32_t>(cells_));
  columns_ = static_cast<float>(1 << ((log2 + 1) / 2));
  rows_ = static_cast<float>(1 << (log2 / 2));
}

std::size_t GatherRays::batch() const {
  return std::clamp<std::size_t>(65536 / rays(), packet_width, most_tile_points);
}

void GatherRays::draw(const TilePoints& points, std::size_t first, std::size_t count,
                      std::uint64_t seed, Samples& samples) const {
  samples.padded = (count + packet_width - 1) / packet_width * packet_width;
  samples.u.resize(rays() * samples.padded);
  samples.v.resize(rays() * samples.padded);
  for (std::size_t k = 0; k < count; ++k) {
    // A later call with more rays draws other samples.
    fill(k, base::Key(seed, base::Stream::FinalGather, points.pixel[first + k]).with(rays()),
         samples);
  }
}

// Every power of two of Owen-scrambled Sobol points has equally many points in each cell.
void GatherRays::fill(std::size_t point, base::Key key, Samples& samples) const {
  const base::SobolSet4::Scramble scramble(key);
  const std::size_t per_cell = rays() / cells_;
  std::array<std::size_t, most_cells> used{};
  base::SobolSet4::Points p;
  const auto at_once = std::min<std::size_t>(base::SobolSet4::width, rays());
  for (std::uint32_t first = 0; first < rays(); first += base::SobolSet4::width) {
    set_.points(first, scramble, p);
    for (std::size_t k = 0; k < at_once; ++k) {
      const auto column = static_cast<std::size_t>(p.x[0][k] * columns_);
      const auto row = static_cast<std::size_t>(p.x[1][k] * rows_);
      const std::size_t cell = row * static_cast<std::size_t>(columns_) + column;
      const std::size_t at = (cell * per_cell + used[cell]++) * samples.padded + point;
      samples.u[at] = p.x[0][k];
      samples.v[at] = p.x[1][k];
    }
  }
}

void GatherRays::make(const TilePoints& points, std::size_t first, std::size_t offset,
                      std::size_t j, const Samples& samples, scenes::RayPacket& rays,
                      std::array<float, packet_width>& cosine) {
  const float* u = &samples.u[j * samples.padded + offset];
  const float* v = &samples.v[j * samples.padded + offset];
  const TilePoints::OriginSet& from = points.set_of(j);
  for (std::size_t k = 0; k < packet_width; ++k) {
    // Lanes past the last point are ignored.
    const std::size_t p = first + offset + k;
    const float radius = std::sqrt(u[k]), z = std::sqrt(1.0F - u[k]);
    const base::Azimuth azimuth = base::azimuth_of(v[k]);
    const float x = radius * azimuth.cosine, y = radius * azimuth.sine;
    cosine[k] = z;
    rays.origin_x[k] = from.origin_x[p];
    rays.origin_y[k] = from.origin_y[p];
    rays.origin_z[k] = from.origin_z[p];
    rays.direction_x[k] = x * from.tangent_x[p] + y * from.bitangent_x[p] + z * from.normal_x[p];
    rays.direction_y[k] = x * from.tangent_y[p] + y * from.bitangent_y[p] + z * from.normal_y[p];
    rays.direction_z[k] = x * from.tangent_z[p] + y * from.bitangent_z[p] + z * from.normal_z[p];
    rays.t_max[k] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace earthshine::raytrace
