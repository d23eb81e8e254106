// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/emitters.h"

#include <algorithm>
#include <cmath>

#include "scenes/light/solid_angle.h"
#include "scenes/ray_query.h"
#include "scenes/reflect/brdf.h"
#include "scenes/surface_texture.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

using base::pi;

constexpr double near_sizes = 3.0;  // solid-angle sampling up to this times the longest edge

bool is_rectangle(const FlatEmitter& emitter) {
  return emitter.shape == FlatShape::Parallelogram &&
         std::abs(glm::dot(emitter.edge1, emitter.edge2)) <=
             1e-6 * glm::length(emitter.edge1) * glm::length(emitter.edge2);
}

// Merges `first` and `second` into a rectangle if they are its halves (0,1,2) and (0,2,3).
bool merge_halves(FlatEmitter& first, const FlatEmitter& second) {
  const Vec3 gap = first.corner + first.edge2 - (second.corner + second.edge1);
  const Vec3 side = first.edge1 + second.edge2 - second.edge1;
  const double tolerance = 1e-6 * (glm::length(first.edge1) + glm::length(second.edge2));
  if (first.shape != FlatShape::Triangle || first.corner != second.corner ||
      glm::length(gap) > tolerance || glm::length(side) > tolerance) {
    return false;
  }
  FlatEmitter both = first;
  both.edge2 = second.edge2;
  both.area_m2 += second.area_m2;
  both.offset_m = std::max(both.offset_m, second.offset_m);
  both.shape = FlatShape::Parallelogram;
  if (!is_rectangle(both)) return false;
  first = both;
  return true;
}

LightBounds bounds_of(const FlatEmitter& emitter) {
  LightBounds bounds;
  const Vec3& a = emitter.corner;
  const Vec3 b = a + emitter.edge1, c = a + emitter.edge2;
  bounds.low = glm::min(a, glm::min(b, c));
  bounds.high = glm::max(a, glm::max(b, c));
  if (emitter.shape == FlatShape::Parallelogram) {
    bounds.low = glm::min(bounds.low, b + emitter.edge2);
    bounds.high = glm::max(bounds.high, b + emitter.edge2);
  }
  bounds.intensity_cd = base::max_component(emitter.exitance) * emitter.area_m2 / pi;
  bounds.axis = emitter.normal;
  bounds.falls_by_cosine = !emitter.two_sided;
  bounds.reach_rad = emitter.two_sided ? pi : pi / 2;
  return bounds;
}

}  // namespace

Vec3 point_on(const FlatEmitter& emitter, double u, double v) {
  if (emitter.shape == FlatShape::Parallelogram) {
    return emitter.corner + u * emitter.edge1 + v * emitter.edge2;
  }
  const double root = std::sqrt(u);
  return emitter.corner + root * ((1.0 - v) * emitter.edge1 + v * emitter.edge2);
}

LightSample toward_area(const Vec3& point, const Vec3& on_source, const Vec3& normal,
                        bool two_sided, const Rgb& exitance, double area_m2) {
  LightSample sample;
  const Vec3 offset = on_source - point;
  const double distance2 = glm::dot(offset, offset);
  if (distance2 <= 0.0) return sample;
  sample.distance_m = std::sqrt(distance2);
  sample.direction = offset / sample.distance_m;
  double cosine = -glm::dot(sample.direction, normal);
  if (two_sided) cosine = std::abs(cosine);
  if (cosine > 0.0) sample.normal_illuminance_lx = exitance * (cosine * area_m2 / (pi * distance2));
  return sample;
}

LightSample sample_flat(const FlatEmitter& emitter, const Vec3& point, double u, double v,
                        Spread spread) {
  const Vec3 offset = emitter.corner - point;
  const double longest2 =
      std::max(glm::dot(emitter.edge1, emitter.edge1), glm::dot(emitter.edge2, emitter.edge2));
  const double height = -glm::dot(offset, emitter.normal);  // of the point over the front
  const bool is_near = glm::dot(offset, offset) < near_sizes * near_sizes * longest2;
  // In its own plane the emitter is invisible, and the solid-angle formulas break down.
  const bool beside = std::abs(height) < 1e-7 * std::sqrt(longest2);
  const bool has_formula = emitter.shape == FlatShape::Triangle || is_rectangle(emitter);
  if (spread == Spread::Best && is_near && !beside && has_formula) {
    LightSample sample;
    if (height < 0.0 && !emitter.two_sided) return sample;
    const SolidAngleSample toward =
        emitter.shape == FlatShape::Triangle
            ? sample_triangle(point, emitter.corner, emitter.edge1, emitter.edge2, u, v)
            : sample_rectangle(point, emitter.corner, emitter.edge1, emitter.edge2, u, v);
    const double slope = -glm::dot(toward.direction, emitter.normal);
    if (toward.solid_angle_sr > 0.0 && slope * height > 0.0) {
      sample.direction = toward.direction;
      sample.distance_m = height / slope;
      sample.normal_illuminance_lx = emitter.exitance * (toward.solid_angle_sr / pi);
    }
    return sample;
  }
  return toward_area(point, point_on(emitter, u, v), emitter.normal, emitter.two_sided,
                     emitter.exitance, emitter.area_m2);
}

