// SPDX-License-Identifier: Apache-2.0
#include "radiosity/bodies/closed_bodies.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <ranges>
#include <utility>

#include "radiosity/bodies/closed_parts.h"
#include "scenes/light/lamp_light.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {
namespace {

constexpr double least_volume_share = 1e-9;  // of its box: a smaller volume encloses nothing
constexpr double most_cells = 512.0;         // per axis of the grid
constexpr std::uint32_t none = 0xFFFFFFFFU;
constexpr std::uint32_t first_hole = 0x80000000U;   // from here on: masked triangles
constexpr std::uint32_t first_front = 0xA0000000U;  // } triangles covered by others
constexpr std::uint32_t first_back = 0xC0000000U;   // }
constexpr std::uint32_t outside = none;             // pseudo-body: all outside rooms

// Whether the half-line from p along +x crosses the edge: +1 upward, -1 downward. The reversed edge
// gives exactly the opposite number.
int crossing(const Vec3& from, const Vec3& to, const Vec3& p) {
  const bool up = from.y <= p.y && p.y < to.y, down = to.y <= p.y && p.y < from.y;
  if (!up && !down) return 0;
  const Vec3& low = up ? from : to;
  const Vec3& high = up ? to : from;
  const double left = (high.x - low.x) * (p.y - low.y) - (high.y - low.y) * (p.x - low.x);
  if (!(left > 0.0)) return 0;
  return up ? 1 : -1;
}

}  // namespace

ClosedSurface::ClosedSurface(std::span<const Vec3> corners)
    : low_(std::numeric_limits<double>::infinity()), high_(-low_) {
  for (const Vec3& p : corners) {
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
  }
  const Vec3 size = high_ - low_, middle = 0.5 * (low_ + high_);
  axis_ = size.x < size.y ? (size.x < size.z ? 0 : 2) : (size.y < size.z ? 1 : 2);
  const std::size_t count = corners.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 &a = corners[3 * k], &b = corners[3 * k + 1], &c = corners[3 * k + 2];
    volume_m3_ += glm::dot(a - middle, glm::cross(b - middle, c - middle)) / 6.0;
    triangles_.push_back({permuted(a), permuted(b), permuted(c)});
  }
  cells_ = static_cast<std::size_t>(std::clamp(std::sqrt(double(count)), 1.0, most_cells));
  corner_ = permuted(low_);
  cell_size_ = glm::max(permuted(size) / double(cells_), Vec3(std::numeric_limits<double>::min()));
  // By descending extent, and each cell's triangles in this order.
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Corners& t = triangles_[k];
    order.emplace_back(-std::max({t.a.z, t.b.z, t.c.z}), k);
  }
  std::ranges::sort(order);
  const auto each_cell = [&](std::uint32_t k, const auto& visit) {
    const Corners& t = triangles_[k];
    const Vec3 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
    const std::size_t last_i = cell(high.x, 0), first_j = cell(low.y, 1), last_j = cell(high.y, 1);
    for (std::size_t i = cell(low.x, 0); i <= last_i; ++i) {
      for (std::size_t j = first_j; j <= last_j; ++j) visit(i * cells_ + j);
    }
  };
  first_.assign(cells_ * cells_ + 1, 0);
  for (std::uint32_t k = 0; k < count; ++k) each_cell(k, [&](std::size_t at) { ++first_[at]; });
  // Ends of the cells, which filling from the back turns into their beginnings.
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  of_cell_.resize(first_.back());
  for (const auto& [top, k] : order | std::views::reverse) {
    each_cell(k, [&](std::size_t at) { of_cell_[--first_[at]] = k; });
  }
}

bool ClosedSurface::is_of(std::span<const Vec3> corners) const {
  bool same = corners.size() == 3 * triangles_.size();
  for (std::size_t k = 0; same && k < triangles_.size(); ++k) {
    const Corners& t = triangles_[k];
    same = t.a == permuted(corners[3 * k]) && t.b == permuted(corners[3 * k + 1]) &&
           t.c == permuted(corners[3 * k + 2]);
  }
  return same;
}

std::size_t ClosedSurface::cell(double x, int axis) const {
  const double index = (x - corner_[axis]) / cell_size_[axis];
  return static_cast<std::size_t>(std::clamp(index, 0.0, double(cells_ - 1)));
}

