// SPDX-License-Identifier: Apache-2.0
#include "radiosity/patches/parted_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace earthshine::radiosity {
namespace {

constexpr double least_share = 1e-4;  // of the cell, on either side
constexpr double least_reach = 0.25;  // share of the line's length in the cell that the wall covers
constexpr double opposite = -0.5;     // cosine
constexpr int most_cuts_deep = 8;
constexpr double corner_rounding = 1e-12;  // of the cell's area

using Polygon = std::vector<PlanePoint>;

double cross(const PlanePoint& u, const PlanePoint& v) { return u.x * v.y - u.y * v.x; }

double area_of(const Polygon& p) {
  double twice = 0.0;
  for (std::size_t k = 2; k < p.size(); ++k) twice += cross(p[k - 1] - p[0], p[k] - p[0]);
  return 0.5 * twice;
}

// Removes degenerate corners: a line through a corner would cross the polygon twice, and a part
// with collinear corners would have no area.
Polygon with_corners(const Polygon& polygon, double least_area) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint& before = kept.empty() ? polygon.back() : kept.back();
    const bool last = k + 1 == polygon.size();
    const PlanePoint &here = polygon[k], &after = last && !kept.empty()
                                                      ? kept.front()
                                                      : polygon[(k + 1) % polygon.size()];
    if (cross(here - before, after - here) > least_area) kept.push_back(here);
  }
  return kept;
}

struct Line {
  PlanePoint normal;
  double reach;
  [[nodiscard]] double beyond(const PlanePoint& p) const { return glm::dot(normal, p) - reach; }
};

// Parts beyond the line and before it.
std::array<Polygon, 2> halves(const Polygon& polygon, const Line& line) {
  std::array<Polygon, 2> sides;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double at_p = line.beyond(p), at_q = line.beyond(q);
    sides[at_p >= 0.0 ? 1 : 0].push_back(p);
    if ((at_p >= 0.0) == (at_q >= 0.0)) continue;
    const PlanePoint between = p + at_p / (at_p - at_q) * (q - p);
    for (Polygon& side : sides) side.push_back(between);
  }
  return sides;
}

// Interval, in units of to - from, in which the line through both is inside the polygon.
std::optional<std::pair<double, double>> within(const Polygon& polygon, const PlanePoint& from,
                                                const PlanePoint& to) {
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double at = cross(edge, from - polygon[k]), change = cross(edge, to - from);
    if (change > 0.0) low = std::max(low, -at / change);
    if (change < 0.0) high = std::min(high, -at / change);
    if (change == 0.0 && at < 0.0) return std::nullopt;
  }
  if (!(low < high)) return std::nullopt;
  return std::pair(low, high);
}

class Parting {
 public:
  Parting(std::span<const Trace> traces, double area) : traces_(traces), area_(area) {}

  // Adds the polygon as one side of a node and returns its index.
  std::int32_t part(const Polygon& whole, int depth = 0) {
    Polygon polygon = with_corners(whole, corner_rounding * area_);
    const std::optional<Line> line = depth < most_cuts_deep ? best(polygon) : std::nullopt;
    if (line) return node(*line, halves(polygon, *line), depth + 1);
    if (polygon.size() > 4) {
      // Patches have at most four corners.
      const std::size_t half = polygon.size() / 2;
      const PlanePoint along = polygon[half] - polygon[0];
      const PlanePoint normal{-along.y, along.x};
      std::array<Polygon, 2> sides;
      sides[0].assign(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(half) + 1);
      sides[1].assign(polygon.begin() + static_cast<std::ptrdiff_t>(half), polygon.end());
      sides[1].push_back(polygon[0]);
      return node({normal, glm::dot(normal, polygon[0])}, sides, most_cuts_deep);
    }
    if (polygon.size() == 3) polygon.push_back(polygon.back());
    cell_.outlines.push_back({polygon[0], polygon[1], polygon[2], polygon[3]});
    return ~static_cast<std::int32_t>(cell_.outlines.size() - 1);
  }

  [[nodiscard]] PartedCell take() {
    if (cell_.nodes.empty()) cell_.outlines.clear();
    return std::move(cell_);
  }

 private:
  std::int32_t node(const Line& line, const std::array<Polygon, 2>& sides, int depth) {
    const std::size_t at = cell_.nodes.size();
    cell_.nodes.push_back({line.normal, line.reach, {}});
    for (std::size_t k = 0; k < 2; ++k) {
      const std::int32_t side = part(sides[k], depth);
      cell_.nodes[at].side[k] = side;
    }
    return static_cast<std::int32_t>(at);
  }

