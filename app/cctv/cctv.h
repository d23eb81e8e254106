// SPDX-License-Identifier: Apache-2.0
// The CCTV stage as the commands use it: which camera and monitor, the picture, what to tell about
// it.
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

// What `camera` of the scene names, or the default preset, which is said on standard error unless
// `quiet`. The scene's [monitor]; each camera of a scene has noise of its own.
[[nodiscard]] CctvSetup cctv_of_camera(const scenes::Scene& scene, const scenes::Camera& camera,
                                       const Common& common);
[[nodiscard]] CctvSetup cctv_of(const degrade::ResolvedCamera& camera, const Common& common);
// A camera that ships, with its monitor. Throws base::Error (Input) for an unknown name.
[[nodiscard]] CctvSetup cctv_of_preset(const std::string& name, const Common& common);

// Whether a frame depends on those before it: by an iris that takes its time, or by lag.
[[nodiscard]] bool remembers(const degrade::CctvCamera& camera);

[[nodiscard]] degrade::Result run_chain(const CctvSetup& setup, const base::Image& radiance);

// The value of a setting; an enumerator as its word.
template <class Value>
[[nodiscard]] Json setting_json(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return degrade::word_of(value);
  } else {
    return value;
  }
}
// Every setting in use.
[[nodiscard]] Json settings_json(const degrade::CctvCamera& camera);
[[nodiscard]] Json monitor_json(const degrade::Monitor& monitor);

// A PNG, or an EXR of what the viewer sees in cd/m^2; both say the settings and the exposure, and
// `more`.
void write_cctv(const std::string& path, const CctvSetup& setup, const degrade::Result& result,
                const HeaderTexts& more = {});

void write_twin(const std::string& path, const CctvSetup& setup, const degrade::Twin& twin,
                const degrade::Result& noisy, const HeaderTexts& more = {});
// Medians over the resels, and the share of the picture where a target is seen as often as not.
[[nodiscard]] Json twin_json(const degrade::Twin& twin);

[[nodiscard]] Json cctv_json(const CctvSetup& setup, const degrade::Result& result);
// One line for people: f-number, gain, what clips.
[[nodiscard]] std::string cctv_summary(const CctvSetup& setup, const degrade::Result& result);

// The picture after each stage of the CCTV chain, as files.

// While it lives, the chain run with `options` writes DIR/NN-stage.exr after each stage, in the
// stage's unit. An empty folder name: nothing. Throws base::Error (Input) when an input
// lies in the folder, and (Work) when a file cannot be written.
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

// Which stages of a CCTV camera run, and the settings that decided.

// {"stage", "runs", "why"} of every stage in order; empty when no CCTV model is named or asked for.
// asked: the call wants the picture on the monitor, of the default model if the camera names none.
[[nodiscard]] Json plan_cctv(const scenes::Scene& scene, const scenes::Camera& camera, bool asked);

}  // namespace earthshine::app
