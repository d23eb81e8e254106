// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/place_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <span>
#include <unordered_map>

#include "base/free_memory.h"
#include "scenes/mesh/triangulate.h"
#include "scenes/text/message_text.h"
#include "scenes/text/table_reader.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// Share of the box's squared diagonal: smaller polygons are rounding errors.
constexpr double smallest_area_share = 1e-12;
// The triangles of a non-planar polygon have more area than its projection, and the file does not
// define the triangulation. A smaller share of excess area is rounding.
constexpr double warp_worth_a_warning = 1e-4;

class Placer {
 public:
  Placer(Scene& scene, Object& object, const Mesh& mesh, const Placement& placement,
         const base::Location& where, FileFronts& fronts)
      : scene_(scene),
        object_(object),
        mesh_(mesh),
        placement_(placement),
        where_(where),
        fronts_(fronts) {}

  void choose(std::uint32_t part) {
    std::vector<char> wanted(mesh_.part_sets.size(), part == no_index ? 1 : 0);
    for (std::size_t s = 0; s < wanted.size(); ++s) {
      const auto& set = mesh_.part_sets[s];
      if (std::find(set.begin(), set.end(), part) != set.end()) wanted[s] = 1;
    }
    for (std::size_t p = 0; p < mesh_.polygons.size(); ++p) {
      const std::uint32_t set = mesh_.polygons[p].part_set;
      if (part == no_index || (set < wanted.size() && wanted[set] != 0)) chosen_.push_back(p);
    }
  }

  void transform() {
    placed_at_.assign(mesh_.vertices.size(), no_index);
    std::vector<char> seen(mesh_.vertices.size(), 0);
    Vec3 low(std::numeric_limits<double>::infinity());
    Vec3 high(-low);
    for (const std::size_t p : chosen_) {
      for (const std::uint32_t index : corners_of(mesh_.polygons[p])) {
        if (seen[index] != 0) continue;
        seen[index] = 1;
        const Vec3 v = placement_.apply(mesh_.vertices[index]);
        for (int c = 0; c < 3; ++c) {
          if (std::abs(v[c]) <= largest_length) continue;
          throw Error(Blame::Input, place_of(p),
                      fmt::format("a vertex at ({}, {}, {}) m after the transform", v.x, v.y, v.z),
                      fmt::format("coordinates are finite and at most {} m", largest_length),
                      "Check the mesh, and unit, scale and translate");
        }
        low = glm::min(low, v);
        high = glm::max(high, v);
      }
    }
    const double diagonal = chosen_.empty() ? 0.0 : glm::length(high - low);
    smallest_area_ = smallest_area_share * diagonal * diagonal;
  }

  void triangulate_all(const std::function<std::uint32_t(const MeshPolygon&)>& material_of) {
    std::size_t triangles = 0;
    for (const std::size_t p : chosen_) triangles += mesh_.polygons[p].count - 2;
    make_room(scene_.triangles, triangles);
    make_room(scene_.vertices, std::min(mesh_.vertices.size(), 3 * triangles));
    object_.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
    next_polygon_ = scene_.triangles.empty() ? 0 : scene_.triangles.back().polygon + 1;
    Triangulation pieces;
    std::vector<Vec3> corners;
    for (const std::size_t p : chosen_) {
      const MeshPolygon& polygon = mesh_.polygons[p];
      const auto indices = corners_of(polygon);
      if (indices.size() > max_polygon_corners) {
        throw Error(Blame::Input, place_of(p),
                    fmt::format("a polygon of {} corners", indices.size()),
                    fmt::format("a polygon has at most {}", max_polygon_corners), "Divide it");
      }
      corners.clear();
      for (const std::uint32_t index : indices)
        corners.push_back(placement_.apply(mesh_.vertices[index]));
      triangulate(corners, smallest_area_, pieces);
      if (pieces.kind == PolygonKind::Degenerate) {
        if (object_.degenerate_count++ == 0) first_degenerate_ = p;
        continue;
      }
      judge(p, pieces);
      note_front(polygon, corners);
      add(pieces, polygon, material_of(polygon));
    }
    object_.triangle_count =
        static_cast<std::uint32_t>(scene_.triangles.size()) - object_.first_triangle;
  }

