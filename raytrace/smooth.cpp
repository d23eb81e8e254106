// SPDX-License-Identifier: Apache-2.0
// Sharing gather rays between neighbouring points, and finding a point for a camera sample.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "raytrace/gather_field.h"
#include "raytrace/local_fit.h"
#include "raytrace/same_surface.h"

namespace earthshine::raytrace {
namespace {

constexpr int steps_each_way = 4;  // neighbours looked at: (2 * 4 + 1)^2, further apart if need be
constexpr std::size_t most_neighbours = (2 * steps_each_way + 1) * (2 * steps_each_way + 1);
// Irradiance is linear in the normal as long as nothing crosses the horizon: neighbouring facets of
// a curved surface may share that far.
constexpr float most_turned = 0.2F;  // rad

// Rounding of single-precision positions, and the spacing across the view of points one pixel
// apart.
float slack(const GatherPoint& point) { return 0.02F * point.spacing_m; }

// How much further apart neighbours are along the surface than across the view.
float stretch(const GatherPoint& point) {
  const float distance = glm::length(point.position);
  const float cosine =
      std::abs(glm::dot(point.position, point.normal)) / std::max(distance, 1e-20F);
  return 1.0F / std::max(cosine, 0.05F);
}

// Of its mean ray's length: how far off a point may stand for another.
constexpr float most_found_share = 0.25F;

constexpr std::size_t flat_variables = 3, all_variables = 5;

struct Neighbour {
  std::size_t index;
  // 1; position in the tangent plane, in radii of the kernel; how the normal is turned.
  std::array<double, all_variables> x;
  double kernel, rays;
  double weight;  // both together; then of the estimate
};

class Smoother {
 public:
  Smoother(const GatherField& field, const std::vector<double>& luminance, double share,
           int most_pixels)
      : field_(field),
        luminance_(luminance),
        share_(static_cast<float>(share)),
        most_pixels_(static_cast<float>(most_pixels)) {}

  // Writes the smoothed radiance of point (x, y) of the window to out[0 .. layers) and its squared
  // error; leaves both as they are where there is nothing to share.
  void point(int x, int y, std::span<glm::vec3> out, float& squared_error) {
    const auto columns = static_cast<std::size_t>(field_.window.columns);
    const std::size_t p = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
    if (field_.points[p].reach_m <= 0.0F) return;
    collect(x, y, p);
    if (count_ < 2) return;
    if (flat_) {
      weigh<flat_variables>();
    } else {
      weigh<all_variables>();
    }
    double squares = 0.0;
    std::fill(out.begin(), out.end(), glm::vec3(0.0F));
    for (std::size_t k = 0; k < count_; ++k) {
      const Neighbour& n = neighbours_[k];
      const auto share = static_cast<float>(n.weight);
      const glm::vec3* from = &field_.radiance[n.index * field_.layers];
      for (std::size_t layer = 0; layer < out.size(); ++layer) out[layer] += share * from[layer];
      squares += n.weight * n.weight / n.rays;
    }
    squared_error = static_cast<float>(noise_ * squares);
    if (std::any_of(out.begin(), out.end(), [](const glm::vec3& value) {
          return std::min({value.x, value.y, value.z}) < 0.0F;
        })) {
      take_mean(out);
    }
  }

 private:
  // Pixels to go along one axis of the picture until the radius is reached.
  struct Steps {
    int step, last;
  };
  [[nodiscard]] Steps steps(int x, int y, int dx, int dy, float radius) const {
    const Window& window = field_.window;
    const std::size_t p = window.index(window.x + x, window.y + y);
    const GatherPoint& at = field_.points[p];
    float apart = at.spacing_m * stretch(at);
    for (const int sign : {-1, 1}) {
      const int qx = window.x + x + sign * dx, qy = window.y + y + sign * dy;
      if (!window.contains(qx, qy)) continue;
      const GatherPoint& next = field_.points[window.index(qx, qy)];
      if (next.reach_m <= 0.0F) continue;
      apart = std::min(apart, glm::length(next.position - at.position));
    }
    apart = std::max(apart, 0.5F * at.spacing_m);
    const int pixels = static_cast<int>(std::min(most_pixels_, radius / apart));
    const int step = std::max(1, (pixels + steps_each_way - 1) / steps_each_way);
    return {step, pixels / step * step};
  }

  void collect(int x, int y, std::size_t p) {
    const Window& window = field_.window;
    const GatherPoint& at = field_.points[p];
    const base::Frame3 frame = base::frame_around(Vec3(at.normal));
    const glm::vec3 tangent(frame.tangent), bitangent(frame.bitangent);
    const float least = 1.5F * at.spacing_m;  // corners, where everything is near
    const float radius = std::max(share_ * at.reach_m, least);
    const Steps across = steps(x, y, 1, 0, radius), down = steps(x, y, 0, 1, radius);
    count_ = 0;
    flat_ = true;
    for (int dy = -down.last; dy <= down.last; dy += down.step) {
      for (int dx = -across.last; dx <= across.last; dx += across.step) {
        const int qx = x + dx, qy = y + dy;
        if (qx < 0 || qy < 0 || qx >= window.columns || qy >= window.rows) continue;
        const std::size_t q =
            static_cast<std::size_t>(qy) * static_cast<std::size_t>(window.columns) +
            static_cast<std::size_t>(qx);
        const GatherPoint& other = field_.points[q];
        if (other.reach_m <= 0.0F) continue;
        const glm::vec3 way = other.position - at.position;
        const float of_pair = std::max(share_ * std::min(at.reach_m, other.reach_m), least);
        const glm::vec3 turned = other.normal - at.normal;
        const float d2 = glm::dot(way, way) / (of_pair * of_pair) +
                         glm::dot(turned, turned) / (most_turned * most_turned);
        if (d2 >= 1.0F ||
            !same_surface(at.position, at.normal, other.position, other.normal, slack(at))) {
          continue;
        }
        const auto kernel = double((1.0F - d2) * (1.0F - d2));
        flat_ = flat_ && glm::dot(turned, turned) == 0.0F;
        neighbours_[count_++] = {q,
                                 {1.0, double(glm::dot(way, tangent) / radius),
                                  double(glm::dot(way, bitangent) / radius),
                                  double(glm::dot(turned, tangent) / most_turned),
                                  double(glm::dot(turned, bitangent) / most_turned)},
                                 kernel,
                                 double(other.rays),
                                 kernel * double(other.rays)};
      }
    }
  }

