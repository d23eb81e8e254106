// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/open_parts.h"

#include <algorithm>

#include "base/parallel.h"
#include "radiosity/patches/patch_offset.h"

namespace earthshine::radiosity {
namespace {

constexpr int most_cuts = 4096;  // per patch

struct Line {
  Vec3 from, to;
};

class PatchCutter {
 public:
  // offset_m: of rays that leave the patch; contact_m: nearer faces lie on it.
  PatchCutter(const ClosedBodies& bodies, const FacetSides& sides, const PatchShape& shape,
              double offset_m, double contact_m, std::span<const std::uint32_t> near)
      : bodies_(bodies),
        sides_(sides),
        normal_(shape.polygon.normal),
        lift_(normal_ * offset_m + sides.origin - bodies.centre()),
        near_m_(contact_m),
        thinnest_m_(1e-3 * contact_m),
        near_(near) {}

  void cut(const ConvexPolygon& polygon, std::uint32_t facet, PatchCover& cover) {
    find_lines(polygon, facet);
    if (is_open(polygon, lines_, cover.parts)) {
      cover.parts.clear();
      return;
    }
    const double area = area_m2(polygon);
    double open = 0.0;
    for (const ConvexPolygon& part : cover.parts) open += area_m2(part);
    cover.open = std::min(open / area, 1.0);
    cover.std_error = 0.5 * undecided_m2_ / area;
  }

 private:
  // Lines in which other faces meet the patch's plane.
  void find_lines(const ConvexPolygon& polygon, std::uint32_t facet) {
    const Box box = box_around(polygon);
    const Plane plane{polygon[0], normal_};
    for (std::uint32_t f = 0; f < sides_.blockers.size(); ++f) {
      if (f == facet || !box.meets(sides_.blocker_box[f], near_m_)) continue;
      const ConvexPolygon& face = sides_.blockers[f];
      std::array<double, ConvexPolygon::most_corners> height{};
      int on_plane = 0;
      for (int k = 0; k < face.count; ++k) {
        double h = plane.height(face[k]);
        if (std::abs(h) <= near_m_) h = 0.0;
        height[static_cast<std::size_t>(k)] = h;
        on_plane += h == 0.0 ? 1 : 0;
      }
      if (on_plane == face.count) {
        for (int k = 0; k < face.count; ++k) lines_.push_back({face[k], face.next(k)});
      } else {
        add_crossing(face, height);
      }
    }
  }

  void add_crossing(const ConvexPolygon& face,
                    const std::array<double, ConvexPolygon::most_corners>& height) {
    std::vector<Vec3> ends;
    for (int k = 0; k < face.count; ++k) {
      const double here = height[static_cast<std::size_t>(k)];
      const double there = height[static_cast<std::size_t>(k + 1 == face.count ? 0 : k + 1)];
      if (here == 0.0) ends.push_back(face[k]);
      if (here * there < 0.0) {
        ends.push_back(face[k] + (here / (here - there)) * (face.next(k) - face[k]));
      }
    }
    if (ends.size() == 2) lines_.push_back({ends[0], ends[1]});
  }

  // Appends the open parts; returns whether they are the whole polygon.
  bool is_open(const ConvexPolygon& polygon, const std::vector<Line>& lines,
               std::vector<ConvexPolygon>& parts) {
    std::vector<Line> inside;
    double longest = thinnest_m_;
    Plane along{};
    for (const Line& line : lines) {
      const double length = length_inside(polygon, line);
      if (length <= thinnest_m_) continue;
      const Plane plane{line.from, glm::normalize(glm::cross(normal_, line.to - line.from))};
      if (!splits(polygon, plane)) continue;
      inside.push_back(line);
      if (length <= longest) continue;
      longest = length;
      along = plane;
    }
    if (inside.empty() || ++cuts_ > most_cuts) return decide(polygon, parts);
    const std::size_t before = parts.size();
    bool all = true;
    for (const Plane& half : {along, Plane{along.point, -along.normal}}) {
      const ConvexPolygon part = clip(polygon, half, thinnest_m_);
      if (part.count < ConvexPolygon::most_corners) {
        all = is_open(part, inside, parts) && all;
        continue;
      }
      // Memory for the next cut.
      ConvexPolygon first, second;
      first.normal = second.normal = normal_;
      for (int k = 0; k <= part.count / 2; ++k) first.add(part[k]);
      for (int k = part.count / 2; k < part.count; ++k) second.add(part[k]);
      second.add(part[0]);
      all = is_open(first, inside, parts) && all;
      all = is_open(second, inside, parts) && all;
    }
    if (all) {
      parts.resize(before);
      parts.push_back(polygon);
    }
    return all;
  }

