// SPDX-License-Identifier: Apache-2.0
#include "raytrace/shade/shading_setup.h"

#include "raytrace/light/distributed_area.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::raytrace {
namespace {

bool reads(const radiosity::Solution& solution, const RenderOptions& options) {
  return options.indirect == Indirect::Radiosity && solution.columns > 0;
}

LeakMask leak_mask(const scenes::World& world, const radiosity::Solution& solution,
                   const RenderOptions& options) {
  const bool shows = reads(solution, options) && !solution.radiosity.empty();
  return shows ? LeakMask(world.query, solution.patches) : LeakMask();
}

std::span<const float> values_if(bool read, const std::vector<float>& values) {
  return read ? std::span<const float>(values) : std::span<const float>();
}

std::size_t image_layers(const scenes::LightGroups& groups, const RenderOptions& options) {
  return options.per_light ? std::max<std::size_t>(1, groups.count()) : 1;
}

std::size_t earth_layer(const scenes::LightGroups& groups, const RenderOptions& options) {
  return options.per_light && groups.earth != scenes::no_group ? groups.earth : 0;
}

BrightPatches bright_of(const radiosity::Solution& solution, const RenderOptions& options) {
  return reads(solution, options) ? BrightPatches(solution) : BrightPatches();
}

}  // namespace

ShadingSetup::ShadingSetup(const scenes::World& world, const radiosity::Solution& solution,
                           const scenes::Camera& camera, const RenderOptions& options)
    : camera_(make_camera_model(camera, options.columns, options.rows)),
      sight_(leak_mask(world, solution, options)),
      all_(solution, values_if(reads(solution, options), solution.radiosity), options.per_light,
           sight_),
      lights_(world, options.indirect, options.distributed_lights, options.per_light,
              earth_area(world.scene, options.distributed_over),
              world.query.specular_paths().mirrors()),
      bright_(bright_of(solution, options)),
      incoming_(world, all_, bright_, image_layers(world.groups, options),
                earth_layer(world.groups, options),
                world.effects.mirror || world.effects.refraction),
      world_{world, lights_, {}, {}, 1, PathSet::NoCaustics},
      shared_{world, lights_, incoming_} {
  shared_.indirect = options.indirect;
  shared_.layers = image_layers(world.groups, options);
  for (std::size_t g = 0; g < world.groups.count(); ++g) {
    shared_.layer.push_back(options.per_light ? g : 0);
  }
  shared_.gathers = options.indirect != Indirect::Distributed &&
                    (reads(solution, options) || world.effects.earth_by_gather);
  shared_.sampled_emitter.assign(world.scene.materials.size(), true);
  if (options.indirect == Indirect::Radiosity) {
    shared_.sampled_emitter = radiosity::emitter_is_explicit(world.scene);
  }
  world_.sampled_emitter = shared_.sampled_emitter;
  world_.layer = shared_.layer;
  world_.layers = shared_.layers;
  if (reads(solution, options)) shared_.world = &world_;
  shared_.seed = shared_.lamp_seed = options.seed;
  shared_.sighting_origin = shared_.query.near(camera_.position);
  shared_.filter = PixelFilter(camera);
}

}  // namespace earthshine::raytrace
