// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/share.h"

#include <utility>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "raytrace/share/signals.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

// Per level, the sum of squared correlations between details at the distances that the first blur
// of their window uses, for independent values on an infinite plane. Squares of normal details have
// these correlations.
constexpr std::array<float, share_levels> alike = {1.15F, 1.10F, 1.13F, 1.14F, 1.14F};
constexpr std::size_t first_blur(std::size_t level) { return level > 0 ? 1 : 0; }
constexpr std::size_t layers_at_once = 4;
constexpr std::size_t points_at_once = 1024;

class Sharer {
 public:
  // own: sums of the estimate, whose memory the denoised means reuse.
  Sharer(const Neighbours& neighbours, const Estimate& estimate, std::vector<glm::vec3> own,
         Keep how)
      : neighbours_(neighbours),
        estimate_(estimate),
        all_(how == Keep::All),
        points_(neighbours.count()),
        in_place_(!own.empty()) {
    shared_.radiance = std::move(own);
  }

  Shared run() {
    shared_.layers = estimate_.layers;
    shared_.resize(estimate_.samples.size());  // room for off-grid points
    for (std::vector<float>& of : keep_) of.assign(points_, 0.0F);
    signs_ = draw_signs(neighbours_, estimate_);
    if (all_) {
      set_noise();
    } else {
      split();
    }
    for_all([&](std::size_t begin, std::size_t end) {
      shared_.squared_errors_with(1.0, begin, end, &shared_.squared_error[begin]);
    });
    squares_.clear();  // frees memory: the layers need more than both
    blurred_.clear();
    take_layers();
    return std::move(shared_);
  }

 private:
  using Planes = Neighbours::Planes;

  // About the number of samples in a value of that level.
  [[nodiscard]] const std::vector<float>& samples_at(std::size_t level) const {
    return level == 0 ? estimate_.samples : samples_around_[level - 1];
  }

