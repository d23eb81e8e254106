// SPDX-License-Identifier: Apache-2.0
// Orientation of the parts of objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "scenes/health/coincident.h"
#include "scenes/health/file_fronts.h"
#include "scenes/health/topology.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Implements the rules of mend_surfaces. Recreate it after triangles were added or removed.
class Orienter {
 public:
  // ids: result of welded(). ids and fronts must outlive the Orienter.
  Orienter(Scene& scene, std::span<const std::uint32_t> ids, const FileFronts& fronts)
      : scene_(scene), ids_(ids), fronts_(fronts) {}

  // bodies_alone: closed parts only, without messages about others.
  void orient_all(bool bodies_alone);

  // Parts of all objects in their present orientation; also fills each object's `surface`.
  [[nodiscard]] FaceParts parts();

 private:
  struct Parts {
    std::vector<SurfacePart> all;
    std::vector<std::uint32_t> by_low_x;  // indices, without wide parts
    std::vector<std::uint32_t> wide;
    double width_m = 0.0;  // largest width along x of the other parts

    // Whether holds(number) is true for any part that may overlap this one along x.
    template <class Holds>
    [[nodiscard]] bool any_beside(const SurfacePart& part, Holds holds) const;
  };
  struct Counts {
    std::size_t bodies = 0, triangles = 0, mixed_edges = 0, one_sided = 0;
    std::size_t by_normals = 0;  // triangles
    double seen_inside = 0.0;    // for surfaces with mixed edges: see seen_from_inside
  };
  enum class Inside { Nothing, Things, Camera };
  // Relative to the part's orientation; Unknown if the file has no normals.
  enum class Front { Unknown, Oriented, Opposite };

  void orient(std::size_t object, bool bodies_alone);
  [[nodiscard]] Parts& parts_of(std::size_t object);
  // Returns the number of triangles flipped.
  std::size_t flip(SurfacePart& part, bool all);
  void flip_as_given(SurfacePart& part, Orient word, Counts& counts);
  static void tally(const SurfacePart& part, std::size_t flipped, Counts& counts);
  [[nodiscard]] Front front_by_normals(const SurfacePart& part) const;
  // Positive if the cameras see more of its inside than of its outside.
  [[nodiscard]] double seen_from_inside(const SurfacePart& part) const;
  void keep_parallelograms(const SurfacePart& part, bool all);
  [[nodiscard]] Inside contents_of(std::size_t object, std::size_t part);
  [[nodiscard]] bool is_cavity(std::size_t object, std::size_t part);
  [[nodiscard]] bool stands_in(const SurfacePart& outer, const SurfacePart& inner) const;
  [[nodiscard]] double cup_volume(const SurfacePart& part) const;
  [[nodiscard]] Vec3 middle_of(std::uint32_t triangle) const;
  [[nodiscard]] bool all_two_sided(const SurfacePart& part) const;
  [[nodiscard]] bool is_window_or_lamp_in_part(const SurfacePart& part) const;
  void say(const Object& object, const Counts& counts);

  Scene& scene_;
  std::span<const std::uint32_t> ids_;
  const FileFronts& fronts_;
  std::map<std::size_t, Parts> parts_;
};

}  // namespace earthshine::scenes
