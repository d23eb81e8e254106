// SPDX-License-Identifier: Apache-2.0
// The solution as rays read it: radiance B / pi at any surface point, per image layer, flat in
// memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/incoming/leak_mask.h"

namespace earthshine::raytrace {

// layers: 1 (all light groups summed) or one per group. Between the centres of a facet's cells the
// radiance is interpolated bilinearly, which makes the error of reading it fall with the square of
// the patch edge; where cells of different sizes meet, between the knots of knots.h.
// Cells of a cluster (radiosity/patches/clusters.h) show one radiance each.
// Across what stands between two cells (leak_mask.h) nothing is interpolated: a cell takes its own
// radiance where it would take that of one that it does not see.
class RadianceTable {
 public:
  RadianceTable() = default;
  // values: radiosity or soft_radiosity of the solution. `sight`, like the solution, must outlive
  // the table.
  RadianceTable(const radiosity::Solution& solution, std::span<const float> values, bool per_light,
                const LeakMask& sight);

  [[nodiscard]] bool empty() const { return radiance_.empty(); }

  // Adds weight * radiance to out[0 .. layers). Nothing for the black back of a one-sided surface.
  void add(const scenes::Hit& hit, const Rgb& weight, std::span<Rgb> out) const;

 private:
  void fill_knots();
  void add_uneven(const radiosity::Facet& facet, bool front, const radiosity::Parameters& where,
                  const Rgb& weight, std::span<Rgb> out) const;

  const radiosity::Patches* patches_ = nullptr;
  const LeakMask* sight_ = nullptr;
  std::size_t layers_ = 0;
  std::vector<glm::vec4> radiance_;  // patch * layers + layer; fourth component unused
  // Facets with a tree: (leaf * knots_per_cell + knot) * layers + layer from where the side starts.
  std::vector<glm::vec4> knots_;
  std::vector<std::array<std::size_t, 2>> side_knots_;  // per facet: back, front
};

}  // namespace earthshine::raytrace
