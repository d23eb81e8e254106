// SPDX-License-Identifier: Apache-2.0
#include "raytrace/probe.h"

#include <mutex>

#include "base/parallel.h"
#include "raytrace/pixel_sums.h"
#include "raytrace/shading_setup.h"

namespace earthshine::raytrace {

Probed probe(const scenes::Scene& scene, const scenes::LightGroups& groups,
             const scenes::Effects& effects, const scenes::RayQuery& query,
             const radiosity::Solution& solution, const radiosity::Solution& aimed_at,
             const scenes::Camera& camera, const RenderOptions& options,
             std::span<const std::uint32_t> pixels, const ProbeOptions& how) {
  RenderOptions together = options;
  together.per_light = false;
  ShadingSetup setup(scene, groups, effects, query, solution, camera, together, &aimed_at);
  ShadingScene& shared = setup.shared();
  shared.diffuse = how.reads_solution ? DiffuseSource::Solution : DiffuseSource::Gather;
  shared.gather_rays = how.gather_rays;
  shared.seed = how.seed;
  shared.lamp_seed = how.lamp_seed;
  Probed probed;
  probed.luminance.resize(pixels.size());
  probed.sample_variance.resize(pixels.size());
  probed.sees_source.resize(pixels.size());
  const auto columns = static_cast<std::uint32_t>(options.columns);
  std::mutex mutex;
  base::parallel_chunks(pixels.size(), 16, [&](std::size_t begin, std::size_t end) {
    RayCounts rays;
    for (std::size_t k = begin; k < end; ++k) {
      const Window window{static_cast<int>(pixels[k] % columns),
                          static_cast<int>(pixels[k] / columns), 1, 1};
      PixelSums sums(window, shared.layers);
      shade_samples(shared, setup.camera(), {static_cast<std::uint32_t>(how.camera_samples)}, sums,
                    rays, {}, {});
      probed.luminance[k] = sums.luminance[0] / how.camera_samples;
      probed.sample_variance[k] = sums.sample_variance(0) * how.camera_samples;
      probed.sees_source[k] = sums.source_samples[0] > 0 ? 1 : 0;
    }
    const std::lock_guard lock(mutex);
    probed.rays += rays;
  });
  return probed;
}

}  // namespace earthshine::raytrace
