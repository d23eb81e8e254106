// SPDX-License-Identifier: Apache-2.0
// Gain by adaptive patches: error of the radiosity against the number of patches, for uniform
// division and for refinement. The reference is a uniform division four times finer than the finest
// one.
//   refine_bench SCENE.toml REFERENCE_EDGE RAYS EDGE[,EDGE...] START_EDGE BUDGET[,BUDGET...]
// Without arguments: the Cornell box and the payload bay by Sun.
//
// The first column is the error of the radiosity of the patches. The second is the same as a mean
// over light groups, each relative to its light. The third is the error of the interpolated
// radiosity, as gather rays read it. Then follow the estimate of the refinement, seconds in all and
// seconds of the refinement.
//
// The error is the RMS over all surfaces, relative to the RMS of the radiosity, at the patch
// centres of the reference. The reference is solved with two seeds. The error is the mean product
// of the two differences, which cancels the noise of the reference.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>

#include "raytrace/incoming/radiance_table.h"
#include "scenes/read/scene_file.h"
#include "tests/support/scene_builder.h"

namespace earthshine {
namespace {

struct Call {
  std::string scene;
  double reference_edge_m;
  int rays;
  std::vector<double> edges_m;
  double start_edge_m;
  std::vector<double> budgets;
};

// Hit on the scene's triangles of a point given by its parameters.
scenes::Hit hit_of(const radiosity::Facet& facet, const radiosity::Parameters& p, bool front) {
  scenes::Hit hit;
  hit.front = front;
  hit.triangle = facet.triangle;
  if (facet.parallelogram) {
    const bool second = p.t > p.s;
    hit.triangle += second ? 1 : 0;
    hit.u = second ? p.s : p.s - p.t;
    hit.v = second ? p.t - p.s : p.t;
    return hit;
  }
  std::array<double, 3> weight{};
  weight[facet.apex] = 1.0 - p.s;
  weight[(facet.apex + 1U) % 3] = p.s * (1.0 - p.t);
  weight[(facet.apex + 2U) % 3] = p.s * p.t;
  hit.u = weight[1];
  hit.v = weight[2];
  return hit;
}

double luminance_of(const radiosity::Solution& s, std::size_t patch, std::size_t group) {
  const float* b = &s.radiosity[patch * s.columns + 3 * group];
  return base::luminance({b[0], b[1], b[2]});
}

// Squared errors and squared reference, per light group and over all groups (last entry).
struct Errors {
  std::vector<double> steps, between, all;
  [[nodiscard]] double of(const std::vector<double>& squares, std::size_t group) const {
    return std::sqrt(std::max(0.0, squares[group]) / all[group]);
  }
  // Mean over the groups, each relative to its light.
  [[nodiscard]] double by_group() const {
    double sum = 0.0;
    for (std::size_t g = 0; g + 1 < all.size(); ++g) sum += std::max(0.0, steps[g]) / all[g];
    return std::sqrt(sum / static_cast<double>(all.size() - 1));
  }
};

class Judge {
 public:
  Judge(const Call& call, const tests::Prepared& scene) : query_(scene.query) {
    radiosity::SolveOptions options;
    options.patch_edge_m = call.reference_edge_m;
    options.form_factor_rays = call.rays;
    options.tolerance = 1e-6;
    for (std::uint64_t k = 0; k < 2; ++k) {
      options.seed = 101 + k;
      reference_[k] = scene.solve(options);
      reference_[k].report = {};
    }
  }

  [[nodiscard]] Errors errors(const radiosity::Solution& solution) const {
    const radiosity::Patches& fine = reference_[0].patches;
    const std::size_t groups = solution.columns / 3;
    Errors errors{std::vector<double>(groups + 1), std::vector<double>(groups + 1),
                  std::vector<double>(groups + 1)};
    const raytrace::LeakMask sight(query_, solution.patches);
    const raytrace::RadianceTable table(solution, solution.radiosity, true, sight);
    std::vector<Rgb> read(groups);
    for (std::uint32_t i = 0; i < fine.count(); ++i) {
      const radiosity::Rectangle r = fine.rectangle(i);
      const scenes::Hit hit =
          hit_of(fine.facets[fine.facet[i]], {0.5 * (r.s0 + r.s1), 0.5 * (r.t0 + r.t1)},
                 fine.is_back[i] == 0);
      const std::uint32_t patch = solution.patches.find(hit.triangle, hit.u, hit.v, hit.front);
      std::fill(read.begin(), read.end(), Rgb(0.0));
      table.add(hit, Rgb(base::pi), read);
      std::array<double, 4> sum{};
      for (std::size_t g = 0; g <= groups; ++g) {
        std::array<double, 4> b = sum;
        if (g < groups) {
          b = {luminance_of(reference_[0], i, g), luminance_of(reference_[1], i, g),
               luminance_of(solution, patch, g), base::luminance(read[g])};
          for (std::size_t k = 0; k < 4; ++k) sum[k] += b[k];
        }
        const double area = fine.area_m2[i];
        errors.steps[g] += area * (b[2] - b[0]) * (b[2] - b[1]);
        errors.between[g] += area * (b[3] - b[0]) * (b[3] - b[1]);
        errors.all[g] += area * b[0] * b[1];
      }
    }
    return errors;
  }
  [[nodiscard]] std::size_t patches() const { return reference_[0].patches.count(); }

