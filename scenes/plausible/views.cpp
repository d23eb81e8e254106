// SPDX-License-Identifier: Apache-2.0
#include "scenes/plausible/views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scenes/text/message_text.h"
#include "scenes/view/projection.h"

namespace earthshine::scenes {
namespace {

constexpr std::size_t grid = 24;    // rays per side
constexpr double near_share = 0.9;  // of the rays
// Share of the distance to the target below which a surface that fills the picture is too near.
constexpr double nearest_share = 0.05;
constexpr double most_backs = 0.5;
// A bay of 15 m read in mm measures 15 mm; the smallest space with a camera measures decimetres.
constexpr double small_m = 0.1;
// Common fields of view. In radians, a number in this range is below 2.7 degrees.
constexpr double usual_fields_from_deg = 15.0, usual_fields_to_deg = 150.0;

struct CameraFrame {
  Vec3 position, forward, right, up;
  Projection projection;

  explicit CameraFrame(const Camera& camera)
      : position(camera.position),
        forward(glm::normalize(camera.look_at - camera.position)),
        right(glm::normalize(glm::cross(forward, camera.up))),
        up(glm::cross(right, forward)),
        projection(camera, camera.columns, camera.rows) {}
  [[nodiscard]] Vec3 direction(const glm::dvec2& place) const {
    const Vec3 d = projection.direction(place);
    return glm::normalize(d.z * forward + d.x * right - d.y * up);
  }
  [[nodiscard]] bool shows(const Vec3& point) const {
    const Vec3 offset = point - position;
    return projection.shows(
        {glm::dot(offset, right), -glm::dot(offset, up), glm::dot(offset, forward)});
  }
};

// Whether a narrow picture shows any object completely, as a telephoto picture does. Uses more
// rays.
bool shows_a_whole_object(const Scene& scene, const View& view) {
  const CameraFrame frame(*view.camera);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (view.hits_of[o] == 0) continue;
    const Object& object = scene.objects[o];
    bool whole = true;
    for (std::uint32_t t = 0; t < object.triangle_count && whole; ++t) {
      for (const std::uint32_t v : scene.triangles[object.first_triangle + t].vertex) {
        whole = whole && frame.shows(scene.vertices[v]);
      }
    }
    if (whole) return true;
  }
  return false;
}

std::size_t most_of(const std::vector<std::size_t>& counts) {
  return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

// 1 if a face at `point`, whose back is visible, turns its back to the middle of the object's box,
// -1 if away from it; 0 for a flat object. normal: of the front.
std::ptrdiff_t inward_sign(const Box& box, const Vec3& point, const Vec3& normal) {
  constexpr double flat = 1e-6;  // of the box
  const double toward = glm::dot(box.middle() - point, -normal);
  if (std::abs(toward) <= flat * box.diagonal()) return 0;
  return toward > 0.0 ? 1 : -1;
}

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

// Lengths below 1 m in mm, others in m.
std::string length_text(double metres) {
  if (metres < 1.0) return fmt::format("{:.2g} mm", 1000.0 * metres);
  return fmt::format("{:.3g} m", metres);
}

std::string blocked_text(const Scene& scene, const View& view) {
  const double distance = glm::length(view.camera->look_at - view.camera->position);
  const std::size_t object = most_of(view.hits_of);
  return fmt::format(
      "camera {} is inside, right behind or right before the object {}: that fills {:.0f} % of its "
      "picture from "
      "{} away, and the camera looks at a point {} away; move the camera in front of that object",
      in_quotes(view.camera->name), in_quotes(scene.objects[object].name),
      100.0 * share(view.hits_of[object], view.rays), length_text(view.farthest_near_m),
      length_text(distance));
}

std::optional<std::string> backs_text(const Scene& scene, const View& view) {
  if (view.back_share() <= most_backs) return std::nullopt;
  const std::size_t number = most_of(view.backs_of);
  const Object& object = scene.objects[number];
  const std::ptrdiff_t inner = view.inner_backs_of[number];
  const char* const remedy = object.orient == Orient::AsIs || inner == 0
                                 ? "turn its faces over (inward)"
                             : inner > 0 ? "say orient = \"inward\" there"
                                         : "say orient = \"outward\" there";
  return fmt::format(
      "most of what camera {} sees ({:.0f} %) is back faces, which are black, the most of them of "
      "the object {}; {}, or orient = \"two-sided\", or move the camera to the other side",
      in_quotes(view.camera->name), 100.0 * view.back_share(), in_quotes(object.name), remedy);
}

std::optional<std::string> field_text(const Scene& scene, const View& view) {
  const double field = view.camera->fov_deg, if_radians = base::degrees(field);
  if (if_radians < usual_fields_from_deg || if_radians > usual_fields_to_deg) return std::nullopt;
  if (shows_a_whole_object(scene, view)) return std::nullopt;
  return fmt::format(
      "camera {}: fov_deg = {:g} is narrow, and no object is in the picture as a whole; {:g} "
      "radians are {:.3g} degrees: write fov_deg = {:.3g} where those are meant",
      in_quotes(view.camera->name), field, field, if_radians, if_radians);
}

}  // namespace

bool View::is_blocked() const {
  const double distance = glm::length(camera->look_at - camera->position);
  return farthest_near_m < nearest_share * distance &&
         share(*std::max_element(hits_of.begin(), hits_of.end()), rays) >= near_share;
}

Vec3 leave_toward(const Scene& scene, const RayQuery& query, const Hit& hit,
                  const Vec3& direction) {
  const Vec3 normal = triangle_normal(scene, hit.triangle);
  const double side = glm::dot(normal, direction) < 0.0 ? -1.0 : 1.0;
  return hit_position(scene, hit) + side * query.offset_m(hit.triangle) * normal;
}

View sample_view(const Scene& scene, const RayQuery& query, const Camera& camera,
                 const std::vector<Box>& bounds) {
  View view;
  view.camera = &camera;
  view.hits_of.resize(scene.objects.size());
  view.backs_of.resize(scene.objects.size());
  view.inner_backs_of.resize(scene.objects.size());
  const CameraFrame frame(camera);
  std::vector<double> distances;
  for (std::size_t k = 0; k < grid * grid; ++k) {
    ++view.rays;
    const auto place = [](std::size_t n) {
      return (static_cast<double>(n) + 0.5) / static_cast<double>(grid);
    };
    const Vec3 direction = frame.direction({place(k % grid), 1.0 - place(k / grid)});
    Vec3 origin = camera.position;
    for (int panes = 0; panes < most_panes_passed; ++panes) {
      const Hit hit = query.closest(origin, direction);
      if (hit.missed()) break;
      const Vec3 point = hit_position(scene, hit);
      const Triangle& triangle = scene.triangles[hit.triangle];
      const Material& material = scene.materials[triangle.material];
      if (base::max_component(material.transmit) > 0.0) {
        origin = leave_toward(scene, query, hit, direction);
        continue;
      }
      ++view.hits;
      ++view.hits_of[triangle.object];
      if (!hit.front && material.has_black_back()) {
        ++view.backs;
        ++view.backs_of[triangle.object];
        view.inner_backs_of[triangle.object] +=
            inward_sign(bounds[triangle.object], point, triangle_normal(scene, hit.triangle));
      }
      view.seen.add(point);
      distances.push_back(glm::length(point - camera.position));
      break;
    }
  }
  const auto nearest = static_cast<std::size_t>(std::ceil(near_share * double(view.rays))) - 1;
  view.farthest_near_m = std::numeric_limits<double>::infinity();
  if (distances.size() > nearest) {
    const auto at = distances.begin() + static_cast<std::ptrdiff_t>(nearest);
    std::nth_element(distances.begin(), at, distances.end());
    view.farthest_near_m = *at;
  }
  return view;
}

std::vector<std::string> implausible_views(const Scene& scene, const std::vector<View>& views) {
  std::vector<std::string> found;
  for (const View& view : views) {
    if (view.is_blocked()) {
      found.push_back(blocked_text(scene, view));
      continue;
    }
    if (const auto backs = backs_text(scene, view)) found.push_back(*backs);
    if (const auto field = field_text(scene, view)) found.push_back(*field);
  }
  return found;
}

std::vector<std::string> implausible_size(const Scene& scene, const std::vector<View>& views) {
  if (scene.vertices.empty()) return {};
  double widest = 0.0;  // extent of the visible surfaces and the cameras
  const View* widest_view = nullptr;
  for (const View& view : views) {
    if (view.hits == 0 || view.is_blocked()) continue;
    Box with_camera = view.seen;
    with_camera.add(view.camera->position);
    if (with_camera.diagonal() <= widest) continue;
    widest = with_camera.diagonal();
    widest_view = &view;
  }
  Box all = box_around(scene.vertices);
  for (const View& view : views) all.add(view.camera->position);
  const double across = widest_view == nullptr ? all.diagonal() : widest;
  if (across >= small_m) return {};
  const std::string what = widest_view == nullptr
                               ? "the scene is"
                               : fmt::format("what camera {} sees is, with itself,",
                                             in_quotes(widest_view->camera->name));
  return {fmt::format("{} {} across; are unit, and scale of the objects, right?", what,
                      length_text(across))};
}

}  // namespace earthshine::scenes
