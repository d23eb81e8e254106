// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/pairs.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "base/parallel.h"
#include "radiosity/exact/hidden_factor.h"
#include "radiosity/exact/occlusion/convex_bodies.h"
#include "radiosity/exact/polygon/polygon_factor.h"

namespace earthshine::radiosity {
namespace {

struct PairError {
  std::uint32_t i, j;
  double error_m2;
};

// Some patches of one side against all patches of another.
struct Work {
  std::uint32_t first, second;  // sides
  std::uint32_t begin, end;     // patches of the first side
  PairCounts counts;
  std::vector<PairError> errors;
};

constexpr std::uint32_t patches_per_work = 64;

std::vector<Work> share_out(const FacetSides& sides) {
  std::vector<Work> works;
  for (std::uint32_t p = 0; p < sides.sides.size(); ++p) {
    const Side& side = sides.sides[p];
    for (std::uint32_t q = p + 1; q < sides.sides.size(); ++q) {
      for (std::uint32_t k = 0; k < side.patch_count; k += patches_per_work) {
        const std::uint32_t begin = side.first_patch + k;
        const std::uint32_t end =
            side.first_patch + std::min(k + patches_per_work, side.patch_count);
        works.push_back({p, q, begin, end, {}, {}});
      }
    }
  }
  return works;
}

// Extent of a blocker's shadows on the plane h = 0 for all points of the receiver: the hull of the
// shadows of its corners. All in the plane's frame.
Extent shadow_cover(const ConvexPolygon& blocker, const ConvexPolygon& receiver) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Extent cover{far, -far, far, -far};
  for (int k = 0; k < receiver.count; ++k) {
    const Vec3& from = receiver[k];
    for (int j = 0; j < blocker.count; ++j) {
      const Vec3& through = blocker[j];
      const double drop = from.z - through.z;
      if (drop <= 1e-9 * from.z) return {-far, far, -far, far};
      const double u = (through.x * from.z - from.x * through.z) / drop;
      const double v = (through.y * from.z - from.y * through.z) / drop;
      cover = {std::min(cover.u0, u), std::max(cover.u1, u), std::min(cover.v0, v),
               std::max(cover.v1, v)};
    }
  }
  return cover;
}

// A unit of work with its memory, reused for later units.
class Worker {
 public:
  void run(const FacetSides& sides, std::span<const PatchCover> covers, double tolerance,
           Work& work, PairExchange& out) {
    const Side& first = sides.sides[work.first];
    const Side& second = sides.sides[work.second];
    margin_m_ = sides.margin_m;
    if (!face_each_other(first, second)) {
      work.counts.facing_away += std::uint64_t{work.end - work.begin} * second.patch_count;
      return;
    }
    find_blockers(sides, first, second);
    for (std::uint32_t i = work.begin; i < work.end; ++i) {
      const ConvexPolygon* a =
          in_front(sides.shapes[i].polygon, second, cut_first_, clipped_first_);
      if (a == nullptr) {
        work.counts.facing_away += second.patch_count;
        continue;
      }
      narrow_blockers(*a, second);
      for (std::uint32_t k = 0; k < second.patch_count; ++k) {
        const std::uint32_t j = second.first_patch + k;
        const ConvexPolygon* b =
            in_front(sides.shapes[j].polygon, first, cut_second_, clipped_second_);
        if (b == nullptr) {
          ++work.counts.facing_away;
          continue;
        }
        find_between(sides.shapes[j].cover);
        HiddenExchange found;
        if (covers.empty() || (covers[i].is_whole() && covers[j].is_whole())) {
          found = exchange(*a, *b, unoccluded(sides, sides.shapes[i], *a, sides.shapes[j], *b),
                           tolerance);
        } else {
          found = exchange_of_parts(first, covers[i], *a, second, covers[j], *b, tolerance);
        }
        store(found, i, j, work, out);
      }
    }
  }

 private:
  bool face_each_other(const Side& first, const Side& second) {
    if (first.facet == second.facet) return false;
    const Plane of_first{first.polygon[0], first.polygon.normal};
    const Plane of_second{second.polygon[0], second.polygon.normal};
    front_first_ = clip(first.polygon, of_second, margin_m_);
    front_second_ = clip(second.polygon, of_first, margin_m_);
    cut_first_ = cut_off(first.polygon, of_second);
    cut_second_ = cut_off(second.polygon, of_first);
    return front_first_.count >= 3 && front_second_.count >= 3;
  }

