// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/strays.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

// Signal over noise of strays that no point of the grid may stand for, of whose own all is kept;
// and noise over signal of those without samples, which have nothing of their own to keep.
constexpr float alone = 1e6F;

float luminance_at(const std::vector<glm::vec3>& radiance, std::size_t point, std::size_t layers,
                   std::size_t seen) {
  glm::vec3 sum(0.0F);
  for (std::size_t k = 0; k < seen; ++k) sum += radiance[point * layers + k];
  return static_cast<float>(base::luminance(Rgb(sum)));
}

// What strays that are held to be alike say of how far they are off what stands for them: the
// squares found, less the noise of these. Those whose noise is small against the signal count the
// more (weights 1 / (s + q)^2, which are best for normal numbers; found in a few rounds).
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
  // Signal that noise may hide: the standard error of what is found of none.
  [[nodiscard]] float hidden() const { return static_cast<float>(hidden_); }
  // 1 / N, for Stein's term.
  [[nodiscard]] float few(float noise) const {
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

void add_strays(std::span<const Stray> strays, const Estimate& estimate, Shared& shared) {
  if (strays.empty()) return;
  const std::size_t layers = estimate.layers, all = estimate.samples.size();
  const std::size_t grid = all - strays.size();
  const bool in_place = estimate.sum.empty();
  shared.radiance.resize(all * layers, glm::vec3(0.0F));
  shared.resize(all);
  shared.hidden.assign(all, 0.0F);

  std::uint32_t last = 0;
  for (const Stray& stray : strays) last = std::max(last, stray.region);
  std::vector<Differences> regions(last + 1U);
  std::vector<float> noise(strays.size(), 0.0F);
  for (std::size_t k = 0; k < strays.size(); ++k) {
    if (estimate.samples[grid + k] <= 0.0F) continue;
    noise[k] = estimate.noise(grid + k);
    if (strays[k].base == no_base) continue;
    const float more = estimate.mean(grid + k) -
                       luminance_at(shared.radiance, strays[k].base, layers, estimate.image_layers);
    regions[strays[k].region].add(more * more, noise[k], estimate.samples[grid + k]);
  }
  for (Differences& region : regions) region.find();
  for (std::size_t k = 0; k < strays.size(); ++k) {
    const std::size_t point = grid + k;
    const bool sampled = estimate.samples[point] > 0.0F, has_base = strays[k].base != no_base;
    float keep = sampled ? 1.0F : 0.0F;
    if (has_base) {
      const Differences& region = regions[strays[k].region];
      const float s = std::max(region.signal(), region.hidden());
      const float q = sampled ? region.noise(estimate.samples[point]) : alone * s;
      shared.signal[0][point] = region.signal();
      shared.hidden[point] = region.hidden();
      shared.noise[0][point] = q;
      shared.few[0][point] = region.few(q);
      if (sampled) keep = kept_share(s, q, region.few(q));
    } else {
      shared.signal[0][point] = alone * noise[k];
      shared.noise[0][point] = noise[k];
    }
    for (std::size_t layer = 0; layer < layers; ++layer) {
      glm::vec3& value = shared.radiance[point * layers + layer];
      const glm::vec3 sum = in_place ? value : estimate.sum[point * layers + layer];
      value = has_base ? shared.radiance[strays[k].base * layers + layer] : glm::vec3(0.0F);
      if (sampled) value += keep * (sum / estimate.samples[point] - value);
    }
    shared.squared_error[point] = static_cast<float>(shared.squared_error_with(point, 1.0));
  }
}

void share_among_peers(const Peers& peers, const Estimate& estimate, Shared& shared) {
  const std::size_t strays = peers.strays.size(), grid = estimate.samples.size() - strays;
  const auto each = [&](std::size_t k, const auto& visit) {
    peers.each(k, [&](std::size_t peer) {
      if (estimate.samples[grid + peer] > 0.0F) visit(peer);
    });
  };
  std::vector<float> keep(strays, 1.0F);
  base::parallel_chunks(strays, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      float count = 0.0F, all = 0.0F, of_sample = 0.0F;
      double off = 0.0, squared = 0.0;  // from its own
      each(k, [&](std::size_t peer) {
        const double from_own =
            double(estimate.mean(grid + peer)) - double(estimate.mean(grid + k));
        const float noise = estimate.noise(grid + peer);
        count += 1.0F, off += from_own, squared += from_own * from_own, all += noise;
        of_sample += noise * estimate.samples[grid + peer];
      });
      if (count < 2.0F) continue;
      all /= count, of_sample /= count;
      const double n = double(count), energy = std::max(0.0, squared - off * off / n) / (n - 1.0);
      const std::size_t point = grid + k;
      const float samples = estimate.samples[point], s = static_cast<float>(energy) - all;
      const float q = samples > 0.0F ? of_sample / samples : alone * std::max(0.0F, s);
      shared.signal[0][point] = s;
      shared.noise[0][point] = q;
      shared.few[0][point] = 1.0F / count;
      shared.rest[point] = all / count;
      shared.squared_error[point] = static_cast<float>(shared.squared_error_with(point, 1.0));
      keep[k] = samples > 0.0F ? kept_share(s, q, 1.0F / count) : 0.0F;
    }
  });
  // A layer after the other: of all of them there may be as much as of the whole picture.
  std::vector<glm::vec3> own(strays);
  for (std::size_t layer = 0; layer < shared.layers; ++layer) {
    const auto value = [&](std::size_t k) -> glm::vec3& {
      return shared.radiance[(grid + k) * shared.layers + layer];
    };
    for (std::size_t k = 0; k < strays; ++k) own[k] = value(k);
    base::parallel_chunks(strays, 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (keep[k] >= 1.0F) continue;
        glm::vec3 mean(0.0F);
        float count = 0.0F;
        each(k, [&](std::size_t peer) { mean += own[peer], count += 1.0F; });
        if (count > 0.0F) value(k) = mean / count + keep[k] * (own[k] - mean / count);
      }
    });
  }
}

}  // namespace earthshine::raytrace
