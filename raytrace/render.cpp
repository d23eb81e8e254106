// SPDX-License-Identifier: Apache-2.0
#include "raytrace/render.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "raytrace/distributed_area.h"
#include "raytrace/shading.h"

namespace earthshine::raytrace {
namespace {

constexpr int tile_edge_px = 16;
constexpr std::size_t rgb = 3;

struct Sampling {
  int camera_samples = 16;  // per pixel
  int gather_rays = 16;     // per camera sample
};

// Rays per pixel shared out so that the pixel's edge and the hemisphere get about equal attention.
// Without gather rays the samples serve edges, lamps and lenses alone.
Sampling share_out(int rays_per_pixel, bool gathers) {
  const auto rays = std::bit_ceil(static_cast<std::uint32_t>(std::max(1, rays_per_pixel)));
  const int log2 = static_cast<int>(std::bit_width(rays)) - 1;
  const int samples = 1 << std::min((log2 + 1) / 2, 6);
  return {samples, gathers ? static_cast<int>(rays) / samples : 0};
}

// The channels of the frame, by address.
struct Channels {
  std::array<std::vector<float>*, rgb> beauty{};
  std::vector<std::array<std::vector<float>*, rgb>> layers;
};

// Image::add may move the channels, hence all are added before any address is taken.
Channels make_channels(base::Image& image, const std::vector<std::string>& layer_names,
                       const std::vector<std::string>& aov_channels) {
  image = base::make_rgb_image(image.width, image.height);
  for (const std::string& name : layer_names) {
    for (const char* channel : {".R", ".G", ".B"}) image.add("light_" + name + channel);
  }
  for (const std::string& name : aov_channels) image.add(name);
  Channels channels;
  for (std::size_t c = 0; c < rgb; ++c) channels.beauty[c] = &image.channels[c].values;
  for (std::size_t k = 0; k < layer_names.size(); ++k) {
    auto& layer = channels.layers.emplace_back();
    for (std::size_t c = 0; c < rgb; ++c) layer[c] = &image.channels[rgb * (k + 1) + c].values;
  }
  return channels;
}

struct AovChannels {
  const char* aov;
  std::vector<const char*> channels;
};
const std::vector<AovChannels>& aov_table() {
  static const std::vector<AovChannels> table = {{"albedo", {"albedo.R", "albedo.G", "albedo.B"}},
                                                 {"normal", {"N.X", "N.Y", "N.Z"}},
                                                 {"position", {"P.X", "P.Y", "P.Z"}},
                                                 {"depth", {"Z"}},
                                                 {"range", {"range"}},
                                                 {"object", {"object"}},
                                                 {"material", {"material"}}};
  return table;
}

std::vector<std::string> aov_channels(const std::vector<std::string>& aovs) {
  std::vector<std::string> channels;
  for (const std::string& aov : aovs) {
    const auto row = std::find_if(aov_table().begin(), aov_table().end(),
                                  [&](const AovChannels& entry) { return aov == entry.aov; });
    if (row == aov_table().end()) {
      std::string allowed = "allowed:";
      for (const AovChannels& entry : aov_table()) allowed += std::string(" ") + entry.aov;
      const std::string nearest = base::nearest_word(aov, aov_names());
      throw base::Error(base::Blame::Input, "--aov", "unknown layer \"" + aov + "\"", allowed,
                        nearest.empty() ? "" : "Did you mean \"" + nearest + "\"?");
    }
    for (const char* channel : row->channels) {
      if (std::find(channels.begin(), channels.end(), channel) == channels.end()) {
        channels.emplace_back(channel);
      }
    }
  }
  return channels;
}

float aov_value(const scenes::Scene& scene, const CameraModel& camera, const Ray& ray,
                const scenes::Hit& hit, std::string_view channel) {
  const auto axis = [&](const Vec3& v) {
    const char last = channel.back();
    return static_cast<float>(last == 'X' || last == 'R'   ? v.x
                              : last == 'Y' || last == 'G' ? v.y
                                                           : v.z);
  };
  const float nothing = std::numeric_limits<float>::infinity();
  if (channel == "Z") {
    return hit.missed() ? nothing
                        : static_cast<float>(hit.t * glm::dot(ray.direction, camera.forward));
  }
  if (channel == "range") return hit.missed() ? nothing : static_cast<float>(hit.t);
  if (hit.missed()) return channel == "object" || channel == "material" ? -1.0F : 0.0F;
  const scenes::Triangle& triangle = scene.triangles[hit.triangle];
  if (channel == "object") return static_cast<float>(triangle.object);
  if (channel == "material") return static_cast<float>(triangle.material);
  if (channel.front() == 'a') return axis(scene.materials[triangle.material].diffuse);
  if (channel.front() == 'P') return axis(hit_position(scene, hit));
  const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
  return axis(hit.front ? normal : -normal);
}

class Renderer {
 public:
  Renderer(const ShadingScene& shared, const CameraModel& camera, const Sampling& sampling,
           Frame& frame, const Channels& channels)
      : shared_(shared), camera_(camera), sampling_(sampling), frame_(frame), channels_(channels) {}

