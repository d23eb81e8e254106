// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "base/sobol_set.h"
#include "base/turn.h"
#include "raytrace/same_surface.h"

namespace earthshine::raytrace {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr int tile_edge_px = 8;
constexpr std::size_t width = RayPacket::width;
constexpr std::size_t most_cells = 64;  // of the hemisphere, one packet's rays all lie in one
constexpr std::size_t most_points = static_cast<std::size_t>(tile_edge_px) * tile_edge_px;

// The points of one tile, side by side for the vector units.
struct TilePoints {
  std::array<std::size_t, most_points> index;
  std::array<std::uint64_t, most_points> pixel;
  std::array<Vec3, most_points> origin, normal;
  alignas(32) float origin_x[most_points], origin_y[most_points], origin_z[most_points];
  alignas(32) float tangent_x[most_points], tangent_y[most_points], tangent_z[most_points];
  alignas(32) float bitangent_x[most_points], bitangent_y[most_points], bitangent_z[most_points];
  alignas(32) float normal_x[most_points], normal_y[most_points], normal_z[most_points];
  std::array<double, most_points> inverse_length, luminance, luminance2;
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
    inverse_length[k] = luminance[k] = luminance2[k] = 0.0;
  }
};

// Sample j of a cell for every point: every power of two of Owen-Sobol points has equally many in
// each cell, so that a cell's rays of neighbouring points run side by side.
class CellSamples {
 public:
  explicit CellSamples(std::uint32_t rays) : set_(rays) {
    cells_ = std::min<std::size_t>(rays, most_cells);
    const int log2 = std::countr_zero(static_cast<std::uint32_t>(cells_));
    columns_ = static_cast<float>(1 << ((log2 + 1) / 2));
    rows_ = static_cast<float>(1 << (log2 / 2));
  }
  [[nodiscard]] std::size_t rays() const { return set_.count(); }

  // Fills u and v [cell][sample][point] for one point.
  void fill(std::size_t point, std::size_t points, base::Key key, std::vector<float>& u,
            std::vector<float>& v) const {
    const base::SobolSet4::Scramble scramble(key);
    const std::size_t per_cell = set_.count() / cells_;
    std::array<std::size_t, most_cells> used{};
    base::SobolSet4::Points p;
    for (std::uint32_t first = 0; first < set_.count(); first += base::SobolSet4::width) {
      set_.points(first, scramble, p);
      for (std::size_t k = 0; k < base::SobolSet4::width; ++k) {
        const auto column = static_cast<std::size_t>(p.x[0][k] * columns_);
        const auto row = static_cast<std::size_t>(p.x[1][k] * rows_);
        const std::size_t cell = row * static_cast<std::size_t>(columns_) + column;
        const std::size_t at = (cell * per_cell + used[cell]++) * points + point;
        u[at] = p.x[0][k];
        v[at] = p.x[1][k];
      }
    }
  }

 private:
  base::SobolSet4 set_;
  std::size_t cells_ = 1;
  float columns_ = 1.0F, rows_ = 1.0F;
};

class Gatherer {
 public:
  Gatherer(const scenes::RayQuery& query, const IncomingLight& incoming, const CellSamples& samples,
           const GatherOptions& options, std::size_t layers)
      : query_(query), incoming_(incoming), samples_(samples), options_(options), layers_(layers) {}

  // sums: points * layers.
  void run(TilePoints& points, std::vector<Rgb>& sums, std::uint64_t& rays,
           std::uint64_t& mirror_rays) {
    sums.assign(points.count * layers_, Rgb(0.0));
    const bool shares = !incoming_.bright().empty();
    const std::size_t aimed = shares ? std::max<std::size_t>(1, samples_.rays() / 16) : 0;
    // Few points at a time where each has many rays, so that the samples stay in cache.
    const std::size_t batch = std::clamp<std::size_t>(65536 / samples_.rays(), width, most_points);
    for (std::size_t first = 0; first < points.count; first += batch) {
      const std::size_t count = std::min(batch, points.count - first);
      const std::size_t padded = (count + width - 1) / width * width;
      u_.resize(samples_.rays() * padded);
      v_.resize(samples_.rays() * padded);
      for (std::size_t k = 0; k < count; ++k) {
        samples_.fill(k, padded,
                      base::Key(options_.seed, base::Stream::FinalGather, points.pixel[first + k]),
                      u_, v_);
      }
      for (std::size_t j = 0; j < samples_.rays(); ++j) {
        for (std::size_t k = 0; k < count; k += width) {
          cast(points, first + k, std::min(width, count - k), &u_[j * padded + k],
               &v_[j * padded + k], static_cast<double>(aimed), sums, mirror_rays);
        }
      }
    }
    rays += points.count * samples_.rays();
    for (std::size_t k = 0; k < points.count; ++k) {
      aim(points, k, aimed, sums, mirror_rays);
      rays += aimed;
    }
  }

