// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/punctual.h"

#include <cmath>

#include "scenes/mesh/gltf/textures.h"

namespace earthshine::scenes {
namespace {

constexpr double strongest_lamp = 1e15;  // cd, as in scene files
constexpr double degrees = 180.0 / base::pi;

GltfLamp lamp_of(const tinygltf::Light& source, GltfModel& model) {
  GltfLamp made;
  Lamp& lamp = made.lamp;
  lamp.name = source.name;
  lamp.axis = {0.0, 0.0, -1.0};
  const Rgb strength = colour_of(source.color, 1.0) * in_range(source.intensity, strongest_lamp);
  (source.type == "directional" ? lamp.illuminance_lx : lamp.intensity_cd) = strength;
  if (source.type == "directional") {
    lamp.kind = LampKind::Distant;
  } else if (source.type == "spot") {
    lamp.kind = LampKind::Spot;
    const auto full = [](double half_angle) {
      return 2.0 * degrees * in_range(half_angle, base::pi / 2.0);
    };
    lamp.field_deg = full(source.spot.outerConeAngle);
    lamp.beam_deg = std::min(lamp.field_deg, full(source.spot.innerConeAngle));
  } else {
    made.is_lamp = source.type == "point";
  }
  if (source.range > 0.0) ++model.unused["ranges of lamps: light goes on"];
  return made;
}

GltfCamera camera_of(const tinygltf::Camera& source, GltfModel& model) {
  GltfCamera made;
  Camera& camera = made.camera;
  camera.name = source.name;
  made.is_camera = source.type == "perspective" && source.perspective.yfov > 0.0 &&
                   source.perspective.yfov < base::pi;
  if (source.type == "orthographic") ++model.unused[flat_cameras_of_file];
  if (!made.is_camera) return made;
  camera.fov_deg = source.perspective.yfov * degrees;
  const double aspect = source.perspective.aspectRatio;
  if (aspect > 0.0 && aspect < 32.0) {
    camera.columns = std::max(1, static_cast<int>(std::lround(camera.rows * aspect)));
  }
  return made;
}

}  // namespace

void read_punctual(GltfModel& model) {
  for (const auto& light : model.file.lights) model.lamps.push_back(lamp_of(light, model));
  for (const auto& camera : model.file.cameras) model.cameras.push_back(camera_of(camera, model));
}

int lamp_on(const tinygltf::Node& node) {
  const tinygltf::Value hung = extension_of(node.extensions, "KHR_lights_punctual");
  return static_cast<int>(number_of(hung, "light", -1.0));
}

}  // namespace earthshine::scenes
