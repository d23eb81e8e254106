// SPDX-License-Identifier: Apache-2.0
#include "raytrace/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "raytrace/cryptomatte.h"

namespace earthshine::raytrace {
namespace {

// What the ray through a pixel's centre met.
struct FirstHit {
  const scenes::Triangle* triangle = nullptr;  // nullptr: nothing
  const scenes::Material* material = nullptr;
  Vec3 position{0.0}, normal{0.0};
  double range_m = 0.0, depth_m = 0.0;
};

FirstHit first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                   const CameraModel& camera, double x, double y) {
  FirstHit found;
  const Ray ray = camera.ray(x, y, 0.0, 0.0);
  const scenes::Hit hit = query.closest(ray.origin, ray.direction);
  if (hit.missed()) return found;
  found.triangle = &scene.triangles[hit.triangle];
  found.material = &scene.materials[found.triangle->material];
  const Vec3 normal = scenes::triangle_normal(scene, hit.triangle);
  // Where the ray crosses the triangle's plane, in double precision: the traced distance is single,
  // and who projects positions back would see that.
  const double towards = glm::dot(ray.direction, normal);
  const double exact =
      glm::dot(scene.vertices[found.triangle->vertex[0]] - ray.origin, normal) / towards;
  found.range_m = std::abs(exact - hit.t) < 1e-3 * hit.t ? exact : hit.t;
  found.position = ray.origin + found.range_m * ray.direction;
  found.depth_m = found.range_m * glm::dot(ray.direction, camera.forward);
  found.normal = hit.front ? normal : -normal;
  return found;
}

float axis(const Vec3& v, char name) {
  return static_cast<float>(name == 'X' || name == 'R'   ? v.x
                            : name == 'Y' || name == 'G' ? v.y
                                                         : v.z);
}

using Value = float (*)(const FirstHit&, char last);

struct FirstHitLayer {
  const char* aov;
  std::vector<std::string> channels;
  float missed;  // where there is no hit
  Value value;
};

const std::vector<FirstHitLayer>& first_hit_layers() {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  static const std::vector<FirstHitLayer> table = {
      {"albedo",
       {"albedo.R", "albedo.G", "albedo.B"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.material->diffuse, c); }},
      {"normal",
       {"N.X", "N.Y", "N.Z"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.normal, c); }},
      {"position",
       {"P.X", "P.Y", "P.Z"},
       0.0F,
       [](const FirstHit& h, char c) { return axis(h.position, c); }},
      {"depth",
       {"Z"},
       infinite,
       [](const FirstHit& h, char) { return static_cast<float>(h.depth_m); }},
      {"range",
       {"range"},
       infinite,
       [](const FirstHit& h, char) { return static_cast<float>(h.range_m); }},
      {"object",
       {"object"},
       -1.0F,
       [](const FirstHit& h, char) { return static_cast<float>(h.triangle->object); }},
      {"material", {"material"}, -1.0F, [](const FirstHit& h, char) {
         return static_cast<float>(h.triangle->material);
       }}};
  return table;
}

// A channel of the image, and how it is filled.
struct Filled {
  std::vector<float>* values;
  const FirstHitLayer* layer;
  char last;
};

std::vector<Filled> channels_to_fill(base::Image& image) {
  std::vector<Filled> filled;
  for (base::Channel& channel : image.channels) {
    for (const FirstHitLayer& layer : first_hit_layers()) {
      if (std::find(layer.channels.begin(), layer.channels.end(), channel.name) ==
          layer.channels.end()) {
        continue;
      }
      filled.push_back({&channel.values, &layer, channel.name.back()});
    }
  }
  return filled;
}

}  // namespace

const std::vector<Layer>& layers() {
  static const std::vector<Layer> table = [] {
    std::vector<Layer> all;
    for (const FirstHitLayer& layer : first_hit_layers()) {
      all.push_back({layer.aov, LayerKind::FirstHit, layer.channels});
    }
    for (const CryptomatteType& type : cryptomatte_types) {
      all.push_back({type.aov, LayerKind::Coverage, cryptomatte_channels(type.name)});
    }
    all.push_back({"variance", LayerKind::Samples, {"variance"}});
    return all;
  }();
  return table;
}

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Layer& layer : layers()) list.push_back(layer.aov);
    return list;
  }();
  return names;
}

std::vector<std::string> layer_channels(const std::vector<std::string>& aovs) {
  std::vector<std::string> channels;
  for (const std::string& aov : aovs) {
    const auto layer = std::find_if(layers().begin(), layers().end(),
                                    [&](const Layer& entry) { return aov == entry.aov; });
    if (layer == layers().end()) {
      std::string allowed = "allowed:";
      for (const std::string& name : aov_names()) allowed += " " + name;
      const std::string nearest = base::nearest_word(aov, aov_names());
      throw base::Error(base::Blame::Input, "--aov", "unknown layer \"" + aov + "\"", allowed,
                        nearest.empty() ? "" : "Did you mean \"" + nearest + "\"?");
    }
    for (const std::string& channel : layer->channels) {
      if (std::find(channels.begin(), channels.end(), channel) == channels.end()) {
        channels.push_back(channel);
      }
    }
  }
  return channels;
}

void fill_first_hit(const scenes::Scene& scene, const scenes::RayQuery& query,
                    const CameraModel& camera, base::Image& image) {
  const std::vector<Filled> filled = channels_to_fill(image);
  if (filled.empty()) return;
  const auto columns = static_cast<std::size_t>(image.width);
  base::parallel_chunks(static_cast<std::size_t>(image.height), 1, [&](std::size_t y, std::size_t) {
    for (std::size_t x = 0; x < columns; ++x) {
      const FirstHit hit = first_hit(scene, query, camera, static_cast<double>(x) + 0.5,
                                     static_cast<double>(y) + 0.5);
      for (const Filled& channel : filled) {
        (*channel.values)[y * columns + x] = hit.triangle == nullptr
                                                 ? channel.layer->missed
                                                 : channel.layer->value(hit, channel.last);
      }
    }
  });
}

}  // namespace earthshine::raytrace
