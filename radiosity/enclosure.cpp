// SPDX-License-Identifier: Apache-2.0
#include "radiosity/enclosure.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"

namespace earthshine::radiosity {
namespace {

// Patches that exchange light, directly or by way of others, by the lowest patch of their part.
std::vector<std::uint32_t> connected_parts(const FormFactors& f) {
  std::vector<std::uint32_t> parent(f.count());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto join = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = root(i), b = root(j);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (std::uint32_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) join(i, f.column[e]);
  }
  f.shares.hear([&](base::Parcel& parcel) { parcel.pass(parent); },
                [&](base::Parcel& parcel) {
                  std::vector<std::uint32_t> theirs;
                  parcel.pass(theirs);
                  for (std::uint32_t i = 0; i < f.count(); ++i) join(i, theirs[i]);
                });
  for (std::uint32_t i = 0; i < f.count(); ++i) parent[i] = root(i);
  return parent;
}

}  // namespace

void check_enclosure(const scenes::Scene& scene, const Patches& patches, const FormFactors& factors,
                     std::span<const double> source, std::span<const double> reflectance,
                     std::size_t columns) {
  // Only where some material reflects all of what it keeps can a part keep all light.
  const std::size_t count = factors.count();
  // What rounding leaves of 1 - mirror - diffuse takes nothing.
  constexpr double rounding = 1e-12;
  const auto takes = [&](std::size_t i, std::size_t c) {
    return factors.kept[i] - reflectance[i * columns + c] > rounding;
  };
  bool suspect = false;
  for (std::size_t k = 0; k < source.size() && !suspect; ++k) {
    suspect = !takes(k / columns, k % columns);
  }
  if (!suspect) return;
  const std::vector<std::uint32_t> part = connected_parts(factors);
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<char> ends(count, 0), lit(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (takes(i, c) || factors.escape[i] > 0.0 || factors.lost[i] > 0.0) ends[part[i]] = 1;
      if (source[i * columns + c] > 0.0) lit[part[i]] = 1;
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
      if (lit[part[i]] == 0 || ends[part[i]] != 0) continue;
      names.insert(scene.materials[patches.material(static_cast<std::uint32_t>(i))].name);
    }
    if (names.empty()) continue;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    throw base::Error(base::Blame::Input, scene.path.string(),
                      "a closed part of the scene reflects everything: material " + list,
                      "somewhere in it light must be absorbed, pass out or meet a black back",
                      "Lower a diffuse reflectance below 1, for instance to 0.999999");
  }
}

}  // namespace earthshine::radiosity