 private:
  const scenes::RayQuery& query_;
  std::array<radiosity::Solution, 2> reference_;
};

struct Measured {
  double patches, error;
};

Measured measure(const Judge& judge, const tests::Prepared& scene, const std::string& name,
                 const radiosity::SolveOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const radiosity::Solution solution = scene.solve(options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const Errors errors = judge.errors(solution);
  const std::size_t all = errors.all.size() - 1;
  const radiosity::SolveReport& report = solution.report;
  double cutting = 0.0;
  for (const auto& [stage, s] : report.seconds) cutting += stage == "patches" ? s : 0.0;
  std::cout << fmt::format(
                   "{:<22} {:>8} {:>9.4f} {:>9.4f} {:>9.4f} {:>9} {:>7.2f} {:>7.2f}\n", name,
                   report.patches, errors.of(errors.steps, all), errors.by_group(),
                   errors.of(errors.between, all),
                   report.rounds.empty() ? "-" : fmt::format("{:.4f}", report.rounds.back().error),
                   seconds.count(), cutting)
            << std::flush;
  return {static_cast<double>(report.patches), errors.of(errors.steps, all)};
}

// Adaptive patches for an error, by a power law between two measurements.
double patches_for(const std::vector<Measured>& curve, double error) {
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const Measured &a = curve[k - 1], &b = curve[k];
    if (error > a.error || error < b.error) continue;
    const double x = std::log(error / a.error) / std::log(b.error / a.error);
    return a.patches * std::pow(b.patches / a.patches, x);
  }
  return std::nan("");
}

void compare(const Call& call) {
  const scenes::Scene scene = scenes::read_scene(call.scene);
  const tests::Prepared prepared(scene);
  const Judge judge(call, prepared);
  std::cout << fmt::format("{}: reference {} patches of {} m\n", call.scene, judge.patches(),
                           call.reference_edge_m);
  std::cout << fmt::format("{:<22} {:>8} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}\n", "cut", "patches",
                           "error", "by group", "interpol.", "estimate", "s", "cutting");
  radiosity::SolveOptions options;
  options.form_factor_rays = 1024;
  options.tolerance = 1e-6;
  std::vector<Measured> even, adaptive;
  for (const double edge_m : call.edges_m) {
    options.patch_edge_m = edge_m;
    even.push_back(measure(judge, prepared, fmt::format("even {} m", edge_m), options));
  }
  options.refine.on = true;
  options.refine.start_edge_m = call.start_edge_m;
  for (const double budget : call.budgets) {
    options.refine.max_patches = static_cast<std::size_t>(budget);
    adaptive.push_back(measure(judge, prepared, fmt::format("adaptive {}", budget), options));
  }
  for (const Measured& m : even) {
    const double needed = patches_for(adaptive, m.error);
    std::cout << fmt::format("error {:.4f}: {:.0f} even, {:.0f} adaptive patches: {:.3f}\n",
                             m.error, m.patches, needed, needed / m.patches);
  }
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) values.push_back(std::stod(item));
  return values;
}

}  // namespace
}  // namespace earthshine

int main(int argc, char** argv) {
  using earthshine::numbers;
  const std::string library = EARTHSHINE_SOURCE_DIR "/scenes/library/";
  std::vector<earthshine::Call> calls{{library + "cornell-box/scene.toml",
                                       0.00625,
                                       128,
                                       {0.05, 0.025},
                                       0.12,
                                       {270, 400, 800, 1400}},
                                      {library + "sts46/day-sun.toml",
                                       0.05625,
                                       32,
                                       {0.45, 0.225},
                                       4.5,
                                       {13600, 14000, 15000, 18000}}};
  if (argc == 7) {
    calls = {{argv[1], std::stod(argv[2]), std::stoi(argv[3]), numbers(argv[4]), std::stod(argv[5]),
              numbers(argv[6])}};
  }
  for (const earthshine::Call& call : calls) earthshine::compare(call);
  return 0;
}