EmitterSet::EmitterSet(const Scene& scene, std::size_t material)
    : scene_(&scene), centre_(centre_of_detail(scene)) {
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.triangles[t].material == material) add(scene, static_cast<std::uint32_t>(t));
  }
  std::vector<LightBounds> bounds;
  double sum = 0.0;
  for (const FlatEmitter& piece : pieces_) {
    const Rgb flux = piece.exitance * (piece.two_sided ? 2.0 * piece.area_m2 : piece.area_m2);
    flux_lm_ += flux;
    cumulative_.push_back(sum += base::luminance(flux));
    bounds.push_back(bounds_of(piece));
  }
  tree_ = LightTree(bounds);
}

void EmitterSet::add(const Scene& scene, std::uint32_t triangle) {
  const Triangle& t = scene.triangles[triangle];
  const Material& material = scene.materials[t.material];
  const Vec3& corner = scene.vertices[t.vertex[0]];
  const FlatEmitter piece{corner,
                          scene.vertices[t.vertex[1]] - corner,
                          scene.vertices[t.vertex[2]] - corner,
                          triangle_normal(scene, triangle),
                          triangle_area(scene, triangle),
                          material.emit,
                          material.two_sided,
                          FlatShape::Triangle,
                          FlatEmitter::none,
                          surface_offset_m(scene, triangle, centre_)};
  if (material.maps && (material.maps->emit.texture || material.has_holes())) {
    pieces_.push_back(piece);
    pieces_.back().exitance = mean_emit(scene, triangle);
    pieces_.back().textured_triangle = triangle;
    return;
  }
  const bool follows = triangle > 0 && scene.triangles[triangle - 1].polygon == t.polygon;
  if (follows && !pieces_.empty() && merge_halves(pieces_.back(), piece)) return;
  pieces_.push_back(piece);
}

const FlatEmitter& EmitterSet::choose(double& u, double& probability) const {
  const double wanted = u * cumulative_.back();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, wanted);
  const auto index = static_cast<std::size_t>(found - cumulative_.begin());
  const double low = index == 0 ? 0.0 : cumulative_[index - 1];
  const double width = cumulative_[index] - low;
  probability = width / cumulative_.back();
  u = std::clamp((wanted - low) / width, 0.0, 1.0);
  return pieces_[index];
}

// Exitance at a point of the emitter, relative to its mean.
Rgb EmitterSet::relative_exitance(const FlatEmitter& emitter, const Vec3& point) const {
  if (emitter.textured_triangle == FlatEmitter::none) return Rgb(1.0);
  const Barycentric at = barycentric(point, emitter.corner, emitter.edge1, emitter.edge2);
  Hit hit;
  hit.triangle = emitter.textured_triangle;
  hit.u = at.u;
  hit.v = at.v;
  Rgb relative(0.0);
  if (!is_there(*scene_, hit.triangle, hit.u, hit.v)) return relative;
  const Material& material = scene_->materials[scene_->triangles[hit.triangle].material];
  const Rgb exitance = emit_at(*scene_, material, hit);
  for (int c = 0; c < 3; ++c) {
    if (emitter.exitance[c] > 0.0) relative[c] = exitance[c] / emitter.exitance[c];
  }
  return relative;
}

void EmitterSet::lift(LightSample& sample, const FlatEmitter& emitter) {
  const double side = glm::dot(sample.direction, emitter.normal) < 0.0 ? 1.0 : -1.0;
  sample.lift_m = side * emitter.offset_m * emitter.normal;
}

void EmitterSet::vary(LightSample& sample, const FlatEmitter& emitter,
                      const Vec3& seen_from) const {
  if (emitter.textured_triangle == FlatEmitter::none) return;
  sample.normal_illuminance_lx *=
      relative_exitance(emitter, seen_from + sample.distance_m * sample.direction);
}

LightSample EmitterSet::sample(const Vec3& point, double u, double v, Spread spread) const {
  double probability = 1.0;
  LightSample sample;
  if (spread == Spread::Best) {
    const auto pick = tree_.pick(point, u);
    if (!pick) return sample;
    sample = sample_flat(pieces_[pick->light], point, pick->rest, v, spread);
    probability = pick->probability;
    vary(sample, pieces_[pick->light], point);
    lift(sample, pieces_[pick->light]);
  } else {
    const FlatEmitter& emitter = choose(u, probability);
    sample = sample_flat(emitter, point, u, v, spread);
    vary(sample, emitter, point);
    lift(sample, emitter);
  }
  sample.normal_illuminance_lx /= probability;
  return sample;
}

EmittedRay EmitterSet::emit(double u, double v, double x, double y) const {
  double probability = 1.0;
  const FlatEmitter& emitter = choose(u, probability);
  Vec3 normal = emitter.normal;
  if (emitter.two_sided) {  // half of the rays leave each side
    if (x >= 0.5) normal = -normal;
    x = x >= 0.5 ? 2.0 * x - 1.0 : 2.0 * x;
  }
  const Vec3 from = point_on(emitter, u, v);
  double weight = 1.0;
  if (emitter.textured_triangle != FlatEmitter::none) {
    weight = base::luminance(relative_exitance(emitter, from) * emitter.exitance) /
             base::luminance(emitter.exitance);
  }
  return {from, cosine_direction(base::frame_around(normal), x, y), weight,
          emitter.offset_m * normal};
}

}  // namespace earthshine::scenes
