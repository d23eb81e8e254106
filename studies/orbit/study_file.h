// SPDX-License-Identifier: Apache-2.0
// A visibility study as in its file (docs/visibility.md, "Study files").
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

// "tss>=0.9": the wanted probability that a target is detected.
struct WantedTarget {
  std::string target;
  double probability = 0.5;
  std::string text;  // the original text
};
// Throws base::Error (Input) at `where` unless it is NAME>=P with 0 < P < 1.
[[nodiscard]] WantedTarget read_wanted(const std::string& text, const base::Location& where);

// The kind of a picture in the report.
enum class Shows { Clean, Cctv, Distributed, DistributedCctv };
struct PictureWish {
  std::string name, title, camera;
  std::optional<double> position_deg;   // } neither: the first position
  std::optional<scenes::Instant> time;  // } in a study along time
  std::string lamps;                    // a setting's name; empty: the first one
  Shows shows = Shows::Clean;
  int lights = 64;   // of distributed lights
  std::string cctv;  // replaces the camera's CCTV camera; empty: the camera's own
  base::Location where;
};
struct PairWish {
  std::string title, left, right;  // names of pictures
};

struct StudyFile {
  std::filesystem::path path;  // empty: from the command line
  std::string name;
  std::vector<std::filesystem::path> scenes;  // relative to the study's file, or absolute
  std::vector<std::string> overrides;         // in the form of --set
  std::vector<std::string> cameras;           // empty: all cameras of the scene
  std::vector<std::string> targets;           // empty: the objects that the scene marks
  std::optional<int> columns, rows;           // empty: the camera's own
  std::vector<double> positions_deg;  // along the orbit, rising; empty: the scene's own position
  bool timeline = false;              // the positions are evenly spaced over one orbit
  bool usual_positions = false;       // default positions: a scene with a [time] uses that instead
  std::optional<scenes::TimeSpan> time;  // replaces positions, for scenes with a trajectory
  std::vector<LampSetting> lamps;        // never empty
  std::map<std::string, std::string> camera_models;  // CCTV camera by camera
  scenes::Scene cctv;                                // its own [[cctv]] tables and [monitor]
  std::vector<std::string> iris;  // modes that answers choose from; empty: the camera's mode
  std::vector<WantedTarget> wanted;
  std::vector<PictureWish> pictures;
  std::vector<PairWish> pairs;
  std::map<std::string, base::Location> where;  // of the file's keys; empty without a file
  double seen_probability = 0.5;                // from which on a target counts as seen
  BasisOptions basis;
  std::vector<std::string> warnings;  // keys without effect, with their places

  // The place of a key, or its name.
  [[nodiscard]] base::Location place(const std::string& key) const;
};

// Most positions of a study.
inline constexpr int most_positions = 3600;

// Throws base::Error (Input) with the place (file:line:column), the value found and the values
// allowed.
[[nodiscard]] StudyFile read_study_file(const std::filesystem::path& path);

// `count` positions over one orbit from 0.
[[nodiscard]] std::vector<double> even_positions(int count);

// Whether the list contains that position, modulo full orbits.
[[nodiscard]] bool stands_among(const std::vector<double>& positions_deg, double position_deg);

// The lamps as in the scene.
[[nodiscard]] LampSetting lamps_as_they_are();

}  // namespace earthshine::studies
