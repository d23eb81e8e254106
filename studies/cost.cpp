// SPDX-License-Identifier: Apache-2.0
#include "studies/cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "radiosity/refine.h"
#include "radiosity/row_pilot.h"
#include "raytrace/path_tracer.h"

namespace earthshine::studies {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double pilot_pixels = 4096.0;
constexpr int pilot_rays = 64;  // per patch
constexpr double few_patches = 4096.0;
constexpr std::size_t pilot_growth = 1024;  // patches that the pilot's refinement may add
constexpr double least_power = 0.25, most_power = 1.0;  // of patches, by which errors fall

double& stage(radiosity::SolveReport& report, const std::string& name) {
  for (auto& [known, seconds] : report.seconds) {
    if (known == name) return seconds;
  }
  return report.seconds.emplace_back(name, 0.0).second;
}

// Patches until refinement ends.
double expected_patches(const std::vector<radiosity::RefineRound>& rounds, double wanted_error,
                        double most) {
  if (rounds.empty()) return most;
  const radiosity::RefineRound& last = rounds.back();
  if (last.error <= wanted_error) return static_cast<double>(last.patches);
  if (rounds.size() < 2) return most;
  const radiosity::RefineRound& first = rounds.front();
  const double growth = std::log(double(last.patches) / double(first.patches));
  const double fall = std::log(first.error / last.error);
  const double power = std::clamp(growth > 0.0 ? fall / growth : 0.0, least_power, most_power);
  return std::min(most, double(last.patches) *
                            std::pow(last.error / std::max(wanted_error, 1e-9), 1.0 / power));
}

// The coarse solve, scaled; `coarse` receives its solution for the pictures.
radiosity::SolveReport expect_solve(const PilotCall& call, radiosity::Solution& coarse) {
  radiosity::SolveOptions cheap = call.solver;
  cheap.form_factor_rays = std::min(pilot_rays, cheap.form_factor_rays);
  cheap.tolerance = std::max(cheap.tolerance, 1e-4);
  const bool refines = call.solver.refine.on;
  const double most =
      static_cast<double>(refines ? radiosity::most_refined_patches(call.scene, call.solver)
                                  : radiosity::count_patches(call.scene, call.solver.patch_edge_m));
  if (refines) {
    const std::size_t start = radiosity::count_patches(call.scene, call.solver.refine.start_edge_m);
    cheap.refine.max_patches = std::min(static_cast<std::size_t>(most), start + pilot_growth);
  } else {
    if (most > few_patches) cheap.patch_edge_m *= std::sqrt(most / few_patches);
  }
  coarse = radiosity::solve(call.scene, call.groups, call.effects, call.query, cheap);
  const radiosity::SolveReport& pilot = coarse.report;
  radiosity::SolveReport report;
  const double patches =
      refines ? expected_patches(pilot.rounds, call.solver.refine.error, most) : most;
  const double n = std::max(1.0, static_cast<double>(pilot.patches));
  const double more = patches / n;
  const double rays = double(call.solver.form_factor_rays) / cheap.form_factor_rays;
  report.patches = static_cast<std::size_t>(patches);
  report.form_factor_rays =
      static_cast<std::uint64_t>(double(pilot.form_factor_rays) * more * rays);
  report.refinement_rays =
      static_cast<std::uint64_t>(double(pilot.refinement_rays) * more * rays / 8);
  const double entries = patches * radiosity::expected_rows(call.scene, call.query, report.patches,
                                                            call.solver.form_factor_rays)
                                       .entries;
  const double filled = entries / std::max(1.0, double(pilot.nonzeros));
  report.nonzeros = static_cast<std::size_t>(entries);
  for (const auto& [name, seconds] : pilot.seconds) {
    double scale = more;
    if (name == "form factors") scale = more * rays;
    if (name == "balance" || name == "linear solve") scale = std::max(1.0, filled);
    // The rounds' solves take an eighth of the rays, at least 64: much as the pilot's.
    if (name == "patches") scale = refines ? std::max(1.0, more * std::max(1.0, rays / 8)) : more;
    stage(report, name) = seconds * scale;
  }
  report.sources_cost = pilot.sources_cost;
  for (radiosity::SourceCost& cost : report.sources_cost) {
    cost.rays = static_cast<std::uint64_t>(double(cost.rays) * more);
    cost.seconds *= more;
    report.shadow_rays += cost.rays;
  }
  return report;
}

class PictureDrawer {
 public:
  PictureDrawer(const PilotCall& call, const radiosity::Solution& coarse)
      : call_(call), coarse_(coarse) {}

  raytrace::Frame draw(const scenes::Camera& camera, raytrace::RenderOptions options,
                       double pixels) const {
    const double wanted = double(options.columns) * options.rows;
    const double scale = std::min(1.0, std::sqrt(pixels / wanted));
    options.columns = std::max(1, static_cast<int>(std::lround(scale * options.columns)));
    options.rows = std::max(1, static_cast<int>(std::lround(scale * options.rows)));
    // Samples and rays gathered again go to edges, whose share of the pixels grows as the picture
    // shrinks, as 1 / noise^2: with the noise so much larger a pixel costs what it does in the
    // whole.
    const double coarser = 1.0 / std::sqrt(scale);
    options.shared.noise *= coarser;
    options.shared.gather_noise *= coarser;
    options.crop = {};
    options.time_limit_s = 0.0;
    if (options.indirect == raytrace::Indirect::Paths) {
      return raytrace::trace_paths(call_.scene, call_.groups, call_.effects, call_.query, camera,
                                   {options.columns,
                                    options.rows,
                                    std::max(2, std::min(8, options.gather_rays)),
                                    options.per_light,
                                    raytrace::PathSet::All,
                                    options.seed,
                                    {}});
    }
    return raytrace::render(call_.scene, call_.groups, call_.effects, call_.query, coarse_, camera,
                            options);
  }

