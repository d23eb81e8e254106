// SPDX-License-Identifier: Apache-2.0
// The work of a visibility study for one camera, read from points/ or done and stored there.
#pragma once

#include <functional>
#include <list>
#include <optional>
#include <vector>

#include "app/views/frames.h"
#include "app/visibility/answers.h"
#include "app/visibility/conditions.h"
#include "app/visibility/pictures.h"
#include "app/visibility/run.h"

namespace earthshine::app {

class CameraWork {
 public:
  using Configurations = std::vector<std::vector<ViewingConfiguration>>;  // for each wanted target

  // All arguments must outlive it.
  CameraWork(const PictureTask& pictures, StudyFrames& frames, StudyConditions& conditions);

  [[nodiscard]] const PictureTask& pictures() const { return pictures_; }
  [[nodiscard]] Share all_batches() const { return {0, conditions_.batches()}; }

  // All input of the results besides the scene.
  [[nodiscard]] const Json& settings() const { return answers_key_; }
  // Whether batches of conditions were done before, with the work that belongs to the first batch
  // (the camera's picture, the study's pictures of it, the viewing configurations).
  [[nodiscard]] bool is_done(Share batches) const;
  [[nodiscard]] std::optional<Configurations> known_configurations() const;
  [[nodiscard]] std::optional<Judged> known_conditions() const;
  [[nodiscard]] std::optional<StudyFrames::Frame> known_frame(std::vector<StudyCost>& costs) const;

  // Moves the frame's image.
  [[nodiscard]] studies::BasisView view_of(StudyFrames::Frame& frame,
                                           std::vector<StudyCost>& costs) const;
  [[nodiscard]] Judged judge(const studies::BasisView& view, const StudyFrames::Frame& frame,
                             Share batches, std::vector<StudyCost>& costs) const;
  // Draws the camera's pictures and returns its viewing configurations; no value if interrupted.
  [[nodiscard]] Configurations conclude(const studies::BasisView& view,
                                        std::vector<FigureEntry>& figures) const;

 private:
  const PictureTask& pictures_;
  StudyFrames& frames_;
  StudyConditions& conditions_;
  Json answers_key_;
};

// A visibility study in parts: processes share batches of conditions, ordered by scene and camera.

class StudyShares {
 public:
  // Sets the number of parts in the task.
  StudyShares(StudyTask& task, const Common& common, std::vector<const StudyPart*> parts);

  // Joins the other parts and does the part's task. A share, or the solutions only: returns false.
  // A merge: checks that nothing is missing and returns true. Throws base::Error (Work) if
  // something is missing, or if interrupted.
  [[nodiscard]] bool run();

 private:
  struct Scene {
    Scene(const StudyPart& scene, const StudyTask& task, const Common& common);

    const StudyPart& part;
    StudyFrames frames;
    StudyConditions conditions;
  };
  // first: index of the camera's first batch among all.
  using Visit = std::function<void(const CameraWork&, StudyFrames& frames, std::size_t first)>;
  void for_each_camera(const Visit& visit);
  [[nodiscard]] std::filesystem::path points() const;
  [[nodiscard]] Json digests();
  void do_share();
  void solve();
  void check_complete();

  StudyTask& task_;
  const Common& common_;
  std::vector<const StudyPart*> parts_;
  std::list<Scene> scenes_;
  std::size_t all_batches_ = 0;
  std::vector<StudyCost> costs_;
};

}  // namespace earthshine::app
