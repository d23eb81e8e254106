// SPDX-License-Identifier: Apache-2.0
#include "app/dataset/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/study/json_fields.h"
#include "scenes/read/place_mesh.h"
#include "scenes/triangle_point.h"
#include "studies/sight/sight.h"

namespace earthshine::app {
namespace {

constexpr double usual_scale_mm = 0.1;
constexpr double mm = 1000.0;
constexpr std::size_t most_compared = 4000;  // points of a model for its diameter

// The corners of an object, each once, and its triangles by them.
struct Model {
  std::vector<Vec3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
};

Model model_of(const scenes::Scene& scene, std::uint32_t object) {
  Model model;
  std::map<std::uint32_t, std::size_t> number_of;
  const scenes::Object& record = scene.objects[object];
  for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
    std::array<std::size_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = scene.triangles[record.first_triangle + t].vertex[k];
      const auto [place, is_new] = number_of.try_emplace(v, model.points.size());
      if (is_new) model.points.push_back(scene.vertices[v]);
      corners[k] = place->second;
    }
    model.triangles.push_back(corners);
  }
  return model;
}

Json by_rows(const glm::dmat3& matrix) {
  Json numbers = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) numbers.push_back(matrix[column][row]);
  }
  return numbers;
}

// x, y, v of COCO: v = 0 outside the picture, 1 hidden, 2 visible. The centre of the first pixel is
// (0, 0), as OpenCV counts.
std::array<double, 3> keypoint(const LabelCall& call, const Vec3& point) {
  const Vec3 in_camera = call.camera.to_camera(point);
  if (!call.camera.projection.shows(in_camera)) return {0.0, 0.0, 0.0};
  const glm::dvec2 film = call.camera.film_from(call.camera.position, point);
  const Vec3 offset = point - call.camera.position;
  const double distance = glm::length(offset);
  const scenes::Hit hit = call.query.closest(call.camera.position, offset / distance);
  // The point lies on a surface, or a little inside of it.
  const double slack = 1e-3 * distance;
  return {film.x - 0.5, film.y - 0.5, hit.missed() || hit.t >= distance - slack ? 2.0 : 1.0};
}