int ClosedSurface::winding(const Vec3& point) const {
  if (!may_wind(point, point)) return 0;
  const Vec3 p = permuted(point);
  const std::size_t at = cell(p.x, 0) * cells_ + cell(p.y, 1);
  int winding = 0;
  for (std::uint32_t k = first_[at]; k < first_[at + 1]; ++k) {
    const auto& [a, b, c] = triangles_[of_cell_[k]];
    if (std::max({a.z, b.z, c.z}) < p.z) break;  // so are all later triangles: none is beyond
    const int turns = crossing(a, b, p) + crossing(b, c, p) + crossing(c, a, p);
    if (turns == 0) continue;
    // Beyond the point along the axis: the point is behind an upward-winding face.
    if (turns * glm::dot(glm::cross(b - a, c - a), p - a) < 0.0) winding += turns;
  }
  return winding;
}

bool is_covered_by_faces(const scenes::CoincidentFaces& coincident, const Patches& patches,
                         std::uint32_t patch) {
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.is_cluster()) return false;  // clusters exclude such triangles
  const bool front = patches.is_back[patch] == 0;
  return coincident.is_covered(facet.triangle, front) ||
         (facet.parallelogram && coincident.is_covered(facet.triangle + 1, front));
}

void ClosedBodies::find_holes(const scenes::Scene& scene) {
  masks_ = scenes::OpacityMasks(scene);
  if (masks_.empty()) return;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (masks_.number(t) == scenes::unmasked) continue;
    const auto& v = scene.triangles[t].vertex;
    masked_.push_back({scene.vertices[v[0]] - centre_, scene.vertices[v[1]] - centre_,
                       scene.vertices[v[2]] - centre_});
  }
}

ClosedBodies::ClosedBodies(const scenes::Scene& scene, const Vec3& centre,
                           const ClosedBodies* earlier)
    : centre_(centre), coincident_(scene) {
  find_holes(scene);
  const ClosedParts parts = find_closed_parts(scene);
  std::vector<char> walls(parts.of.size(), 0);
  const std::map<std::uint32_t, std::vector<Vec3>> stoppers = find_stoppers(scene, parts);
  const auto is_solid = [&](std::uint32_t part) {
    return parts.closed[part] != 0 || stoppers.contains(part);
  };
  for (const auto& triangles : triangles_by_part(parts, is_solid)) {
    std::vector<Vec3> corners;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t v : scene.triangles[t].vertex) {
        corners.push_back(scene.vertices[v] - centre);
      }
    }
    if (const auto stopper = stoppers.find(parts.of[triangles.front()]);
        stopper != stoppers.end()) {
      for (const Vec3& p : stopper->second) corners.push_back(p - centre);
    }
    SharedSurface& surface = of_triangle_[triangles.front()];
    if (earlier != nullptr) {
      const auto known = earlier->of_triangle_.find(triangles.front());
      if (known != earlier->of_triangle_.end() && known->second->is_of(corners)) {
        surface = known->second;
      }
    }
    if (!surface) surface = std::make_shared<const ClosedSurface>(corners);
    const double least = least_volume_share * surface->box_m3();
    if (surface->volume_m3() > least) {
      bodies_.push_back({surface, {}});
    } else if (surface->volume_m3() < -least) {
      for (const std::uint32_t t : triangles) walls[t] = 1;
      cavities_.push_back(surface);
    }
  }
  for (Body& body : bodies_) {
    for (std::uint32_t c = 0; c < cavities_.size(); ++c) {
      if (cavities_[c]->lies_in_box_of(*body.surface)) body.cavities.push_back(c);
    }
  }
  leave_out_lit(scene);
  dark_outside_ = !cavities_.empty() && light_is_in_rooms(scene, parts.of, walls);
}

std::vector<scenes::Box> differing_bodies(const ClosedBodies& a, const ClosedBodies& b) {
  std::vector<scenes::Box> boxes;
  const auto surfaces_of = [](const ClosedBodies& all) {
    std::vector<const ClosedSurface*> found;
    for (const auto& body : all.bodies_) found.push_back(body.surface.get());
    for (const auto& cavity : all.cavities_) found.push_back(cavity.get());
    std::ranges::sort(found);
    return found;
  };
  std::vector<const ClosedSurface*> differ;
  std::ranges::set_symmetric_difference(surfaces_of(a), surfaces_of(b), std::back_inserter(differ));
  for (const ClosedSurface* surface : differ) {
    const auto [low, high] = surface->box();
    boxes.push_back({low + a.centre_, high + a.centre_});
  }
  return boxes;
}