  void pixel(int x, int y, PixelShader& shader, float* squared_error) const {
    const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.columns) +
                       static_cast<std::size_t>(x);
    const auto samples = static_cast<std::size_t>(sampling_.camera_samples);
    shader.begin_pixel(index, samples);
    const base::SobolOwen4 points(base::Key(shared_.seed, base::Stream::Pixel, index));
    scenes::RayPacket packet;
    scenes::HitPacket hits;
    std::array<Ray, scenes::RayPacket::width> rays;
    for (std::size_t first = 0; first < samples; first += rays.size()) {
      const std::size_t count = std::min(rays.size(), samples - first);
      for (std::size_t k = 0; k < count; ++k) {
        const auto p = points.point(static_cast<std::uint32_t>(first + k));
        rays[k] = camera_.ray(x + double(p[0]), y + double(p[1]), p[2], p[3]);
        shared_.query.set(packet, k, rays[k].origin, rays[k].direction);
      }
      shared_.query.closest(packet, count, hits);
      for (std::size_t k = 0; k < count; ++k) {
        shader.add_sample(first + k, rays[k],
                          {hits.triangle[k], hits.u[k], hits.v[k], hits.t[k], hits.front[k] != 0});
      }
    }
    shader.end_pixel();
    store(index, shader, squared_error[index]);
  }

  void aovs(int x, int y, const std::vector<std::string>& names, std::size_t first_channel) const {
    const Ray ray = camera_.ray(x + 0.5, y + 0.5, 0.0, 0.0);
    const scenes::Hit hit = shared_.query.closest(ray.origin, ray.direction);
    const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.columns) +
                       static_cast<std::size_t>(x);
    for (std::size_t k = 0; k < names.size(); ++k) {
      frame_.image.channels[first_channel + k].values[index] =
          aov_value(shared_.scene, camera_, ray, hit, names[k]);
    }
  }

 private:
  void store(std::size_t index, const PixelShader& shader, float& squared_error) const {
    const double n = sampling_.camera_samples;
    std::array<float, rgb> total{};
    for (std::size_t layer = 0; layer < shader.sums().size(); ++layer) {
      for (std::size_t c = 0; c < rgb; ++c) {
        const auto value = static_cast<float>(shader.sums()[layer][static_cast<int>(c)] / n);
        total[c] += value;
        if (!channels_.layers.empty()) (*channels_.layers[layer][c])[index] = value;
      }
    }
    for (std::size_t c = 0; c < rgb; ++c) (*channels_.beauty[c])[index] = total[c];
    double sum = 0.0, squares = 0.0;
    for (const double y : shader.sample_luminance()) {
      sum += y;
      squares += y * y;
    }
    const double variance = n > 1.0 ? std::max(0.0, squares - sum * sum / n) / (n - 1.0) : 0.0;
    squared_error = static_cast<float>(variance / n);
  }

  const ShadingScene& shared_;
  const CameraModel& camera_;
  const Sampling& sampling_;
  Frame& frame_;
  const Channels& channels_;
};

double relative_noise(const base::Image& image, const std::vector<float>& squared_error) {
  double error = 0.0, mean = 0.0;
  const std::vector<float> luminance = base::luminance_of(image);
  for (std::size_t k = 0; k < luminance.size(); ++k) {
    error += double(squared_error[k]);
    mean += double(luminance[k]);
  }
  const auto n = static_cast<double>(luminance.size());
  return mean > 0.0 ? std::sqrt(error / n) / (mean / n) : 0.0;
}

}  // namespace

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const AovChannels& row : aov_table()) list.emplace_back(row.aov);
    return list;
  }();
  return names;
}

