// SPDX-License-Identifier: Apache-2.0
// Seconds and bytes per patch, from a thousand to two hundred thousand patches.
#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <string>

#include "scenes/read/scene_file.h"
#include "tests/support/case_scene.h"
#include "tests/support/scene_builder.h"
#include "tests/validation/tables.h"

namespace earthshine::validation {
namespace {

// Resets the peak memory that Linux records for the process. First returns unused heap memory of
// earlier runs.
void forget_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return 1024.0 * std::stod(line.substr(6));
  }
  return 0.0;
}

// A closed room of 4 m with 5 x 5 x 5 boxes: each patch sees many near and distant bodies.
scenes::Scene room_of_boxes() {
  tests::CaseScene s;
  const std::uint32_t wall = s.material(0.7), lit = s.material(0.7, 100.0), box = s.material(0.5);
  const auto shell = [&s](const Vec3& low, double size, bool inside, std::uint32_t top) {
    const Vec3 x(size, 0, 0), y(0, size, 0), z(0, 0, size);
    const Vec3 corner[] = {low, low + x, low, low + y, low, low + z};
    const Vec3 u[] = {y, z, z, x, x, y}, v[] = {z, y, x, z, y, x};
    for (int f = 0; f < 6; ++f) {
      if (f == 5 && top != 0) s.object("lit", top);
      s.grid(corner[f], inside ? u[f] : v[f], inside ? v[f] : u[f], 1, 1);
    }
  };
  s.object("room", wall);
  shell(Vec3(0), 4.0, true, lit);
  s.object("boxes", box);
  for (int k = 0; k < 125; ++k) {
    shell(0.8 * Vec3(k % 5, k / 5 % 5, k / 25) + Vec3(0.25), 0.3, false, 0);
  }
  return s.scene;
}

// Slope of log y over log x, by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0.0, my = 0.0, xy = 0.0, xx = 0.0;
  const auto n = double(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    mx += std::log(x[k]) / n;
    my += std::log(y[k]) / n;
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    xy += (std::log(x[k]) - mx) * (std::log(y[k]) - my);
    xx += (std::log(x[k]) - mx) * (std::log(x[k]) - mx);
  }
  return xy / xx;
}

// Patch edge that gives about this number of patches.
double edge_for(const scenes::Scene& scene, double patches) {
  double low = 1e-3, high = 100.0;
  for (int step = 0; step < 24; ++step) {
    const double edge = std::sqrt(low * high);
    double area = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      area += scenes::triangle_area(scene, t);
    }
    if (area / (edge * edge) > 4.0 * patches) {
      low = edge;
      continue;
    }
    (double(radiosity::subdivide(scene, edge).count()) > patches ? low : high) = edge;
  }
  return high;
}

void costs(const std::string& name, const scenes::Scene& scene) {
  fmt::print("\n{}, 1024 rays a patch:\n\n", name);
  fmt::print(
      "| patches | seconds | µs a patch | bytes a patch, peak | MiB, peak | nonzeros a row |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  std::vector<double> patches, seconds, bytes;
  const tests::Prepared prepared(scene);
  for (const double wanted : {1e3, 3e3, 1e4, 3e4, 1e5, 2e5}) {
    radiosity::SolveOptions options;
    options.patch_edge_m = edge_for(scene, wanted);
    // A scene has at least as many patches as facets.
    const auto count = double(radiosity::subdivide(scene, options.patch_edge_m).count());
    if (!patches.empty() && count < 1.2 * patches.back()) continue;
    const double before = [] {
      forget_peak_memory();
      return peak_bytes();
    }();
    const auto start = std::chrono::steady_clock::now();
    const radiosity::Solution s = prepared.solve(options);
    const double taken =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double peak = peak_bytes(), n = double(s.report.patches);
    fmt::print("| {} | {:.2f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", s.report.patches, taken,
               1e6 * taken / n, (peak - before) / n, peak / 1048576.0,
               double(s.report.nonzeros) / n);
    patches.push_back(n);
    seconds.push_back(taken);
    bytes.push_back(std::max(1.0, peak - before));
  }
  fmt::print("\nSeconds grow as patches^{:.2f}, bytes as patches^{:.2f}.\n",
             exponent(patches, seconds), exponent(patches, bytes));
}

}  // namespace

void cost_table() {
  costs("STS-46 payload bay by day",
        scenes::read_scene(EARTHSHINE_SOURCE_DIR "/scenes/library/sts46/day-earthshine.toml"));
  costs("Closed room with 125 boxes", room_of_boxes());
}

}  // namespace earthshine::validation
