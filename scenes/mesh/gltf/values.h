// SPDX-License-Identifier: Apache-2.0
// Values of glTF extensions, which may be of any type or missing. Only the files that own tinygltf
// include this.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace earthshine::scenes {

// What is no number, or none between 0 and `most`, is brought there.
[[nodiscard]] inline double in_range(double x, double most = 1.0) {
  return std::isfinite(x) ? std::clamp(x, 0.0, most) : 0.0;
}

// The first three, each in [0, most].
[[nodiscard]] inline Rgb colour_of(const std::vector<double>& values, double otherwise,
                                   double most = 1.0) {
  if (values.size() < 3) return Rgb(otherwise);
  return {in_range(values[0], most), in_range(values[1], most), in_range(values[2], most)};
}

// The extension, or an empty value.
[[nodiscard]] inline tinygltf::Value extension_of(const tinygltf::ExtensionMap& extensions,
                                                  const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? tinygltf::Value() : found->second;
}

[[nodiscard]] inline double number_of(const tinygltf::Value& table, const char* key,
                                      double otherwise) {
  if (!table.IsObject() || !table.Has(key)) return otherwise;
  const tinygltf::Value& value = table.Get(key);
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(number) ? number : otherwise;
}

[[nodiscard]] inline std::vector<double> numbers_of(const tinygltf::Value& table, const char* key) {
  std::vector<double> numbers;
  if (!table.IsObject() || !table.Has(key)) return numbers;
  const tinygltf::Value& array = table.Get(key);
  for (std::size_t k = 0; array.IsArray() && k < array.ArrayLen(); ++k) {
    const tinygltf::Value& value = array.Get(static_cast<int>(k));
    numbers.push_back(value.IsNumber() ? value.GetNumberAsDouble() : 0.0);
  }
  return numbers;
}

}  // namespace earthshine::scenes
