// SPDX-License-Identifier: Apache-2.0
// The tables that shading reads, built once per picture.
#pragma once

#include "raytrace/shade/shading.h"

namespace earthshine::raytrace {

class ShadingSetup {
 public:
  // All arguments must outlive it.
  ShadingSetup(const scenes::World& world, const radiosity::Solution& solution,
               const scenes::Camera& camera, const RenderOptions& options);
  ShadingSetup(const ShadingSetup&) = delete;
  ShadingSetup& operator=(const ShadingSetup&) = delete;

  [[nodiscard]] ShadingScene& shared() { return shared_; }
  // For residual paths, and for lobe rays at gather points.
  [[nodiscard]] const PathWorld& world() const { return world_; }
  [[nodiscard]] const CameraModel& camera() const { return camera_; }

 private:
  CameraModel camera_;
  LeakMask sight_;
  RadianceTable all_;
  LightSampler lights_;
  BrightPatches bright_;
  IncomingLight incoming_;
  PathWorld world_;
  ShadingScene shared_;
};

}  // namespace earthshine::raytrace
