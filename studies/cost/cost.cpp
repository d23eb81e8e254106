// SPDX-License-Identifier: Apache-2.0
#include "studies/cost/cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "radiosity/near_lamps.h"
#include "radiosity/refine.h"
#include "raytrace/adaptive/allocator.h"
#include "raytrace/paths/path_tracer.h"
#include "studies/cost/cost_laws.h"

namespace earthshine::studies {
namespace {

// Pictures with a wanted error are started with at most this many pixels and stopped after this
// time. Pixels of the whole picture cost less each, because fewer are at edges and more are
// similar: on the payload bay and the still life 4 times the pixels cost 1.7 to 2.6 times as much;
// part of the cost is independent of the pixels.
constexpr double begun_pixels = 128.0 * 128.0, begun_cpu_s = 2.0;
constexpr double power_of_pixels = 0.48;
// Exponent of seconds over the ratio of errors if even the initial sampling was stopped: measured
// on the payload bay with its four lights, 512 x 512, where it is 0.96 to 1.17.
constexpr double power_of_a_cut_look = 1.05;
// Other pictures have the fewer pixels, and are repeated with more if that was fast.
constexpr double least_pixels = 1024.0, most_pixels = 4096.0, enough_cpu_s = 0.5;
constexpr int pilot_rays = 64;  // per patch
constexpr double few_patches = 4096.0;
constexpr std::size_t pilot_growth = 1024;  // patches that the pilot's refinement may add

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }
  [[nodiscard]] double cpu_seconds() const { return base::cpu_seconds() - cpu_; }
  // Seconds on an idle machine.
  [[nodiscard]] double seconds_alone() const { return cpu_seconds() / base::available_threads(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double cpu_ = base::cpu_seconds();
};

// Solves coarsely and scales the report; `coarse` receives the solution for the pictures.
radiosity::SolveReport expect_solve(const PilotCall& call, radiosity::Solution& coarse) {
  radiosity::SolveOptions cheap = call.solver;
  cheap.form_factor_rays = std::min(pilot_rays, cheap.form_factor_rays);
  cheap.tolerance = std::max(cheap.tolerance, 1e-4);
  const bool refines = call.solver.refine.on;
  const double most = static_cast<double>(
      refines ? radiosity::most_refined_patches(call.scene, call.solver)
              : radiosity::count_near_lamps(call.scene, call.solver.patch_edge_m));
  if (refines) {
    const std::size_t start = radiosity::count_patches(call.scene, call.solver.refine.start_edge_m);
    cheap.refine.max_patches = std::min(static_cast<std::size_t>(most), start + pilot_growth);
  } else {
    if (most > few_patches) cheap.patch_edge_m *= std::sqrt(most / few_patches);
  }
  const Stopwatch watch;
  coarse = radiosity::solve(call, cheap);
  radiosity::SolveReport& pilot = coarse.report;
  const double alone = watch.seconds_alone() / std::max(1e-9, watch.seconds());
  for (auto& [stage, seconds] : pilot.seconds) seconds *= alone;
  for (radiosity::SourceCost& cost : pilot.sources_cost) cost.seconds *= alone;
  SolveScale scale;
  scale.refines = refines;
  scale.patches = refines ? expected_patches(pilot.rounds, call.solver.refine.error, most) : most;
  scale.rays = double(call.solver.form_factor_rays) / cheap.form_factor_rays;
  scale.row_entries = call.row_entries;
  return scaled(pilot, scale);
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
    options.crop = {};
    if (options.indirect == raytrace::Indirect::Paths) {
      return raytrace::trace_paths(call_, camera,
                                   {options.columns,
                                    options.rows,
                                    std::max(2, std::min(8, options.gather_rays)),
                                    options.per_light,
                                    options.paths,
                                    options.seed,
                                    {}});
    }
    options.time_limit_s = 0.0;
    return raytrace::render(call_, coarse_, camera, options);
  }

 private:
  const PilotCall& call_;
  const radiosity::Solution& coarse_;
};

// Converts seconds to an idle machine.
raytrace::Frame timed(const Stopwatch& watch, raytrace::Frame frame) {
  const double alone = watch.seconds_alone() / std::max(1e-9, watch.seconds());
  frame.report.seconds *= alone;
  frame.report.gather_seconds *= alone;
  return frame;
}

raytrace::RenderReport expect_steered(const PictureDrawer& drawer, const scenes::Camera& camera,
                                      raytrace::RenderOptions options, base::Image& image) {
  const Stopwatch watch;
  options.stop = [&watch] { return watch.cpu_seconds() > begun_cpu_s; };
  options.initial_sampling_pixels =
      static_cast<std::size_t>(options.columns) * static_cast<std::size_t>(options.rows);
  raytrace::Frame frame = timed(watch, drawer.draw(camera, options, begun_pixels));
  const double growth = samples_growth(frame.report, options.error);
  const double pixels = std::pow(
      double(options.columns) * options.rows / static_cast<double>(frame.image.pixel_count()),
      power_of_pixels);
  const double share = options.crop.columns > 0 ? static_cast<double>(options.crop.pixel_count()) /
                                                      (double(options.columns) * options.rows)
                                                : 1.0;
  image = std::move(frame.image);
  return scaled(frame.report, {1.0, growth * pixels * share, 0.0});
}

raytrace::RenderReport expect_picture(const PictureDrawer& drawer, const scenes::Camera& camera,
                                      const raytrace::RenderOptions& options, base::Image& image) {
  if (options.error > 0.0 && options.indirect == raytrace::Indirect::Radiosity) {
    return expect_steered(drawer, camera, options, image);
  }
  const double whole = double(options.columns) * options.rows;
  raytrace::Frame frame;
  SmallPicture small;
  for (const double pixels : {least_pixels, most_pixels}) {
    const Stopwatch watch;
    frame = timed(watch, drawer.draw(camera, options, pixels));
    const SmallPicture drawn{frame.report, static_cast<double>(frame.image.pixel_count())};
    small = {pixels > least_pixels ? as_part_of(whole, small, drawn) : drawn.report, drawn.pixels};
    if (watch.cpu_seconds() > enough_cpu_s) break;
  }
  const double pixels =
      options.crop.columns > 0 ? static_cast<double>(options.crop.pixel_count()) : whole;
  const raytrace::RenderReport report =
      scaled(small.report,
             {small.pixels, pixels,
              options.indirect == raytrace::Indirect::Paths ? double(options.gather_rays) : 0.0});
  image = std::move(frame.image);
  return report;
}

// Division of the bill among the effects.

double solve_seconds(const radiosity::SolveReport& report) {
  double sum = 0.0;
  for (const auto& [name, seconds] : report.seconds) sum += seconds;
  return sum;
}

}  // namespace

