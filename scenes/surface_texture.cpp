// SPDX-License-Identifier: Apache-2.0
#include "scenes/surface_texture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/numbers/sobol_set.h"
#include "base/parallel.h"
#include "scenes/texture/texture.h"

namespace earthshine::scenes {
namespace {

// Samples per side of a triangle for its mean: sixteen per texel between the first two bounds, but
// at least one per texel up to the last bound.
constexpr int fewest_samples = 4, most_samples = 64, most_of_many_texels = 256;
// For the mean over all surfaces of a material: many small triangles need few samples each.
constexpr std::size_t samples_of_material = std::size_t{1} << 20;
constexpr std::size_t triangles_together = 1024;

// Interpolates vertex values at a place.
template <class Value, class OfVertex>
Value mixed(const Scene& scene, const std::vector<OfVertex>& of_vertex, const SurfacePlace& place) {
  const auto& vertex = scene.triangles[place.triangle].vertex;
  const Value a(of_vertex[vertex[0]]), b(of_vertex[vertex[1]]), c(of_vertex[vertex[2]]);
  return (1.0 - place.u - place.v) * a + place.u * b + place.v * c;
}

const std::vector<glm::vec2>& coordinates(const Scene& scene, const TextureMap& map) {
  return map.by_second ? scene.second_uv : scene.vertex_uv;
}

glm::dvec2 uv_at(const Scene& scene, const SurfacePlace& place) {
  return mixed<glm::dvec2>(scene, scene.vertex_uv, place);
}

// Texels per metre of the triangle, from the ratio of areas.
double texels_per_m_of(const Scene& scene, const TextureMap& map, std::uint32_t triangle) {
  const auto& vertex = scene.triangles[triangle].vertex;
  const auto& uv = coordinates(scene, map);
  const glm::dvec2 a(uv[vertex[0]]);
  const glm::dvec2 ab = glm::dvec2(uv[vertex[1]]) - a, ac = glm::dvec2(uv[vertex[2]]) - a;
  const double in_texture =
      0.5 * std::abs((ab.x * ac.y - ab.y * ac.x) * glm::determinant(map.transform->matrix)) *
      map.texture->width() * map.texture->height();
  return std::sqrt(in_texture / triangle_area(scene, triangle));
}

glm::dvec4 look_up(const Scene& scene, const TextureMap& map, const SurfacePlace& place) {
  const auto uv = mixed<glm::dvec2>(scene, coordinates(scene, map), place);
  return map.texture->at(map.transform->apply(uv));
}

// Factor on the material's diffuse colour at a place.
Rgb diffuse_factor(const Scene& scene, const MaterialMaps& maps, const SurfacePlace& place) {
  Rgb factor(1.0);
  if (maps.diffuse.texture) factor = Rgb(look_up(scene, maps.diffuse, place));
  if (maps.by_vertex) factor *= mixed<Rgb>(scene, scene.vertex_colour, place);
  return factor;
}

// Area-weighted sums over the surfaces of a material.
struct Sums {
  double area = 0.0;
  Rgb diffuse{0.0}, emit{0.0};
  Sums& operator+=(const Sums& other) {
    area += other.area;
    diffuse += other.diffuse;
    emit += other.emit;
    return *this;
  }
};

// Takes at most `most` samples of the low-discrepancy sequence from index `first` on, so that
// triangles with the same pattern do not share samples.
void add_triangle(const Scene& scene, std::uint32_t triangle, const MaterialMaps& maps, Sums& sums,
                  std::size_t most = SIZE_MAX, std::size_t first = 0) {
  const double area = triangle_area(scene, triangle);
  if (!maps.diffuse.texture && !maps.emit.texture && !maps.opacity.texture) {
    // Vertex colours are linear: their mean is the value at the middle.
    sums.area += area;
    sums.diffuse += area * diffuse_factor(scene, maps, {triangle, 1.0 / 3.0, 1.0 / 3.0});
    return;
  }
  const double texels = std::clamp(texels_per_m(scene, triangle) * std::sqrt(area), 1.0, 1e6);
  const int n =
      std::max(std::clamp(static_cast<int>(std::ceil(16.0 * texels)), fewest_samples, most_samples),
               std::min(static_cast<int>(std::ceil(texels)), most_of_many_texels));
  const std::size_t count = std::min(static_cast<std::size_t>(n) * std::size_t(n), most);
  SurfacePlace place{triangle, 0.0, 0.0};
  const double share = area / double(count);
  for (std::size_t k = 0; k < count; ++k) {
    const glm::dvec2 square = base::even_point(first + k);
    const double root = std::sqrt(square.x);  // uniform over the triangle
    place.u = root * (1.0 - square.y);
    place.v = root * square.y;
    if (!is_opaque(maps, uv_at(scene, place))) continue;
    sums.area += share;
    if (maps.vary_diffuse()) sums.diffuse += share * diffuse_factor(scene, maps, place);
    if (maps.emit.texture) sums.emit += share * Rgb(look_up(scene, maps.emit, place));
  }
}

void settle(const Rgb& sum, double area, TextureMap& map, Rgb& factor) {
  const Rgb plain = map.texture ? Rgb(map.texture->mean()) : Rgb(1.0);
  const Rgb mean = area > 0.0 ? sum / area : plain;
  for (int c = 0; c < 3; ++c) map.over_mean[c] = mean[c] > 0.0 ? 1.0 / mean[c] : 0.0;
  factor *= mean;
}

}  // namespace

double texels_per_m(const Scene& scene, std::uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  double most = 0.0;
  if (!material.maps) return most;
  for (const TextureMap* map :
       {&material.maps->diffuse, &material.maps->emit, &material.maps->opacity}) {
    if (map->texture) most = std::max(most, texels_per_m_of(scene, *map, triangle));
  }
  return most;
}

Rgb textured_diffuse(const Scene& scene, const Material& material, const SurfacePlace& place) {
  if (!material.maps || !material.maps->vary_diffuse()) return material.diffuse;
  return material.diffuse * diffuse_factor(scene, *material.maps, place) *
         material.maps->diffuse.over_mean;
}

Rgb textured_emit(const Scene& scene, const Material& material, const SurfacePlace& place) {
  if (!material.maps || !material.maps->emit.texture) return material.emit;
  const TextureMap& map = material.maps->emit;
  return material.emit * Rgb(look_up(scene, map, place)) * map.over_mean;
}

bool is_there(const Scene& scene, std::uint32_t triangle, double u, double v) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  return !material.maps || is_opaque(*material.maps, uv_at(scene, {triangle, u, v}));
}

