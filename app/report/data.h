// SPDX-License-Identifier: Apache-2.0
// Presentation of a study's results: words of verdicts, columns, tables.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/study/results.h"

namespace earthshine::app {

// Presentation of a verdict.
struct VerdictWords {
  const char* mark;  // text of a cell of the matrix, besides its colour
  const char* rest;  // completes the mark to a word
  const char* text;
};
inline constexpr std::array<VerdictWords, 7> verdict_words = {{
    {"I", "dentified", "identified"},
    {"R", "ecognised", "recognised"},
    {"D", "etected", "detected"},
    {"?", " doubtful", "doubtful"},
    {"N", "ot seen", "not seen"},
    {"O", "ut of view", "out of view"},
    {"H", "idden", "hidden"},
}};
[[nodiscard]] constexpr const VerdictWords& words_of(studies::Verdict verdict) {
  return verdict_words[static_cast<std::size_t>(verdict)];
}
[[nodiscard]] constexpr bool is_seen(studies::Verdict verdict) {
  return verdict <= studies::Verdict::Detected;
}

// Numbers of a result, one column each.
enum class Form : std::uint8_t { Plain, Count, Chance, Percent };
struct FigureColumn {
  Figure of;
  const char* title;
  Form form;
  bool brief;  // also shown for studies too large to show all
};
using studies::EyeSight, studies::MonitorSight, studies::Probability, studies::SignalSight;
inline constexpr std::array sight_columns = {
    FigureColumn{chance_of<&Probability::detect>, "P detect", Form::Chance, true},
    FigureColumn{chance_of<&Probability::recognise>, "P recognise", Form::Chance, true},
    FigureColumn{chance_of<&Probability::identify>, "P identify", Form::Chance, true},
    FigureColumn{sight_of<&studies::Sight::pixels>, "pixels", Form::Count, true},
    FigureColumn{sight_of<&studies::Sight::visible_fraction>, "visible, %", Form::Percent, true},
    FigureColumn{figure_of<&TargetFindings::lit_fraction>, "lit, %", Form::Percent, true},
    FigureColumn{sight_of<&studies::Sight::angle_deg>, "angle, °", Form::Plain, false},
    FigureColumn{sight_of<&studies::Sight::tv_lines>, "TV lines", Form::Plain, true},
    FigureColumn{sight_of<&studies::Sight::johnson_cycles>, "Johnson cycles", Form::Plain, false},
    FigureColumn{sight_of<&studies::Sight::luminance>, "luminance, cd/m²", Form::Plain, true},
    FigureColumn{sight_of<&studies::Sight::surround>, "surround, cd/m²", Form::Plain, false},
    FigureColumn{sight_of<&studies::Sight::weber>, "Weber", Form::Plain, true},
    FigureColumn{figure_of<&TargetFindings::luminance_error>, "error of luminance, %",
                 Form::Percent, false},
    FigureColumn{noise_of<&studies::ConditionNoise::relative>, "noise of the picture, %",
                 Form::Percent, false},
    FigureColumn{noise_of<&studies::ConditionNoise::cd_m2>, "noise of the picture, cd/m²",
                 Form::Plain, false},
    FigureColumn{sight_of<&studies::Sight::saturated>, "saturated, %", Form::Percent, false},
    FigureColumn{sight_of<&studies::Sight::crushed>, "crushed, %", Form::Percent, false},
};
inline constexpr std::array signal_columns = {
    FigureColumn{signal_of<&SignalSight::mean>, "signal", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::surround>, "signal around", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::weber>, "signal Weber", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::snr>, "SNR", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::cnr>, "CNR", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::rose>, "Rose", Form::Plain, false},
    FigureColumn{signal_of<&SignalSight::dprime>, "d′", Form::Plain, false},
    FigureColumn{monitor_of<&MonitorSight::luminance>, "monitor, cd/m²", Form::Plain, false},
    FigureColumn{monitor_of<&MonitorSight::surround>, "monitor around, cd/m²", Form::Plain, false},
    FigureColumn{monitor_of<&MonitorSight::weber>, "monitor Weber", Form::Plain, false},
    FigureColumn{eye_of<&EyeSight::threshold>, "eye’s threshold", Form::Plain, false},
    FigureColumn{eye_of<&EyeSight::weber>, "eye’s Weber", Form::Plain, false},
    FigureColumn{eye_of<&EyeSight::cycles>, "eye’s cycles", Form::Plain, false},
    FigureColumn{eye_chance_of<&Probability::detect>, "eye: P detect", Form::Chance, false},
    FigureColumn{eye_chance_of<&Probability::recognise>, "eye: P recognise", Form::Chance, false},
    FigureColumn{eye_chance_of<&Probability::identify>, "eye: P identify", Form::Chance, false},
};

// A table of the report: adjacent conditions of one scene. For an orbit one per lamp setting, by
// ascending position; conditions without a position share one table.
struct Block {
  std::size_t scene;
  std::string lamps;  // "" if the conditions have no position
  std::vector<std::size_t> conditions;
};
[[nodiscard]] std::vector<Block> blocks_of(const StudyResults& study);

// The results of a block by camera, target and index in the block's conditions.
[[nodiscard]] std::vector<std::size_t> results_of(const StudyResults& study, const Block& block);

}  // namespace earthshine::app