double samples_growth(const raytrace::RenderReport& report, double wanted) {
  if (report.growth > 0.0) return report.growth;
  const double ratio = report.relative_noise / wanted;
  return ratio > 1.0 ? std::pow(ratio / raytrace::stop_fraction(wanted), power_of_a_cut_look) : 1.0;
}

Pilot expect_costs(const PilotCall& call, const std::vector<const scenes::Camera*>& cameras,
                   const std::vector<raytrace::RenderOptions>& pictures) {
  // It ends by the clock, which differs between ranks: each has its own pilot.
  const base::RanksInForce alone(nullptr);
  const Stopwatch watch;
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
  pilot.seconds = watch.seconds();
  pilot.cpu_seconds = watch.cpu_seconds();
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
    // Without interreflection the hemisphere is searched for the Earth only.
    EffectCost& gathers = effects.interreflection
                              ? between
                              : sources[static_cast<std::size_t>(scenes::LightKind::Earth)];
    gathers.rays += static_cast<double>(rays.gather);
    gathers.seconds += report.gather_seconds;
    // Path tracing has no separate gather stage: all rays share the seconds.
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

RanksCost ranks_cost(const Bill& bill, std::size_t columns, double pixels) {
  RanksCost cost;
  for (const auto& [name, seconds] : bill.solve.seconds) {
    // Each rank divides surfaces into patches; the samples of refinement are shared.
    const bool alone = name == "ledger" || (name == "patches" && bill.solve.refinement_rays == 0);
    (alone ? cost.alone_s : cost.shared_s) += seconds;
  }
  for (const raytrace::RenderReport& report : bill.pictures) cost.shared_s += report.seconds;
  // Bytes per patch, in the order of the terms: result of a row; scale factors and their sums in 16
  // bands, per balancing sweep; row; four floats of the solution, per column; two products per
  // iteration, packed in fours of columns.
  const auto patches = static_cast<double>(bill.solve.patches);
  const double sweeps = bill.solve.balance.sweeps, fours = std::ceil(double(columns) / 4.0);
  cost.bytes_to_all = patches * (64.0 + 32.0 * sweeps + 8.0 + 16.0 * double(columns) +
                                 64.0 * fours * double(bill.solve.iterations)) +
                      24.0 * pixels;
  // Each entry comes once from the rank that cast it; filled-in hits come once more, with their
  // rows.
  const double filling = bill.solve.balance.filled > 0 ? 12.0 : 0.0;
  cost.bytes_dealt =
      (8.0 + filling) * static_cast<double>(bill.solve.nonzeros) + patches * 128.0 * sweeps;
  return cost;
}

double bytes_of_a_rank(const RanksCost& cost, int ranks) {
  return ranks > 1 ? cost.bytes_to_all + cost.bytes_dealt / ranks : 0.0;
}

double seconds_on_ranks(const RanksCost& cost, int ranks, double bytes_per_s) {
  return cost.alone_s + cost.shared_s / ranks + bytes_of_a_rank(cost, ranks) / bytes_per_s;
}

}  // namespace earthshine::studies