// Around both.
std::array<int, 4> box_with(const std::array<int, 4>& box, const studies::PixelsOutside& outside) {
  if (outside.count == 0) return box;
  int left = outside.left, right = outside.right, top = outside.top, bottom = outside.bottom;
  if (box[2] > 0) {
    left = std::min(left, box[0]);
    top = std::min(top, box[1]);
    right = std::max(right, box[0] + box[2] - 1);
    bottom = std::max(bottom, box[1] + box[3] - 1);
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace

Masks masks_of(const studies::TargetView& view, const studies::ObjectMap& map) {
  Masks masks;
  masks.visible.resize(map.object.size());
  for (std::size_t k = 0; k < map.object.size(); ++k) {
    masks.visible[k] = map.object[k] == static_cast<std::int32_t>(view.object) ? 255 : 0;
  }
  masks.whole = masks.visible;
  for (const std::uint32_t pixel : view.hidden) masks.whole[pixel] = 255;
  return masks;
}

std::array<int, 4> box_of(const MaskPixels& mask, int columns) {
  int left = columns, top = -1, right = -1, bottom = -1;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    if (mask[k] == 0) continue;
    const int x = static_cast<int>(k) % columns, y = static_cast<int>(k) / columns;
    left = std::min(left, x);
    right = std::max(right, x);
    if (top < 0) top = y;
    bottom = y;
  }
  if (top < 0) return {-1, -1, -1, -1};
  return {left, top, right - left + 1, bottom - top + 1};
}

std::vector<std::uint32_t> coco_runs(const MaskPixels& mask, int columns) {
  std::vector<std::uint32_t> runs{0};
  bool on = false;
  const auto across = static_cast<std::size_t>(columns), down = mask.size() / across;
  for (std::size_t x = 0; x < across; ++x) {
    for (std::size_t y = 0; y < down; ++y) {
      if ((mask[y * across + x] != 0) != on) {
        on = !on;
        runs.push_back(0);
      }
      ++runs.back();
    }
  }
  return runs;
}

Depth16 depth16(const std::vector<float>& depth_m) {
  constexpr double largest = 65535.0;
  double deepest = 0.0;
  for (const float depth : depth_m) {
    if (std::isfinite(depth)) deepest = std::max(deepest, mm * double(depth));
  }
  Depth16 picture;
  picture.scale_mm = std::max(usual_scale_mm, deepest / largest);
  for (const float depth : depth_m) {
    const bool met = std::isfinite(depth) && depth > 0.0F;
    const double value = met ? std::round(mm * double(depth) / picture.scale_mm) : 0.0;
    picture.values.push_back(static_cast<std::uint16_t>(std::clamp(value, 0.0, largest)));
  }
  return picture;
}

Json labels_of(const LabelCall& call, const std::vector<studies::TargetView>& views,
               const std::vector<Masks>& masks) {
  const raytrace::CameraMatrices matrices = camera_matrices(call.camera);
  // World to camera: the transpose of the rotation in to_world, by rows.
  const auto& m = matrices.to_world;
  const glm::dmat3 rotation(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
  const Vec3 shift = -(rotation * call.camera.position);
  std::array<double, 9> k = matrices.k;
  k[2] -= 0.5;  // OpenCV's pixels have whole numbers at their centres
  k[5] -= 0.5;
  Json labels;
  labels["scene_camera"] = {{"cam_K", k},
                            {"depth_scale", call.depth_scale_mm},
                            {"cam_R_w2c", by_rows(rotation)},
                            {"cam_t_w2c", {mm * shift.x, mm * shift.y, mm * shift.z}}};
  for (const char* list : {"scene_gt", "scene_gt_info", "annotations"}) {
    labels[list] = Json::array();
  }
  for (std::size_t t = 0; t < views.size(); ++t) {
    const scenes::Pose& pose = call.model_to_scene[t];
    const Vec3 at = rotation * pose.offset_m + shift;
    labels["scene_gt"].push_back({{"cam_R_m2c", by_rows(rotation * pose.rotation)},
                                  {"cam_t_m2c", {mm * at.x, mm * at.y, mm * at.z}},
                                  {"obj_id", t + 1}});
    const auto count = [](const MaskPixels& mask) {
      return static_cast<std::size_t>(std::ranges::count(mask, std::uint8_t{255}));
    };
    // The whole silhouette, also beyond the picture (bop_toolkit, scripts/calc_gt_info.py).
    const std::size_t all = count(masks[t].whole) + call.outside[t].count;
    const std::size_t seen = count(masks[t].visible);
    std::size_t valid = 0;
    for (std::size_t p = 0; p < masks[t].whole.size(); ++p) {
      valid += masks[t].whole[p] != 0 && std::isfinite(call.depth_m[p]) ? 1 : 0;
    }
    const auto visible_box = box_of(masks[t].visible, call.map.columns);
    labels["scene_gt_info"].push_back(
        {{"bbox_obj", box_with(box_of(masks[t].whole, call.map.columns), call.outside[t])},
         {"bbox_visib", visible_box},
         {"px_count_all", all},
         {"px_count_valid", valid},
         {"px_count_visib", seen},
         {"visib_fract", all == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(all)}});
    if (seen == 0) continue;
    Json annotation = {{"id", call.image * views.size() + t + 1},
                       {"image_id", call.image},
                       {"category_id", t + 1},
                       {"iscrowd", 0},
                       {"bbox", visible_box},
                       {"area", seen},
                       {"segmentation",
                        {{"size", {call.map.rows, call.map.columns}},
                         {"counts", coco_runs(masks[t].visible, call.map.columns)}}}};
    const std::vector<KeyPoint>& points = call.recipe.targets[t].points;
    if (!points.empty()) {
      Json numbers = Json::array();
      std::size_t inside = 0;
      for (const KeyPoint& point : points) {
        const auto [x, y, v] = keypoint(call, pose.point(point.position));
        inside += v > 0.0 ? 1 : 0;
        numbers.insert(numbers.end(), {x, y, static_cast<int>(v)});
      }
      annotation["keypoints"] = numbers;
      annotation["num_keypoints"] = inside;
    }
    labels["annotations"].push_back(annotation);
  }
  return labels;
}

Json sights_of(const scenes::Camera& camera, const base::Image& picture,
               const studies::ObjectMap& map, const std::vector<studies::TargetView>& views,
               const std::optional<CctvSetup>& cctv) {
  std::optional<degrade::Setup> chain;
  if (cctv) chain = cctv->chain;
  const studies::CameraSight found =
      studies::measure_sight(studies::plan_sight(camera, map, views), picture, chain);
  Json sights = Json::array();
  for (std::size_t t = 0; t < views.size(); ++t) {
    Json sight = kept_json(found.targets[t]);
    sight["name"] = views[t].name;
    sights.push_back(std::move(sight));
  }
  return sights;
}

std::string model_ply(const scenes::Scene& scene, std::uint32_t object) {
  const Model model = model_of(scene, object);
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment millimetres\nelement vertex {}\nproperty float x\nproperty "
      "float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\n"
      "end_header\n",
      model.points.size(), model.triangles.size());
  for (const Vec3& p : model.points) {
    text += fmt::format("{:.7g} {:.7g} {:.7g}\n", mm * p.x, mm * p.y, mm * p.z);
  }
  for (const auto& t : model.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

Json model_info(const scenes::Scene& scene, std::uint32_t object) {
  const Model model = model_of(scene, object);
  const scenes::Box box = scenes::box_around(model.points);
  double diameter = 0.0;
  if (model.points.size() <= most_compared) {
    for (const Vec3& a : model.points) {
      for (const Vec3& b : model.points) diameter = std::max(diameter, glm::length(a - b));
    }
  } else {
    diameter = box.diagonal();  // an upper bound
  }
  const Vec3 low = mm * box.low, size = mm * (box.high - box.low);
  return {{"diameter", mm * diameter}, {"min_x", low.x},   {"min_y", low.y},  {"min_z", low.z},
          {"size_x", size.x},          {"size_y", size.y}, {"size_z", size.z}};
}

}  // namespace earthshine::app
