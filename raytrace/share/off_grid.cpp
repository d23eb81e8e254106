// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/off_grid.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

// Ratio of signal to noise of off-grid points without a base, which keep their own value; and of
// noise to signal of points without samples.
constexpr float unsampled_noise = 1e6F;

float luminance_at(const std::vector<glm::vec3>& radiance, std::size_t point, std::size_t layers,
                   std::size_t seen) {
  glm::vec3 sum(0.0F);
  for (std::size_t k = 0; k < seen; ++k) sum += radiance[point * layers + k];
  return static_cast<float>(base::luminance(Rgb(sum)));
}

// Differences of the off-grid points of a region from their shared values: mean square minus noise.
// Differences with less noise have more weight (1 / (s + q)^2, optimal for normal noise; found by a
// few iterations).
class Differences {
 public:
  void add(float squared, float noise, float samples) {
    squared_.push_back(squared);
    samples_.push_back(samples);
    of_sample_ += double(noise) * double(samples);
  }
  void find() {
    if (squared_.empty()) return;
    of_sample_ /= static_cast<double>(squared_.size());
    double sum = 0.0;
    for (std::size_t k = 0; k < squared_.size(); ++k) sum += double(squared_[k]) - noise_of(k);
    signal_ = sum / static_cast<double>(squared_.size());
    for (int round = 0; round < rounds; ++round) weigh();
  }
  [[nodiscard]] float noise(float samples) const {
    return static_cast<float>(of_sample_ / double(samples));
  }
  [[nodiscard]] float signal() const { return static_cast<float>(signal_); }
  // The standard error of the signal if the true signal is 0.
  [[nodiscard]] float hidden() const { return static_cast<float>(hidden_); }
  // 1 / N, for Stein's term.
  [[nodiscard]] float inverse_dof(float noise) const {
    const double all = std::max(0.0, signal_) + double(noise);
    return known_ > 0.0 ? static_cast<float>(std::min(1.0, 1.0 / (known_ * all * all))) : 1.0F;
  }

 private:
  static constexpr int rounds = 4;
  [[nodiscard]] double noise_of(std::size_t k) const { return of_sample_ / double(samples_[k]); }
  void weigh() {
    double sum = 0.0, of_noise = 0.0;
    known_ = 0.0;
    for (std::size_t k = 0; k < squared_.size(); ++k) {
      const double q = noise_of(k), all = std::max(0.0, signal_) + q;
      if (all <= 0.0) continue;
      const double weight = 1.0 / (all * all);
      known_ += weight;
      sum += weight * (double(squared_[k]) - q);
      of_noise += weight * weight * q * q;
    }
    if (known_ <= 0.0) return;
    signal_ = sum / known_;
    hidden_ = std::sqrt(2.0 * of_noise) / known_;
  }

  std::vector<float> squared_, samples_;
  double of_sample_ = 0.0, signal_ = 0.0, known_ = 0.0, hidden_ = 0.0;
};

}  // namespace