  [[nodiscard]] bool cut_off(const ConvexPolygon& polygon, const Plane& plane) const {
    for (int k = 0; k < polygon.count; ++k) {
      if (plane.height(polygon[k]) < -margin_m_) return true;
    }
    return false;
  }

  // The part of the patch in front of the other side's plane; nullptr if there is none.
  const ConvexPolygon* in_front(const ConvexPolygon& polygon, const Side& other, bool cut,
                                ConvexPolygon& room) const {
    if (!cut) return &polygon;
    room = clip(polygon, {other.polygon[0], other.polygon.normal}, margin_m_);
    return room.count >= 3 ? &room : nullptr;
  }

  void find_blockers(const FacetSides& sides, const Side& first, const Side& second) {
    blockers_.clear();
    const Box one = box_around(front_first_), two = box_around(front_second_);
    const Box both{glm::min(one.low, two.low), glm::max(one.high, two.high)};
    const Shaft shaft(front_first_, front_second_, margin_m_);
    std::uint32_t last_body = no_body;
    bool is_whole = false;
    for (const std::uint32_t f : sides.hiding) {
      if (f == first.facet || f == second.facet || !both.meets(sides.blocker_box[f], margin_m_)) {
        continue;
      }
      ConvexPolygon part =
          clip(sides.blockers[f], {first.polygon[0], first.polygon.normal}, margin_m_);
      if (part.count < 3) continue;
      part = clip(part, {second.polygon[0], second.polygon.normal}, margin_m_);
      if (part.count < 3 || !shaft.may_hide(part)) continue;
      const std::uint32_t number = sides.bodies.of_polygon[f];
      if (number == no_body) {
        blockers_.push_back({part});
        continue;
      }
      const ConvexBody& body = sides.bodies.bodies[number];
      if (number != last_body) {
        last_body = number;
        is_whole = body.is_before({first.polygon[0], first.polygon.normal}, margin_m_) &&
                   body.is_before({second.polygon[0], second.polygon.normal}, margin_m_);
      }
      blockers_.push_back({part, &body, is_whole});
    }
  }

  // Selects blockers between one patch and the other side, with the extents of their shadows.
  void narrow_blockers(const ConvexPolygon& patch, const Side& second) {
    narrow_.clear();
    covers_.clear();
    if (blockers_.empty()) return;
    const Shaft shaft(patch, front_second_, margin_m_);
    const TargetFrame frame(second.polygon);
    const ConvexPolygon seen = frame.polygon(patch);
    for (const Blocker& blocker : blockers_) {
      if (!shaft.may_hide(blocker.shape)) continue;
      narrow_.push_back(&blocker);
      covers_.push_back(shadow_cover(frame.polygon(blocker.shape), seen));
    }
  }

  void find_between(const Extent& target) {
    between_.clear();
    for (std::size_t k = 0; k < narrow_.size(); ++k) {
      if (covers_[k].meets(target)) between_.push_back(narrow_[k]);
    }
  }

  // Exchange of polygons in front of each other, with the blockers of between_ that may occlude.
  HiddenExchange exchange(const ConvexPolygon& a, const ConvexPolygon& b, double unoccluded_m2,
                          double tolerance) {
    here_.clear();
    if (!between_.empty()) {
      const Shaft shaft(a, b, margin_m_);
      std::copy_if(between_.begin(), between_.end(), std::back_inserter(here_),
                   [&](const Blocker* k) { return shaft.may_hide(k->shape); });
    }
    if (here_.empty()) return {.exchange_m2 = unoccluded_m2, .any_visible = true};
    return hidden_.exchange(a, b, here_, unoccluded_m2,
                            tolerance * std::min(area_m2(a), area_m2(b)), margin_m_);
  }

