// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/target_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "raytrace/camera/camera.h"
#include "scenes/ray_query.h"
#include "scenes/triangle_point.h"
#include "scenes/view/motion.h"

namespace earthshine::studies {
namespace {

using Mask = std::vector<std::uint8_t>;

// Calls visit(index) for the neighbours of a pixel in the picture.
template <class Visit>
void for_neighbours(int columns, int rows, std::uint32_t pixel, bool diagonal, Visit visit) {
  const int x = static_cast<int>(pixel) % columns, y = static_cast<int>(pixel) / columns;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || (!diagonal && dx != 0 && dy != 0)) continue;
      if (x + dx < 0 || x + dx >= columns || y + dy < 0 || y + dy >= rows) continue;
      visit(static_cast<std::uint32_t>((y + dy) * columns + x + dx));
    }
  }
}

std::vector<std::uint32_t> core_of(const ObjectMap& map, const std::vector<std::uint32_t>& seen,
                                   std::int32_t object) {
  std::vector<std::uint32_t> core;
  for (const std::uint32_t pixel : seen) {
    bool inside = true;  // the picture's border is no outline
    for_neighbours(map.columns, map.rows, pixel, true,
                   [&](std::uint32_t next) { inside = inside && map.object[next] == object; });
    if (inside) core.push_back(pixel);
  }
  return core;
}

// Grows outward pixel by pixel, alternating 4 and 8 neighbours: octagons, nearly round.
std::vector<std::uint32_t> surround_of(const ObjectMap& map,
                                       const std::vector<std::uint32_t>& seen) {
  Mask reached(map.object.size(), 0);
  for (const std::uint32_t pixel : seen) reached[pixel] = 1;
  const auto grow = [&](const std::vector<std::uint32_t>& from, bool diagonal) {
    std::vector<std::uint32_t> shell;
    for (const std::uint32_t pixel : from) {
      for_neighbours(map.columns, map.rows, pixel, diagonal, [&](std::uint32_t next) {
        if (reached[next] != 0) return;
        reached[next] = 1;
        shell.push_back(next);
      });
    }
    return shell;
  };
  const std::vector<std::uint32_t> outline = grow(seen, true);
  std::vector<std::uint32_t> surround, shell = outline;
  for (bool diagonal = false;; diagonal = !diagonal) {
    shell = grow(shell, diagonal);
    if (shell.empty()) break;
    // The last shell counts if it brings the number closer to that of the target.
    const std::size_t before = surround.size(), after = before + shell.size();
    const bool nearer = after <= seen.size() || after - seen.size() < seen.size() - before;
    if (before > 0 && !nearer) break;
    surround.insert(surround.end(), shell.begin(), shell.end());
    if (after >= seen.size()) break;
  }
  std::sort(surround.begin(), surround.end());
  return surround;
}

constexpr std::uint8_t shows_back = 2;  // in the mask of cast_alone; 1: any other of its surfaces

// Film beyond the picture of a distorting lens may lie beyond all directions, where they repeat.
bool has_direction(const raytrace::CameraModel& model, double x, double y) {
  if (!model.projection.is_distorted()) return true;
  constexpr double off_px = 1e-3;
  const glm::dvec2 size(model.columns, model.rows), at(x, y);
  return glm::length(model.projection.place(model.projection.direction(at / size)) * size - at) <
         off_px;
}