void add_off_grid_points(std::span<const OffGridPoint> off_grid_points, const Estimate& estimate,
                         Shared& shared) {
  if (off_grid_points.empty()) return;
  const std::size_t layers = estimate.layers, all = estimate.samples.size();
  const std::size_t grid = all - off_grid_points.size();
  const bool in_place = estimate.sum.empty();
  shared.radiance.resize(all * layers, glm::vec3(0.0F));
  shared.resize(all);
  shared.hidden.assign(all, 0.0F);

  std::uint32_t last = 0;
  for (const OffGridPoint& off_grid_point : off_grid_points)
    last = std::max(last, off_grid_point.region);
  std::vector<Differences> regions(last + 1U);
  std::vector<float> noise(off_grid_points.size(), 0.0F);
  for (std::size_t k = 0; k < off_grid_points.size(); ++k) {
    if (estimate.samples[grid + k] <= 0.0F) continue;
    noise[k] = estimate.noise(grid + k);
    if (off_grid_points[k].base == no_base) continue;
    const float more =
        estimate.mean(grid + k) -
        luminance_at(shared.radiance, off_grid_points[k].base, layers, estimate.image_layers);
    regions[off_grid_points[k].region].add(more * more, noise[k], estimate.samples[grid + k]);
  }
  for (Differences& region : regions) region.find();
  for (std::size_t k = 0; k < off_grid_points.size(); ++k) {
    const std::size_t point = grid + k;
    const bool sampled = estimate.samples[point] > 0.0F,
               has_base = off_grid_points[k].base != no_base;
    float keep = sampled ? 1.0F : 0.0F;
    if (has_base) {
      const Differences& region = regions[off_grid_points[k].region];
      const float s = std::max(region.signal(), region.hidden());
      const float q = sampled ? region.noise(estimate.samples[point]) : unsampled_noise * s;
      shared.signal[0][point] = region.signal();
      shared.hidden[point] = region.hidden();
      shared.noise[0][point] = q;
      shared.inverse_dof[0][point] = region.inverse_dof(q);
      if (sampled) keep = wiener_gain(s, q, region.inverse_dof(q));
    } else {
      shared.signal[0][point] = unsampled_noise * noise[k];
      shared.noise[0][point] = noise[k];
    }
    for (std::size_t layer = 0; layer < layers; ++layer) {
      glm::vec3& value = shared.radiance[point * layers + layer];
      const glm::vec3 sum = in_place ? value : estimate.sum[point * layers + layer];
      value =
          has_base ? shared.radiance[off_grid_points[k].base * layers + layer] : glm::vec3(0.0F);
      if (sampled) value += keep * (sum / estimate.samples[point] - value);
    }
    shared.squared_error[point] = static_cast<float>(shared.squared_error_with(point, 1.0));
  }
}

void share_among_mirror_neighbours(const MirrorNeighbourhood& mirror_neighbours,
                                   const Estimate& estimate, Shared& shared) {
  const std::size_t off_grid_points = mirror_neighbours.off_grid_points.size(),
                    grid = estimate.samples.size() - off_grid_points;
  const auto each = [&](std::size_t k, const auto& visit) {
    mirror_neighbours.each(k, [&](std::size_t mirror_neighbour) {
      if (estimate.samples[grid + mirror_neighbour] > 0.0F) visit(mirror_neighbour);
    });
  };
  std::vector<float> keep(off_grid_points, 1.0F);
  base::parallel_chunks(off_grid_points, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      float count = 0.0F, all = 0.0F, of_sample = 0.0F;
      double off = 0.0, squared = 0.0;  // sums of differences from its own value, and of squares
      each(k, [&](std::size_t mirror_neighbour) {
        const double from_own =
            double(estimate.mean(grid + mirror_neighbour)) - double(estimate.mean(grid + k));
        const float noise = estimate.noise(grid + mirror_neighbour);
        count += 1.0F, off += from_own, squared += from_own * from_own, all += noise;
        of_sample += noise * estimate.samples[grid + mirror_neighbour];
      });
      if (count < 2.0F) continue;
      all /= count, of_sample /= count;
      const double n = double(count), energy = std::max(0.0, squared - off * off / n) / (n - 1.0);
      const std::size_t point = grid + k;
      const float samples = estimate.samples[point], s = static_cast<float>(energy) - all;
      const float q = samples > 0.0F ? of_sample / samples : unsampled_noise * std::max(0.0F, s);
      shared.signal[0][point] = s;
      shared.noise[0][point] = q;
      shared.inverse_dof[0][point] = 1.0F / count;
      shared.rest[point] = all / count;
      shared.squared_error[point] = static_cast<float>(shared.squared_error_with(point, 1.0));
      keep[k] = samples > 0.0F ? wiener_gain(s, q, 1.0F / count) : 0.0F;
    }
  });
  // One layer at a time: all layers may take as much memory as the whole picture.
  std::vector<glm::vec3> own(off_grid_points);
  for (std::size_t layer = 0; layer < shared.layers; ++layer) {
    const auto value = [&](std::size_t k) -> glm::vec3& {
      return shared.radiance[(grid + k) * shared.layers + layer];
    };
    for (std::size_t k = 0; k < off_grid_points; ++k) own[k] = value(k);
    base::parallel_chunks(off_grid_points, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (keep[k] >= 1.0F) continue;
        glm::vec3 mean(0.0F);
        float count = 0.0F;
        each(k,
             [&](std::size_t mirror_neighbour) { mean += own[mirror_neighbour], count += 1.0F; });
        if (count > 0.0F) value(k) = mean / count + keep[k] * (own[k] - mean / count);
      }
    });
  }
}

}  // namespace earthshine::raytrace
