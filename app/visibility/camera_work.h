// SPDX-License-Identifier: Apache-2.0
// The work of a visibility study on one camera, found in points/ or done and kept there.
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
  using Configurations = std::vector<std::vector<ViewingConfiguration>>;  // of each wanted target

  // All must outlive it.
  CameraWork(const PictureTask& pictures, StudyFrames& frames, StudyConditions& conditions);

  [[nodiscard]] const PictureTask& pictures() const { return pictures_; }
  [[nodiscard]] Share all_batches() const { return {0, conditions_.batches()}; }

  // All that the results depend on besides the scene.
  [[nodiscard]] const Json& settings() const { return answers_key_; }
  // Whether batches of conditions, and what comes with the first of them (the camera's picture, the
  // study's pictures of it, the viewing configurations), were done before.
  [[nodiscard]] bool is_done(Share batches) const;
  [[nodiscard]] std::optional<Configurations> known_configurations() const;
  [[nodiscard]] std::optional<Judged> known_conditions() const;
  [[nodiscard]] std::optional<StudyFrames::Frame> known_frame(std::vector<StudyCost>& costs) const;

  // Takes the frame's image.
  [[nodiscard]] studies::BasisView view_of(StudyFrames::Frame& frame,
                                           std::vector<StudyCost>& costs) const;
  [[nodiscard]] Judged judge(const studies::BasisView& view, const StudyFrames::Frame& frame,
                             Share batches, std::vector<StudyCost>& costs) const;
  // The camera's pictures, and what its wishes are answered by; nothing where an end is asked for.
  [[nodiscard]] Configurations conclude(const studies::BasisView& view,
                                        std::vector<FigureEntry>& figures) const;

 private:
  const PictureTask& pictures_;
  StudyFrames& frames_;
  StudyConditions& conditions_;
  Json answers_key_;
};

// A visibility study in parts: batches of conditions in the order of scenes and cameras, in shares.

class StudyShares {
 public:
  // The task's part is told how many there are.
  StudyShares(StudyTask& task, const Common& common, std::vector<const StudyPart*> parts);

  // Joins the other parts and does what the task's part says: a share, or the solutions alone, and
  // false; or sees that nothing is missing, and true. Throws base::Error (Work) where something is,
  // or once it is interrupted.
  [[nodiscard]] bool run();

 private:
  struct Scene {
    Scene(const StudyPart& scene, const StudyTask& task, const Common& common);

    const StudyPart& part;
    StudyFrames frames;
    StudyConditions conditions;
  };
  // first: number of the camera's first batch among all.
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
