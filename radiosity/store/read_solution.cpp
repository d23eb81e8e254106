// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/files/hdf5_file.h"
#include "base/input/input_file.h"
#include "radiosity/bodies/wall_traces.h"
#include "radiosity/patches/posed_patches.h"
#include "radiosity/store/solution_fields.h"
#include "radiosity/store/solution_file.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::radiosity {
namespace {

using base::Blame;
using base::Error;
using base::Hdf5Reader;
using base::Hdf5Shape;

constexpr std::size_t most_bytes = std::size_t{1} << 36;

template <class Number>
void demand_finite(const Hdf5Reader& file, const char* name, const std::vector<Number>& values) {
  const auto finite = [](Number x) { return std::isfinite(static_cast<double>(x)); };
  if (!std::all_of(values.begin(), values.end(), finite)) {
    file.fail(fmt::format("\"{}\" holds a number that is not finite", name));
  }
}

struct Reading {
  const Hdf5Reader& file;
  std::size_t facets, tree, patches, groups;
  const void* sized = nullptr;  // records that were resized last

  template <class T>
  void column(const char* name, std::vector<T>& values, const Hdf5Shape& shape, const char*,
              const char*) {
    values = file.array<T>(name, shape);
    demand_finite(file, name, values);
  }
  template <class Record, class T>
  void rows(const char* name, std::vector<Record>& records, T Record::*member, const char*,
            const char*) {
    // The first member read determines the number of records; the others must agree.
    const auto resize = [&](std::size_t count) {
      if (sized != &records) records.assign(count, Record{});
      sized = &records;
    };
    if constexpr (std::is_same_v<T, std::string>) {
      std::vector<std::string> texts = file.texts(name);
      resize(texts.size());
      if (texts.size() != records.size()) {
        file.fail(fmt::format("\"{}\" is {}, expected {}", name, texts.size(), records.size()));
      }
      for (std::size_t k = 0; k < records.size(); ++k) records[k].*member = std::move(texts[k]);
    } else if constexpr (std::is_same_v<T, Rgb>) {
      const std::vector<double> numbers = file.array<double>(name, {records.size(), 3});
      demand_finite(file, name, numbers);
      for (std::size_t k = 0; k < records.size(); ++k) {
        records[k].*member = {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
      }
    } else {
      using Number = std::conditional_t<std::is_integral_v<T>, std::uint64_t, double>;
      const Hdf5Shape shape = file.shape(name);
      const std::size_t count =
          sized == &records ? records.size() : (shape.empty() ? 0 : shape.front());
      const std::vector<Number> numbers = file.array<Number>(name, {count});
      resize(count);
      demand_finite(file, name, numbers);
      for (std::size_t k = 0; k < records.size(); ++k) records[k].*member = numbers[k];
    }
  }
  void optional(const char* name, double& value) {
    if (file.has_attribute(name)) value = file.number_attribute(name);
  }
  template <class T>
  void value(const char* name, T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      value = file.number_attribute(name);
    } else {
      const std::uint64_t count = file.count_attribute(name);
      value = static_cast<T>(count);
      if (static_cast<std::uint64_t>(value) != count) {
        file.fail(fmt::format("\"{}\" is out of range", name));
      }
    }
  }
};

[[noreturn]] void refuse(const Hdf5Reader& file, const std::string& found,
                         const SolutionOrigin& origin) {
  throw Error(
      Blame::Input, file.name(), found,
      "a solution serves the geometry, materials, lights, sky and quality it was solved with",
      fmt::format(
          "Run \"earthshine solve {} -o {}\" again, with the same --set, --error and --seed",
          origin.scene.path.string(), file.name()));
}

void refuse_other_program(const Hdf5Reader& file, const SolutionOrigin& origin) {
  const std::uint64_t format = file.count_attribute("format");
  const std::string program = file.text_attribute("program");
  if (format != solution_format) {
    refuse(file, fmt::format("is of format {}, this program has {}", format, solution_format),
           origin);
  }
  if (program != origin.program) {
    refuse(file,
           fmt::format("was solved by version {}, this is {}, which may find other numbers",
                       program, origin.program),
           origin);
  }
}

void refuse_stale(const Hdf5Reader& file, const SolutionOrigin& origin) {
  std::vector<std::string> differ;
  for (const ScenePart& part : scene_parts(origin.scene, origin.groups)) {
    if (file.count_attribute(part.key) != part.digest) differ.push_back(part.words);
  }
  std::vector<std::string>& settings = origin.other_settings ? *origin.other_settings : differ;
  for (const SolveKnob& knob : solve_knobs(origin.options)) {
    const auto compare = [&](auto now, auto then) {
      if (now != then) settings.push_back(fmt::format("{} ({}, now {})", knob.words, then, now));
    };
    if (const auto* number = std::get_if<double>(&knob.value)) {
      compare(*number, file.number_attribute(knob.key));
    } else {
      compare(std::get<std::uint64_t>(knob.value), file.count_attribute(knob.key));
    }
  }
  if (differ.empty()) return;
  refuse(file, fmt::format("is stale: since it was solved, {} changed", fmt::join(differ, ", ")),
         origin);
}

}  // namespace

Solution read_solution(const std::filesystem::path& path, const SolutionOrigin& origin) {
  std::error_code other;  // such as no permission, which is reported below
  if (!std::filesystem::exists(path, other) && !other) {
    throw Error(Blame::Input, path.string(), "there is no such file", {},
                fmt::format("Make it with \"earthshine solve {} -o {}\"",
                            origin.scene.path.string(), path.string()));
  }
  const Hdf5Reader file(base::read_input_file(path, most_bytes, {"--solution"}), path.string());
  refuse_other_program(file, origin);
  refuse_stale(file, origin);

  const auto extent = [&](const char* name, std::size_t rank) {
    Hdf5Shape shape = file.shape(name);
    if (shape.size() != rank) file.fail(fmt::format("\"{}\" has {} axes", name, shape.size()));
    return shape;
  };
  const std::size_t groups = extent("radiosity", 3)[1];
  if (groups != 0 && groups != origin.groups.count()) {
    file.fail(fmt::format("it has {} light groups, the scene {}", groups, origin.groups.count()));
  }
  Reading store{file, extent("facets/s_count", 1)[0], extent("facets/tree", 1)[0],
                extent("area", 1)[0], groups};
  PatchLayout layout;
  visit_layout(store, layout);
  Solution solution;
  try {
    const scenes::Scene& cut = origin.first_pose != nullptr ? *origin.first_pose : origin.scene;
    solution.patches = rebuild_patches(cut, std::move(layout), find_wall_traces);
    if (origin.first_pose != nullptr) {
      solution.patches = posed_patches(std::move(solution.patches), origin.scene);
    }
  } catch (const std::invalid_argument& problem) {
    file.fail(problem.what());
  }
  solution.columns = 3 * groups;
  visit_light(store, solution);
  visit_report(store, solution.report);
  solution.report.patches = solution.patches.count();
  return solution;
}

}  // namespace earthshine::radiosity
