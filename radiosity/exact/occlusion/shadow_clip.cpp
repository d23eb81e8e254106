// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/occlusion/shadow_clip.h"

#include <algorithm>
#include <cmath>

#include "radiosity/direct/lambert.h"

namespace earthshine::radiosity {
namespace {

// Sine below which edges count as parallel, and share of a side within which points are merged.
constexpr double parallel = 1e-7, same = 1e-9;
// Limit of kinks per side: single edges of round bodies do not matter.
constexpr std::size_t most_edges = 48;

}  // namespace

ConvexPolygon TargetFrame::polygon(const ConvexPolygon& p) const {
  ConvexPolygon seen;
  seen.normal = direction(p.normal);
  for (int k = 0; k < p.count; ++k) seen.add(point(p[k]));
  return seen;
}

void ShadowClip::set(const TargetFrame& frame, const ConvexPolygon& target,
                     std::span<const Blocker> blockers, double margin_m) {
  frame_ = &frame;
  target_.clear();
  for (int k = 0; k < target.count; ++k) target_.push_back({target[k].x, target[k].y});
  blockers_ = blockers;
  margin_m_ = margin_m;
  area_m2_ = area_m2(target);
}

// Adds the line in which the plane through the point and an outline edge meets the target's plane.
void ShadowClip::add_line(const Vec3& from, const Vec3& to, double sign) {
  const Vec3 n = sign * glm::cross(from, to);
  lines_.push_back({n.x, n.y, -glm::dot(n, point_), margin_m_ * (std::abs(n.x) + std::abs(n.y))});
}

bool ShadowClip::make_lines(const Blocker& blocker) {
  lines_.clear();
  if (blocker.whole_body) return make_outline(*blocker.body);
  const ConvexPolygon& face = blocker.shape;
  const double side = glm::dot(face.normal, point_ - face[0]);
  // Seen edge-on it has no width.
  if (std::abs(side) <= margin_m_) return false;
  if (side < 0.0 && blocker.body != nullptr && is_outside(*blocker.body)) return false;
  Vec3 from = face[face.count - 1] - point_;
  for (int k = 0; k < face.count; ++k) {
    const Vec3 to = face[k] - point_;
    add_line(from, to, side > 0.0 ? -1.0 : 1.0);
    from = to;
  }
  return true;
}

bool ShadowClip::is_outside(const ConvexBody& body) const {
  const Vec3 from_here = frame_->to_scene(point_);
  return std::any_of(body.faces.begin(), body.faces.end(),
                     [&](const Plane& face) { return face.height(from_here) > margin_m_; });
}

// The edges between faces toward the point and faces away from it.
bool ShadowClip::make_outline(const ConvexBody& body) {
  const Vec3 from_here = frame_->to_scene(point_);
  faces_point_.clear();
  for (const Plane& face : body.faces) {
    faces_point_.push_back(face.height(from_here) > margin_m_ ? 1 : 0);
  }
  for (const ConvexBody::Edge& edge : body.edges) {
    const bool left = faces_point_[edge.left] != 0, right = faces_point_[edge.right] != 0;
    if (left == right) continue;
    add_line(frame_->direction(edge.from - from_here), frame_->direction(edge.to - from_here),
             left ? -1.0 : 1.0);
  }
  return !lines_.empty();
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

// Divides the piece along the lines: outside any line it stays visible, inside all lines it is
// hidden.
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
    // Both parts together have at most two more corners than before, and two in common.
    const auto start = static_cast<std::uint32_t>(corners_.size());
    corners_.resize(start + 2 * inside.count + 4);
    const Corner* from = &corners_[inside.start];
    Corner* in = &corners_[start];
    Corner* out = in + inside.count + 2;
    const Corner *in_start = in, *out_start = out;
    for (std::uint32_t k = 0; k < inside.count; ++k) {
      const std::uint32_t next = k + 1 == inside.count ? 0 : k + 1;
      const double here = height_[k], there = height_[next];
      if (here >= 0.0) *in++ = from[k];
      if (here <= 0.0) *out++ = from[k];
      if (here * there < 0.0) {
        const double t = here / (here - there);
        const Corner cross{from[k].u + t * (from[next].u - from[k].u),
                           from[k].v + t * (from[next].v - from[k].v)};
        *in++ = *out++ = cross;
      }
    }
    visible_.push_back({start + inside.count + 2, static_cast<std::uint32_t>(out - out_start)});
    inside = {start, static_cast<std::uint32_t>(in - in_start)};
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
    if (blocker.whole_body && !is_outside(*blocker.body)) {
      hidden_.insert(hidden_.end(), visible_.begin(), visible_.end());
      visible_.clear();
      break;
    }
    if (!make_lines(blocker)) continue;
    std::size_t first = 0;
    while (first < visible_.size() && clear_of_lines(visible_[first])) ++first;
    if (first == visible_.size()) continue;
    remaining_.assign(visible_.begin() + static_cast<std::ptrdiff_t>(first), visible_.end());
    visible_.resize(first);
    for (std::size_t k = 0; k < remaining_.size(); ++k) {
      if (k > 0 && clear_of_lines(remaining_[k])) {
        visible_.push_back(remaining_[k]);
      } else {
        subtract(remaining_[k]);
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

// An edge parallel to `along`, as a point of the perpendicular plane: `across` in units of the
// receiver's side, `towards` the height above the receiver in metres.
void ShadowKinks::collect(const Vec3& from, const Vec3& to, const Projection& projection,
                          std::vector<Point>& points) {
  const Vec3 edge = to - from;
  const double off = glm::length(glm::cross(edge, projection.along));
  if (off > parallel * glm::length(edge) * projection.along_m) return;
  const Vec3 at = from - projection.corner;
  const Point made{glm::dot(at, projection.across), glm::dot(at, projection.normal)};
  for (const Point& point : points) {
    if (std::abs(point.across - made.across) < same &&
        std::abs(point.towards - made.towards) < same * projection.side_m) {
      return;
    }
  }
  points.push_back(made);
}

void ShadowKinks::find(const Vec3& corner, const Vec3& side, const Vec3& along,
                       const TargetFrame& frame, const ConvexPolygon& target,
                       std::span<const Blocker> blockers, std::vector<double>& kinks) {
  Projection projection{corner,
                        along,
                        glm::normalize(glm::cross(side, along)),
                        Vec3(0.0),
                        glm::length(side),
                        glm::length(along)};
  // In the plane spanned by side and normal, projected along `along`.
  const Vec3 across = glm::cross(along, projection.normal);
  projection.across = across / glm::dot(across, side);
  of_target_.clear();
  of_blockers_.clear();
  for (int k = 0; k < target.count; ++k) {
    collect(target[k], target.next(k), projection, of_target_);
  }
  for (const Blocker& blocker : blockers) {
    if (blocker.whole_body) {
      if (blocker.body->edges.size() > most_edges) continue;
      for (const ConvexBody::Edge& edge : blocker.body->edges) {
        collect(frame.point(edge.from), frame.point(edge.to), projection, of_blockers_);
      }
    } else {
      for (int k = 0; k < blocker.shape.count; ++k) {
        collect(blocker.shape[k], blocker.shape.next(k), projection, of_blockers_);
      }
    }
  }
  // The line through two points meets the receiver, towards = 0, at x.
  const auto add = [&kinks](const Point& p, const Point& q) {
    const double rise = q.towards - p.towards;
    if (rise == 0.0) return;
    const double x = p.across - p.towards * (q.across - p.across) / rise;
    if (x > same && x < 1.0 - same) kinks.push_back(x);
  };
  kinks.clear();
  for (std::size_t k = 0; k < of_blockers_.size(); ++k) {
    for (const Point& point : of_target_) add(of_blockers_[k], point);
    for (std::size_t j = 0; j < k; ++j) add(of_blockers_[k], of_blockers_[j]);
  }
}

void ShadowKinks::find(const Vec3& corner, const Vec3& ab, const Vec3& ad, const TargetFrame& frame,
                       const ConvexPolygon& target, std::span<const Blocker> blockers) {
  find(corner, ab, ad, frame, target, blockers, at_x_);
  find(corner, ad, ab, frame, target, blockers, at_y_);
}

void ShadowKinks::clear() {
  at_x_.clear();
  at_y_.clear();
}

double ShadowKinks::split(const std::vector<double>& kinks, double low, double high) {
  const double middle = 0.5 * (low + high), width = high - low;
  double nearest = (0.5 - 1e-6) * width, best = middle;
  for (const double x : kinks) {
    if (std::abs(x - middle) < nearest) {
      nearest = std::abs(x - middle);
      best = x;
    }
  }
  return best;
}

}  // namespace earthshine::radiosity