// The pixels of the window whose centre shows `object` without all others, and whether they show
// its black back. Film goes on beyond the picture.
Mask cast_alone(const scenes::Scene& scene, const raytrace::CameraModel& model,
                std::uint32_t object, const raytrace::Window& window) {
  scenes::Scene alone;
  alone.vertices = scene.vertices;  // all vertices, so that rays have the same rounding as in the
                                    // whole scene
  alone.vertex_uv = scene.vertex_uv;
  for (const scenes::Material& material : scene.materials) {
    alone.materials.emplace_back().maps = material.maps;  // a hole shows what is behind
  }
  const scenes::Object& record = scene.objects[object];
  const auto first = scene.triangles.begin() + record.first_triangle;
  alone.triangles.assign(first, first + record.triangle_count);
  Mask mask(window.pixel_count(), 0);
  if (alone.triangles.empty()) return mask;
  const scenes::RayQuery query(alone);
  const auto rows = static_cast<std::size_t>(window.rows);
  base::parallel_chunks(rows, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = window.y + static_cast<int>(begin); y < window.y + static_cast<int>(end); ++y) {
      for (int x = window.x; x < window.x + window.columns; ++x) {
        if (!has_direction(model, x + 0.5, y + 0.5)) continue;
        const raytrace::Ray ray = model.ray(x + 0.5, y + 0.5, 0.0, 0.0);
        const scenes::Hit hit = query.closest(ray.origin, ray.direction);
        if (hit.missed()) continue;
        const scenes::Material& material = scene.materials[alone.triangles[hit.triangle].material];
        mask[window.index(x, y)] = !hit.front && material.has_black_back() ? shows_back : 1;
      }
    }
  });
  return mask;
}

// Finds the objects that the map shows on pixels of `alone`.
void find_blockers(TargetView& view, const ObjectMap& map, const Mask& alone) {
  std::map<std::int32_t, std::size_t> counts;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const std::int32_t shown = map.object[i];
    if (alone[i] == 0 || shown == static_cast<std::int32_t>(view.object)) continue;
    view.hidden.push_back(static_cast<std::uint32_t>(i));
    if (shown != no_object) ++counts[shown];
  }
  for (const auto& [object, pixels] : counts) {
    view.hidden_by.push_back({static_cast<std::uint32_t>(object), pixels});
  }
  std::stable_sort(view.hidden_by.begin(), view.hidden_by.end(),
                   [](const auto& a, const auto& b) { return a.pixels > b.pixels; });
}

// Whether any corner of the object projects into the picture.
bool reaches_frame(const scenes::Scene& scene, const raytrace::CameraModel& model,
                   std::uint32_t object) {
  const scenes::Object& record = scene.objects[object];
  for (std::uint32_t k = 0; k < record.triangle_count; ++k) {
    for (const std::uint32_t v : scene.triangles[record.first_triangle + k].vertex) {
      if (model.projection.shows(model.to_camera(scene.vertices[v]))) return true;
    }
  }
  return false;
}

// Velocity of its centre in pixels per second, to the right and down; 0 behind the camera.
std::array<double, 2> motion_of(const scenes::Scene& scene, const raytrace::CameraModel& model,
                                std::uint32_t object) {
  const scenes::Object& record = scene.objects[object];
  if (!(record.motion.moves() || model.motion.moves()) || record.triangle_count == 0) {
    return {0.0, 0.0};
  }
  const Vec3 middle = scenes::bounds_of(scene, record).middle();
  if (!model.projection.is_before(model.to_camera(middle))) return {0.0, 0.0};
  const Vec3 about = scenes::spin_centre(scene, record);
  // A central difference over a time in which it moves by a millionth of its distance.
  const double rotation_rad = base::radians(glm::length(record.motion.spin_deg_s)) *
                                  glm::length(middle - about) /
                                  glm::length(middle - model.position) +
                              base::radians(glm::length(model.motion.spin_deg_s));
  const double speed = glm::length(record.motion.velocity_m_s - model.motion.velocity_m_s) /
                           glm::length(middle - model.position) +
                       rotation_rad;
  if (!(speed > 0.0)) return {0.0, 0.0};
  const double dt = 1e-6 / speed;
  const auto film = [&](double t_s) {
    const raytrace::CameraModel camera = model.at(t_s);
    return camera.film_from(camera.position,
                            scenes::MovedBy(record.motion, about, t_s).point(middle));
  };
  const glm::dvec2 moved = film(dt) - film(-dt);
  return {moved.x / (2.0 * dt), moved.y / (2.0 * dt)};
}

bool touches_border(const Mask& mask, int columns, int rows) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const int x = static_cast<int>(i) % columns, y = static_cast<int>(i) / columns;
    if (mask[i] != 0 && (x == 0 || y == 0 || x == columns - 1 || y == rows - 1)) return true;
  }
  return false;
}

}  // namespace

