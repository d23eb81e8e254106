// SPDX-License-Identifier: Apache-2.0
// The library of closed-form cases (tests/data/view-factors.json): each has a scene with its
// geometry, and the result to compare.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/objects/form_factors.h"
#include "tests/support/case_scene.h"

namespace earthshine::tests {

struct CaseRecord {
  std::string name, group;
  double value = 0.0;
  std::map<std::string, std::vector<double>> parameters;  // numbers only; a scalar has one entry

  [[nodiscard]] double at(const std::string& key, std::size_t k = 0) const {
    return parameters.at(key).at(k);
  }
};

// In the file's order. Throws std::runtime_error if it cannot be read.
[[nodiscard]] std::vector<CaseRecord> read_case_library(const std::filesystem::path& path);

enum class CaseKind {
  Factor,     // F from one object to another, or to all (to == every_object)
  Radiosity,  // mean B of an object, from the solved scene
  Network     // B of an object from F between whole objects, one zone each
};

inline constexpr std::size_t every_object = ~std::size_t{0};

struct Case {
  CaseRecord record;
  CaseKind kind = CaseKind::Factor;
  CaseScene made;
  std::size_t from = 0, to = 0;                         // objects; a radiosity is of `from`
  int rays = 4096;                                      // per patch
  std::vector<double> zone_reflectance, zone_exitance;  // of a network, per object
  // Largest difference between the exact values of the scene and of the library: polygons instead
  // of round bodies, patches of constant radiosity instead of a continuum. 0: none.
  double model_error = 0.0;
};

// A case, or the reason why none can be built.
struct BuiltCase {
  std::optional<Case> built;
  std::string refusal;
};

[[nodiscard]] BuiltCase build_case(const CaseRecord& record);

struct CaseResult {
  double computed = 0.0, std_error = 0.0;
  double rays = 0.0;

  // Error by rounding and the solver's tolerance.
  static constexpr double rounding = 1e-8;
  [[nodiscard]] double error(const Case& of) const { return computed - of.record.value; }
  // Whether the error is within four standard errors, the scene's model error or rounding.
  [[nodiscard]] bool agrees(const Case& of) const;
};

// A method for form factors between objects.
using ObjectFactorMethod =
    std::function<radiosity::ObjectFormFactors(const Case&, std::uint64_t seed)>;
[[nodiscard]] radiosity::ObjectFormFactors object_factors_by_rays(const Case& of,
                                                                  std::uint64_t seed);

// Throws base::Error (Input) for scenes with mirrors.
[[nodiscard]] radiosity::ObjectFormFactors object_factors_exact(const Case& of, std::uint64_t seed);

// Number of patches of the case's scene.
[[nodiscard]] std::size_t patch_count(const Case& of);

// Standard errors: of form factors from one run, of radiosities from the scatter of `seeds` runs.
inline constexpr int radiosity_seeds = 16;
[[nodiscard]] CaseResult run_case(const Case& of, const ObjectFactorMethod& method,
                                  std::uint64_t seed);

}  // namespace earthshine::tests