  [[nodiscard]] bool splits(const ConvexPolygon& polygon, const Plane& plane) const {
    bool above = false, below = false;
    for (int k = 0; k < polygon.count; ++k) {
      const double height = plane.height(polygon[k]);
      above = above || height > thinnest_m_;
      below = below || height < -thinnest_m_;
    }
    return above && below;
  }

  [[nodiscard]] double length_inside(const ConvexPolygon& polygon, const Line& line) const {
    double first = 0.0, last = 1.0;
    for (int k = 0; k < polygon.count; ++k) {
      const Vec3 inward = glm::cross(normal_, polygon.next(k) - polygon[k]);
      const double length = glm::length(inward);
      if (length <= 0.0) continue;
      const double from = glm::dot(inward, line.from - polygon[k]) / length;
      const double to = glm::dot(inward, line.to - polygon[k]) / length;
      if (from <= thinnest_m_ && to <= thinnest_m_) return 0.0;  // at or outside the border
      if (from < 0.0) first = std::max(first, from / (from - to));
      if (to < 0.0) last = std::min(last, from / (from - to));
    }
    return (last - first) * glm::length(line.to - line.from);
  }

  bool decide(const ConvexPolygon& part, std::vector<ConvexPolygon>& parts) {
    Vec3 middle(0.0);
    for (int k = 0; k < part.count; ++k) middle += part[k] / double(part.count);
    const bool open = !covers(middle);
    bool undecided = false;
    for (int k = 0; k < part.count; ++k) {
      undecided = undecided || covers(0.1 * middle + 0.9 * part[k]) == open;
    }
    if (undecided) undecided_m2_ += area_m2(part);
    if (open) parts.push_back(part);
    return open;
  }
  [[nodiscard]] bool covers(const Vec3& point) const { return bodies_.cover(point + lift_, near_); }

  const ClosedBodies& bodies_;
  const FacetSides& sides_;
  Vec3 normal_, lift_;
  double near_m_, thinnest_m_;
  std::span<const std::uint32_t> near_;
  std::vector<Line> lines_;
  int cuts_ = 0;
  double undecided_m2_ = 0.0;
};

}  // namespace

std::vector<PatchCover> find_open_parts(const ClosedBodies& bodies, const scenes::RayQuery& query,
                                        const Patches& patches, const FacetSides& sides) {
  std::vector<PatchCover> covers(patches.count());
  base::parallel_chunks(covers.size(), 1, [&](std::size_t k, std::size_t) {
    const auto patch = static_cast<std::uint32_t>(k);
    PatchCover& cover = covers[patch];
    const double offset_m = patch_offset_m(patches, query, patch);
    cover.near = bodies.near(patches, patch, 2.0 * offset_m);
    if (cover.near.empty()) return;
    const PatchShape& shape = sides.shapes[patch];
    const double contact_m = query.offsets().contact(patches.facets[patches.facet[patch]].triangle);
    PatchCutter(bodies, sides, shape, offset_m, contact_m, cover.near)
        .cut(shape.polygon, patches.facet[patch], cover);
  });
  return covers;
}

}  // namespace earthshine::radiosity