 private:
  void cast(TilePoints& points, std::size_t first, std::size_t count, const float* u,
            const float* v, double aimed, std::vector<Rgb>& sums, std::uint64_t& mirror_rays) {
    RayPacket rays;
    alignas(32) float height[width];
    for (std::size_t k = 0; k < width; ++k) {
      // Lanes past the last point repeat what stands there; their hits are not read.
      const std::size_t p = first + k;
      const float radius = std::sqrt(u[k]);
      height[k] = std::sqrt(1.0F - u[k]);
      const base::Turned way = base::turn(v[k]);
      const float x = radius * way.cosine, y = radius * way.sine, z = height[k];
      rays.origin_x[k] = points.origin_x[p];
      rays.origin_y[k] = points.origin_y[p];
      rays.origin_z[k] = points.origin_z[p];
      rays.direction_x[k] =
          x * points.tangent_x[p] + y * points.bitangent_x[p] + z * points.normal_x[p];
      rays.direction_y[k] =
          x * points.tangent_y[p] + y * points.bitangent_y[p] + z * points.normal_y[p];
      rays.direction_z[k] =
          x * points.tangent_z[p] + y * points.bitangent_z[p] + z * points.normal_z[p];
      rays.t_max[k] = std::numeric_limits<float>::infinity();
    }
    HitPacket hits;
    query_.closest(rays, count, hits);
    RayShare share;
    share.found_rays = static_cast<double>(samples_.rays());
    share.aimed_rays = aimed;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
      if (aimed > 0.0) share.cosine = static_cast<double>(height[k]);
      const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
      if (!hit.missed()) points.inverse_length[first + k] += 1.0 / std::max(hit.t, 1e-6);
      bring(points, first + k, hit, direction, share, 1.0 / share.found_rays, sums, mirror_rays);
    }
  }

  void aim(TilePoints& points, std::size_t k, std::size_t count, std::vector<Rgb>& sums,
           std::uint64_t& mirror_rays) {
    base::Rng rng(
        base::Key(options_.seed, base::Stream::FinalGather, points.pixel[k]).with(samples_.rays()));
    for (std::size_t j = 0; j < count; ++j) {
      const double choice = rng.next(), x = rng.next(), y = rng.next();
      const auto aimed =
          incoming_.aim(points.origin[k], points.normal[k], choice, x, y,
                        static_cast<double>(samples_.rays()), static_cast<double>(count));
      if (aimed.weight <= 0.0) continue;
      bring(points, k, query_.closest(points.origin[k], aimed.direction), aimed.direction,
            aimed.share, aimed.weight, sums, mirror_rays);
    }
  }

  void bring(TilePoints& points, std::size_t k, const scenes::Hit& hit, const Vec3& direction,
             const RayShare& share, double weight, std::vector<Rgb>& sums,
             std::uint64_t& mirror_rays) {
    const std::span<Rgb> out(&sums[k * layers_], layers_);
    const double before = luminance_sum(out);
    incoming_.add(hit, direction, share, Rgb(weight), out, mirror_rays);
    const double brought = luminance_sum(out) - before;
    points.luminance[k] += brought;
    points.luminance2[k] += brought * brought;
  }

  [[nodiscard]] double luminance_sum(std::span<const Rgb> layers) const {
    Rgb sum(0.0);
    for (std::size_t k = 0; k < options_.image_layers; ++k) sum += layers[k];
    return base::luminance(sum);
  }

  const scenes::RayQuery& query_;
  const IncomingLight& incoming_;
  const CellSamples& samples_;
  const GatherOptions& options_;
  std::size_t layers_;
  std::vector<float> u_, v_;
};

