// SPDX-License-Identifier: Apache-2.0
// The reference pictures of the ladder.
#include <algorithm>
#include <cmath>

#include "base/numbers/random.h"
#include "studies/accuracy/accuracy.h"

namespace earthshine::studies {

std::uint64_t reference_seed(std::uint64_t seed, int side, int index) {
  // Far from the seeds that a user may give for other runs.
  constexpr std::uint64_t mark = 0x7265666572656e63ULL;
  return base::mix64(base::mix64(seed ^ mark) + 2 * static_cast<std::uint64_t>(index) +
                     static_cast<std::uint64_t>(side));
}

std::optional<base::Image> trace_batch(const scenes::World& study, const AccuracyView& view,
                                       const Batch& batch, const raytrace::Progress& progress) {
  scenes::Asked asked;
  asked.cameras = {&view.camera};
  asked.paths = scenes::LightPaths::Traced;
  const scenes::Effects effects = scenes::find_effects(study.scene, study.groups, asked);
  const raytrace::Frame frame =
      raytrace::trace_paths({study.scene, study.groups, effects, study.query}, view.camera,
                            {view.columns, view.rows, batch.paths_per_pixel, false, batch.paths,
                             reference_seed(view.seed, batch.side, batch.index), view.stop},
                            progress);
  if (frame.report.stopped) return std::nullopt;
  base::Image kept{frame.image.width, frame.image.height, {}};
  const raytrace::StatedError& stated = frame.error;
  kept.channels.push_back({"Y", stated.luminance});
  base::Channel& variance = kept.channels.emplace_back(base::Channel{"variance", {}});
  for (const auto& parts : stated.squared) {
    variance.values.push_back(parts[static_cast<std::size_t>(raytrace::ErrorPart::Camera)]);
  }
  const std::vector<bool> counted = stated.counted();
  kept.channels.push_back({"counts", {counted.begin(), counted.end()}});
  return kept;
}

NoisyPicture mean_of_batches(const std::vector<Batch>& batches,
                             const std::vector<base::Image>& pictures) {
  double paths = 0.0;
  for (const Batch& batch : batches) paths += batch.paths_per_pixel;
  const std::size_t pixels = pictures.front().pixel_count();
  NoisyPicture mean{std::vector<double>(pixels), std::vector<double>(pixels),
                    std::vector<bool>(pixels, true)};
  for (std::size_t k = 0; k < batches.size(); ++k) {
    const double weight = batches[k].paths_per_pixel / paths;
    const std::vector<float>& luminance = pictures[k].find("Y")->values;
    const std::vector<float>& variance = pictures[k].find("variance")->values;
    const std::vector<float>& counts = pictures[k].find("counts")->values;
    for (std::size_t p = 0; p < pixels; ++p) {
      mean.luminance[p] += weight * double(luminance[p]);
      mean.variance[p] += weight * weight * double(variance[p]);
      mean.counts[p] = mean.counts[p] && counts[p] > 0.0F;
    }
  }
  return mean;
}

std::vector<int> further_batches(int first_paths, double found, double wanted, int most) {
  constexpr int largest = 64;  // limits the loss of an interrupted run
  std::vector<int> batches;
  if (!(found > wanted) || !(wanted > 0.0)) return batches;
  const double ratio = found / wanted;
  const double needed = std::min(double(most), std::ceil(first_paths * ratio * ratio));
  for (int left = static_cast<int>(needed) - first_paths; left > 0; left -= largest) {
    batches.push_back(std::max(2, std::min(largest, left)));
  }
  return batches;
}

bool leaves_paths_out(const scenes::Effects& effects) {
  return effects.mirror || effects.refraction;
}

AccuracyStep straight_step(double error) {
  AccuracyStep step;
  step.method = "direct";
  step.series = series::error;
  step.setting = error;
  step.indirect = raytrace::Indirect::None;
  step.quality.error = error;
  return step;
}

}  // namespace earthshine::studies