ObjectMap object_map(const base::Image& image) {
  const base::Channel* layer = image.find("object");
  if (layer == nullptr) {
    throw base::Error(base::Blame::Input, "study", "the picture has no layer \"object\"", {},
                      "Render it with that layer");
  }
  ObjectMap map{image.width, image.height, {}};
  map.object.reserve(layer->values.size());
  for (const float value : layer->values) {
    map.object.push_back(static_cast<std::int32_t>(std::lround(value)));
  }
  return map;
}

TargetView find_target(const ObjectMap& map, std::uint32_t object) {
  TargetView view;
  view.object = object;
  const auto wanted = static_cast<std::int32_t>(object);
  std::vector<std::uint32_t> seen;
  for (std::size_t i = 0; i < map.object.size(); ++i) {
    if (map.object[i] == wanted) seen.push_back(static_cast<std::uint32_t>(i));
  }
  view.pixels = seen.size();
  if (seen.empty()) return view;
  view.surround = surround_of(map, seen);
  view.measured = core_of(map, seen, wanted);
  if (4 * view.measured.size() < seen.size()) view.measured = std::move(seen);
  return view;
}

std::vector<TargetView> find_targets(const scenes::Scene& scene, const scenes::Camera& camera,
                                     const ObjectMap& map) {
  const raytrace::CameraModel model = raytrace::make_camera_model(camera, map.columns, map.rows);
  std::vector<TargetView> views;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    if (!scene.objects[object].target) continue;
    TargetView view = find_target(map, object);
    view.name = scene.objects[object].name;
    Mask alone = cast_alone(scene, model, object, {0, 0, map.columns, map.rows});
    // A rounding error may move a ray to the other side of a silhouette; seen pixels are always
    // part of `alone`.
    for (std::size_t i = 0; i < alone.size(); ++i) {
      if (map.object[i] != static_cast<std::int32_t>(object)) continue;
      if (alone[i] == shows_back) view.black_back.push_back(static_cast<std::uint32_t>(i));
      alone[i] = 1;
    }
    view.pixels_alone =
        alone.size() - static_cast<std::size_t>(std::count(alone.begin(), alone.end(), 0));
    find_blockers(view, map, alone);
    view.in_frame = view.pixels_alone > 0 || reaches_frame(scene, model, object);
    view.motion_px_s = motion_of(scene, model, object);
    view.cut_by_frame = touches_border(alone, map.columns, map.rows);
    views.push_back(std::move(view));
  }
  return views;
}

PixelsOutside pixels_outside(const scenes::Scene& scene, const scenes::Camera& camera,
                             std::uint32_t object, int columns, int rows) {
  PixelsOutside outside;
  const raytrace::CameraModel model = raytrace::make_camera_model(camera, columns, rows);
  const scenes::Object& record = scene.objects[object];
  const auto shows = [&](const scenes::Triangle& triangle) {
    return std::ranges::all_of(triangle.vertex, [&](std::uint32_t v) {
      return model.projection.shows(model.to_camera(scene.vertices[v]));
    });
  };
  const auto first = scene.triangles.begin() + record.first_triangle;
  // With distortion a triangle may leave the picture although its corners are inside.
  if (!model.projection.is_distorted() &&
      std::all_of(first, first + record.triangle_count, shows)) {
    return outside;
  }
  const raytrace::Window canvas{-columns, -rows, 3 * columns, 3 * rows};
  const Mask alone = cast_alone(scene, model, object, canvas);
  for (int y = canvas.y; y < canvas.y + canvas.rows; ++y) {
    for (int x = canvas.x; x < canvas.x + canvas.columns; ++x) {
      const bool inside = x >= 0 && x < columns && y >= 0 && y < rows;
      if (inside || alone[canvas.index(x, y)] == 0) continue;
      if (outside.count++ == 0) outside = {1, x, x, y, y};
      outside.left = std::min(outside.left, x);
      outside.right = std::max(outside.right, x);
      outside.bottom = y;
    }
  }
  return outside;
}

}  // namespace earthshine::studies
