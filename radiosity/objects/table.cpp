// SPDX-License-Identifier: Apache-2.0
#include "radiosity/objects/table.h"

#include <algorithm>
#include <cmath>

namespace earthshine::radiosity {

Reconciliation::Reconciliation(const ObjectTable& estimate, std::span<const double> area_m2,
                               std::span<const double> rays_per_m2)
    : area_m2_(area_m2.begin(), area_m2.end()),
      rays_per_m2_(rays_per_m2.begin(), rays_per_m2.end()),
      variance_(estimate) {
  average(variance_);
  const std::size_t n = estimate.objects();
  for (std::size_t i = 0; i < n; ++i) {
    double* row = variance_.row(i);
    for (std::size_t k = 0; k < n + 2; ++k) {
      const double rays = rays_per_m2_[i] + (k < n && k != i ? rays_per_m2_[k] : 0.0);
      row[k] = rays > 0.0 ? std::max(0.0, row[k]) / rays : 0.0;
    }
  }
}

void Reconciliation::average(ObjectTable& table) const {
  for (std::size_t i = 0; i < table.objects(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double rays = rays_per_m2_[i] + rays_per_m2_[k];
      if (rays <= 0.0) continue;
      const double x =
          (rays_per_m2_[i] * table.row(i)[k] + rays_per_m2_[k] * table.row(k)[i]) / rays;
      table.row(i)[k] = table.row(k)[i] = x;
    }
  }
}

void Reconciliation::apply(ObjectTable& table, bool closes_to_area) const {
  average(table);
  const std::size_t n = table.objects();
  std::vector<double> missing(n), diagonal(n, 0.0), l(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    missing[i] = closes_to_area ? area_m2_[i] : 0.0;
    for (std::size_t k = 0; k < n + 2; ++k) {
      missing[i] -= table.row(i)[k];
      diagonal[i] += variance_.row(i)[k];
    }
  }
  // (D + V) l = missing by conjugate gradients with D as preconditioner; it is positive, and
  // semidefinite only where a closed scene leaves it consistent.
  std::vector<double> left = missing, z(n), way(n), change(n);
  const auto conditioned = [&] {
    double size = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      z[i] = diagonal[i] > 0.0 ? left[i] / diagonal[i] : 0.0;
      size += z[i] * left[i];
    }
    return size;
  };
  double size = conditioned();
  const double wanted = 1e-30 * size;
  way = z;
  for (std::size_t step = 0; step < 4 * n + 20 && size > wanted; ++step) {
    double curvature = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      change[i] = diagonal[i] * way[i];
      for (std::size_t k = 0; k < n; ++k) {
        if (k != i) change[i] += variance_.row(i)[k] * way[k];
      }
      curvature += change[i] * way[i];
    }
    if (!(curvature > 0.0)) break;
    for (std::size_t i = 0; i < n; ++i) {
      l[i] += size / curvature * way[i];
      left[i] -= size / curvature * change[i];
    }
    const double next = conditioned();
    for (std::size_t i = 0; i < n; ++i) way[i] = z[i] + next / size * way[i];
    size = next;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n + 2; ++k) {
      // What a row alone is about, itself, the sky and black backs, follows that row alone.
      table.row(i)[k] += variance_.row(i)[k] * (k < n && k != i ? l[i] + l[k] : l[i]);
    }
  }
}

}  // namespace earthshine::radiosity
