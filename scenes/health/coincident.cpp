// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/coincident.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/free_memory.h"
#include "scenes/health/box_join.h"
#include "scenes/surface_offset.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

constexpr double parallel_sine = 1e-3;  // preliminary test; heights decide
constexpr double tie_share = 0.02;      // of the contact distance: rounding in the file
// Rays with a larger offset than coarse_m may miss a gap. Below narrow_gap offsets a gap is too
// narrow: at least 5 % of its height is skipped.
constexpr double coarse_m = 1e-5, narrow_gap = 20.0;
constexpr std::size_t asked_every = 1U << 20;  // pairs between two memory checks

struct Overlap {
  double area_m2, height_m;  // of the second over the first, along the first's normal
};

// A convex polygon in the plane of the first triangle: x and y along two of its axes, z the height
// of the second triangle's plane.
using Polygon = std::vector<Vec3>;

Polygon clipped(const Polygon& polygon, const Vec3& from, const Vec3& to) {
  const auto inside = [&](const Vec3& p) {
    return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
  };
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double at_p = inside(p), at_q = inside(q);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p >= 0.0) != (at_q >= 0.0)) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

std::optional<Overlap> overlap_of(const Corners& first, const Corners& second, double contact_m) {
  const Vec3 n = first.normal(), m = second.normal();
  const Vec3 across = glm::cross(n, m);
  if (glm::dot(across, across) > parallel_sine * parallel_sine * glm::dot(n, n) * glm::dot(m, m)) {
    return std::nullopt;
  }
  const base::Frame3 frame = base::frame_around(glm::normalize(n));
  const auto local = [&](const Vec3& p) {
    const Vec3 d = p - first.a;
    return Vec3(glm::dot(d, frame.tangent), glm::dot(d, frame.bitangent),
                glm::dot(d, frame.normal));
  };
  Polygon polygon{local(second.a), local(second.b), local(second.c)};
  const std::array<Vec3, 3> edges{Vec3(0.0), local(first.b), local(first.c)};
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    polygon = clipped(polygon, edges[k], edges[(k + 1) % 3]);
  }
  double twice_area = 0.0, perimeter = 0.0, height = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    if (std::abs(p.z) > contact_m) return std::nullopt;
    twice_area += p.x * q.y - p.y * q.x;
    perimeter += std::hypot(q.x - p.x, q.y - p.y);
    height += p.z / static_cast<double>(polygon.size());
  }
  const double area = 0.5 * std::abs(twice_area);
  if (area <= contact_m * perimeter) return std::nullopt;
  return Overlap{area, height};
}

class Coincidence {
 public:
  Coincidence(Scene& scene, const FaceParts& parts)
      : scene_(scene), parts_(parts), offsets_(scene), centre_(scene.vertices.front()) {}

