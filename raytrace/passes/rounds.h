// SPDX-License-Identifier: Apache-2.0
// How much a first look at a picture takes, how far each round of samples goes from there to the
// error that is wanted, and when no end of them is in sight.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/passes/sample_plan.h"
#include "raytrace/tuning.h"

namespace earthshine::raytrace {

// Where the first look all over a picture is not enough, samples follow where errors look largest,
// and what looked too small stays so. On the payload bay the true error is 0.89 to 1.08 of what is
// stated at 5 %, and up to 1.1 of it at 2 % (night, camera A). Rounds go on until the
// statement, times the doubt that few pixels leave (ErrorSums), is this share of the wanted error:
// more of a coarse one, since a round more for a hundredth of the samples takes a twentieth of the
// time.
[[nodiscard]] double sure_share(double wanted);

// What a first look casts at gather points. Where a coarse picture is wanted, or any that a time
// limit allows, half as many gather rays and paths, and of all three kinds none at every second
// pixel where no edge is near: smooth pictures are done with that, and of others it tells as well
// as the whole where more samples should go (payload bay, 5 %; at 3 % it does not). In small
// pictures more paths, for light that few of them find.
struct FirstLook {
  std::uint32_t gather_rays = tuning::initial_gather_rays;
  std::uint32_t paths = tuning::initial_paths, lobe_rays = tuning::initial_lobe_rays;
  bool every_second = false;  // GatherField::look_first()
};
[[nodiscard]] FirstLook first_look(double wanted, std::size_t points);

// Samples that are not shared: the rays of a pixel are divided so that its edges and the hemisphere
// get about equal attention. Without gather rays the samples serve edges, lamps and lenses alone.
struct PixelSamples {
  int camera_samples = 16;  // per pixel
  int gather_rays = 16;     // per camera sample
};
[[nodiscard]] PixelSamples share_out(int rays_per_pixel, bool gathers);

class Rounds {
 public:
  // wanted: relative to the mean luminance; 0: as small as can be.
  explicit Rounds(double wanted) : wanted_(wanted) {}

  // Looks at the picture's error. so_far, affordable: what its samples have cost, and what more may
  // (rays of a packet). No plan: the error is reached, or no samples can be afforded, or
  // gave_up().
  [[nodiscard]] std::optional<SamplePlan> next(SamplePlanner& planner, double so_far,
                                               double affordable);
  // Far more samples than the error should have taken have not brought it much down.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  // By the last look alone: samples in all over those so far.
  [[nodiscard]] double growth() const;
  // The same by where they would go.
  [[nodiscard]] double growth(SamplePlanner& planner, double so_far) const;

  // That was stated after samples of that cost, and its doubt (ErrorSums).
  struct Look {
    double cost = 0.0, error = 0.0, doubt = 1.0;
  };
  // Whether the last of these looks is after 1024 times the samples of one whose error it has not
  // halved: of noise that all samples know of they leave a thirty-second, but a first look may miss
  // most of what there is.
  [[nodiscard]] static bool is_hopeless(const std::vector<Look>& looks);

 private:
  [[nodiscard]] double squared_aim(double doubt) const {
    const double aim = tuning::planned_share * wanted_ / doubt;
    return aim * aim;
  }

  double wanted_;
  std::vector<Look> looks_;
  bool gave_up_ = false;
};

}  // namespace earthshine::raytrace
