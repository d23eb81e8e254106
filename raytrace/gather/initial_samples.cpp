// SPDX-License-Identifier: Apache-2.0
// Selects the gather points for initial samples, and those to sample after a stop or time limit.
#include <algorithm>
#include <bit>

#include "raytrace/gather/gather_field.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {
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
  const auto wants = [&](std::size_t p) {
    return points_[p].reach_m > 0.0F && reflected(kind, p) > 0.0;
  };
  std::vector<std::uint8_t> sampled(points_.size(), 0);
  for (std::size_t p = 0; p < points_.size(); ++p) sampled[p] = samples(kind, p) > 0.0F ? 1 : 0;
  std::vector<std::uint32_t> missing(points_.size(), 0U);
  const auto sample = [&](std::size_t p) {
    missing[p] = sampled[p] != 0 ? 0 : fewest_samples(kind);
    sampled[p] = 1;
  };
  const auto serves = [&](std::size_t q, std::size_t p) {
    return wants(q) && points_[q].material == points_[p].material &&
           stands_for(points_[q], sighting_of(points_[p]));
  };
  const int columns = window_.columns, rows = window_.rows;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  };
  const auto is_served = [&](int x, int y) {
    for (int qy = std::max(0, y - tuning::stop_reach_px);
         qy <= std::min(rows - 1, y + tuning::stop_reach_px); ++qy) {
      for (int qx = std::max(0, x - tuning::stop_reach_px);
           qx <= std::min(columns - 1, x + tuning::stop_reach_px); ++qx) {
        if (sampled[at(qx, qy)] != 0 && serves(at(qx, qy), at(x, y))) return true;
      }
    }
    return false;
  };
  // The point that serves (x, y) and most of the later pixels, which lie to the right and below.
  const auto best_for = [&](int x, int y) {
    for (int away = 2 * tuning::stop_reach_px; away > 0; --away) {
      for (int dy = std::max(0, away - tuning::stop_reach_px);
           dy <= std::min(away, tuning::stop_reach_px); ++dy) {
        const int qx = x + away - dy, qy = y + dy;
        if (qx < columns && qy < rows && serves(at(qx, qy), at(x, y))) return at(qx, qy);
      }
    }
    return at(x, y);
  };
  if (!setting_.shares) {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (wants(p)) sample(p);
    }
  }
  constexpr int block = 2 * tuning::stop_reach_px + 1;
  for (int y = tuning::stop_reach_px; y < rows; y += block) {
    for (int x = tuning::stop_reach_px; x < columns; x += block) {
      if (wants(at(x, y))) sample(at(x, y));
    }
  }
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (wants(at(x, y)) && !is_served(x, y)) sample(best_for(x, y));
    }
  }
  const MirrorNeighbourhood mirror_neighbours{off_grid_points_, first_off_grid_, mirror_neighbours_,
                                              window_.columns};
  for (std::size_t p = grid_; p < points_.size(); ++p) {
    if (!wants(p) || off_grid_points_[p - grid_].base != no_base) continue;
    int served_by = 0;
    mirror_neighbours.each(p - grid_, [&](std::size_t mirror_neighbour) {
      served_by += sampled[grid_ + mirror_neighbour];
    });
    if (served_by < tuning::enough_mirror_neighbours) sample(p);
  }
  cast(kind, missing, 0, {});
}

}  // namespace earthshine::raytrace
