// SPDX-License-Identifier: Apache-2.0
#include "app/console/view_solution.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "app/console/assets.h"
#include "app/console/page.h"
#include "app/report/text.h"
#include "base/files/deflate.h"
#include "base/files/hdf5_file.h"
#include "base/input/input_file.h"
#include "base/units.h"

namespace earthshine::app {
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 32U;
constexpr std::size_t most_patches = 400'000;  // a page of some 30 MB

template <class Number>
std::string packed(const std::vector<Number>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(Number));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return base64(base::deflated(bytes));
}

// Sums over the light groups, or one of them.
std::vector<float> luminances(const std::vector<float>& values, std::size_t groups,
                              std::optional<std::size_t> only) {
  std::vector<float> sums(values.size() / (3 * groups));
  for (std::size_t p = 0; p < sums.size(); ++p) {
    Rgb sum(0.0);
    for (std::size_t g = only.value_or(0); g < (only ? *only + 1 : groups); ++g) {
      const float* value = &values[3 * (p * groups + g)];
      sum += Rgb(value[0], value[1], value[2]);
    }
    sums[p] = static_cast<float>(base::luminance(sum));
  }
  return sums;
}

}  // namespace

SolutionPage solution_page(const std::string& path) {
  const base::Hdf5Reader file(base::read_input_file(path, most_bytes, {"FILE"}), path);
  const std::size_t count = file.shape("corners").at(0);
  const std::vector<std::string> names = file.texts("group_names");
  const base::Hdf5Shape shape = file.shape("radiosity");
  const std::size_t groups = shape.size() == 3 && shape[0] == count ? shape[1] : 0;
  if (groups > names.size()) file.fail("has light groups without names");
  if (count > most_patches) {
    file.fail(fmt::format("has {} patches; a page shows {} at most", count, most_patches));
  }
  Json data = {{"name", std::filesystem::path(path).filename().string()},
               {"objects", file.texts("object_names")},
               {"layers", Json::array()},
               {"facts", Json::array()}};
  std::vector<std::string> blobs;
  const auto stored = [&](const auto& values) {
    blobs.push_back(packed(values));
    return fmt::format("b{}", blobs.size() - 1);
  };
  for (const char* fact : {"scene", "name", "program"}) {
    data["facts"].push_back({fact, file.text_attribute(fact)});
  }
  data["facts"].push_back({"patches", std::to_string(count)});
  data["corners"] = stored(file.array<float>("corners", {count, 4, 3}));
  data["object"] = stored(file.array<std::uint32_t>("object", {count}));
  const auto add = [&](const std::string& name, const char* unit,
                       const std::vector<float>& values) {
    data["layers"].push_back({{"name", name}, {"unit", unit}, {"data", stored(values)}});
  };
  if (groups > 0) {
    const std::vector<float> radiosity = file.array<float>("radiosity", shape);
    const std::vector<float> all = luminances(radiosity, groups, {});
    add("radiosity", "lm/m²", all);
    std::vector<float> diffuse = all;
    for (float& value : diffuse) value = static_cast<float>(double(value) / base::pi);
    add("luminance", "cd/m²", diffuse);
    for (const char* name : {"illuminance_direct", "illuminance_indirect"}) {
      add(name, "lx", luminances(file.array<float>(name, shape), groups, {}));
    }
    for (std::size_t g = 0; g < groups && groups > 1; ++g) {
      add("radiosity by " + names[g], "lm/m²", luminances(radiosity, groups, g));
    }
  }
  SolutionPage page{{}, count, data["layers"].size()};
  page.html = page_of(
      {data["name"],
       std::string(console_style()) + std::string(view_style()) + std::string(solid_style()),
       solid_body(), solid_script(), solid_script_hash()},
      data, blobs);
  return page;
}

}  // namespace earthshine::app
