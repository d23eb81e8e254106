// SPDX-License-Identifier: Apache-2.0
// A visibility study as its file has it (docs/visibility.md, "Study files").
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scenes/scene.h"
#include "scenes/time/mission.h"
#include "studies/light/light_basis.h"

namespace earthshine::studies {

// "tss>=0.9": a target is to be detected with that probability.
struct WantedTarget {
  std::string target;
  double probability = 0.5;
  std::string text;  // as it was given
};
// Throws base::Error (Input) at `where` unless it is NAME>=P with P from above 0 to below 1.
[[nodiscard]] WantedTarget read_wanted(const std::string& text, const base::Location& where);

// What a picture of the report shows.
enum class Shows { Clean, Cctv, Distributed, DistributedCctv };
struct PictureWish {
  std::string name, title, camera;
  std::optional<double> position_deg;   // } neither: the first position
  std::optional<scenes::Instant> time;  // } of a study along time
  std::string lamps;                    // a setting's name; empty: the first one
  Shows shows = Shows::Clean;
  int lights = 64;   // of the distributed ones
  std::string cctv;  // another CCTV camera than the camera's own; empty: that
  base::Location where;
};
struct PairWish {
  std::string title, left, right;  // names of pictures
};

struct StudyFile {
  std::filesystem::path path;  // empty: put together from a call
  std::string name;
  std::vector<std::filesystem::path> scenes;  // beside the study's file, or absolute
  std::vector<std::string> overrides;         // as --set has them
  std::vector<std::string> cameras;           // empty: all of the scene
  std::vector<std::string> targets;           // empty: the objects that the scene marks
  std::optional<int> columns, rows;           // none: the camera's own
  std::vector<double> positions_deg;  // along the orbit, rising; empty: the scene's own place
  bool timeline = false;              // the positions are evenly spaced over one turn
  bool usual_positions = false;  // nobody asked for them: a scene with a [time] goes along that
  std::optional<scenes::TimeSpan> time;  // in place of positions, of scenes with a trajectory
  std::vector<LampSetting> lamps;        // never empty
  std::map<std::string, std::string> camera_models;  // CCTV camera by camera
  scenes::Scene cctv;                                // its own [[cctv]] tables and [monitor]
  std::vector<std::string> iris;  // modes that answers choose among; empty: the camera's
  std::vector<WantedTarget> wanted;
  std::vector<PictureWish> pictures;
  std::vector<PairWish> pairs;
  std::map<std::string, base::Location> where;  // of the file's keys; none of a study without one
  double seen_probability = 0.5;                // from which on a target counts as seen
  BasisOptions basis;
  std::vector<std::string> warnings;  // of keys without effect, with their places

  // Where a key stands, or its name.
  [[nodiscard]] base::Location place(const std::string& key) const;
};

// Most positions of a study.
inline constexpr int most_positions = 3600;

// Throws base::Error (Input): where (file:line:column), what was found, what is allowed.
[[nodiscard]] StudyFile read_study_file(const std::filesystem::path& path);

// `count` positions over one turn from 0.
[[nodiscard]] std::vector<double> even_positions(int count);

// Whether that place of the orbit is among them, whole turns apart or not.
[[nodiscard]] bool stands_among(const std::vector<double>& positions_deg, double position_deg);

// The lamps as the scene has them.
[[nodiscard]] LampSetting lamps_as_they_are();

}  // namespace earthshine::studies
