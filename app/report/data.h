// SPDX-License-Identifier: Apache-2.0
// study.json as values: checked, its names turned into indices.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

using Number = std::optional<double>;  // nullopt: does not exist

enum class Verdict : std::uint8_t {
  Identified,
  Recognised,
  Detected,
  Doubtful,
  NotSeen,
  OutOfView,
  Hidden
};
struct VerdictWords {
  const char* key;   // in study.json
  const char* mark;  // what a cell of the matrix shows, beside its colour
  const char* rest;  // what makes a word of the mark
  const char* text;
};
inline constexpr std::array<VerdictWords, 7> verdict_words = {{
    {"identified", "I", "dentified", "identified"},
    {"recognised", "R", "ecognised", "recognised"},
    {"detected", "D", "etected", "detected"},
    {"doubtful", "?", " doubtful", "doubtful"},
    {"not-seen", "N", "ot seen", "not seen"},
    {"out-of-view", "O", "ut of view", "out of view"},
    {"hidden", "H", "idden", "hidden"},
}};
[[nodiscard]] constexpr const VerdictWords& words_of(Verdict verdict) {
  return verdict_words[static_cast<std::size_t>(verdict)];
}
[[nodiscard]] constexpr bool is_seen(Verdict verdict) { return verdict <= Verdict::Detected; }

// The figures of a result, one column each.
enum class Form : std::uint8_t { Plain, Count, Chance, Percent };
struct FigureColumn {
  const char* part;  // the object inside the result that has it, or ""
  const char* key;
  const char* title;
  Form form;
  bool brief;  // also shown of a study so large that not all can be
};
inline constexpr std::array sight_columns = {
    FigureColumn{"probability", "detect", "P detect", Form::Chance, true},
    FigureColumn{"probability", "recognise", "P recognise", Form::Chance, true},
    FigureColumn{"probability", "identify", "P identify", Form::Chance, true},
    FigureColumn{"", "pixels", "pixels", Form::Count, true},
    FigureColumn{"", "visible_fraction", "visible, %", Form::Percent, true},
    FigureColumn{"", "lit_fraction", "lit, %", Form::Percent, true},
    FigureColumn{"", "angle_deg", "angle, °", Form::Plain, false},
    FigureColumn{"", "tv_lines", "TV lines", Form::Plain, true},
    FigureColumn{"", "johnson_cycles", "Johnson cycles", Form::Plain, false},
    FigureColumn{"", "luminance", "luminance, cd/m²", Form::Plain, true},
    FigureColumn{"", "surround", "surround, cd/m²", Form::Plain, false},
    FigureColumn{"", "weber", "Weber", Form::Plain, true},
    FigureColumn{"", "luminance_error", "error of luminance, %", Form::Percent, false},
    FigureColumn{"", "saturated", "saturated, %", Form::Percent, false},
    FigureColumn{"", "crushed", "crushed, %", Form::Percent, false},
};
inline constexpr std::array signal_columns = {
    FigureColumn{"signal", "mean", "signal", Form::Plain, false},
    FigureColumn{"signal", "surround", "signal around", Form::Plain, false},
    FigureColumn{"signal", "weber", "signal Weber", Form::Plain, false},
    FigureColumn{"signal", "snr", "SNR", Form::Plain, false},
    FigureColumn{"signal", "cnr", "CNR", Form::Plain, false},
    FigureColumn{"signal", "rose", "Rose", Form::Plain, false},
    FigureColumn{"signal", "dprime", "d′", Form::Plain, false},
    FigureColumn{"monitor", "luminance", "monitor, cd/m²", Form::Plain, false},
    FigureColumn{"monitor", "surround", "monitor around, cd/m²", Form::Plain, false},
    FigureColumn{"monitor", "weber", "monitor Weber", Form::Plain, false},
    FigureColumn{"eye", "threshold", "eye’s threshold", Form::Plain, false},
    FigureColumn{"eye", "weber", "eye’s Weber", Form::Plain, false},
    FigureColumn{"eye", "cycles", "eye’s cycles", Form::Plain, false},
    FigureColumn{"eye.probability", "detect", "eye: P detect", Form::Chance, false},
    FigureColumn{"eye.probability", "recognise", "eye: P recognise", Form::Chance, false},
    FigureColumn{"eye.probability", "identify", "eye: P identify", Form::Chance, false},
};

struct GroupShare {
  std::string group;
  Number value;
};
struct SceneEntry {
  std::string id, name, path;
};
struct CameraEntry {
  std::size_t scene;
  std::string name, cctv, iris, error_text;
  Number columns, rows, fov_deg, relative_noise, render_seconds;
};
struct ConditionEntry {
  std::string id, name, lamps, phase;
  std::size_t scene;
  Number position_deg, time_s, sun_share, earth_error;
  std::vector<GroupShare> factors;
};
struct Reason {
  std::string cause, by, text;
  Number share, probability_without;
};
struct ResultEntry {
  std::size_t condition, camera, target;
  Verdict verdict;
  std::array<Number, sight_columns.size()> sight;
  std::array<Number, signal_columns.size()> signal;
  std::vector<GroupShare> lit_by, light_by, light_from;
  bool cut_by_frame;
  std::string why;
  std::vector<Reason> reasons;
};
struct Timeline {
  std::string scene, camera, target, lamps;  // names, as shown
  std::vector<Number> position_deg, time_s, sun_share, detect, recognise, identify, luminance,
      weber;
};
struct AnswerEntry {
  std::string wanted, target, text, camera, iris, lamps;
  bool found;
  Number least, least_factor;
  std::vector<std::pair<double, double>> arcs_deg;
};
struct PictureEntry {
  std::string file, caption;
};
struct PairEntry {
  std::string title;
  PictureEntry left, right;
};
// Of a condition as a camera shows it; monitor: "" without a CCTV.
struct ThumbnailEntry {
  std::size_t condition, camera;
  std::string file, monitor;
};
struct CostEntry {
  std::string stage;
  Number seconds, rays;
};

struct StudyResults {
  std::string name, version;
  bool complete;
  std::vector<SceneEntry> scenes;
  std::vector<CameraEntry> cameras;
  std::vector<std::string> targets;
  std::vector<ConditionEntry> conditions;
  std::vector<ResultEntry> results;
  std::vector<Timeline> timelines;
  std::vector<AnswerEntry> answers;
  std::vector<PairEntry> pairs;
  std::vector<PictureEntry> figures;
  std::vector<ThumbnailEntry> thumbnails;
  std::vector<CostEntry> costs;
  std::vector<std::string> notes;
  Json settings, provenance;
};

// Throws base::Error (Input) with the place in `file` where something is not as it should be.
[[nodiscard]] StudyResults read_results(const std::string& file, const Json& json);

// A table of the report: conditions of one scene that stand side by side. Of an orbit one per lamp
// setting, by rising position; conditions without a position are together in one.
struct Block {
  std::size_t scene;
  std::string lamps;  // "" where the conditions have no position
  std::vector<std::size_t> conditions;
};
[[nodiscard]] std::vector<Block> blocks_of(const StudyResults& study);

// The results of a block by camera, target and place in the block's conditions.
[[nodiscard]] std::vector<std::size_t> results_of(const StudyResults& study, const Block& block);

}  // namespace earthshine::app