Frame render(const scenes::Scene& scene, const scenes::LightGroups& groups,
             const scenes::Effects& effects, const scenes::RayQuery& query,
             const radiosity::Solution& solution, const scenes::Camera& camera,
             const RenderOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string> extra = aov_channels(options.aovs);
  const bool reads_solution = options.indirect == Indirect::Radiosity && solution.columns > 0;
  const RadianceTable all(solution, reads_solution ? solution.radiosity : std::vector<float>{},
                          options.per_light);
  const bool recursive = effects.mirror || effects.refraction || effects.phong;
  const RadianceTable soft(
      solution, reads_solution && recursive ? solution.soft_radiosity : std::vector<float>{},
      options.per_light);
  const LightSampler lights(scene, groups, effects, options.indirect, options.distributed_lights,
                            earth_area(scene, options.distributed_over));

  const BrightPatches bright = reads_solution ? BrightPatches(solution) : BrightPatches();

  ShadingScene shared{scene, groups, effects, query, lights, all, soft, bright};
  shared.indirect = options.indirect;
  shared.layers = options.per_light ? std::max<std::size_t>(1, groups.count()) : 1;
  for (std::size_t g = 0; g < groups.count(); ++g)
    shared.layer.push_back(options.per_light ? g : 0);
  shared.gathers =
      options.indirect != Indirect::Distributed && (reads_solution || effects.earth_by_gather);
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    const bool has_surface = scene.lamps[k].kind == scenes::LampKind::Rectangle ||
                             scene.lamps[k].kind == scenes::LampKind::Disk;
    if (has_surface && groups.lamp[k] != scenes::no_group) shared.area_lamps.push_back(k);
  }
  shared.follows_specular = effects.mirror || effects.refraction;
  shared.sampled_emitter.assign(scene.materials.size(), true);
  if (options.indirect == Indirect::Radiosity) {
    shared.sampled_emitter = radiosity::emitter_is_explicit(scene);
  }
  shared.seed = options.seed;
  const Sampling sampling = share_out(options.gather_rays, shared.gathers);
  shared.gather_rays = sampling.gather_rays;

  Frame frame;
  frame.image.width = options.columns;
  frame.image.height = options.rows;
  const Channels channels = make_channels(
      frame.image, options.per_light ? groups.names : std::vector<std::string>{}, extra);
  const std::size_t first_aov = frame.image.channels.size() - extra.size();
  const CameraModel model = make_camera_model(camera, options.columns, options.rows);
  const Renderer renderer(shared, model, sampling, frame, channels);

  const int tiles_x = (options.columns + tile_edge_px - 1) / tile_edge_px;
  const int tiles_y = (options.rows + tile_edge_px - 1) / tile_edge_px;
  const auto tile_count = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  std::vector<float> squared_error(frame.image.pixel_count());
  std::vector<RayCounts> tile_rays(tile_count);
  std::size_t done = 0;
  std::mutex progress_mutex;
  base::parallel_chunks(tile_count, 1, [&](std::size_t tile, std::size_t) {
    PixelShader shader(shared);
    const int x0 = static_cast<int>(tile % static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    const int y0 = static_cast<int>(tile / static_cast<std::size_t>(tiles_x)) * tile_edge_px;
    for (int y = y0; y < std::min(y0 + tile_edge_px, options.rows); ++y) {
      for (int x = x0; x < std::min(x0 + tile_edge_px, options.columns); ++x) {
        renderer.pixel(x, y, shader, squared_error.data());
        if (!extra.empty()) renderer.aovs(x, y, extra, first_aov);
      }
    }
    tile_rays[tile] = shader.rays();
    if (progress) {
      const std::lock_guard lock(progress_mutex);
      progress(++done, tile_count);
    }
  });
  for (const RayCounts& rays : tile_rays) frame.report.rays += rays;
  frame.report.camera_samples = sampling.camera_samples;
  frame.report.gather_rays = sampling.gather_rays;
  frame.report.relative_noise = relative_noise(frame.image, squared_error);
  frame.report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return frame;
}

}  // namespace earthshine::raytrace
