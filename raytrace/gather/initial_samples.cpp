// SPDX-License-Identifier: Apache-2.0
// Selects the gather points for initial samples, and those to sample after a stop or time limit.
#include <algorithm>
#include <bit>

#include "raytrace/gather/gather_field.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

// Which pixels a few sampled points serve: those of the same surface within stop_reach_px.
struct SparsePoints {
  const std::vector<GatherPoint>& points;
  int columns, rows;
  std::vector<std::uint8_t> wanted, sampled;  // by point, 1: yes

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool serves(std::size_t q, std::size_t p) const {
    return wanted[q] != 0 && points[q].material == points[p].material &&
           stands_for(points[q], sighting_of(points[p]));
  }
  [[nodiscard]] bool is_served(int x, int y) const {
    constexpr int reach = tuning::stop_reach_px;
    for (int qy = std::max(0, y - reach); qy <= std::min(rows - 1, y + reach); ++qy) {
      for (int qx = std::max(0, x - reach); qx <= std::min(columns - 1, x + reach); ++qx) {
        if (sampled[at(qx, qy)] != 0 && serves(at(qx, qy), at(x, y))) return true;
      }
    }
    return false;
  }
  // The point that serves (x, y) and most of the later pixels, which lie to the right and below.
  [[nodiscard]] std::size_t best_for(int x, int y) const {
    constexpr int reach = tuning::stop_reach_px;
    for (int away = 2 * reach; away > 0; --away) {
      for (int dy = std::max(0, away - reach); dy <= std::min(away, reach); ++dy) {
        const int qx = x + away - dy, qy = y + dy;
        if (qx < columns && qy < rows && serves(at(qx, qy), at(x, y))) return at(qx, qy);
      }
    }
    return at(x, y);
  }
};

}  // namespace

double GatherField::mean_lobe() const {
  double sum = 0.0, count = 0.0;
  for (const GatherPoint& point : points_) {
    sum += double(point.lobe);
    count += point.lobe > 0.0F ? 1.0 : 0.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

void GatherField::sample_initial(Gathered kind, std::uint32_t each, bool every_second,
                                 const std::function<bool()>& stop) {
  std::vector<std::uint32_t> samples(points_.size(), each);
  const bool few_rays = kind == Gathered::Lobe && each <= fewest_samples(kind);
  const double mean = few_rays ? mean_lobe() : 0.0;
  for (std::size_t p = 0; p < samples.size() && mean > 0.0; ++p) {
    const double times = std::clamp(double(points_[p].lobe) / mean, 1.0, tuning::most_lobe_times);
    samples[p] *= std::bit_floor(static_cast<std::uint32_t>(times));
  }
  for (std::size_t p = 0; every_second && setting_.shares && p < grid_; ++p) {
    const auto [x, y] = place_of(p);
    if ((x + y) % 2 != 0 && is_interior(x, y)) samples[p] = 0;
  }
  cast(kind, samples, 0, stop);
}

void GatherField::sample_sparse(Gathered kind) {
  if (!gathers(kind)) return;
  SparsePoints sparse{points_, window_.columns, window_.rows, {}, {}};
  for (std::size_t p = 0; p < points_.size(); ++p) {
    sparse.wanted.push_back(points_[p].reach_m > 0.0F && reflected(kind, p) > 0.0 ? 1 : 0);
    sparse.sampled.push_back(samples(kind, p) > 0.0F ? 1 : 0);
  }
  std::vector<std::uint32_t> missing(points_.size(), 0U);
  const auto sample = [&](std::size_t p) {
    missing[p] = sparse.sampled[p] != 0 ? 0 : fewest_samples(kind);
    sparse.sampled[p] = 1;
  };
  if (!setting_.shares) {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (sparse.wanted[p] != 0) sample(p);
    }
  }
  constexpr int block = 2 * tuning::stop_reach_px + 1;
  for (int y = tuning::stop_reach_px; y < window_.rows; y += block) {
    for (int x = tuning::stop_reach_px; x < window_.columns; x += block) {
      if (sparse.wanted[sparse.at(x, y)] != 0) sample(sparse.at(x, y));
    }
  }
  for (int y = 0; y < window_.rows; ++y) {
    for (int x = 0; x < window_.columns; ++x) {
      if (sparse.wanted[sparse.at(x, y)] != 0 && !sparse.is_served(x, y)) {
        sample(sparse.best_for(x, y));
      }
    }
  }
  const MirrorNeighbourhood mirror_neighbours{off_grid_points_, first_off_grid_, mirror_neighbours_,
                                              window_.columns};
  for (std::size_t p = grid_; p < points_.size(); ++p) {
    if (sparse.wanted[p] == 0 || off_grid_points_[p - grid_].base != no_base) continue;
    int served_by = 0;
    mirror_neighbours.each(p - grid_, [&](std::size_t mirror_neighbour) {
      served_by += sparse.sampled[grid_ + mirror_neighbour];
    });
    if (served_by < tuning::enough_mirror_neighbours) sample(p);
  }
  cast(kind, missing, 0, {});
}

}  // namespace earthshine::raytrace
