// SPDX-License-Identifier: Apache-2.0
#include "radiosity/store/solution_file.h"

#include <fmt/format.h>

#include "base/files/hdf5_file.h"
#include "base/files/output_file.h"
#include "radiosity/store/solution_fields.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::radiosity {
namespace {

using base::Hdf5Shape;
using base::Hdf5Writer;

// Rgb is stored as three numbers, counts as 64 bits; texts and numbers unchanged.
template <class T>
constexpr std::size_t width = 1;
template <>
constexpr std::size_t width<Rgb> = 3;

struct Writing {
  Hdf5Writer& file;
  std::size_t facets, tree, patches, groups;

  template <class T>
  void column(const char* name, const std::vector<T>& values, const Hdf5Shape& shape,
              const char* unit, const char* meaning) {
    file.array<T>(name, values, shape, {unit, meaning});
  }
  template <class Record, class T>
  void rows(const char* name, const std::vector<Record>& records, T Record::*member,
            const char* unit, const char* meaning) {
    if constexpr (std::is_same_v<T, std::string>) {
      std::vector<std::string> texts;
      texts.reserve(records.size());
      for (const Record& record : records) texts.push_back(record.*member);
      file.texts(name, texts, {unit, meaning});
    } else {
      using Number = std::conditional_t<std::is_integral_v<T>, std::uint64_t, double>;
      std::vector<Number> numbers;
      for (const Record& record : records) {
        if constexpr (width<T> == 3) {
          for (int c = 0; c < 3; ++c) numbers.push_back((record.*member)[c]);
        } else {
          numbers.push_back(record.*member);
        }
      }
      const Hdf5Shape shape =
          width<T> == 3 ? Hdf5Shape{records.size(), 3} : Hdf5Shape{records.size()};
      file.array<Number>(name, numbers, shape, {unit, meaning});
    }
  }
  void optional(const char* name, double value) {
    if (value != 0.0) file.attribute(name, value);
  }
  template <class T>
  void value(const char* name, const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      file.attribute(name, double{value});
    } else {
      file.attribute(name, static_cast<std::uint64_t>(value));
    }
  }
};

// Derived data for other readers, which this program recomputes.
void write_geometry(Hdf5Writer& file, const Patches& patches) {
  const std::size_t count = patches.count();
  std::vector<float> corners, normals;
  std::vector<std::uint32_t> objects, materials;
  const auto append = [](std::vector<float>& to, const Vec3& v) {
    for (int c = 0; c < 3; ++c) to.push_back(static_cast<float>(v[c]));
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const Vec3& corner : patches.corners(i)) append(corners, corner);
    append(normals, patches.normal(i));
    objects.push_back(patches.object(i));
    materials.push_back(patches.material(i));
  }
  file.array<float>("corners", corners, {count, 4, 3},
                    {"m", "counter-clockwise about the normal; a triangle has one twice"});
  file.array<float>("normal", normals, {count, 3}, {"", "unit vector of the patch's own side"});
  file.array<std::uint32_t>("object", objects, {count}, {"", "number in object_names"});
  file.array<std::uint32_t>("material", materials, {count}, {"", "number in material_names"});
  file.array<std::uint8_t>("is_back", patches.is_back, {count}, {"", "1: the back of a sheet"});
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const Named& entry : list) names.push_back(entry.name);
  return names;
}

void write_origin(Hdf5Writer& file, const SolutionOrigin& origin) {
  file.attribute("format", solution_format);
  file.attribute("program", origin.program);
  file.attribute("scene", origin.scene.path.string());
  file.attribute("name", origin.scene.name);
  file.attribute("lengths", "m");
  file.attribute("colours", "linear RGB, Rec. 709 primaries");
  for (const SolveKnob& knob : solve_knobs(origin.options)) {
    std::visit([&](auto value) { file.attribute(knob.key, value); }, knob.value);
  }
  for (const ScenePart& part : scene_parts(origin.scene, origin.groups)) {
    file.attribute(part.key, part.digest);
  }
  file.texts("group_names", origin.groups.names, {"", "light groups, in the order of radiosity"});
  file.texts("object_names", names_of(origin.scene.objects), {});
  file.texts("material_names", names_of(origin.scene.materials), {});
}

}  // namespace

std::string solution_bytes(const Solution& solution, const SolutionOrigin& origin) {
  Hdf5Writer file;
  write_origin(file, origin);
  write_geometry(file, solution.patches);
  const PatchLayout layout = layout_of(solution.patches);
  Writing store{file, layout.s_count.size(), layout.tree.size(), solution.patches.count(),
                solution.columns / 3};
  visit_layout(store, layout);
  visit_light(store, solution);
  visit_report(store, solution.report);
  return file.finish();
}

void write_solution(const std::filesystem::path& path, const Solution& solution,
                    const SolutionOrigin& origin) {
  if (base::another_rank_writes()) return;
  base::write_text(path, solution_bytes(solution, origin));
}

}  // namespace earthshine::radiosity