  // Where neighbours lie on one side only, the fit may run below zero: there their mean.
  void take_mean(std::span<glm::vec3> out) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < count_; ++k) sum += neighbours_[k].kernel * neighbours_[k].rays;
    std::fill(out.begin(), out.end(), glm::vec3(0.0F));
    for (std::size_t k = 0; k < count_; ++k) {
      const auto share = static_cast<float>(neighbours_[k].kernel * neighbours_[k].rays / sum);
      const glm::vec3* from = &field_.radiance[neighbours_[k].index * field_.layers];
      for (std::size_t layer = 0; layer < out.size(); ++layer) out[layer] += share * from[layer];
    }
  }

  // Kernel weights become the weights of a linear estimate of the value at the point itself. Also
  // the noise that the fit leaves, as the variance of a single ray.
  template <std::size_t variables>
  void weigh() {
    using Fit = LocalFit<variables>;
    Fit fit;
    typename Fit::Values right{};
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
      const Neighbour& n = neighbours_[k];
      fit.add(n.weight, n.x);
      for (std::size_t i = 0; i < right.size(); ++i) {
        right[i] += n.weight * n.x[i] * luminance_[n.index];
      }
      sum += n.kernel;
      squares += n.kernel * n.kernel;
    }
    const auto unknowns = static_cast<double>(fit.factor());
    const typename Fit::Values luminance = fit.solve(right), share = fit.solve({1.0});
    double left = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
      Neighbour& n = neighbours_[k];
      double off = luminance_[n.index], part = 0.0;
      for (std::size_t i = 0; i < right.size(); ++i) {
        off -= luminance[i] * n.x[i];
        part += share[i] * n.x[i];
      }
      left += n.weight * off * off;
      n.weight *= part;
    }
    // Uneven weights count as fewer neighbours (Kish), of which the unknowns take their part.
    const double count = sum * sum / squares;
    noise_ = left / sum * (count / std::max(1.0, count - unknowns));
  }

  const GatherField& field_;
  const std::vector<double>& luminance_;
  float share_, most_pixels_;
  std::array<Neighbour, most_neighbours> neighbours_;
  std::size_t count_ = 0;
  bool flat_ = true;  // all neighbours have the point's normal
  double noise_ = 0.0;
};

}  // namespace

void smooth(GatherField& field, double share, int most_pixels) {
  if (share <= 0.0 || field.points.empty()) return;
  std::vector<glm::vec3> radiance = field.radiance;
  std::vector<float> squared_error = field.squared_error;
  std::vector<double> luminance(field.points.size());
  for (std::size_t p = 0; p < luminance.size(); ++p) {
    Rgb sum(0.0);
    for (std::size_t k = 0; k < field.image_layers; ++k) {
      sum += Rgb(field.radiance[p * field.layers + k]);
    }
    luminance[p] = base::luminance(sum);
  }
  base::parallel_chunks(
      static_cast<std::size_t>(field.window.rows), 4, [&](std::size_t begin, std::size_t end) {
        Smoother smoother(field, luminance, share, most_pixels);
        for (std::size_t y = begin; y < end; ++y) {
          for (int x = 0; x < field.window.columns; ++x) {
            const std::size_t p =
                y * static_cast<std::size_t>(field.window.columns) + static_cast<std::size_t>(x);
            smoother.point(x, static_cast<int>(y), {&radiance[p * field.layers], field.layers},
                           squared_error[p]);
          }
        }
      });
  field.radiance = std::move(radiance);
  field.squared_error = std::move(squared_error);
}

std::size_t GatherField::find(int x, int y, const glm::vec3& position,
                              const glm::vec3& normal) const {
  const auto fits = [&](std::size_t index, float& distance) {
    const GatherPoint& point = points[index];
    if (point.reach_m <= 0.0F) return false;
    const glm::vec3 way = position - point.position;
    distance = glm::length(way);
    // Further off, irradiance may be another: a gap in a wall, the foot of a box.
    return distance <= std::min(3.0F * point.spacing_m * stretch(point),
                                most_found_share * point.reach_m) &&
           same_surface(point.position, point.normal, position, normal, slack(point));
  };
  float distance = 0.0F;
  if (window.contains(x, y)) {
    const std::size_t own = window.index(x, y);
    if (fits(own, distance)) return own;
  }
  for (int ring = 1; ring <= 2; ++ring) {
    std::size_t nearest = no_point;
    float least = std::numeric_limits<float>::infinity();
    for (int qy = y - ring; qy <= y + ring; ++qy) {
      for (int qx = x - ring; qx <= x + ring; ++qx) {
        if (!window.contains(qx, qy)) continue;
        if (std::max(std::abs(qx - x), std::abs(qy - y)) != ring) continue;
        if (fits(window.index(qx, qy), distance) && distance < least) {
          least = distance;
          nearest = window.index(qx, qy);
        }
      }
    }
    if (nearest != no_point) return nearest;
  }
  return no_point;
}

}  // namespace earthshine::raytrace
