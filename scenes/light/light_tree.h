// SPDX-License-Identifier: Apache-2.0
// Which of many lights are worth a shadow ray at a point, in a time that grows with the logarithm
// of their number: all that matter, and of the rest a few by chance, weighted so that the mean is
// right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Where lights may be, which way they may shine and how strongly at most.
struct LightBounds {
  Vec3 low{0.0}, high{0.0};      // box that holds them, m
  Vec3 axis{0.0, 0.0, 1.0};      // unit
  double axes_rad = 0.0;         // every light's own axis lies within this angle of `axis`
  double reach_rad = base::pi;   // and no light shines further than this from its own
  bool falls_by_cosine = false;  // intensity falls from the axis as of a flat Lambert source
  double intensity_cd = 0.0;     // sum of their greatest intensities, in any channel
};
[[nodiscard]] LightBounds bounds_of(const Lamp& lamp);

// What asks for light: a surface with the reflectance diffuse + specular cos^shininess(alpha), of
// which only the proportion counts here.
struct Receiver {
  Vec3 point{0.0};
  Vec3 normal{0.0, 0.0, 1.0};    // 0: light counts from whichever side it comes
  Vec3 mirrored{0.0, 0.0, 1.0};  // the mirror direction of the view
  double diffuse = 1.0, specular = 0.0, shininess = 1.0;
};

struct LightChoice {
  std::size_t light;
  double weight;  // 1 / expected number of times it is chosen
};

class LightTree {
 public:
  explicit LightTree(const std::vector<LightBounds>& lights);

  // Adds to `chosen` every light whose unshadowed contribution may exceed `share` of what all of
  // them give by the same bounds, with weight 1, and of the others about one per `share` of the
  // light they give (1 / share at most), with weight 1 / probability. Over u uniform in [0, 1) the
  // expected sum of weight x contribution is the sum over all lights, whatever stands between. The
  // draws are systematic over a line on which neighbours in space are neighbours, so that evenly
  // spread u give evenly spread lights. Lights that cannot reach the receiver are left out.
  void choose(const Receiver& receiver, double u, double share,
              std::vector<LightChoice>& chosen) const;

  // One light, by what each may give the point, whichever way a surface there faces. `rest` is what
  // the choice has left of u: uniform in [0, 1) for every light. Nothing if none can reach the
  // point.
  struct Pick {
    std::size_t light;
    double probability, rest;
  };
  [[nodiscard]] std::optional<Pick> pick(const Vec3& point, double u) const;

  // Adds the lights whose boxes a ray meets before `reach_m`.
  void along(const Vec3& origin, const Vec3& direction, double reach_m,
             std::vector<std::size_t>& lights) const;

  [[nodiscard]] std::size_t count() const { return (nodes_.size() + 1) / 2; }

 private:
  struct Node {
    Vec3 centre;
    Vec3 half;       // of the box
    double radius2;  // of the sphere around it
    Vec3 axis;
    double cos_axes, sin_axes;  // of LightBounds::axes_rad
    double cos_edge;            // of axes_rad + reach_rad; -1: shines all round
    bool falls_by_cosine;
    double intensity_cd;
    std::uint32_t light;  // of a leaf
    std::uint32_t right;  // of a fork: its second child, the first comes next; 0: a leaf
  };
  // bound: no less than what the node's lights give the receiver; estimate: about that, finite
  // where the receiver stands among them, and 0 only where bound is.
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
  // From a node down to a light, for t uniform in [0, 1).
  [[nodiscard]] std::optional<Pick> descend(const Receiver& receiver, std::uint32_t node,
                                            double t) const;
  [[nodiscard]] static Value value_of(const Node& node, const Receiver& receiver);

  std::vector<Node> nodes_;  // a fork stands before its children
};

}  // namespace earthshine::scenes
