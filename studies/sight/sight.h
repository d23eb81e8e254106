// SPDX-License-Identifier: Apache-2.0
// How well a viewer sees each target, from the target's view (studies/targets/target_view.h) and
// one linear picture: on the monitor of the camera's CCTV, and by eye through a window in its
// place. docs/studies.md has all formulas, thresholds and their sources. A value that does not
// exist is empty, never NaN or infinite; without noise, the SNR is degrade::most_snr.
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
  double even_chance_snr = 2.8;       // SNR_D that half of all viewers see (Rosell, Willson)
  double seen_probability = 0.5;      // from which on a verdict is positive
  double doubtful_probability = 0.1;  // below: not seen
  double hidden_fraction = 0.1;       // visible fraction below which a target is hidden
  double most_black_back = 0.5;       // share of the seen pixels from which on a target is doubtful
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
  std::optional<double> surround;    // mean of b; all values below are empty without it
  std::optional<double> weber;       // (t - b) / b; empty for a black surround
  std::optional<double> cnr;         // |t - b| / sqrt((sigma_t^2 + sigma_b^2) / 2), one frame
  std::optional<double> rose;        // k: the CNR of the whole target in the eye's time
  std::optional<double> snr_d;       // |t - b| / sigma of that difference in the eye's time
  std::optional<double> difference;  // root mean square of t - b over the target's parts
  std::optional<double> dprime;      // ideal observer that knows the target's shape, in that time
  std::optional<double> limiting_frequency;  // cycles per resel where C0 MTF(u) = 3 / SNR of a bar
};

// Mean luminances on the screen, cd/m^2, as the viewer sees them: with noise, phosphor spread and
// room light.
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
  std::optional<double> threshold;  // Weber contrast; empty without a surround, or if that is black
  std::optional<double> weber;
  std::optional<Probability> probability;  // empty without a surround
};

// Factors on the difference between target and surround: the ends of its 95 % interval over it.
struct ContrastBounds {
  double low = 1.0, high = 1.0;
};

struct Sight {
  Verdict verdict = Verdict::OutOfView;
  // For the difference between target and surround at the ends of its 95 % interval.
  Verdict verdict_low = Verdict::OutOfView, verdict_high = Verdict::OutOfView;
  // Of the monitor's viewer, or of the eye without CCTV. Empty out of view, completely hidden, or
  // if the target fills the picture and has no surround.
  std::optional<Probability> probability;

  std::size_t pixels = 0;
  std::optional<double> visible_fraction;  // empty if the target alone would not be in view
  bool cut_by_frame = false;
  std::optional<double> shown_from, shown_to;  // ShownRange of the view, cd/m^2; with a CCTV

  // The following are empty if no pixel is seen.
  std::optional<double> angle_deg;  // subtended by the visible part's least extent
  std::optional<double> tv_lines;   // over that extent: lines of the CCTV, otherwise rows of the
                                    // picture
  std::optional<double> luminance, surround, weber;  // of the scene, cd/m^2
  std::optional<SignalSight> signal;                 // with a CCTV
  std::optional<MonitorSight> monitor;               // with a CCTV
  std::optional<double> johnson_cycles;              // with a CCTV and a surround
  std::optional<double> saturated, crushed;          // shares of the seen pixels; with a CCTV
  std::optional<double> black_back;                  // share of the seen pixels with a black back
  std::optional<EyeSight> eye;
};

struct TargetResels;  // studies/sight/target_signal.h

// Data that do not depend on light, iris and lamps.
struct SightTarget {
  TargetView view;
  std::vector<std::uint32_t> seen;  // pixels in ascending order
  Extent extent;
  // Parts of view.measured and of the surround beside it, by direction from the target's centre: up
  // to eight, each with at least 16 pixels of both. A large target in sun and shadow may equal its
  // surround on average but differ from it everywhere; probabilities use the root mean square of
  // the parts' differences. Empty: the target is one part.
  struct Part {
    std::vector<std::uint32_t> target, surround;
    double share = 0.0;  // of the pixels of all parts
  };
  std::vector<Part> parts;
  // After place_targets(); null: measure_sight() computes it in each call.
  std::shared_ptr<const TargetResels> resels;
};
struct SightPlan {
  ObjectMap map;
  double fov_deg = 0.0;  // vertical
  std::vector<SightTarget> targets;
};
[[nodiscard]] SightPlan plan_sight(const scenes::Camera& camera, ObjectMap map,
                                   std::vector<TargetView> views);

// Computes once the targets' resels on that CCTV and its screen, for many calls of measure_sight.
// The latter computes them itself for another monitor or other stages.
void place_targets(SightPlan& plan, const degrade::Setup& cctv);

struct CameraSight {
  double mean_luminance = 0.0;                // of the whole view, cd/m^2
  std::optional<degrade::Exposure> exposure;  // of the CCTV
  std::vector<Sight> targets;                 // one for each target of the plan
};

// radiance: R, G, B or Y in cd/m^2, of the plan's size. cctv: its seed has no effect. The scene is
// static except for moving targets, and the camera is in its steady state. A target that shows
// black backs is at best doubtful, because the luminance of the real backs is unknown. Throws as
// degrade::degrade does, and base::Error (Input) if the sizes differ.
// deviation: per target, the standard error of the difference of mean luminances, target minus
// surround, cd/m^2; empty: the picture is exact. The bounds are 1.96 standard errors away. For m
// parts, each difference has m times that variance, and their squares add up: the lower bound is
// (1.96^2 + m)^(1/2) standard errors away.
[[nodiscard]] CameraSight measure_sight(const SightPlan& plan, const base::Image& radiance,
                                        const std::optional<degrade::Setup>& cctv,
                                        const SightOptions& options = {},
                                        std::span<const double> deviation = {});

}  // namespace earthshine::studies