 private:
  const PilotCall& call_;
  const radiosity::Solution& coarse_;
};

void scale_rays(raytrace::RayCounts& rays, double once, double per_sample) {
  const auto times = [](std::uint64_t& count, double by) {
    count = static_cast<std::uint64_t>(double(count) * by);
  };
  times(rays.gather, once);
  times(rays.layers, once);
  for (std::uint64_t* count :
       {&rays.camera, &rays.shadow, &rays.lobe, &rays.mirror, &rays.refraction}) {
    times(*count, per_sample);
  }
  for (std::uint64_t& count : rays.to_light) times(count, per_sample);
}

raytrace::RenderReport expect_picture(const PictureDrawer& drawer, const scenes::Camera& camera,
                                      const raytrace::RenderOptions& options, base::Image& image) {
  raytrace::Frame frame = drawer.draw(camera, options, pilot_pixels);
  raytrace::RenderReport report = frame.report;
  const double pixels = options.crop.columns > 0 ? static_cast<double>(options.crop.pixel_count())
                                                 : double(options.columns) * options.rows;
  const double drawn = static_cast<double>(frame.image.pixel_count());
  double samples = report.camera_samples;
  if (options.indirect == raytrace::Indirect::Paths) samples = options.gather_rays;
  const double more = pixels / drawn;
  const double per_sample = more * samples / std::max(1e-9, report.camera_samples);
  const double shading = std::max(0.0, report.seconds - report.gather_seconds);
  scale_rays(report.rays, options.indirect == raytrace::Indirect::Paths ? per_sample : more,
             per_sample);
  report.gather_seconds *= more;
  report.seconds = report.gather_seconds + shading * per_sample;
  report.camera_samples = samples;
  image = std::move(frame.image);
  return report;
}

double solve_seconds(const radiosity::SolveReport& report) {
  double sum = 0.0;
  for (const auto& [name, seconds] : report.seconds) sum += seconds;
  return sum;
}

}  // namespace

Pilot expect_costs(const PilotCall& call, const std::vector<const scenes::Camera*>& cameras,
                   const std::vector<raytrace::RenderOptions>& pictures) {
  const auto start = Clock::now();
  Pilot pilot;
  radiosity::Solution coarse;
  if (call.effects.solution && !call.scene.triangles.empty()) {
    pilot.bill.solve = expect_solve(call, coarse);
  }
  const PictureDrawer drawer(call, coarse);
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    pilot.pictures.emplace_back();
    pilot.bill.pictures.push_back(
        expect_picture(drawer, *cameras[k], pictures[k], pilot.pictures.back()));
  }
  pilot.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return pilot;
}

std::vector<EffectCost> effect_costs(const Bill& bill, const scenes::Effects& effects) {
  EffectCost between{"interreflection"}, glossy{"glossy reflection"}, mirror{"mirror"},
      refraction{"refraction"}, layers{"layers"}, camera{"camera rays"};
  std::vector<EffectCost> sources;
  for (std::size_t k = 0; k < scenes::light_kinds; ++k) {
    const radiosity::SourceCost& cost = bill.solve.sources_cost[k];
    sources.push_back({std::string(scenes::effect_of(static_cast<scenes::LightKind>(k))),
                       static_cast<double>(cost.rays), cost.seconds});
  }
  between.rays = static_cast<double>(bill.solve.refinement_rays + bill.solve.form_factor_rays);
  for (const auto& [name, seconds] : bill.solve.seconds) {
    if (name != "direct light") between.seconds += seconds;
  }
  for (const raytrace::RenderReport& report : bill.pictures) {
    const raytrace::RayCounts& rays = report.rays;
    // Without light between surfaces the hemisphere is searched for the Earth alone.
    EffectCost& gathers = effects.interreflection
                              ? between
                              : sources[static_cast<std::size_t>(scenes::LightKind::Earth)];
    gathers.rays += static_cast<double>(rays.gather);
    gathers.seconds += report.gather_seconds;
    // Paths have no gather stage of their own: all their rays share the seconds.
    const double apart = report.gather_seconds > 0.0 ? static_cast<double>(rays.gather) : 0.0;
    const double shaded = std::max(1.0, static_cast<double>(rays.total()) - apart);
    const double per_ray = std::max(0.0, report.seconds - report.gather_seconds) / shaded;
    if (apart == 0.0) gathers.seconds += per_ray * static_cast<double>(rays.gather);
    const auto take = [per_ray](EffectCost& cost, std::uint64_t count) {
      cost.rays += static_cast<double>(count);
      cost.seconds += per_ray * static_cast<double>(count);
    };
    for (std::size_t k = 0; k < scenes::light_kinds; ++k) take(sources[k], rays.to_light[k]);
    take(glossy, rays.lobe);
    take(mirror, rays.mirror);
    take(refraction, rays.refraction);
    take(layers, rays.layers);
    take(camera, rays.camera + rays.planning);
  }
  std::vector<EffectCost> costs = {between, glossy, mirror, refraction, layers, camera};
  costs.insert(costs.end(), sources.begin(), sources.end());
  return costs;
}

double total_seconds(const Bill& bill) {
  double sum = solve_seconds(bill.solve);
  for (const raytrace::RenderReport& report : bill.pictures) sum += report.seconds;
  return sum;
}

}  // namespace earthshine::studies