  void report() {
    if (object_.polygon_count == 0) {
      throw Error(Blame::Input, where_,
                  fmt::format("the object {} has no surface", in_quotes(object_.name)),
                  chosen_.empty()
                      ? "its mesh or part has no faces"
                      : fmt::format("all of its {} polygons are without area", chosen_.size()));
    }
    if (object_.degenerate_count > 0) {
      scene_.warnings.push_back(
          fmt::format("object {}: {} of {} polygons have no area and are left out, the "
                      "first at {}",
                      in_quotes(object_.name), object_.degenerate_count, chosen_.size(),
                      base::to_string(place_of(first_degenerate_))));
    }
    if (without_uv_ > 0) {
      scene_.warnings.push_back(fmt::format(
          "object {}: {} corners of faces with a texture have no texture coordinates, "
          "or such that are not there, the first at {}; they take its upper left corner",
          in_quotes(object_.name), without_uv_, base::to_string(place_of(first_without_uv_))));
    }
    if (warped_count_ > 0) {
      scene_.warnings.push_back(
          fmt::format("object {}: {} of {} polygons are not flat and are cut into triangles, which "
                      "have up to {} % more area than the polygon seen along its normal, the "
                      "most at {}",
                      in_quotes(object_.name), warped_count_, chosen_.size(),
                      most_warped_ < 10.0 ? fmt::format("{:.3g}", 100.0 * most_warped_)
                                          : std::string("1000 and more"),
                      base::to_string(place_of(most_warped_at_))));
    }
  }

 private:
  // A growing array is copied to a larger one; both exist for a while.
  template <class Item>
  void make_room(const std::vector<Item>& items, std::size_t more) const {
    const std::size_t wanted = items.size() + more;
    if (wanted <= items.capacity()) return;
    const std::size_t capacity = std::max(wanted, 2 * items.capacity());
    base::check_room(capacity * sizeof(Item), base::to_string(where_));
  }

  [[nodiscard]] std::span<const std::uint32_t> corners_of(const MeshPolygon& polygon) const {
    return std::span(mesh_.indices).subspan(polygon.first, polygon.count);
  }

  // The polygon's line if the file has lines, else the file and the polygon's index, else the
  // scene's key.
  [[nodiscard]] base::Location place_of(std::size_t p) const {
    if (mesh_.path.empty()) return where_;
    const std::uint32_t line = mesh_.polygons[p].line;
    if (line > 0) return {mesh_.path.string(), static_cast<int>(line), 0};
    return {fmt::format("{}, polygon {}", mesh_.path.string(), p + 1)};
  }

  void judge(std::size_t p, const Triangulation& pieces) {
    if (pieces.kind == PolygonKind::Crossing) {
      throw Error(Blame::Input, place_of(p), "the polygon's outline crosses itself",
                  "a polygon is simple: its triangles add up to its area",
                  "Repair the mesh or divide it");
    }
    const double warp = pieces.triangle_area / pieces.area - 1.0;
    if (warp > warp_worth_a_warning) {
      if (warped_count_++ == 0 || warp > most_warped_) most_warped_at_ = p;
      most_warped_ = std::max(most_warped_, warp);
    }
  }