Rgb mean_emit(const Scene& scene, std::uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  Sums sums;
  add_triangle(scene, triangle, *material.maps, sums);
  const double area = triangle_area(scene, triangle);
  const TextureMap& map = material.maps->emit;
  return map.texture ? material.emit * map.over_mean * (sums.emit / area)
                     : material.emit * (sums.area / area);
}

void settle_textures(Scene& scene) {
  if (scene.vertex_uv.empty()) return;
  const std::size_t count = scene.vertices.size();
  scene.vertex_uv.resize(count, glm::vec2(0.0F));
  if (!scene.second_uv.empty()) scene.second_uv.resize(count, glm::vec2(0.0F));
  if (!scene.vertex_colour.empty()) scene.vertex_colour.resize(count, glm::vec3(1.0F));
  std::vector<std::vector<std::uint32_t>> worn(scene.materials.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const std::uint32_t m = scene.triangles[t].material;
    if (scene.materials[m].maps) worn[m].push_back(t);
  }
  for (std::size_t m = 0; m < worn.size(); ++m) {
    Material& material = scene.materials[m];
    if (!material.maps) continue;
    auto maps = std::make_shared<MaterialMaps>(*material.maps);
    const std::size_t most =
        std::max<std::size_t>(1, samples_of_material / std::max<std::size_t>(1, worn[m].size()));
    const Sums sums = base::ordered_sum(
        worn[m].size(), triangles_together, Sums{}, [&](std::size_t begin, std::size_t end) {
          Sums part;
          for (std::size_t k = begin; k < end; ++k) {
            add_triangle(scene, worn[m][k], *maps, part, most, k * most);
          }
          return part;
        });
    if (maps->vary_diffuse()) settle(sums.diffuse, sums.area, maps->diffuse, material.diffuse);
    if (maps->emit.texture) settle(sums.emit, sums.area, maps->emit, material.emit);
    material.maps = std::move(maps);
  }
}

std::size_t texture_bytes(const Scene& scene) {
  std::set<const Texture*> all;
  for (const Material& material : scene.materials) {
    if (!material.maps) continue;
    for (const TextureMap* map :
         {&material.maps->diffuse, &material.maps->emit, &material.maps->opacity}) {
      if (map->texture) all.insert(map->texture.get());
    }
  }
  std::size_t bytes = 0;
  for (const Texture* texture : all) bytes += texture->bytes();
  return bytes;
}

OpacityMasks::OpacityMasks(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.has_holes()) maps_.push_back(material.maps);
  }
  if (maps_.empty()) return;
  number_.assign(scene.triangles.size(), unmasked);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const Triangle& triangle = scene.triangles[t];
    const Material& material = scene.materials[triangle.material];
    if (!material.has_holes()) continue;
    number_[t] = static_cast<std::uint32_t>(masked_.size());
    masked_.push_back({{scene.vertex_uv[triangle.vertex[0]], scene.vertex_uv[triangle.vertex[1]],
                        scene.vertex_uv[triangle.vertex[2]]},
                       material.maps.get()});
  }
}

bool OpacityMasks::has_hole(std::uint32_t number, double u, double v) const {
  const Masked& masked = masked_[number];
  return !is_opaque(*masked.maps, (1.0 - u - v) * glm::dvec2(masked.uv[0]) +
                                      u * glm::dvec2(masked.uv[1]) + v * glm::dvec2(masked.uv[2]));
}

bool any_has_holes(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.has_holes(); });
}

bool is_opaque(const MaterialMaps& maps, const glm::dvec2& uv) {
  const TextureMap& map = maps.opacity;
  return !map.texture || map.texture->at(map.transform->apply(uv)).a >= maps.cutoff;
}

}  // namespace earthshine::scenes
