// SPDX-License-Identifier: Apache-2.0
// The pixels of target objects in a camera's picture, independent of light:
//   seen      pixels whose centre shows the target
//   alone     pixels whose centre would show it without all other objects
//   core      seen pixels with 8 seen neighbours: a pixel on the outline mixes the light of both
//             sides
//   surround  about as many pixels as are seen, in a band around them one pixel off the outline,
//             whatever they show: background, foreground or sky
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// Per pixel the index of the object at its centre, or no_object. Rows from the top.
inline constexpr std::int32_t no_object = -1;
struct ObjectMap {
  int columns = 0;
  int rows = 0;
  std::vector<std::int32_t> object;
};

// From the frame's layer "object" (raytrace::RenderOptions::aovs). Throws base::Error (Input) if
// the picture has none.
[[nodiscard]] ObjectMap object_map(const base::Image& image);

struct TargetView {
  std::uint32_t object = 0;
  std::string name;
  std::size_t pixels = 0;        // seen
  std::size_t pixels_alone = 0;  // at least as many as seen
  bool in_frame = false;         // a corner of it is within the picture, seen or not
  bool cut_by_frame = false;     // alone, it reaches the picture's border: parts may be outside
  // Pixels of `alone` that show something else: indices in ascending order.
  std::vector<std::uint32_t> hidden;
  // The objects on those pixels, most pixels first.
  struct Blocker {
    std::uint32_t object = 0;
    std::size_t pixels = 0;
  };
  std::vector<Blocker> hidden_by;
  // Pixels for its luminance: the core, or all seen pixels of a thin target with less than a
  // quarter of them in the core. Pixel indices in ascending order.
  std::vector<std::uint32_t> measured;
  std::vector<std::uint32_t> surround;  // empty if the target fills the picture
  // Seen pixels with the black back of a one-sided surface: the luminance of the real back is
  // unknown.
  std::vector<std::uint32_t> black_back;
  // Of the target's centre in the picture, to the right and down, against the camera.
  std::array<double, 2> motion_px_s = {0.0, 0.0};

  [[nodiscard]] bool in_view() const { return pixels > 0; }
};

// The view of one object of the map, without the results of a cast of the object alone
// (pixels_alone, cut_by_frame, hidden, hidden_by, black_back) and without its motion.
[[nodiscard]] TargetView find_target(const ObjectMap& map, std::uint32_t object);

// All objects of the scene marked as targets, in its order. Each is cast again without the rest of
// the scene, with the rays of the map, so that an unoccluded target has the same pixels.
[[nodiscard]] std::vector<TargetView> find_targets(const scenes::Scene& scene,
                                                   const scenes::Camera& camera,
                                                   const ObjectMap& map);

// Pixels beyond the picture whose centre would show the object without all others, up to a
// picture's width and height from it on each side; lens distortion continues there.
struct PixelsOutside {
  std::size_t count = 0;
  // The outermost of them; (0, 0) is the picture's first pixel.
  int left = 0, right = 0, top = 0, bottom = 0;
};
[[nodiscard]] PixelsOutside pixels_outside(const scenes::Scene& scene, const scenes::Camera& camera,
                                           std::uint32_t object, int columns, int rows);

}  // namespace earthshine::studies
