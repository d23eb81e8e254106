// SPDX-License-Identifier: Apache-2.0
// Where the target objects stand in a camera's picture, before any light is looked at:
//   seen      pixels whose centre shows the target
//   alone     pixels whose centre would show it if nothing else were there
//   core      seen pixels whose 8 neighbours are seen too: a pixel on the outline mixes the light
//             of both sides, so that it says nothing about either
//   surround  about as many pixels as are seen, in a band round them one pixel off the outline;
//             whatever they show: what lies behind, what stands in front, the sky
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// Per pixel the index of the object that its centre shows, or no_object. Rows from the top.
inline constexpr std::int32_t no_object = -1;
struct ObjectMap {
  int columns = 0;
  int rows = 0;
  std::vector<std::int32_t> object;
};

// Of the frame's layer "object" (raytrace::RenderOptions::aovs). Throws base::Error (Input) if the
// picture has none.
[[nodiscard]] ObjectMap object_map(const base::Image& image);

struct TargetView {
  std::uint32_t object = 0;
  std::string name;
  std::size_t pixels = 0;        // seen
  std::size_t pixels_alone = 0;  // never fewer than seen
  bool in_frame = false;         // some corner of it lies within the picture, seen or not
  bool cut_by_frame = false;  // alone it reaches the picture's border: more of it may lie outside
  // Pixels that would show it alone and show something else: indices in ascending order.
  std::vector<std::uint32_t> hidden;
  // The objects on those pixels, most pixels first.
  struct Blocker {
    std::uint32_t object = 0;
    std::size_t pixels = 0;
  };
  std::vector<Blocker> hidden_by;
  // What its luminance is taken over: the core, or all seen pixels of a target so thin that less
  // than a quarter of them is core. Pixel indices in ascending order.
  std::vector<std::uint32_t> measured;
  std::vector<std::uint32_t> surround;  // empty where the target fills the picture
  // Seen pixels that show the black back of a one-sided surface: how a real back looks is not
  // known.
  std::vector<std::uint32_t> black_back;
  // Of the target's middle across the picture, to the right and down, by Object::velocity_m_s.
  std::array<double, 2> motion_px_s = {0.0, 0.0};

  [[nodiscard]] bool in_view() const { return pixels > 0; }
};

// The view of one object of the map, without what a cast of the object alone would add
// (pixels_alone, cut_by_frame, hidden, hidden_by, black_back) and without its motion.
[[nodiscard]] TargetView find_target(const ObjectMap& map, std::uint32_t object);

// All objects of the scene marked as targets, in its order. Each is cast once more without the rest
// of the scene, with the rays that made the map, so that what is wholly in view counts the same.
[[nodiscard]] std::vector<TargetView> find_targets(const scenes::Scene& scene,
                                                   const scenes::Camera& camera,
                                                   const ObjectMap& map);

}  // namespace earthshine::studies