// A lamp inside means light inside: the body is a room with inverted faces.
void ClosedBodies::leave_out_lit(const scenes::Scene& scene) {
  for (auto b = static_cast<std::uint32_t>(bodies_.size()); b-- > 0;) {
    const bool lit =
        std::any_of(scene.lamps.begin(), scene.lamps.end(), [&](const scenes::Lamp& lamp) {
          return !lamp.is_distant() &&
                 cover(lamp.position - centre_, std::span<const std::uint32_t>(&b, 1));
        });
    if (lit) bodies_.erase(bodies_.begin() + b);
  }
}

bool ClosedBodies::in_room(const Vec3& point) const {
  return std::any_of(cavities_.begin(), cavities_.end(),
                     [&](const SharedSurface& room) { return room->winding(point) < 0; });
}

// Whether the sky is dark, every lamp is in a room, and every emitting surface is connected with a
// room's wall or has a vertex in a room.
bool ClosedBodies::light_is_in_rooms(const scenes::Scene& scene,
                                     const std::vector<std::uint32_t>& part_of,
                                     const std::vector<char>& walls) const {
  if (scenes::has_light_outside(scene)) return false;
  for (const scenes::Lamp& lamp : scene.lamps) {
    if (!in_room(lamp.position - centre_)) return false;
  }
  std::vector<char> shines(part_of.size(), 0), inside(part_of.size(), 0);
  for (std::uint32_t t = 0; t < part_of.size(); ++t) {
    const scenes::Triangle& triangle = scene.triangles[t];
    if (scene.materials[triangle.material].emits()) shines[part_of[t]] = 1;
  }
  for (std::uint32_t t = 0; t < part_of.size(); ++t) {
    if (shines[part_of[t]] == 0 || inside[part_of[t]] != 0) continue;
    bool in = walls[t] != 0;
    for (const std::uint32_t v : scene.triangles[t].vertex) {
      in = in || in_room(scene.vertices[v] - centre_);
    }
    if (in) inside[part_of[t]] = 1;
  }
  return shines == inside;
}

std::vector<std::uint32_t> ClosedBodies::near(const Patches& patches, std::uint32_t patch,
                                              double margin_m) const {
  auto [low, high] = patches.box(patch);
  low -= centre_;
  high -= centre_;
  std::vector<std::uint32_t> found;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].surface->may_wind(low - margin_m, high + margin_m)) found.push_back(b);
  }
  if (dark_outside_) found.push_back(outside);
  const Facet& facet = patches.facets[patches.facet[patch]];
  if (facet.is_cluster() || (masks_.empty() && coincident_.empty())) return found;
  const bool front = patches.is_back[patch] == 0;
  for (std::uint32_t t = facet.triangle; t < facet.triangle + (facet.parallelogram ? 2U : 1U);
       ++t) {
    if (!masks_.empty() && masks_.number(t) != scenes::unmasked) {
      found.push_back(first_hole + masks_.number(t));
    }
    if (coincident_.is_covered(t, front)) found.push_back((front ? first_front : first_back) + t);
  }
  return found;
}

// The point lies just above the triangle: computes its barycentric coordinates.
bool ClosedBodies::in_hole(const Vec3& point, std::uint32_t number) const {
  const auto& [a, b, c] = masked_[number];
  const auto [u, v] = scenes::barycentric(point, a, b - a, c - a);
  constexpr double rounding = 1e-5;
  if (u < -rounding || v < -rounding || u + v > 1.0 + rounding) return false;  // other half
  return masks_.has_hole(number, u, v);
}

bool ClosedBodies::cover(const Vec3& point, std::span<const std::uint32_t> bodies) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](std::uint32_t b) {
    if (b == outside) return !in_room(point);
    if (b >= first_back) return coincident_.covers(b - first_back, false, point + centre_);
    if (b >= first_front) return coincident_.covers(b - first_front, true, point + centre_);
    if (b >= first_hole) return in_hole(point, b - first_hole);
    const Body& body = bodies_[b];
    return body.surface->winding(point) > 0 &&
           std::none_of(body.cavities.begin(), body.cavities.end(),
                        [&](std::uint32_t c) { return cavities_[c]->winding(point) < 0; });
  });
}

}  // namespace earthshine::radiosity
