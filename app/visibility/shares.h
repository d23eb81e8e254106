// SPDX-License-Identifier: Apache-2.0
// A visibility study in parts: batches of conditions in the order of scenes and cameras, in shares.
#pragma once

#include <functional>
#include <list>
#include <vector>

#include "app/visibility/camera_work.h"
#include "app/visibility/run.h"

namespace earthshine::app {

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
