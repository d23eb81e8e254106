// SPDX-License-Identifier: Apache-2.0
// One scene of a visibility study, with all data that its conditions share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cctv/cctv.h"
#include "app/command.h"
#include "scenes/ray_query.h"
#include "studies/light/light_basis.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// "orbit 30 deg", or for a study along time the UTC of the spacecraft's position: `moments` are the
// times of positions_deg, which are ascending, or empty.
[[nodiscard]] std::string place_text(const std::vector<double>& positions_deg,
                                     const std::vector<scenes::Instant>& moments,
                                     double position_deg);

struct StudyCamera {
  const scenes::Camera* camera = nullptr;
  int columns = 0, rows = 0;
  std::optional<CctvSetup> cctv;
};

// Of pose, lens, size and CCTV.
[[nodiscard]] std::string camera_digest(const StudyCamera& camera);

// One scene, or one pose of a scene whose joints move. Not movable: its members refer to each
// other.
struct StudyPart {
  std::string id;         // "s0", "s1", ...; of a later pose of its joints "s0-p1", ...
  std::size_t scene = 0;  // its number in the study
  std::string path;       // as the study has it
  std::string pose;       // of its joints and tracks, for people; empty without
  LoadedScene loaded;
  std::vector<double> positions_deg;  // empty: the scene's own position
  // Time of each position since orbit noon; along time, since the first time.
  std::vector<double> times_s;
  std::vector<scenes::Instant> moments;  // along time, positions_deg exceed 360; else empty
  std::unique_ptr<const studies::LightBasis> basis;
  LoadedScene basis_scene;  // of the basis, with its groups and effects
  std::unique_ptr<const scenes::RayQuery> query;
  const StudyPart* first_pose =
      nullptr;  // of its scene: whose patches it has; null: it is the first
  std::vector<StudyCamera> cameras;
  std::vector<const scenes::Camera*> skipped;  // inside a body
  std::string skipped_at;                      // of one of several poses: its UTC; else empty
  std::vector<std::string> targets;

  // "orbit 30 deg", or along time "2026-03-01T12:00:00Z".
  [[nodiscard]] std::string place_text(std::size_t place) const {
    return earthshine::app::place_text(positions_deg, moments, positions_deg[place]);
  }
  [[nodiscard]] std::size_t conditions() const {
    return basis->places().size() * basis->settings().size();
  }
  // Units of Work::StudyPicture.
  [[nodiscard]] double picture_units(const StudyCamera& camera) const {
    constexpr double groups_of_double_cost = 20.0;  // measured on sts46
    return double(camera.columns) * camera.rows *
           (1.0 + static_cast<double>(basis->groups().count()) / groups_of_double_cost);
  }
};

using StudyParts = std::vector<std::unique_ptr<StudyPart>>;

// Reads and checks everything that the study names in one of its scenes. Along time a scene with
// moving joints is a part for each run of moments in one pose, in their order. Throws base::Error
// (Input) before any light is computed.
[[nodiscard]] StudyParts prepare_parts(const studies::StudyFile& study, std::size_t index,
                                       const Common& common);

}  // namespace earthshine::app