  // Pairs with a triangle of an object that is moved; all pairs if none is.
  void find(const std::vector<bool>& is_moved = {}) {
    if (parts_.kind.size() < 2) return;
    is_moved_ = is_moved;
    Box around;  // the moved triangles
    for (std::uint32_t t = 0; !is_moved_.empty() && t < scene_.triangles.size(); ++t) {
      if (!concerns(t, t)) continue;
      const auto [low, high] = box_of(t);
      around.add(Vec3(low)), around.add(Vec3(high));
    }
    base::check_room(scene_.triangles.size() * 2 * sizeof(LabelledBox), scene_.path.string());
    std::vector<LabelledBox> boxes;
    boxes.reserve(scene_.triangles.size());
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      if (material(t).has_holes()) continue;
      const auto [low, high] = box_of(t);
      if (!is_moved_.empty() && !around.meets({Vec3(low), Vec3(high)})) continue;
      boxes.push_back({low, high, parts_.of[t], t});
    }
    join_boxes(std::move(boxes), [&](std::uint32_t a, std::uint32_t b) {
      if (concerns(a, b)) look_at(std::min(a, b), std::max(a, b));
    });
    std::sort(scene_.coincident.begin(), scene_.coincident.end(),
              [](const FacePair& p, const FacePair& q) {
                return std::tie(p.a, p.b) < std::tie(q.a, q.b);
              });
    say();
  }

 private:
  // The face with the higher rank lies on the other.
  struct Rank {
    bool shines;
    int open;  // 2 open; 1 room's wall, 0 body
    std::uint32_t triangle;
    auto operator<=>(const Rank&) const = default;
  };
  struct Gap {
    double height_m = 0.0, offset_m = 0.0;
    double away_m = 0.0;  // distance from the centre
  };
  // Areas decided by rank alone, m2.
  struct Decided {
    double over_m2 = 0.0, sides_m2 = 0.0;  // one on the other, back to back
  };

  // Slightly enlarged, so that neither a gap nor rounding separates two touching boxes.
  [[nodiscard]] std::pair<glm::vec3, glm::vec3> box_of(std::uint32_t t) const {
    const Corners p = corners_of(scene_, t);
    const double contact_m = reach_m(t);
    const Vec3 low = glm::min(p.a, glm::min(p.b, p.c)) - contact_m - centre_,
               high = glm::max(p.a, glm::max(p.b, p.c)) + contact_m - centre_;
    return {glm::vec3(low), glm::vec3(high)};
  }
  [[nodiscard]] const Material& material(std::uint32_t t) const {
    return scene_.materials[scene_.triangles[t].material];
  }
  [[nodiscard]] std::uint32_t object(std::uint32_t t) const { return scene_.triangles[t].object; }
  [[nodiscard]] FaceParts::Kind kind(std::uint32_t t) const { return parts_.kind[parts_.of[t]]; }
  [[nodiscard]] Rank rank(std::uint32_t t) const {
    const bool open = material(t).two_sided || kind(t) == FaceParts::Kind::Open;
    return {material(t).emits(), open ? 2 : kind(t) == FaceParts::Kind::Room ? 1 : 0, t};
  }

  [[nodiscard]] bool concerns(std::uint32_t a, std::uint32_t b) const {
    return is_moved_.empty() || is_moved_[object(a)] || is_moved_[object(b)];
  }

  void look_at(std::uint32_t a, std::uint32_t b) {
    const bool glass_a = material(a).lets_light_through(),
               glass_b = material(b).lets_light_through();
    if (glass_a && glass_b) return;
    const Corners first = corners_of(scene_, a), second = corners_of(scene_, b);
    const double contact_m = offsets_.contact(a, b);
    const std::optional<Overlap> overlap = overlap_of(first, second, contact_m);
    if (!overlap) return note_gap(a, b, first, second);
    if (glass_a || glass_b) {
      add({a, b, false, false});
      return;
    }
    const bool same_orientation = glm::dot(first.normal(), second.normal()) > 0.0;
    // House walls are seen from both sides, whichever face rounding puts in front.
    const bool wall = !same_orientation && !material(a).two_sided && !material(b).two_sided &&
                      (kind(a) == FaceParts::Kind::Body || kind(b) == FaceParts::Kind::Body) &&
                      !look_at_each_other(a, b);
    const bool tie = wall || std::abs(overlap->height_m) < tie_share * contact_m;
    const bool b_before = tie ? is_before(a, b, same_orientation) : overlap->height_m > 0.0;
    const bool a_before = same_orientation != b_before;
    add({a, b, b_before, a_before});
    const bool sheet = material(a).two_sided || material(b).two_sided;
    if (!tie || (a_before && b_before && !sheet) ||
        scene_.triangles[a].material == scene_.triangles[b].material) {
      return;
    }
    const Rank of_a = rank(a), of_b = rank(b);
    if (of_a.shines != of_b.shines || of_a.open < 2 || of_b.open < 2) return;
    const bool b_over = of_b > of_a;
    Decided& decided =
        decided_[b_over ? std::pair(object(a), object(b)) : std::pair(object(b), object(a))];
    (same_orientation || sheet ? decided.over_m2 : decided.sides_m2) += overlap->area_m2;
  }

  // Search distance for other faces around a triangle.
  [[nodiscard]] double reach_m(std::uint32_t t) const {
    return offsets_.of(t) > coarse_m ? narrow_gap * offsets_.of(t) : offsets_.contact(t);
  }

  // Records faces so close together that the offset of rays is a large part of their distance.
  void note_gap(std::uint32_t a, std::uint32_t b, const Corners& first, const Corners& second) {
    const double offset_m = std::max(offsets_.of(a), offsets_.of(b));
    if (offset_m <= coarse_m) return;
    const auto gap = overlap_of(first, second, narrow_gap * offset_m);
    if (!gap) return;
    Gap& widest = gaps_[std::minmax(object(a), object(b))];
    if (offset_m > widest.offset_m) {
      widest = {std::abs(gap->height_m), offset_m, glm::length(first.a - offsets_.centre())};
    }
  }

  void add(const FacePair& pair) {
    scene_.coincident.push_back(pair);
    if (scene_.coincident.size() % asked_every == 0) {
      base::check_room(scene_.coincident.size() * 2 * sizeof(FacePair), scene_.path.string());
    }
  }

  // Whether b is in front of a's front, if heights do not decide.
  [[nodiscard]] bool is_before(std::uint32_t a, std::uint32_t b, bool same_orientation) {
    const bool sheet_a = material(a).two_sided, sheet_b = material(b).two_sided;
    if (!same_orientation && !sheet_a && !sheet_b) return look_at_each_other(a, b);
    // The higher rank lies on the front of the other; or, if it has no black back, with its own
    // back on the other.
    if (rank(b) > rank(a)) return !sheet_a || sheet_b || same_orientation;
    const bool a_before_b = !sheet_b || sheet_a || same_orientation;
    return same_orientation ? !a_before_b : a_before_b;
  }

  [[nodiscard]] bool look_at_each_other(std::uint32_t a, std::uint32_t b) {
    using Kind = FaceParts::Kind;
    if (kind(b) == Kind::Body) std::swap(a, b);
    if (kind(a) != Kind::Body) return false;
    if (kind(b) == Kind::Body) return true;
    // The walls of a house form a body with its contents inside. An object on or in a body extends
    // beyond it.
    const auto &house = part_box(parts_.of[a]), &other = part_box(parts_.of[b]);
    const glm::vec3 reach(static_cast<float>(4.0 * offsets_.contact(a, b)));
    return glm::any(glm::lessThan(other.first, house.first - reach)) ||
           glm::any(glm::greaterThan(other.second, house.second + reach));
  }

  const std::pair<glm::vec3, glm::vec3>& part_box(std::uint32_t part) {
    if (part_boxes_.empty()) {
      const glm::vec3 far(std::numeric_limits<float>::infinity());
      part_boxes_.assign(parts_.kind.size(), {far, -far});
      for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
        const auto [low, high] = box_of(t);
        auto& box = part_boxes_[parts_.of[t]];
        box = {glm::min(box.first, low), glm::max(box.second, high)};
      }
    }
    return part_boxes_[part];
  }

  void say() {
    for (const auto& [objects, gap] : gaps_) {
      scene_.warnings.push_back(fmt::format(
          "faces of {} and {} are {:.2g} m apart, {:.3g} m from the scene's centre of detail, "
          "where "
          "single precision makes rays start {:.2g} m off surfaces: light and shadow between them "
          "are wrong. Leave out distant objects, or render them as a separate scene",
          in_quotes(scene_.objects[objects.first].name),
          in_quotes(scene_.objects[objects.second].name), gap.height_m, gap.away_m, gap.offset_m));
    }
    for (const auto& [objects, decided] : decided_) {
      if (scene_.objects[objects.first].orient == Orient::AsIs ||
          scene_.objects[objects.second].orient == Orient::AsIs) {
        continue;
      }
      const std::string under = in_quotes(scene_.objects[objects.first].name),
                        over = in_quotes(scene_.objects[objects.second].name);
      if (decided.over_m2 > 0.0) {
        scene_.warnings.push_back(fmt::format(
            "objects {} and {}: {:.3g} m2 of their faces lie in one plane on each other; those of "
            "{} are seen. Where that is wrong, move one by some 0.1 mm",
            under, over, decided.over_m2, over));
      }
      if (decided.sides_m2 > 0.0) {
        scene_.warnings.push_back(
            fmt::format("objects {} and {}: {:.3g} m2 of their faces lie back to back; each is "
                        "seen from its front",
                        under, over, decided.sides_m2));
      }
    }
  }

  Scene& scene_;
  const FaceParts& parts_;
  SurfaceOffsets offsets_;
  Vec3 centre_;  // origin of single-precision coordinates
  std::vector<bool> is_moved_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Gap> gaps_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Decided> decided_;  // objects: below, above
  std::vector<std::pair<glm::vec3, glm::vec3>> part_boxes_;
};

}  // namespace

