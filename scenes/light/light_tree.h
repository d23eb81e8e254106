// SPDX-License-Identifier: Apache-2.0
// Selects the lights among many that get a shadow ray at a point, in logarithmic time: all
// important lights, and a weighted random sample of the others without bias.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Bounds of the positions, directions and intensities of lights.
struct LightBounds {
  Vec3 low{0.0}, high{0.0};      // contains all lights, m
  Vec3 axis{0.0, 0.0, 1.0};      // unit
  double axes_rad = 0.0;         // maximum angle between a light's axis and `axis`
  double reach_rad = base::pi;   // maximum angle of emission from a light's axis
  bool falls_by_cosine = false;  // intensity follows the cosine, as of a flat Lambertian source
  double intensity_cd = 0.0;     // sum of their maximum intensities, over channels
};
[[nodiscard]] LightBounds bounds_of(const Lamp& lamp);

// The receiver: a surface with reflectance diffuse + specular cos^shininess(alpha), of which only
// the ratio matters.
struct Receiver {
  Vec3 point{0.0};
  Vec3 normal{0.0, 0.0, 1.0};    // 0: light from both sides counts
  Vec3 mirrored{0.0, 0.0, 1.0};  // the mirror direction of the view
  double diffuse = 1.0, specular = 0.0, shininess = 1.0;
};

struct LightChoice {
  std::size_t light;
  double weight;  // 1 / expected number of selections
};

class LightTree {
 public:
  explicit LightTree(const std::vector<LightBounds>& lights);

  // Adds to `chosen`, with weight 1, every light whose unshadowed contribution may exceed `share`
  // of the estimated total. Of the other lights adds about one per `share` of the total (1 / share
  // at most), with weight 1 / probability. Over u uniform in [0, 1) the expected sum of weight x
  // contribution equals the sum over all lights, with any occlusion. The draws are systematic along
  // an order in which neighbours in space are adjacent, so that uniform u give a uniform
  // distribution of lights. Lights that cannot reach the receiver are omitted.
  void choose(const Receiver& receiver, double u, double share,
              std::vector<LightChoice>& chosen) const;

  // Selects one light by the bound of its contribution at the point, for any orientation of the
  // surface. `rest` is the reused random number: uniform in [0, 1) for each light. No value if no
  // light can reach the point.
  struct Pick {
    std::size_t light;
    double probability, rest;
  };
  [[nodiscard]] std::optional<Pick> pick(const Vec3& point, double u) const;

  // Adds the lights whose boxes a ray hits before `reach_m`.
  void along(const Vec3& origin, const Vec3& direction, double reach_m,
             std::vector<std::size_t>& lights) const;

  [[nodiscard]] std::size_t count() const { return (nodes_.size() + 1) / 2; }

 private:
  struct Node {
    Vec3 centre;
    Vec3 half;       // of the box's size
    double radius2;  // of the bounding sphere
    Vec3 axis;
    double cos_axes, sin_axes;  // of LightBounds::axes_rad
    double cos_edge;            // of axes_rad + reach_rad; -1: emits in all directions
    bool falls_by_cosine;
    double intensity_cd;
    std::uint32_t light;  // for a leaf
    std::uint32_t right;  // index of the second child (the first one follows its parent); 0: a leaf
  };
  // bound: upper bound of the light of the node's lights at the receiver. estimate: an
  // approximation, finite where the receiver is among the lights, and 0 only if the bound is 0.
  struct Value {
    double bound, estimate;
  };
  struct Piece {
    std::uint32_t node;
    Value value;
  };
  std::uint32_t build(const std::vector<LightBounds>& lights, std::uint32_t* first,
                      std::uint32_t* last);
  void along(std::uint32_t node, const Vec3& origin, const Vec3& direction, double reach_m,
             std::vector<std::size_t>& lights) const;
  // Descends from a node to a light, for t uniform in [0, 1).
  [[nodiscard]] std::optional<Pick> descend(const Receiver& receiver, std::uint32_t node,
                                            double t) const;
  [[nodiscard]] static Value value_of(const Node& node, const Receiver& receiver);

  std::vector<Node> nodes_;  // parents precede their children
};

}  // namespace earthshine::scenes