  // The line of the wall that covers the largest share of its length in the polygon.
  [[nodiscard]] std::optional<Line> best(const Polygon& polygon) const {
    std::optional<Line> line;
    double most = least_reach;
    for (const Trace& trace : traces_) {
      const double share = share_of(polygon, trace);
      if (share <= most || (trace.of_body && !ends_behind(polygon, trace))) continue;
      const Line own{trace.normal, trace.reach};
      const std::array<Polygon, 2> sides = halves(polygon, own);
      if (std::min(area_of(sides[0]), area_of(sides[1])) < least_share * area_) continue;
      line = own;
      most = share;
    }
    return line;
  }

  // Share of the line's length in the polygon that the wall covers.
  static double share_of(const Polygon& polygon, const Trace& trace) {
    const auto in = within(polygon, trace.from, trace.to);
    if (!in) return 0.0;
    const double taken = std::min(1.0, in->second) - std::max(0.0, in->first);
    return std::max(0.0, taken) / (in->second - in->first);
  }

  [[nodiscard]] bool ends_behind(const Polygon& polygon, const Trace& wall) const {
    return std::any_of(traces_.begin(), traces_.end(), [&](const Trace& other) {
      return other.of_body && glm::dot(other.front, wall.front) < opposite &&
             glm::dot(wall.normal, 0.5 * (other.from + other.to)) <= wall.reach &&
             share_of(polygon, other) > 0.0;
    });
  }

  std::span<const Trace> traces_;
  double area_;
  PartedCell cell_;
};

}  // namespace

Traces::Traces(std::vector<std::vector<Trace>> by_facet) : of_(std::move(by_facet)) {
  any_ = std::any_of(of_.begin(), of_.end(), [](const auto& traces) { return !traces.empty(); });
}

void Traces::near(std::uint32_t facet, const Outline& cell, std::vector<Trace>& found) const {
  found.clear();
  const PlanePoint low = glm::min(glm::min(cell[0], cell[1]), glm::min(cell[2], cell[3])),
                   high = glm::max(glm::max(cell[0], cell[1]), glm::max(cell[2], cell[3]));
  for (const Trace& t : of_[facet]) {
    if (glm::all(glm::lessThanEqual(glm::min(t.from, t.to), high)) &&
        glm::all(glm::greaterThanEqual(glm::max(t.from, t.to), low))) {
      found.push_back(t);
    }
  }
}

void append(Patches& patches, const PartedCell& parted) {
  patches.part_nodes.insert(patches.part_nodes.end(), parted.nodes.begin(), parted.nodes.end());
  patches.outlines.insert(patches.outlines.end(), parted.outlines.begin(), parted.outlines.end());
}

std::uint32_t find_before(const Patches& patches, const TrianglePlace& hit, bool front,
                          const Vec3& direction, double back_m) {
  const Facet& f = patches.facets[patches.of_triangle[hit.triangle]];
  const Parameters at = patches.parameters(hit.triangle, hit.u, hit.v);
  const Vec3 n = glm::cross(f.a, f.b);
  const double scale = back_m / glm::dot(n, n);
  PlanePoint p =
      f.parallelogram ? PlanePoint(at.s, at.t) : PlanePoint(at.s * (1.0 - at.t), at.s * at.t);
  p -= scale *
       PlanePoint(glm::dot(glm::cross(direction, f.b), n), glm::dot(glm::cross(f.a, direction), n));
  p = glm::max(p, PlanePoint(0.0));
  const double sum = p.x + p.y;
  const Parameters before =
      f.parallelogram ? Parameters{p.x, p.y} : Parameters{sum, sum > 0.0 ? p.y / sum : 0.0};
  return (front ? f.first_front : f.first_back) + patches.leaf(f, before);
}

Outline outline_of(const Facet& facet, const Cell& cell) {
  const Rectangle r = rectangle_of(facet, cell);
  const auto at = [&](double s, double t) {
    return facet.parallelogram ? PlanePoint(s, t) : PlanePoint(s * (1.0 - t), s * t);
  };
  return {at(r.s0, r.t0), at(r.s1, r.t0), at(r.s1, r.t1), at(r.s0, r.t1)};
}

PartedCell part_cell(const Facet& facet, const Cell& cell, std::span<const Trace> traces) {
  if (traces.empty()) return {};
  const Outline outline = outline_of(facet, cell);
  Polygon polygon;
  for (const PlanePoint& p : outline) {
    if (polygon.empty() || (p != polygon.back() && p != polygon.front())) polygon.push_back(p);
  }
  const double area = area_of(polygon);
  Parting parting(traces, area);
  parting.part(polygon);
  return parting.take();
}

}  // namespace earthshine::radiosity
