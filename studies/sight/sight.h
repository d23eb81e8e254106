// SPDX-License-Identifier: Apache-2.0
// How well a camera's viewer sees each target, from where the target stands
// (studies/targets/target_view.h) and one linear picture: by the monitor of its CCTV, and by eye
// through a window in its place. docs/studies.md has all formulas, thresholds and their sources. A
// figure that does not exist is empty, never NaN or infinite; what has no noise counts with
// degrade::most_snr.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "degrade/chain.h"
#include "scenes/scene.h"
#include "studies/sight/johnson.h"
#include "studies/targets/target_view.h"

namespace earthshine::studies {

struct SightOptions {
  double eye_integration_s = 0.2;     // over which the viewer's eye averages frames
  double frame_s = 1.0 / 30.0;        // of the CCTV: two fields
  double even_chance_snr = 2.8;       // SNR_D that is seen in half of all cases (Rosell, Willson)
  double seen_probability = 0.5;      // from which on a verdict says so
  double doubtful_probability = 0.1;  // below: not seen
  double hidden_fraction = 0.1;       // visible fraction below which a target is hidden
  double most_black_back = 0.5;       // share of its seen pixels from which on a target is doubtful
  CyclesNeeded cycles;
  EyeOptions eye;
};

enum class Verdict { Identified, Recognised, Detected, Doubtful, NotSeen, OutOfView, Hidden };
// "identified", "recognised", "detected", "doubtful", "not-seen", "out-of-view", "hidden".
[[nodiscard]] std::string_view word_of(Verdict verdict);

// In the line signal v, 0 black and 1 white, with noise: target t and surround b.
struct SignalSight {
  double mean = 0.0;                 // of t
  double snr = 0.0;                  // mean / sigma of a resel of t in one frame
  std::optional<double> surround;    // mean of b; all below are empty without one
  std::optional<double> weber;       // (t - b) / b; none round black
  std::optional<double> cnr;         // |t - b| / sqrt((sigma_t^2 + sigma_b^2) / 2), one frame
  std::optional<double> rose;        // k: the same of the whole target in the eye's time
  std::optional<double> snr_d;       // |t - b| / sigma of that difference in the eye's time
  std::optional<double> difference;  // root mean square of t - b over the target's parts
  std::optional<double> dprime;      // ideal observer that knows the target's shape, in that time
  std::optional<double> limiting_frequency;  // cycles per resel where C0 MTF(u) = 3 / SNR of a bar
};

// On the screen, cd/m^2, as a viewer sees it on average: with noise, phosphor spread and room
// light.
struct MonitorSight {
  double luminance = 0.0;
  std::optional<double> surround, weber;
  std::optional<double> threshold;  // Weber contrast that the eye sees there in half of all cases
};

// The eye in the camera's place, adapted to the mean luminance of the view.
struct EyeSight {
  double adaptation = 0.0;          // cd/m^2
  double acuity = 0.0;              // cycles per degree
  double cycles = 0.0;              // across the target
  std::optional<double> threshold;  // Weber contrast; none without a surround or round black
  std::optional<double> weber;
  std::optional<Probability> probability;  // none without a surround
};

// Factors on the difference between target and surround: the ends of its 95 % interval over it.
struct ContrastBounds {
  double low = 1.0, high = 1.0;
};

struct Sight {
  Verdict verdict = Verdict::OutOfView;
  // With the difference between target and surround at the ends of its 95 % interval.
  Verdict verdict_low = Verdict::OutOfView, verdict_high = Verdict::OutOfView;
  // Of the monitor's viewer, or of the eye where there is no CCTV. None out of view, hidden
  // altogether, or where the target fills the picture: nothing is there to tell it from.
  std::optional<Probability> probability;

  std::size_t pixels = 0;
  std::optional<double> visible_fraction;  // none where it would not even show alone
  bool cut_by_frame = false;
  std::optional<double> shown_from, shown_to;  // ShownRange of the view, cd/m^2; with a CCTV

  // None of those below where no pixel is seen.
  std::optional<double> angle_deg;  // that the seen part's least extent subtends
  std::optional<double> tv_lines;   // over that extent: lines of the CCTV, else rows of the picture
  std::optional<double> luminance, surround, weber;  // of the scene, cd/m^2
  std::optional<SignalSight> signal;                 // with a CCTV
  std::optional<MonitorSight> monitor;               // with a CCTV
  std::optional<double> johnson_cycles;              // with a CCTV and a surround
  std::optional<double> saturated, crushed;          // shares of the seen pixels; with a CCTV
  std::optional<double> black_back;                  // share of them that shows a black back
  std::optional<EyeSight> eye;
};

struct TargetResels;  // studies/sight/target_signal.h

// What stays while light, iris and lamps change.
struct SightTarget {
  TargetView view;
  std::vector<std::uint32_t> seen;  // pixels in ascending order
  Extent extent;
  // Parts of view.measured and of the surround beside it, by direction from the target's middle:
  // up to eight, none with fewer than 16 pixels of either. A large target in sun and shadow may be
  // as bright as its surround on average and stand out against it everywhere; probabilities go by
  // the root mean square of the parts' differences. Empty: the target is one part.
  struct Part {
    std::vector<std::uint32_t> target, surround;
    double share = 0.0;  // of the pixels of all parts
  };
  std::vector<Part> parts;
  // Of a placed plan (place_targets); what is null is found at each measure_sight.
  std::shared_ptr<const TargetResels> resels;
};
struct SightPlan {
  ObjectMap map;
  double fov_deg = 0.0;  // vertical
  std::vector<SightTarget> targets;
};
[[nodiscard]] SightPlan plan_sight(const scenes::Camera& camera, ObjectMap map,
                                   std::vector<TargetView> views);

// Finds once on which resels of that CCTV and its screen the targets stand. Worth it where
// measure_sight is called often; it does so itself where monitor or stages are others.
void place_targets(SightPlan& plan, const degrade::Setup& cctv);

struct CameraSight {
  double mean_luminance = 0.0;                // of the whole view, cd/m^2
  std::optional<degrade::Exposure> exposure;  // of the CCTV
  std::vector<Sight> targets;                 // one for each of the plan's
};

// radiance: R, G, B or Y in cd/m^2, of the plan's size. cctv: its seed does not matter. The camera
// is taken to have looked for long at a scene that is still but for targets that move. A target of
// which black backs show is at best doubtful: how its real back looks is not known. Throws as
// degrade::degrade does, and base::Error (Input) if the sizes differ.
// deviation: of each target, the standard error of the difference of mean luminances, target less
// surround, cd/m^2; empty: the picture is exact. The bounds are 1.96 of it off; where the target has
// m parts, whose differences of m times that variance add up as squares, the lower one is
// (1.96^2 + m)^(1/2) of it off.
[[nodiscard]] CameraSight measure_sight(const SightPlan& plan, const base::Image& radiance,
                                        const std::optional<degrade::Setup>& cctv,
                                        const SightOptions& options = {},
                                        std::span<const double> deviation = {});

}  // namespace earthshine::studies
