// SPDX-License-Identifier: Apache-2.0
#include "raytrace/gather_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "raytrace/gather_rays.h"

namespace earthshine::raytrace {
namespace {

using scenes::HitPacket;
using scenes::RayPacket;

constexpr std::size_t width = RayPacket::width;

struct TileSums {
  std::vector<Rgb> radiance;  // point * layers
  std::array<double, most_tile_points> inverse_length{}, luminance{}, luminance2{};
  std::uint64_t rays = 0;
  RayCounts onward;
};

class Gatherer {
 public:
  Gatherer(const scenes::RayQuery& query, const IncomingLight& incoming, const GatherRays& rays,
           const GatherOptions& options, std::size_t layers, const TilePoints& points)
      : query_(query),
        incoming_(incoming),
        rays_(rays),
        options_(options),
        layers_(layers),
        points_(points) {}

  [[nodiscard]] const TileSums& run() {
    sums_.radiance.assign(points_.count * layers_, Rgb(0.0));
    const bool shares = !incoming_.bright().empty();
    const std::size_t aimed = shares ? std::max<std::size_t>(1, rays_.rays() / 16) : 0;
    GatherRays::Samples samples;
    for (std::size_t first = 0; first < points_.count; first += rays_.batch()) {
      const std::size_t count = std::min(rays_.batch(), points_.count - first);
      rays_.draw(points_, first, count, options_.seed, samples);
      for (std::size_t j = 0; j < rays_.rays(); ++j) {
        for (std::size_t k = 0; k < count; k += width) {
          cast(first, k, std::min(width, count - k), j, samples, static_cast<double>(aimed));
        }
      }
    }
    for (std::size_t k = 0; k < points_.count; ++k) aim(k, aimed);
    sums_.rays = points_.count * (rays_.rays() + aimed);
    return sums_;
  }

 private:
  void cast(std::size_t first, std::size_t offset, std::size_t count, std::size_t j,
            const GatherRays::Samples& samples, double aimed) {
    RayPacket rays;
    HitPacket hits;
    std::array<float, width> cosine;
    GatherRays::make(points_, first, offset, j, samples, rays, cosine);
    query_.closest(rays, count, hits);
    RayShare share;
    share.found_rays = static_cast<double>(rays_.rays());
    share.aimed_rays = aimed;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = first + offset + k;
      const Vec3 direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
      if (aimed > 0.0) share.cosine = double(cosine[k]);
      const scenes::Hit hit{hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0};
      if (!hit.missed()) sums_.inverse_length[p] += 1.0 / std::max(hit.t, 1e-6);
      bring(p, hit, direction, share, 1.0 / share.found_rays);
    }
  }

  void aim(std::size_t k, std::size_t count) {
    base::Rng rng(base::Key(options_.seed, base::Stream::FinalGather, points_.pixel[k])
                      .with(rays_.rays())
                      .with(1));
    for (std::size_t j = 0; j < count; ++j) {
      const double choice = rng.next(), x = rng.next(), y = rng.next();
      const auto aimed =
          incoming_.aim(points_.origin[k], points_.normal[k], choice, x, y,
                        static_cast<double>(rays_.rays()), static_cast<double>(count));
      if (aimed.weight <= 0.0) continue;
      bring(k, query_.closest(points_.origin[k], aimed.direction), aimed.direction, aimed.share,
            aimed.weight);
    }
  }

  void bring(std::size_t k, const scenes::Hit& hit, const Vec3& direction, const RayShare& share,
             double weight) {
    const std::span<Rgb> out(&sums_.radiance[k * layers_], layers_);
    const double before = luminance_of(out);
    incoming_.add(hit, direction, share, Rgb(weight), out, sums_.onward);
    const double brought = luminance_of(out) - before;
    sums_.luminance[k] += brought;
    sums_.luminance2[k] += brought * brought;
  }

  [[nodiscard]] double luminance_of(std::span<const Rgb> layers) const {
    Rgb sum(0.0);
    for (std::size_t k = 0; k < options_.image_layers; ++k) sum += layers[k];
    return base::luminance(sum);
  }

