// SPDX-License-Identifier: Apache-2.0
#include "radiosity/shadow_clip.h"

#include <cmath>

#include "radiosity/lambert.h"

namespace earthshine::radiosity {

ConvexPolygon TargetFrame::polygon(const ConvexPolygon& p) const {
  ConvexPolygon seen;
  seen.normal = direction(p.normal);
  for (int k = 0; k < p.count; ++k) seen.add(point(p[k]));
  return seen;
}

void ShadowClip::set(const ConvexPolygon& target, std::span<const Blocker> blockers,
                     double margin_m) {
  target_.clear();
  for (int k = 0; k < target.count; ++k) target_.push_back({target[k].x, target[k].y});
  blockers_ = blockers;
  margin_m_ = margin_m;
  area_m2_ = area_m2(target);
}

// The planes through the point and the blocker's edges, where they meet the target's plane.
bool ShadowClip::make_lines(const Blocker& face) {
  const ConvexPolygon& blocker = face.shape;
  const double side = glm::dot(blocker.normal, point_ - blocker[0]);
  if (std::abs(side) <= margin_m_ || (face.front_only && side < 0.0)) return false;  // edge-on: no width
  const double turn = side > 0.0 ? -1.0 : 1.0;
  lines_.clear();
  Vec3 from = blocker[blocker.count - 1] - point_;
  for (int k = 0; k < blocker.count; ++k) {
    const Vec3 to = blocker[k] - point_;
    const Vec3 n = turn * glm::cross(from, to);
    from = to;
    lines_.push_back({n.x, n.y, -glm::dot(n, point_), margin_m_ * (std::abs(n.x) + std::abs(n.y))});
  }
  return true;
}

bool ShadowClip::clear_of_lines(const Piece& piece) const {
  for (const Line& line : lines_) {
    bool outside = true;
    for (std::uint32_t k = 0; k < piece.count && outside; ++k) {
      outside = line.at(corners_[piece.start + k]) <= line.margin;
    }
    if (outside) return true;
  }
  return false;
}

// Splits the piece along the lines: what is outside one of them stays visible, what is inside all
// of them is hidden.
void ShadowClip::subtract(const Piece& piece) {
  Piece inside = piece;
  for (const Line& line : lines_) {
    height_.resize(inside.count);
    bool any_in = false, any_out = false;
    for (std::uint32_t k = 0; k < inside.count; ++k) {
      double h = line.at(corners_[inside.start + k]);
      if (std::abs(h) <= line.margin) h = 0.0;
      height_[k] = h;
      any_in = any_in || h > 0.0;
      any_out = any_out || h < 0.0;
    }
    if (!any_out) continue;
    if (!any_in) {
      visible_.push_back(inside);
      return;
    }
    const auto part = [&](double sign) {
      const Piece made{static_cast<std::uint32_t>(corners_.size()), 0};
      for (std::uint32_t k = 0; k < inside.count; ++k) {
        const std::uint32_t next = k + 1 == inside.count ? 0 : k + 1;
        const Corner p = corners_[inside.start + k], q = corners_[inside.start + next];
        if (sign * height_[k] >= 0.0) corners_.push_back(p);
        if (height_[k] * height_[next] < 0.0) {
          const double t = height_[k] / (height_[k] - height_[next]);
          corners_.push_back({p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)});
        }
      }
      return Piece{made.start, static_cast<std::uint32_t>(corners_.size()) - made.start};
    };
    visible_.push_back(part(-1.0));
    inside = part(1.0);
  }
  hidden_.push_back(inside);
}

void ShadowClip::cut(const Vec3& point) {
  point_ = point;
  corners_.assign(target_.begin(), target_.end());
  visible_.assign(1, {0, static_cast<std::uint32_t>(target_.size())});
  hidden_.clear();
  for (const Blocker& blocker : blockers_) {
    if (visible_.empty()) break;
    if (!make_lines(blocker)) continue;
    bool touched = false;
    for (const Piece& piece : visible_) touched = touched || !clear_of_lines(piece);
    if (!touched) continue;
    remaining_.swap(visible_);
    visible_.clear();
    for (const Piece& piece : remaining_) {
      if (clear_of_lines(piece)) {
        visible_.push_back(piece);
      } else {
        subtract(piece);
      }
    }
  }
}

double ShadowClip::share(const std::vector<Piece>& pieces, const Vec3& normal) const {
  LambertSum sum(normal);
  for (const Piece& piece : pieces) {
    const auto seen = [&](std::uint32_t k) {
      const Corner& p = corners_[piece.start + k];
      return Vec3(p.u - point_.x, p.v - point_.y, -point_.z);
    };
    Vec3 from = seen(piece.count - 1);
    for (std::uint32_t k = 0; k < piece.count; ++k) {
      const Vec3 to = seen(k);
      sum.add(from, to);
      from = to;
    }
  }
  return std::max(0.0, sum.share());
}

double ShadowClip::visible_area_share() const {
  double twice = 0.0;
  for (const Piece& piece : visible_) {
    for (std::uint32_t k = 0; k < piece.count; ++k) {
      const Corner& p = corners_[piece.start + k];
      const Corner& q = corners_[piece.start + (k + 1 == piece.count ? 0 : k + 1)];
      twice += p.u * q.v - p.v * q.u;
    }
  }
  return 0.5 * twice / area_m2_;
}

}  // namespace earthshine::radiosity
