// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/orienter.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Solid angles: a point on a face, an edge or a corner sees some, a point outside 0, a point
// strictly inside 4 pi.
constexpr double on_it = 0.1;
constexpr double strictly_inside = 4.0 * base::pi - 0.1;
// Number of triangles of another part that are tested.
constexpr std::size_t faces_probed = 8;
constexpr double wide = 8.0;  // times the median width of the parts

}  // namespace

Orienter::Parts& Orienter::parts_of(std::size_t object) {
  const auto [entry, fresh] = parts_.try_emplace(object);
  Parts& parts = entry->second;
  if (!fresh) return parts;
  parts.all = surface_parts(scene_, scene_.objects[object], ids_);
  std::vector<double> widths;
  for (const SurfacePart& part : parts.all) widths.push_back(part.high.x - part.low.x);
  std::vector<double> sorted = widths;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double limit = wide * sorted[sorted.size() / 2];
  for (std::uint32_t p = 0; p < parts.all.size(); ++p) {
    if (widths[p] > limit) {
      parts.wide.push_back(p);
    } else {
      parts.by_low_x.push_back(p);
      parts.width_m = std::max(parts.width_m, widths[p]);
    }
  }
  std::sort(parts.by_low_x.begin(), parts.by_low_x.end(), [&](std::uint32_t a, std::uint32_t b) {
    return parts.all[a].low.x < parts.all[b].low.x;
  });
  return parts;
}

FaceParts Orienter::parts() {
  FaceParts found;
  found.of.resize(scene_.triangles.size());
  for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
    SurfaceHealth& health = scene_.objects[o].surface;
    health = {};
    for (const SurfacePart& part : parts_of(o).all) {
      ++health.parts;
      health.open_edges += part.open_edges;
      health.non_manifold_edges += part.crowded_edges;
      health.mixed_edges += part.mixed_edges;
      if (part.closed()) ++health.closed_parts;
      const bool inward = part.is_body() && part.volume_m3 < 0.0;
      if (inward) ++health.inward_parts;
      const auto number = static_cast<std::uint32_t>(found.kind.size());
      for (const std::uint32_t t : part.triangles) found.of[t] = number;
      found.kind.push_back(!part.is_body() || part.mixed_edges > 0 ? FaceParts::Kind::Open
                           : inward                                ? FaceParts::Kind::Room
                                                                   : FaceParts::Kind::Body);
    }
  }
  return found;
}

void Orienter::orient_all(bool bodies_alone) {
  for (std::size_t o = 0; o < scene_.objects.size(); ++o) orient(o, bodies_alone);
}

void Orienter::orient(std::size_t number, bool bodies_alone) {
  const Object& object = scene_.objects[number];
  if (object.orient == Orient::AsIs || object.orient == Orient::TwoSided) return;
  const std::size_t count = parts_of(number).all.size();
  Counts counts;
  for (std::size_t p = 0; p < count; ++p) {
    SurfacePart& part = parts_of(number).all[p];
    if (bodies_alone && !part.is_body()) continue;
    if (all_two_sided(part)) continue;  // no side of it is black
    if (!part.orientable) {
      ++counts.one_sided;
      continue;
    }
    if (object.orient != Orient::Mended) {
      const bool cavity = object.orient == Orient::Outward && is_cavity(number, p);
      if (!cavity) flip_as_given(part, object.orient, counts);
      continue;
    }
    const Front front = front_by_normals(part);
    const bool against = front == Front::Opposite;
    if (!part.is_body()) {
      if (front == Front::Unknown) {
        counts.mixed_edges += part.mixed_edges;
        if (part.mixed_edges > 0) counts.seen_inside += seen_from_inside(part);
      } else if (against || part.mixed_edges > 0) {
        counts.by_normals += flip(part, against);
      }
      continue;
    }
    const bool inward = part.volume_m3 < 0.0;
    if (!inward && !against && part.mixed_edges == 0) continue;
    if (is_cavity(number, p)) continue;
    const Inside inside = contents_of(number, p);
    if (inside == Inside::Nothing) {
      if (inward || part.mixed_edges > 0) tally(part, flip(part, inward), counts);
    } else if (front != Front::Unknown) {
      if (against || part.mixed_edges > 0) counts.by_normals += flip(part, against);
    } else if (part.mixed_edges > 0) {
      // A part around a camera is a room; around other objects most of the area decides.
      const bool keeps_side = inside == Inside::Things || inward;
      tally(part, flip(part, !keeps_side), counts);
    }
  }
  say(object, counts);
}

// Orients by "outward" or "inward". A flat part has neither side; its faces get equal orientation.
void Orienter::flip_as_given(SurfacePart& part, Orient word, Counts& counts) {
  const double edge = glm::length(part.high - part.low);
  const double volume = part.closed() ? part.volume_m3 : cup_volume(part);
  const bool flat = std::abs(volume) <= SurfacePart::flat_share * edge * edge * edge;
  const bool all = !flat && (volume < 0.0) == (word == Orient::Outward);
  if (all || part.mixed_edges > 0) tally(part, flip(part, all), counts);
}

