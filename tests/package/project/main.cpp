// SPDX-License-Identifier: Apache-2.0
// The mean luminance of a scene's first camera by direct light alone, cd/m^2.
#include <iostream>
#include <numeric>

#include "raytrace/render.h"
#include "scenes/read/scene_file.h"

int main(int argc, char** argv) {
  using namespace earthshine;
  if (argc != 2) return 2;
  const scenes::Scene scene = scenes::read_scene(argv[1]);
  const scenes::LightGroups groups = scenes::find_light_groups(scene);
  scenes::Asked asked;
  asked.paths = scenes::LightPaths::Straight;
  const scenes::Effects effects = scenes::find_effects(scene, groups, asked);
  const scenes::RayQuery query(scene);
  raytrace::RenderOptions options = raytrace::render_options(scenes::resolve_quality(scene));
  options.columns = options.rows = 16;
  options.indirect = raytrace::Indirect::None;
  const raytrace::Frame frame =
      raytrace::render({scene, groups, effects, query}, {}, scene.cameras.front(), options);
  const std::vector<float> light = base::luminance_of(frame.image);
  std::cout << std::accumulate(light.begin(), light.end(), 0.0) / double(light.size()) << "\n";
}