  const scenes::RayQuery& query_;
  const IncomingLight& incoming_;
  const GatherRays& rays_;
  const GatherOptions& options_;
  std::size_t layers_;
  const TilePoints& points_;
  TileSums sums_;
};

// The points of a tile: what the rays through its pixels' centres meet.
void find_points(const scenes::RayQuery& query, const GatherSurface& surface,
                 const CameraModel& camera, const Window& tile,
                 const std::vector<std::uint8_t>* marks, GatherField& field, TilePoints& points) {
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
      if (marks != nullptr && (*marks)[index] == 0) continue;
      GatherPoint& point = field.points[index];
      point.position = glm::vec3(wanted.position - camera.position);
      point.normal = glm::vec3(wanted.normal);
      point.spacing_m = static_cast<float>(hit.t * pixel_m);
      point.reflectance = static_cast<float>(wanted.reflectance);
      points.add(index,
                 static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
                     static_cast<std::uint64_t>(x),
                 wanted.position + wanted.normal * query.surface_offset_m(), wanted.normal,
                 query.centre());
    }
  }
}

void cast_tiles(GatherField& field, const std::vector<std::uint8_t>* marks,
                const scenes::RayQuery& query, const IncomingLight& incoming,
                const GatherSurface& surface, const CameraModel& camera,
                const GatherOptions& options) {
  const Window& window = field.window;
  const GatherRays rays(static_cast<std::uint32_t>(options.rays));
  // Tiles lie on a grid of the picture, so that a window of it casts the same packets.
  const int x0 = window.x / gather_tile_px,
            x1 = (window.x + window.columns - 1) / gather_tile_px + 1;
  const int y0 = window.y / gather_tile_px, y1 = (window.y + window.rows - 1) / gather_tile_px + 1;
  const auto columns = static_cast<std::size_t>(x1 - x0);
  const std::size_t tiles = columns * static_cast<std::size_t>(y1 - y0);
  std::mutex mutex;
  std::size_t done = 0;
  base::parallel_chunks(tiles, 1, [&](std::size_t t, std::size_t) {
    if (options.stop && options.stop()) return;
    Window tile;
    tile.x = std::max(window.x, (x0 + static_cast<int>(t % columns)) * gather_tile_px);
    tile.y = std::max(window.y, (y0 + static_cast<int>(t / columns)) * gather_tile_px);
    const int right = (x0 + static_cast<int>(t % columns) + 1) * gather_tile_px;
    const int bottom = (y0 + static_cast<int>(t / columns) + 1) * gather_tile_px;
    tile.columns = std::min(right, window.x + window.columns) - tile.x;
    tile.rows = std::min(bottom, window.y + window.rows) - tile.y;
    TilePoints points;
    find_points(query, surface, camera, tile, marks, field, points);
    Gatherer gatherer(query, incoming, rays, options, field.layers, points);
    const TileSums& sums = gatherer.run();
    const auto n = static_cast<double>(options.rays);
    for (std::size_t k = 0; k < points.count; ++k) {
      GatherPoint& point = field.points[points.index[k]];
      point.reach_m = static_cast<float>(n / std::max(sums.inverse_length[k], 1e-30));
      point.rays = static_cast<float>(n);
      for (std::size_t layer = 0; layer < field.layers; ++layer) {
        field.radiance[points.index[k] * field.layers + layer] =
            glm::vec3(sums.radiance[k * field.layers + layer]);
      }
      const double mean = sums.luminance[k];
      field.squared_error[points.index[k]] =
          static_cast<float>(std::max(0.0, sums.luminance2[k] - mean * mean / n));
    }
    const std::lock_guard lock(mutex);
    field.gather_rays += sums.rays;
    field.onward += sums.onward;
    field.camera_rays += tile.pixel_count();
    if (options.progress) options.progress(++done, tiles);
  });
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
  cast_tiles(field, nullptr, query, incoming, surface, camera, options);
  return field;
}

void gather_again(GatherField& field, const std::vector<std::uint8_t>& marks,
                  const scenes::RayQuery& query, const IncomingLight& incoming,
                  const GatherSurface& surface, const CameraModel& camera,
                  const GatherOptions& options) {
  cast_tiles(field, &marks, query, incoming, surface, camera, options);
}

}  // namespace earthshine::raytrace