void Orienter::tally(const SurfacePart& part, std::size_t flipped, Counts& counts) {
  if (flipped == part.triangles.size()) {
    ++counts.bodies;
  } else {
    counts.triangles += flipped;
  }
}

Orienter::Front Orienter::front_by_normals(const SurfacePart& part) const {
  constexpr double most = 0.5, nearly_all = 0.95;
  double all = 0.0, along = 0.0, against = 0.0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const std::uint32_t t = part.triangles[k];
    const Vec3 normal = (part.flipped[k] != 0 ? -1.0 : 1.0) * corners_of(scene_, t).normal();
    const double area = glm::length(normal);
    const double side = glm::dot(normal, fronts_.of(scene_.triangles[t].polygon));
    all += area;
    if (side > 0.0) along += area;
    if (side < 0.0) against += area;
  }
  const double said = along + against;
  if (said < most * all || std::max(along, against) < nearly_all * said) return Front::Unknown;
  return along > against ? Front::Oriented : Front::Opposite;
}

// Sum of the solid angles of its faces, positive if the inside is visible.
double Orienter::seen_from_inside(const SurfacePart& part) const {
  const double outward = cup_volume(part) < 0.0 ? -1.0 : 1.0;
  double sum = 0.0;
  for (const Camera& camera : scene_.cameras) {
    for (std::size_t k = 0; k < part.triangles.size(); ++k) {
      const Corners at = corners_of(scene_, part.triangles[k]).seen_from(camera.position);
      sum += (part.flipped[k] != 0 ? -outward : outward) * at.solid_angle();
    }
  }
  return sum;
}

std::size_t Orienter::flip(SurfacePart& part, bool all) {
  std::size_t flipped = 0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    if ((part.flipped[k] != 0) == all) continue;
    auto& vertex = scene_.triangles[part.triangles[k]].vertex;
    std::swap(vertex[1], vertex[2]);
    ++flipped;
  }
  keep_parallelograms(part, all);
  // Later tests use the new orientation.
  if (all) part.volume_m3 = -part.volume_m3;
  std::fill(part.flipped.begin(), part.flipped.end(), char{0});
  part.mixed_edges = 0;
  return flipped;
}

// (0,1,2), (0,2,3) of a parallelogram became (0,2,1), (0,3,2); restores the order.
void Orienter::keep_parallelograms(const SurfacePart& part, bool all) {
  const auto is_flipped = [&](std::size_t k) { return (part.flipped[k] != 0) != all; };
  auto& triangles = scene_.triangles;
  for (std::size_t k = 0; k + 1 < part.triangles.size(); ++k) {
    const std::uint32_t t = part.triangles[k];
    const auto same = [&](std::uint32_t other) {
      return other < triangles.size() && triangles[other].polygon == triangles[t].polygon;
    };
    if (!is_flipped(k) || !is_flipped(k + 1) || part.triangles[k + 1] != t + 1) continue;
    if (same(t + 1) && !same(t + 2) && !(t > 0 && same(t - 1))) {
      std::swap(triangles[t], triangles[t + 1]);
    }
  }
}

template <class Holds>
bool Orienter::Parts::any_beside(const SurfacePart& part, Holds holds) const {
  const auto from = std::lower_bound(by_low_x.begin(), by_low_x.end(), part.low.x - width_m,
                                     [&](std::uint32_t q, double x) { return all[q].low.x < x; });
  for (auto q = from; q != by_low_x.end() && all[*q].low.x <= part.high.x; ++q) {
    if (holds(*q)) return true;
  }
  return std::any_of(wide.begin(), wide.end(), holds);
}

Orienter::Inside Orienter::contents_of(std::size_t number, std::size_t p) {
  const SurfacePart& part = parts_of(number).all[p];
  for (const Camera& camera : scene_.cameras) {
    if (solid_angle_of(scene_, part, camera.position) > on_it) return Inside::Camera;
  }
  for (const Lamp& lamp : scene_.lamps) {
    if (lamp.is_distant()) continue;
    if (solid_angle_of(scene_, part, lamp.position) > on_it) return Inside::Things;
  }
  if (is_window_or_lamp_in_part(part)) return Inside::Things;
  for (std::size_t o = 0; o < scene_.objects.size(); ++o) {
    if (o == number) continue;
    const Object& other = scene_.objects[o];
    for (std::size_t k = 0; k < faces_probed; ++k) {
      const auto step = static_cast<std::uint32_t>(k * other.triangle_count / faces_probed);
      if (solid_angle_of(scene_, part, middle_of(other.first_triangle + step)) > strictly_inside) {
        return Inside::Things;
      }
    }
  }
  const Parts& parts = parts_of(number);
  const auto holds = [&](std::uint32_t q) { return q != p && stands_in(part, parts.all[q]); };
  return parts.any_beside(part, holds) ? Inside::Things : Inside::Nothing;
}