  // corners: of the polygon, in the scene.
  void note_front(const MeshPolygon& polygon, const std::vector<Vec3>& corners) {
    constexpr double least_cosine = 0.05;  // of a normal to the polygon's normal
    if (mesh_.normal_indices.empty() || object_.orient != Orient::Mended) return;
    const auto indices = corners_of(polygon);
    const auto corner = [&](std::size_t k) { return mesh_.vertices[indices[k]]; };
    Vec3 own(0.0), placed(0.0);
    for (std::size_t k = 1; k + 1 < indices.size(); ++k) {
      own += glm::cross(corner(k) - corner(0), corner(k + 1) - corner(0));
      placed += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    }
    const double length = glm::length(own);
    int along = 0, against = 0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const std::size_t index = polygon.first + k;
      const std::uint32_t n =
          index < mesh_.normal_indices.size() ? mesh_.normal_indices[index] : no_index;
      if (n == no_index) return;
      const Vec3 normal(mesh_.normals[n]);
      const double cosine = glm::dot(normal, own) / (glm::length(normal) * length);
      along += cosine > least_cosine ? 1 : 0;
      against += cosine < -least_cosine ? 1 : 0;
    }
    const auto all = static_cast<int>(indices.size());
    if (along == all || against == all) {
      const bool flips = (against == all) != placement_.is_mirrored();
      fronts_.set(next_polygon_, flips ? -placed : placed);
    }
  }

  std::uint32_t plain_vertex(std::uint32_t corner) {
    if (placed_at_[corner] == no_index) {
      placed_at_[corner] = static_cast<std::uint32_t>(scene_.vertices.size());
      scene_.vertices.push_back(placement_.apply(mesh_.vertices[corner]));
    }
    return placed_at_[corner];
  }

  // One vertex per pair of position and texture coordinates.
  std::uint32_t textured_vertex(std::uint32_t corner, std::uint32_t index) {
    const std::uint32_t uv = index < mesh_.uv_indices.size() ? mesh_.uv_indices[index] : no_index;
    if (uv == no_index) ++without_uv_;
    const auto [entry, fresh] = textured_at_.emplace(
        (std::uint64_t{corner} << 32U) | uv, static_cast<std::uint32_t>(scene_.vertices.size()));
    if (fresh) {
      const std::size_t place = scene_.vertices.size();
      const auto append = [&](auto& list, const auto& own, const auto& otherwise) {
        if (list.empty() && own.empty()) return;
        list.resize(place, otherwise);
        list.push_back(uv < own.size() ? own[uv] : otherwise);
      };
      scene_.vertex_uv.resize(place, glm::vec2(0.0F));
      scene_.vertex_uv.push_back(uv == no_index ? glm::vec2(0.0F) : mesh_.uv[uv]);
      append(scene_.second_uv, mesh_.second_uv, glm::vec2(0.0F));
      append(scene_.vertex_colour, mesh_.colours, glm::vec3(1.0F));
      scene_.vertices.push_back(placement_.apply(mesh_.vertices[corner]));
    }
    return entry->second;
  }

  void add(const Triangulation& pieces, const MeshPolygon& polygon, std::uint32_t material) {
    const auto indices = corners_of(polygon);
    const bool textured = scene_.materials[material].maps != nullptr;
    if (scene_.triangles.size() + pieces.triangles.size() > max_scene_triangles) {
      throw Error(Blame::Input, where_, "the scene is too large",
                  fmt::format("it has at most {} triangles", max_scene_triangles));
    }
    const auto number = static_cast<std::uint32_t>(scene_.objects.size());
    if (without_uv_ == 0) {
      first_without_uv_ = static_cast<std::size_t>(&polygon - mesh_.polygons.data());
    }
    for (const auto& piece : pieces.triangles) {
      Triangle triangle{{0, 0, 0}, number, material, next_polygon_};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = indices[piece[k]];
        // Turned about the first corner, so that a parallelogram stays (0,1,2), (0,2,3) of its
        // corners read the other way round.
        triangle.vertex[placement_.reverses() ? (3 - k) % 3 : k] =
            textured ? textured_vertex(corner, polygon.first + piece[k]) : plain_vertex(corner);
      }
      scene_.triangles.push_back(triangle);
    }
    if (placement_.reverses() && pieces.triangles.size() == 2) {
      std::swap(scene_.triangles[scene_.triangles.size() - 1],
                scene_.triangles[scene_.triangles.size() - 2]);
    }
    ++next_polygon_;
    ++object_.polygon_count;
    object_.area_m2 += pieces.triangle_area;
  }

  Scene& scene_;
  Object& object_;
  const Mesh& mesh_;
  const Placement& placement_;
  const base::Location& where_;
  FileFronts& fronts_;
  std::vector<std::size_t> chosen_;
  std::vector<std::uint32_t> placed_at_;                          // scene vertex per mesh vertex
  std::unordered_map<std::uint64_t, std::uint32_t> textured_at_;  // by (vertex, uv)
  std::size_t without_uv_ = 0;                                    // textured corners
  std::size_t first_without_uv_ = 0;                              // polygon of the first one
  double smallest_area_ = 0.0;
  std::uint32_t next_polygon_ = 0;
  std::size_t first_degenerate_ = 0;
  std::size_t most_warped_at_ = 0;
  std::size_t warped_count_ = 0;
  double most_warped_ = 0.0;
};

}  // namespace

glm::dmat3 rotation_xyz(const Vec3& degrees) {
  glm::dmat4 matrix(1.0);
  for (int axis = 2; axis >= 0; --axis) {
    Vec3 around(0.0);
    around[axis] = 1.0;
    matrix = glm::rotate(matrix, base::radians(degrees[axis]), around);
  }
  return glm::dmat3(matrix);
}

void place_mesh(Scene& scene, Object object, const Mesh& mesh, std::uint32_t part,
                const Placement& placement, const base::Location& where,
                const std::function<std::uint32_t(const MeshPolygon&)>& material_of,
                FileFronts& fronts) {
  Placer placer(scene, object, mesh, placement, where, fronts);
  placer.choose(part);
  placer.transform();
  placer.triangulate_all(material_of);
  placer.report();
  scene.objects.push_back(std::move(object));
}

}  // namespace earthshine::scenes
