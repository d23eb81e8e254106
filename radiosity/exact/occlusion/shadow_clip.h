// SPDX-License-Identifier: Apache-2.0
// Visible part of a flat polygon from a point: the shadows of occluders are cut off exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/exact/occlusion/convex_bodies.h"

namespace earthshine::radiosity {

// For views from outside a closed convex body, its faces away from the viewer occlude nothing that
// its other faces do not. Inside the body, and if one of its faces lies on the receiver, every face
// occludes.
struct Blocker {
  ConvexPolygon shape;
  const ConvexBody* body = nullptr;  // the body it is a face of, in scene coordinates
  // The whole body is in front of both polygons: its outline is the shadow of all its faces.
  bool whole_body = false;
};

// The target's own frame: (u, v) in its plane from its first corner, h the height above it.
class TargetFrame {
 public:
  explicit TargetFrame(const ConvexPolygon& target)
      : origin_(target[0]), axes_(base::frame_around(target.normal)) {}
  [[nodiscard]] Vec3 direction(const Vec3& d) const {
    return {glm::dot(d, axes_.tangent), glm::dot(d, axes_.bitangent), glm::dot(d, axes_.normal)};
  }
  [[nodiscard]] Vec3 point(const Vec3& p) const { return direction(p - origin_); }
  [[nodiscard]] ConvexPolygon polygon(const ConvexPolygon& p) const;
  [[nodiscard]] Vec3 to_scene(const Vec3& p) const { return origin_ + axes_.to_world(p); }

 private:
  Vec3 origin_;
  base::Frame3 axes_;
};

// Everything in the target's frame. The parts are disjoint and together form the target.
class ShadowClip {
 public:
  // Blockers must lie in front of the target (h >= 0) and of the planes of all points used.
  void set(const TargetFrame& frame, const ConvexPolygon& target, std::span<const Blocker> blockers,
           double margin_m);

  // Divides the target as seen from `point` (h > 0).
  void cut(const Vec3& point);
  [[nodiscard]] bool wholly_visible() const { return hidden_.empty(); }
  [[nodiscard]] bool wholly_hidden() const { return visible_.empty(); }

  // Lambert factors at the last point, for the receiver's unit normal there.
  [[nodiscard]] double visible_share(const Vec3& normal) const { return share(visible_, normal); }
  [[nodiscard]] double hidden_share(const Vec3& normal) const { return share(hidden_, normal); }
  // Share of the target's area that is visible from the last point.
  [[nodiscard]] double visible_area_share() const;

 private:
  struct Corner {
    double u, v;
  };
  struct Piece {
    std::uint32_t start, count;
  };
  struct Line {  // inside where a u + b v + c > 0
    double a, b, c, margin;
    [[nodiscard]] double at(const Corner& p) const { return a * p.u + b * p.v + c; }
  };

  [[nodiscard]] bool make_lines(const Blocker& blocker);
  [[nodiscard]] bool make_outline(const ConvexBody& body);
  [[nodiscard]] bool is_outside(const ConvexBody& body) const;
  void add_line(const Vec3& from, const Vec3& to, double sign);
  void subtract(const Piece& piece);
  [[nodiscard]] bool clear_of_lines(const Piece& piece) const;
  [[nodiscard]] double share(const std::vector<Piece>& pieces, const Vec3& normal) const;

  const TargetFrame* frame_ = nullptr;
  std::span<const Blocker> blockers_;
  std::vector<Corner> target_, corners_;
  std::vector<Piece> visible_, remaining_, hidden_;
  std::vector<Line> lines_;
  std::vector<char> faces_point_;
  std::vector<double> height_;
  Vec3 point_{0.0};
  double margin_m_ = 0.0, area_m2_ = 0.0;
};

// Kinks of the view of a target past occluders, on a receiver: planes through two parallel edges,
// where one passes behind the other. Finds only planes that meet the receiver parallel to one of
// its sides; between right-angled bodies these are all.

class ShadowKinks {
 public:
  // The receiver is corner + x ab + y ad, x and y in [0, 1]. Everything in the target's frame.
  void find(const Vec3& corner, const Vec3& ab, const Vec3& ad, const TargetFrame& frame,
            const ConvexPolygon& target, std::span<const Blocker> blockers);
  void clear();

  // Where to divide [low, high]: at the kink nearest to the middle, else in the middle.
  [[nodiscard]] double split_x(double low, double high) const { return split(at_x_, low, high); }
  [[nodiscard]] double split_y(double low, double high) const { return split(at_y_, low, high); }

 private:
  struct Point {  // an edge projected along its own direction
    double across, towards;
  };

  struct Projection {
    Vec3 corner, along, normal, across;
    double side_m, along_m;
  };

  void find(const Vec3& corner, const Vec3& side, const Vec3& along, const TargetFrame& frame,
            const ConvexPolygon& target, std::span<const Blocker> blockers,
            std::vector<double>& kinks);
  static void collect(const Vec3& from, const Vec3& to, const Projection& projection,
                      std::vector<Point>& points);
  [[nodiscard]] static double split(const std::vector<double>& kinks, double low, double high);

  std::vector<double> at_x_, at_y_;
  std::vector<Point> of_target_, of_blockers_;
};

}  // namespace earthshine::radiosity
