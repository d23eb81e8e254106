// SPDX-License-Identifier: Apache-2.0
#include "tests/support/case_library.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "radiosity/exact/form_factors.h"
#include "tests/support/case_builders.h"
#include "tests/support/scene_builder.h"

namespace earthshine::tests {
namespace {

// Large enough that every polygon of a case is one patch.
constexpr double uncut_m = 1e9;

std::vector<double> numbers(const nlohmann::json& value) {
  std::vector<double> result;
  if (value.is_number()) result.push_back(value.get<double>());
  if (value.is_array()) {
    for (const nlohmann::json& entry : value) {
      if (entry.is_number()) result.push_back(entry.get<double>());
    }
  }
  return result;
}

const CaseBuilder* find_builder(const std::string& name) {
  for (const auto& builders : {rectangle_builders(), round_builders(), radiosity_builders()}) {
    for (const CaseBuilder& builder : builders) {
      if (name.rfind(builder.prefix, 0) == 0) return &builder;
    }
  }
  return nullptr;
}

// B = M + rho F B for a few zones, by Neumann iteration; rho is far enough below 1.
double network_radiosity(const Case& of, const radiosity::ObjectFormFactors& factors) {
  std::vector<double> b = of.zone_exitance;
  for (int bounce = 0; bounce < 400; ++bounce) {
    std::vector<double> next = of.zone_exitance;
    for (std::size_t i = 0; i < b.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) {
        next[i] += of.zone_reflectance[i] * factors.F[i][j] * b[j];
      }
    }
    b = next;
  }
  return b[of.from];
}

double solved_radiosity(const Prepared& prepared, const Case& of, std::uint64_t seed,
                        CaseResult& result) {
  radiosity::SolveOptions options;
  options.form_factor_rays = of.rays;
  options.seed = seed;
  // The patches of the case, without clusters of small ones.
  const radiosity::Solution solution =
      radiosity::solve(prepared, options, radiosity::subdivide(prepared.scene, uncut_m));
  result.rays += double(solution.report.form_factor_rays);
  return solution.report.objects[of.from].radiosity_lm_m2.g;
}

CaseResult factor(const Case& of, const ObjectFactorMethod& method, std::uint64_t seed) {
  const radiosity::ObjectFormFactors found = method(of, seed);
  if (of.to != every_object) {
    return {found.F[of.from][of.to], found.std_error[of.from][of.to], 0.0};
  }
  // Errors within a row cancel in its sum; the remaining error is light that was found to escape.
  CaseResult result;
  for (const double f : found.F[of.from]) result.computed += f;
  return result;
}

}  // namespace

std::vector<CaseRecord> read_case_library(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  std::vector<CaseRecord> records;
  const nlohmann::json library = nlohmann::json::parse(file);
  for (const nlohmann::json& entry : library.at("cases")) {
    CaseRecord record;
    record.name = entry.at("name");
    record.group = entry.at("group");
    record.value = std::stod(entry.at("value").get<std::string>());
    for (const auto& [key, value] : entry.at("parameters").items()) {
      record.parameters[key] = numbers(value);
    }
    records.push_back(std::move(record));
  }
  return records;
}

BuiltCase build_case(const CaseRecord& record) {
  BuiltCase result;
  if (record.name.rfind("love_equation", 0) == 0) {
    result.refusal =
        "its kernel d / (pi (d^2 + x^2)) is that of no diffuse surfaces (facing strips have h^2 / "
        "(2 (h^2 + x^2)^1.5)): there is no such scene";
    return result;
  }
  const CaseBuilder* builder = find_builder(record.name);
  if (builder == nullptr) {
    result.refusal = "no scene is known for it";
    return result;
  }
  result.built.emplace();
  result.built->record = record;
  builder->build(record, *result.built);
  return result;
}

bool CaseResult::agrees(const Case& of) const {
  const double allowed = rounding * std::max(1.0, std::abs(of.record.value)) + of.model_error;
  return std::abs(error(of)) <= 4.0 * std_error + allowed;
}

radiosity::ObjectFormFactors object_factors_by_rays(const Case& of, std::uint64_t seed) {
  const scenes::RayQuery query(of.made.scene);
  const radiosity::Patches patches = radiosity::subdivide(of.made.scene, uncut_m);
  radiosity::ObjectFactorReport report;
  return radiosity::object_form_factors_by_rays(of.made.scene, query, patches,
                                                {of.rays, seed, false}, report);
}

radiosity::ObjectFormFactors object_factors_exact(const Case& of, std::uint64_t seed) {
  const scenes::RayQuery query(of.made.scene);
  const radiosity::Patches patches = radiosity::subdivide(of.made.scene, uncut_m);
  radiosity::ExactOptions options;
  options.tolerance = 1e-6;
  options.seed = seed;
  return radiosity::object_form_factors(
      of.made.scene, patches,
      radiosity::exact_form_factors(of.made.scene, query, patches, options).factors);
}

std::size_t patch_count(const Case& of) {
  return radiosity::subdivide(of.made.scene, uncut_m).count();
}

CaseResult run_case(const Case& of, const ObjectFactorMethod& method, std::uint64_t seed) {
  if (of.kind == CaseKind::Factor) return factor(of, method, seed);
  CaseResult result;
  std::vector<double> found;
  const Prepared prepared(of.made.scene);
  for (int k = 0; k < radiosity_seeds; ++k) {
    const std::uint64_t each = seed * radiosity_seeds + std::uint64_t(k);
    found.push_back(of.kind == CaseKind::Network ? network_radiosity(of, method(of, each))
                                                 : solved_radiosity(prepared, of, each, result));
    result.computed += found.back() / radiosity_seeds;
  }
  double square = 0.0;
  for (const double b : found) square += (b - result.computed) * (b - result.computed);
  result.std_error = std::sqrt(square / (radiosity_seeds * (radiosity_seeds - 1.0)));
  return result;
}

}  // namespace earthshine::tests