// The points of a tile: what the rays through its pixels' centres meet.
void find_points(const scenes::RayQuery& query, const GatherSurface& surface,
                 const CameraModel& camera, const Window& tile, GatherField& field,
                 TilePoints& points) {
  RayPacket packet;
  HitPacket hits;
  std::array<Ray, width> rays;
  const double pixel_m = 2.0 * camera.half_height / camera.rows;  // at unit distance
  for (int y = tile.y; y < tile.y + tile.rows; ++y) {
    const auto count = static_cast<std::size_t>(tile.columns);
    for (std::size_t k = 0; k < count; ++k) {
      rays[k] = camera.ray(tile.x + static_cast<double>(k) + 0.5, y + 0.5, 0.0, 0.0);
      query.set(packet, k, rays[k].origin, rays[k].direction);
    }
    query.closest(packet, count, hits);
    for (std::size_t k = 0; k < count; ++k) {
      const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
      GatherRequest wanted;
      if (hit.missed() || !surface(hit, wanted)) continue;
      const int x = tile.x + static_cast<int>(k);
      const std::size_t index = field.window.index(x, y);
      GatherPoint& point = field.points[index];
      point.position = glm::vec3(wanted.position - camera.position);
      point.normal = glm::vec3(wanted.normal);
      point.spacing_m = static_cast<float>(hit.t * pixel_m);
      points.add(index,
                 static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
                     static_cast<std::uint64_t>(x),
                 wanted.position + wanted.normal * query.surface_offset_m(), wanted.normal,
                 query.centre());
    }
  }
}

}  // namespace

GatherField gather_field(const scenes::RayQuery& query, const IncomingLight& incoming,
                         const GatherSurface& surface, const CameraModel& camera,
                         const Window& window, const GatherOptions& options) {
  GatherField field;
  field.window = window;
  field.image_layers = options.image_layers;
  field.layers = options.image_layers + (options.keeps_sky_apart ? 1 : 0);
  field.points.resize(window.pixel_count());
  field.radiance.assign(window.pixel_count() * field.layers, glm::vec3(0.0F));
  field.squared_error.assign(window.pixel_count(), 0.0F);
  const CellSamples samples(static_cast<std::uint32_t>(options.rays));
  // Tiles lie on a grid of the picture, so that a window of it casts the same packets.
  const int x0 = window.x / tile_edge_px, x1 = (window.x + window.columns - 1) / tile_edge_px + 1;
  const int y0 = window.y / tile_edge_px, y1 = (window.y + window.rows - 1) / tile_edge_px + 1;
  const auto columns = static_cast<std::size_t>(x1 - x0);
  const std::size_t tiles = columns * static_cast<std::size_t>(y1 - y0);
  std::mutex mutex;
  std::size_t done = 0;
  base::parallel_chunks(tiles, 1, [&](std::size_t t, std::size_t) {
    if (options.stop && options.stop()) return;
    Window tile;
    tile.x = std::max(window.x, (x0 + static_cast<int>(t % columns)) * tile_edge_px);
    tile.y = std::max(window.y, (y0 + static_cast<int>(t / columns)) * tile_edge_px);
    const int right = (x0 + static_cast<int>(t % columns) + 1) * tile_edge_px;
    const int bottom = (y0 + static_cast<int>(t / columns) + 1) * tile_edge_px;
    tile.columns = std::min(right, window.x + window.columns) - tile.x;
    tile.rows = std::min(bottom, window.y + window.rows) - tile.y;
    TilePoints points;
    find_points(query, surface, camera, tile, field, points);
    Gatherer gatherer(query, incoming, samples, options, field.layers);
    std::vector<Rgb> sums;
    std::uint64_t rays = 0, mirror_rays = 0;
    gatherer.run(points, sums, rays, mirror_rays);
    const auto n = static_cast<double>(options.rays);
    for (std::size_t k = 0; k < points.count; ++k) {
      GatherPoint& point = field.points[points.index[k]];
      point.reach_m = static_cast<float>(n / std::max(points.inverse_length[k], 1e-30));
      for (std::size_t layer = 0; layer < field.layers; ++layer) {
        field.radiance[points.index[k] * field.layers + layer] =
            glm::vec3(sums[k * field.layers + layer]);
      }
      const double mean = points.luminance[k];
      field.squared_error[points.index[k]] =
          static_cast<float>(std::max(0.0, points.luminance2[k] - mean * mean / n));
    }
    const std::lock_guard lock(mutex);
    field.gather_rays += rays;
    field.mirror_rays += mirror_rays;
    field.camera_rays += tile.pixel_count();
    if (options.progress) options.progress(++done, tiles);
  });
  return field;
}

}  // namespace earthshine::raytrace