void add_instances(FaceParts& parts, const Scene& scene) {
  for (const Object& object : scene.objects) {
    if (!object.instance) continue;
    const Object& original = scene.objects[object.instance->object];
    const std::uint32_t from = parts.of[original.first_triangle];
    const auto first = static_cast<std::uint32_t>(parts.kind.size());
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      const std::uint32_t part = parts.of[original.first_triangle + t] - from;
      if (first + part == parts.kind.size()) parts.kind.push_back(parts.kind[from + part]);
      parts.of.push_back(first + part);
    }
  }
}

void find_coincident_faces(Scene& scene, const FaceParts& parts) {
  if (scene.triangles.empty()) return;
  Coincidence(scene, parts).find();
}

void find_coincident_faces_again(Scene& scene, const std::vector<bool>& is_moved) {
  if (scene.triangles.empty() || std::ranges::find(is_moved, true) == is_moved.end()) return;
  std::vector<std::string> said = scene.warnings;
  std::erase_if(scene.coincident, [&](const FacePair& pair) {
    return is_moved[scene.triangles[pair.a].object] || is_moved[scene.triangles[pair.b].object];
  });
  Coincidence(scene, *scene.face_parts).find(is_moved);
  scene.warnings = std::move(said);
}

}  // namespace earthshine::scenes