  // Between the open parts of both patches.
  HiddenExchange exchange_of_parts(const Side& first, const PatchCover& cover_a,
                                   const ConvexPolygon& a, const Side& second,
                                   const PatchCover& cover_b, const ConvexPolygon& b,
                                   double tolerance) {
    const auto parts = [](const PatchCover& cover, const ConvexPolygon& whole) {
      return cover.is_whole() ? std::span<const ConvexPolygon>(&whole, 1)
                              : std::span<const ConvexPolygon>(cover.parts);
    };
    const auto of_a = parts(cover_a, a), of_b = parts(cover_b, b);
    HiddenExchange sum;
    ConvexPolygon clipped_a, clipped_b;
    for (const ConvexPolygon& whole_a : of_a) {
      const ConvexPolygon* part_a = in_front(whole_a, second, cut_first_, clipped_a);
      if (part_a == nullptr) continue;
      for (const ConvexPolygon& whole_b : of_b) {
        const ConvexPolygon* part_b = in_front(whole_b, first, cut_second_, clipped_b);
        if (part_b == nullptr) continue;
        const HiddenExchange found =
            exchange(*part_a, *part_b, exchange_m2(*part_a, *part_b, margin_m_),
                     tolerance / double(std::min(of_a.size(), of_b.size())));
        sum.exchange_m2 += found.exchange_m2;
        sum.error_m2 += found.error_m2;
        sum.any_hidden = sum.any_hidden || found.any_hidden;
        sum.any_visible = sum.any_visible || found.any_visible;
        sum.points += found.points;
      }
    }
    return sum;
  }

  static void store(const HiddenExchange& found, std::uint32_t i, std::uint32_t j, Work& work,
                    PairExchange& out) {
    work.counts.points += static_cast<std::uint64_t>(found.points);
    ++(found.any_visible ? found.any_hidden ? work.counts.partly_hidden : work.counts.unoccluded
                         : work.counts.wholly_hidden);
    if (found.error_m2 > 0.0) work.errors.push_back({i, j, found.error_m2});
    out.upper_m2[out.index(i, j)] = found.exchange_m2;
  }

  double unoccluded(const FacetSides& sides, const PatchShape& from, const ConvexPolygon& a,
                    const PatchShape& to, const ConvexPolygon& b) const {
    if (!cut_first_ && !cut_second_) {
      const double separation =
          glm::length(from.ball.centre - to.ball.centre) / (from.ball.radius + to.ball.radius);
      if (const int order = area_order(separation); order > 0) {
        return area_exchange_m2(sides.points_of(from, order), a.normal, sides.points_of(to, order),
                                b.normal);
      }
    }
    return exchange_m2(a, b, margin_m_);
  }

  ConvexPolygon front_first_, front_second_, clipped_first_, clipped_second_;
  bool cut_first_ = false, cut_second_ = false;
  std::vector<Blocker> blockers_;
  std::vector<const Blocker*> narrow_, between_, here_;
  std::vector<Extent> covers_;
  HiddenFactor hidden_;
  double margin_m_ = 0.0;
};

}  // namespace

PairExchange exchange_of_pairs(const Patches& patches, const FacetSides& sides,
                               std::span<const PatchCover> covers, double tolerance) {
  PairExchange result;
  result.count = patches.count();
  result.row_square_error.assign(result.count, 0.0);
  if (result.count < 2) return result;
  result.upper_m2.assign(result.count * (result.count - 1) / 2, 0.0);
  std::vector<Work> works = share_out(sides);
  base::parallel_chunks(works.size(), 1, [&](std::size_t begin, std::size_t end) {
    thread_local Worker worker;
    for (std::size_t k = begin; k < end; ++k)
      worker.run(sides, covers, tolerance, works[k], result);
  });
  for (const Side& side : sides.sides) {
    result.counts.facing_away += std::uint64_t{side.patch_count} * (side.patch_count - 1) / 2;
  }
  for (const Work& work : works) {
    result.counts.facing_away += work.counts.facing_away;
    result.counts.unoccluded += work.counts.unoccluded;
    result.counts.partly_hidden += work.counts.partly_hidden;
    result.counts.wholly_hidden += work.counts.wholly_hidden;
    result.counts.points += work.counts.points;
    for (const PairError& e : work.errors) {
      const auto square = [&](std::uint32_t k) {
        const double share = e.error_m2 / patches.area_m2[k];
        return share * share;
      };
      result.row_square_error[e.i] += square(e.i);
      result.row_square_error[e.j] += square(e.j);
    }
  }
  return result;
}

}  // namespace earthshine::radiosity