  // Values of one level become values of the next; the difference is the detail, 0 without samples.
  // Neighbours are weighted by their numbers of samples.
  void step(std::size_t level, Planes& values, Planes& detail) {
    neighbours_.blur(level, values, &samples_at(level), coarse_);
    if (detail.empty()) detail = neighbours_.planes(values.size());
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t k = 0; k < values.size(); ++k) {
        for (std::size_t p = begin; p < end; ++p) {
          const bool none = level == 0 && estimate_.samples[p] <= 0.0F;
          detail[k][p] = none ? 0.0F : values[k][p] - coarse_[k][p];
        }
      }
    });
    values.swap(coarse_);
  }

  void blur_squares(std::size_t level) {
    for (std::size_t k = first_blur(level); k < tuning::window_blurs; ++k) {
      neighbours_.blur(level + k, squares_, nullptr, blurred_);
      squares_.swap(blurred_);
    }
  }

  [[nodiscard]] float sign(std::size_t p, std::size_t field) const {
    return sign_of(signs_[p], field);
  }

  // The means, and fields of their noise.
  [[nodiscard]] Planes means_and_noise() const {
    Planes values = neighbours_.planes(1 + tuning::noise_fields);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        values[0][p] = estimate_.mean(p);
        const float noise = std::sqrt(estimate_.noise(p));
        for (std::size_t k = 0; k < tuning::noise_fields; ++k)
          values[1 + k][p] = sign(p, k) * noise;
      }
    });
    return values;
  }

  // With Keep::All: the noise of the points themselves.
  void set_noise() {
    expected_.resize(points_);
    for (std::size_t p = 0; p < points_; ++p) {
      expected_[p] = estimate_.samples[p] > 0.0F ? 1.0F / estimate_.samples[p] : 0.0F;
    }
    take_squares(means_and_noise());
    blur_squares(0);
    for (std::size_t p = 0; p < points_; ++p) {
      shared_.noise[0][p] = expected_[p] * squares_[NoiseSquare][p];
      shared_.signal[0][p] = certain * shared_.noise[0][p];
    }
  }

  void split() {
    Planes values = means_and_noise(), detail;
    for (std::size_t level = 0; level < samples_around_.size(); ++level) {
      Planes around;
      neighbours_.blur(level, {samples_at(level)}, nullptr, around);
      samples_around_[level] = std::move(around.front());
    }
    for (std::size_t level = 0; level < share_levels; ++level) {
      step(level, values, detail);
      expect(level);
      take_squares(detail);
      take_scatter(level);
      blur_squares(level);
      keep(level);
    }
    squares_.resize(Scatter);
    blurred_.resize(Scatter);
    take_squares(values);
    blur_squares(share_levels - 1);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        shared_.rest[p] = expected_[p] * squares_[NoiseSquare][p];
      }
    });
  }

  // Weight: 1 over the variance expected from the sample counts. Energy and NoiseSquare: weight
  // times the squared value, and times the mean square of the noise fields.
  void take_squares(const Planes& values) {
    if (squares_.empty())
      squares_ = neighbours_.planes(all_ ? Scatter : Scatter + tuning::scatter_fields);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const float weight = expected_[p] > 0.0F ? 1.0F / expected_[p] : 0.0F;
        float noise = 0.0F;
        for (std::size_t k = 1; k <= tuning::noise_fields; ++k)
          noise += values[k][p] * values[k][p];
        squares_[Weight][p] = weight;
        squares_[Energy][p] = weight * values[0][p] * values[0][p];
        squares_[NoiseSquare][p] = weight * noise / float(tuning::noise_fields);
      }
    });
  }

  // The difference of both squares with random signs: the square of its mean over a window
  // estimates the variance of s there. It includes the chance in the means and the noise of single
  // points, which all noise fields share, and the uneven distribution of the signal.
  void take_scatter(std::size_t level) {
    const float root = std::sqrt(alike[level]);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t k = 0; k < tuning::scatter_fields; ++k) {
        for (std::size_t p = begin; p < end; ++p) {
          const float off = squares_[Energy][p] - squares_[NoiseSquare][p];
          squares_[Scatter + k][p] = root * sign(p, tuning::noise_fields + k) * off;
        }
      }
    });
  }

  // Relative mean squares of the details' noise, from the sample counts. In a mean weighted by
  // samples n and B-spline weights k, a point has the weight w = k0 n / N, N = sum k n. Its value
  // has the noise (1 - w)^2 / n, the other values about (K / N - w^2 / n), K = sum k^2.
  void expect(std::size_t level) {
    constexpr float own = 9.0F / 64.0F, squares = 0.0748F;
    expected_.resize(points_);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const float n = estimate_.samples[p];
        const float around = level > 0 ? samples_at(level)[p] : samples_around_[0][p];
        if (around <= 0.0F) {
          expected_[p] = 0.0F;
        } else if (level > 0) {
          expected_[p] = 1.0F / around;
        } else if (n <= 0.0F) {
          expected_[p] = 0.0F;
        } else {
          const float w = own * n / around;
          expected_[p] = (1.0F - w) * (1.0F - w) / n + std::max(0.0F, squares / around - w * w / n);
        }
      }
    });
  }

  void keep(std::size_t level) {
    find_signals(level, squares_, expected_, shared_);
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        keep_[level][p] = wiener_gain(shared_.signal[level][p], shared_.noise[level][p],
                                      shared_.inverse_dof[level][p]);
      }
    });
  }

  // A few layers at a time: planes of all layers would take more memory than everything else.
  void take_layers() {
    if (!in_place_) {
      shared_.radiance.reserve(estimate_.samples.size() *
                               estimate_.layers);  // room for off-grid points
      shared_.radiance.resize(points_ * estimate_.layers);
    }
    for (std::size_t first = 0; first < estimate_.layers; first += layers_at_once) {
      take_layers(first, std::min(layers_at_once, estimate_.layers - first));
    }
  }

  void take_layers(std::size_t first, std::size_t count) {
    Planes values = neighbours_.planes(3 * count), kept = neighbours_.planes(3 * count), detail;
    const auto at = [&](std::size_t p, std::size_t k) {
      return p * estimate_.layers + first + k / 3;
    };
    const std::vector<glm::vec3>& sums = in_place_ ? shared_.radiance : estimate_.sum;
    // Loops over points outside, because the layers of a point are adjacent in memory.
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        if (estimate_.samples[p] <= 0.0F) continue;
        for (std::size_t k = 0; k < values.size(); ++k) {
          values[k][p] = sums[at(p, k)][static_cast<int>(k % 3)] / estimate_.samples[p];
        }
      }
    });
    for (std::size_t level = 0; !all_ && level < share_levels; ++level) {
      step(level, values, detail);
      for_all([&](std::size_t begin, std::size_t end) {
        for (std::size_t k = 0; k < values.size(); ++k) {
          for (std::size_t p = begin; p < end; ++p) kept[k][p] += keep_[level][p] * detail[k][p];
        }
      });
    }
    for_all([&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        for (std::size_t k = 0; k < values.size(); ++k) {
          shared_.radiance[at(p, k)][static_cast<int>(k % 3)] = values[k][p] + kept[k][p];
        }
      }
    });
  }

  template <class Visit>
  void for_all(const Visit& visit) const {
    base::parallel_chunks(points_, points_at_once, visit);
  }

  const Neighbours& neighbours_;
  const Estimate& estimate_;
  bool all_;
  std::size_t points_;
  bool in_place_;
  Shared shared_;
  std::array<std::vector<float>, share_levels> keep_;
  std::vector<std::uint8_t> signs_;
  std::array<std::vector<float>, share_levels - 1> samples_around_;  // per level: mean numbers of
                                                                     // samples
  std::vector<float> expected_;
  Planes coarse_, squares_, blurred_;
};

}  // namespace

Shared share(const Neighbours& neighbours, const Estimate& estimate, Keep keep) {
  return Sharer(neighbours, estimate, {}, keep).run();
}

Shared share_in_place(const Neighbours& neighbours, Estimate& estimate, Keep keep) {
  return Sharer(neighbours, estimate, std::exchange(estimate.sum, {}), keep).run();
}

}  // namespace earthshine::raytrace
