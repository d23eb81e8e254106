// SPDX-License-Identifier: Apache-2.0
// What the radiosity solution is wrong by, as a picture shows it or over the surfaces themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/second_looks.h"
#include "raytrace/probe.h"
#include "studies/doubt.h"
#include "studies/study.h"

namespace earthshine::studies {

// Relative to the mean luminance of the pixels, or to the mean radiosity of the surfaces.
struct SolutionError {
  Doubt form_factors;  // noise of the form factors' rays
  Doubt patches;       // one radiosity for a whole patch
  Doubt lamps;         // noise of the shadow rays by which patches see lamps, Sun and emitters
  Doubt solver;        // what the iteration left
  [[nodiscard]] Doubt total() const { return form_factors + patches + lamps + solver; }
};

// The values that the other solutions of look_again() give, for the same things in the same order.
struct Looks {
  std::vector<double> own;  // of the solution itself
  std::vector<std::vector<double>> few_rays, other_direct, other_patches;
  void add(radiosity::Look look, std::vector<double> values);
};

// The patches' error is the difference to another cut,
// extrapolated to no patch size at all: if the finer of the two has q of the other's error, the
// coarser one is off by 1 / (1 - q) of the difference, the finer one by q / (1 - q). The radiosity
// is interpolated when it is read, which makes its error fall with the square of the patch edge
// where light varies smoothly: the estimate takes q = r^2, r = SecondLooks::error_ratio. The bound
// takes q = r^(3/4), for shadows' edges: all error is in the cells that the edge crosses, an area
// as wide as they are. Where the cuts' means show that the solution is too bright, errors of the
// patches are relative to the mean without that. The product of the differences to two independent
// others has their noise left out. scale: what errors are relative to.
[[nodiscard]] SolutionError solution_error(const Looks& looks, const radiosity::SecondLooks& made,
                                           double solver_error, double scale);
// Relative to the mean, what is bright as error_weight() has it.
[[nodiscard]] SolutionError weighed_error(Looks looks, const radiosity::SecondLooks& made,
                                          double solver_error);
// The values numbered by `which`.
[[nodiscard]] Looks some_of(const Looks& looks, const std::vector<std::uint32_t>& which);

// Watches some pixels of a picture while the scene is solved again: those asked for.
class PictureWatch {
 public:
  // All must outlive it. pixels: as of raytrace::probe.
  PictureWatch(const StudyScene& scene, const radiosity::Solution& solution,
               const scenes::Camera& camera, const raytrace::RenderOptions& options,
               std::vector<std::uint32_t> pixels);
  void add(radiosity::Look look, const radiosity::Solution& other);

  [[nodiscard]] const Looks& looks() const { return looks_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  std::vector<double> look_at(const radiosity::Solution& solution);

  const StudyScene& scene_;
  const radiosity::Solution& solution_;
  const scenes::Camera& camera_;
  raytrace::RenderOptions options_;
  std::vector<std::uint32_t> pixels_;
  std::uint64_t rays_ = 0;
  Looks looks_;
};

}  // namespace earthshine::studies
