// SPDX-License-Identifier: Apache-2.0
// Labels of an image in the formats of BOP (bop_toolkit, docs/bop_datasets_format.md) and COCO
// (cocodataset.org, "Data format").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cctv/cctv.h"
#include "app/dataset/recipe.h"
#include "raytrace/camera/camera.h"
#include "scenes/ray_query.h"
#include "scenes/time/linkage.h"
#include "studies/targets/target_view.h"

namespace earthshine::app {

// One byte a pixel, 0 or 255.
using MaskPixels = std::vector<std::uint8_t>;
struct Masks {
  MaskPixels whole, visible;  // of the target alone, and as the picture shows it
};
[[nodiscard]] Masks masks_of(const studies::TargetView& view, const studies::ObjectMap& map);

// Left, top, width, height in pixels; -1 throughout for an empty mask.
[[nodiscard]] std::array<int, 4> box_of(const MaskPixels& mask, int columns);

// Lengths of runs of 0 and 1 by turns, down the columns, beginning with 0.
[[nodiscard]] std::vector<std::uint32_t> coco_runs(const MaskPixels& mask, int columns);

// Depth in 16 bits: value * scale is millimetres. 0: nothing was met. The scale is 0.1 unless the
// largest depth needs more.
struct Depth16 {
  std::vector<std::uint16_t> values;
  double scale_mm = 0.1;
};
[[nodiscard]] Depth16 depth16(const std::vector<float>& depth_m);

struct LabelCall {
  const Recipe& recipe;
  const scenes::Scene& scene;
  const scenes::RayQuery& query;
  const raytrace::CameraModel& camera;
  const studies::ObjectMap& map;
  const std::vector<float>& depth_m;
  double depth_scale_mm;
  std::size_t image;
  std::vector<scenes::Pose> model_to_scene;     // of each target, m
  std::vector<studies::PixelsOutside> outside;  // of each target
};
// {"scene_camera", "scene_gt", "scene_gt_info", "annotations"} of the image; masks come in the
// order of scene_gt, which lists all targets.
[[nodiscard]] Json labels_of(const LabelCall& call, const std::vector<studies::TargetView>& views,
                             const std::vector<Masks>& masks);

// {"name", "verdict", "signal" ...} of each target in the picture, with the keys of study.json: on
// the monitor of the CCTV, without one by eye.
[[nodiscard]] Json sights_of(const scenes::Camera& camera, const base::Image& picture,
                             const studies::ObjectMap& map,
                             const std::vector<studies::TargetView>& views,
                             const std::optional<CctvSetup>& cctv);

// Of the target in the model's axes: corners in mm, as PLY, and its size as models_info.json has
// it.
[[nodiscard]] std::string model_ply(const scenes::Scene& scene, std::uint32_t object);
[[nodiscard]] Json model_info(const scenes::Scene& scene, std::uint32_t object);

}  // namespace earthshine::app