// Whether it lies in an outward body of the same object.
bool Orienter::is_cavity(std::size_t number, std::size_t p) {
  const Parts& parts = parts_of(number);
  const SurfacePart& part = parts.all[p];
  const auto holds = [&](std::uint32_t q) {
    const SurfacePart& outer = parts.all[q];
    return q != p && outer.is_body() && outer.volume_m3 > 0.0 && stands_in(outer, part);
  };
  return parts.any_beside(part, holds);
}

bool Orienter::stands_in(const SurfacePart& outer, const SurfacePart& inner) const {
  if (glm::any(glm::lessThan(inner.high, outer.low)) ||
      glm::any(glm::greaterThan(inner.low, outer.high))) {
    return false;
  }
  for (std::size_t k = 0; k < faces_probed; ++k) {
    const std::uint32_t triangle = inner.triangles[k * inner.triangles.size() / faces_probed];
    if (solid_angle_of(scene_, outer, middle_of(triangle)) > strictly_inside) return true;
  }
  return false;
}

// Signed volume of the pyramids from the middle of its box: an open part is outward if positive.
double Orienter::cup_volume(const SurfacePart& part) const {
  const Vec3 middle = 0.5 * (part.low + part.high);
  double volume = 0.0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const Corners at = corners_of(scene_, part.triangles[k]).seen_from(middle);
    volume += (part.flipped[k] != 0 ? -1.0 : 1.0) * at.triple_product() / 6.0;
  }
  return volume;
}

Vec3 Orienter::middle_of(std::uint32_t triangle) const {
  const auto [a, b, c] = corners_of(scene_, triangle);
  return (a + b + c) / 3.0;
}

bool Orienter::all_two_sided(const SurfacePart& part) const {
  return std::all_of(part.triangles.begin(), part.triangles.end(), [&](std::uint32_t t) {
    return scene_.materials[scene_.triangles[t].material].two_sided;
  });
}

// A window in a wall or an emitting ceiling makes a closed part a room; a body completely of glass
// or completely emitting is none.
bool Orienter::is_window_or_lamp_in_part(const SurfacePart& part) const {
  std::size_t some = 0;
  for (const std::uint32_t t : part.triangles) {
    const Material& material = scene_.materials[scene_.triangles[t].material];
    if (material.emits() || material.lets_light_through()) ++some;
  }
  return some > 0 && some < part.triangles.size();
}

void Orienter::say(const Object& object, const Counts& counts) {
  const std::string name = in_quotes(object.name);
  auto& warnings = scene_.warnings;
  if (counts.bodies > 0) {
    const std::string surfaces =
        counts.bodies == 1 ? "a surface was" : fmt::format("{} surfaces were", counts.bodies);
    warnings.push_back(
        object.orient == Orient::Inward
            ? fmt::format("object {}: {} turned inward, as orient says", name, surfaces)
            : fmt::format("object {}: {} inside out, turned outward; where it is a room, say "
                          "orient = \"as-is\"",
                          name, surfaces));
  }
  if (counts.triangles > 0) {
    warnings.push_back(
        fmt::format("object {}: {} of {} triangles were wound against their neighbours, turned; "
                    "orient = \"as-is\" leaves them",
                    name, counts.triangles, object.triangle_count));
  }
  if (counts.by_normals > 0) {
    warnings.push_back(
        fmt::format("object {}: {} of {} triangles were wound against the file's vertex normals, "
                    "whose side is the front; turned. orient = \"as-is\" leaves them",
                    name, counts.by_normals, object.triangle_count));
  }
  if (counts.mixed_edges > 0) {
    // Fronts should face the cameras.
    const char* const sides = counts.seen_inside > 0.0   ? "\"inward\", the side that cameras see,"
                              : counts.seen_inside < 0.0 ? "\"outward\", the side that cameras see,"
                                                         : "\"inward\", \"outward\"";
    warnings.push_back(fmt::format(
        "object {}: at {} of its surfaces the faces on both sides are wound against each other; "
        "backs are black. Say orient = {} or \"two-sided\", or \"as-is\"",
        name, counts.mixed_edges == 1 ? "an edge" : fmt::format("{} edges", counts.mixed_edges),
        sides));
  }
  if (counts.one_sided > 0) {
    warnings.push_back(fmt::format(
        "object {}: {} like a Moebius strip, without two sides; backs are black. Say orient = "
        "\"two-sided\", or \"as-is\"",
        name,
        counts.one_sided == 1 ? "a surface is" : fmt::format("{} surfaces are", counts.one_sided)));
  }
}

}  // namespace earthshine::scenes
