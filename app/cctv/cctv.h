// SPDX-License-Identifier: Apache-2.0
// The CCTV stage for the commands: camera and monitor, the picture, reports.
#pragma once

#include <string>
#include <type_traits>

#include "app/command.h"
#include "app/output.h"
#include "base/image.h"
#include "degrade/chain.h"
#include "degrade/settings/camera_file.h"
#include "degrade/twin.h"
#include "scenes/scene.h"

namespace earthshine::app {

inline constexpr std::string_view default_preset = "sit-monochrome";

struct CctvSetup {
  std::string name;  // of the [[cctv]] table or preset
  degrade::Setup chain;
};

// The CCTV model of `camera`, or the default preset, which is noted on standard error unless
// `quiet`. Uses the scene's [monitor]; each camera of a scene has independent noise.
[[nodiscard]] CctvSetup cctv_of_camera(const scenes::Scene& scene, const scenes::Camera& camera,
                                       const Common& common);
[[nodiscard]] CctvSetup cctv_of(const degrade::ResolvedCamera& camera, const Common& common);
// A built-in camera with its monitor. Throws base::Error (Input) for an unknown name.
[[nodiscard]] CctvSetup cctv_of_preset(const std::string& name, const Common& common);

[[nodiscard]] degrade::Result run_chain(const CctvSetup& setup, const base::Image& radiance);

// The value of a setting; enumerators as words.
template <class Value>
[[nodiscard]] Json setting_json(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return degrade::word_of(value);
  } else {
    return value;
  }
}
// All settings in use.
[[nodiscard]] Json settings_json(const degrade::CctvCamera& camera);
[[nodiscard]] Json monitor_json(const degrade::Monitor& monitor);

// Writes a PNG, or an EXR of the displayed luminance in cd/m^2. The header has the settings, the
// exposure, and `more`.
void write_cctv(const std::string& path, const CctvSetup& setup, const degrade::Result& result,
                const HeaderTexts& more = {});

void write_twin(const std::string& path, const CctvSetup& setup, const degrade::Twin& twin,
                const degrade::Result& noisy, const HeaderTexts& more = {});
// Medians over the resels, and the share of the picture where a target is visible with probability
// one half or more.
[[nodiscard]] Json twin_json(const degrade::Twin& twin);

[[nodiscard]] Json cctv_json(const CctvSetup& setup, const degrade::Result& result);
// One line for people: f-number, gain, clipping.
[[nodiscard]] std::string cctv_summary(const CctvSetup& setup, const degrade::Result& result);

// Pictures after each stage of the CCTV chain, as files.

// During its lifetime the chain run with `options` writes DIR/NN-stage.exr after each stage, in the
// stage's unit. An empty folder name disables it. Throws base::Error (Input) if an input lies in
// the folder, and (Work) if a file cannot be written.
class StagePictures {
 public:
  StagePictures(std::string folder, const Files& inputs, degrade::Options& options);
  ~StagePictures();
  StagePictures(const StagePictures&) = delete;
  StagePictures& operator=(const StagePictures&) = delete;

 private:
  std::string folder_;
  degrade::Options& options_;
};

// The active stages of a CCTV camera, and the settings that decide.

// {"stage", "runs", "why"} for every stage in order; empty without a CCTV model. asked: the call
// needs the monitor picture, with the default model if the camera names none.
[[nodiscard]] Json plan_cctv(const scenes::Scene& scene, const scenes::Camera& camera, bool asked);

}  // namespace earthshine::app
