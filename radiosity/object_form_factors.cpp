// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "radiosity/form_factors.h"

namespace earthshine::radiosity {

ObjectFormFactors object_form_factors(const scenes::Scene& scene, const Patches& patches,
                                      const FormFactors& factors) {
  const std::size_t objects = scene.objects.size();
  ObjectFormFactors result;
  result.F.assign(objects, std::vector<double>(objects, 0.0));
  result.std_error.assign(objects, std::vector<double>(objects, 0.0));
  result.sky.assign(objects, 0.0);
  result.black.assign(objects, 0.0);
  result.area_m2.assign(objects, 0.0);
  std::vector<std::size_t> patch_count(objects, 0);
  std::vector<double> to(objects);
  for (std::size_t i = 0; i < patches.count(); ++i) {
    const std::uint32_t from = patches.object(static_cast<std::uint32_t>(i));
    const double area = patches.area_m2[i];
    std::fill(to.begin(), to.end(), 0.0);
    double closed = factors.sky[i] + factors.black[i];
    for (std::uint64_t e = factors.row_start[i]; e < factors.row_start[i + 1]; ++e) {
      const std::uint32_t j = factors.column[e];
      const double f = factors.row_scale[i] * factors.hits[e] * factors.column_scale[j];
      to[patches.object(j)] += f;
      closed += f * factors.kept[j];
    }
    result.max_row_error = std::max(result.max_row_error, std::abs(closed - 1.0));
    ++patch_count[from];
    result.area_m2[from] += area;
    result.sky[from] += area * factors.sky[i];
    result.black[from] += area * factors.black[i];
    for (std::size_t k = 0; k < objects; ++k) {
      result.F[from][k] += area * to[k];
      const double p = std::clamp(to[k], 0.0, 1.0);
      result.std_error[from][k] += area * area * p * (1.0 - p) / factors.rays_per_patch;
    }
  }
  for (std::size_t i = 0; i < objects; ++i) {
    const double area = result.area_m2[i];
    if (area <= 0.0) continue;
    result.sky[i] /= area;
    result.black[i] /= area;
    for (std::size_t k = 0; k < objects; ++k) {
      result.F[i][k] /= area;
      result.std_error[i][k] = std::sqrt(result.std_error[i][k]) / area;
      // No hit, or nothing but hits, among n rays: the binomial formula says 0, the truth is about
      // 1 / n.
      if (result.std_error[i][k] == 0.0) {
        result.std_error[i][k] = 1.0 / (double(patch_count[i]) * factors.rays_per_patch);
      }
    }
  }
  for (std::size_t i = 0; i < objects; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double there = result.area_m2[i] * result.F[i][k];
      const double back = result.area_m2[k] * result.F[k][i];
      if (result.F[i][k] > 4.0 * result.std_error[i][k] &&
          result.F[k][i] > 4.0 * result.std_error[k][i]) {
        result.max_reciprocity_error =
            std::max(result.max_reciprocity_error, std::abs(there - back) / std::max(there, back));
      }
    }
  }
  return result;
}

}  // namespace earthshine::radiosity
