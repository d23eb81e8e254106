// SPDX-License-Identifier: Apache-2.0
// earthshine study visibility: all cameras and targets of the scene at its own position; study
// orbit: along the orbit; study run: a study file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/options.h"
#include "app/study/results.h"
#include "app/study/study.h"
#include "app/visibility/run.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

struct VisibilityCall {
  StudyCall study;
  std::vector<std::string> wanted, iris;
  bool dry_run = false;
  ToneChoice tone = {};
};

struct OrbitCall : VisibilityCall {
  std::uint64_t positions = 0;  // 0: unset
  std::string at;               // positions in degrees, in any order, separated by commas
};

struct FileCall {
  std::string file, folder;
  PartCall part;
  bool json = false, dry_run = false;
  ToneChoice tone = {};
};

std::vector<double> positions_of(const std::string& text) {
  std::vector<double> positions;
  for (const std::string& word : split_at_commas(text)) {
    const auto read = parsed<double>(word);
    if (!read || !(std::abs(*read) <= 360.0)) {
      throw base::Error(base::Blame::Input, "--at", fmt::format("\"{}\" is no position", word),
                        "allowed are numbers from -360 to 360, with commas between",
                        "Write for instance --at 0,90,180");
    }
    const double value = *read;
    if (studies::stands_among(positions, value)) {
      throw base::Error(base::Blame::Input, "--at",
                        fmt::format("the place of {:g} stands there twice", value), {},
                        "Name it once");
    }
    positions.push_back(value);
  }
  std::sort(positions.begin(), positions.end());
  return positions;
}

void add_options(CLI::App& parser, VisibilityCall& call) {
  add_study_options(parser, call.study);
  add_cameras_option(parser, call.study);
  add_wanted_options(parser, call.wanted, call.iris);
  add_part_options(parser, call.study.part);
  parser.add_flag("--dry-run", call.dry_run, "Only say what would be done, and its price");
  add_tone_options(parser, call.tone, study_tone_help);
}

// The task of a study made from the call's options.
StudyTask task_of(studies::StudyFile study, const VisibilityCall& call,
                  const std::string& command) {
  StudyTask task{std::move(study), call.study.folder, command, call.tone};
  task.part = call.study.part;
  return task;
}

std::string cell(const Number& value, double factor, const char* unit) {
  return value ? fmt::format("{:.3g}{}", factor * *value, unit) : "-";
}

// Text for one condition.
std::string visibility_text(const StudyResults& study) {
  if (study.results.empty()) return study_text(study);
  constexpr const char* row = "{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n";
  std::string text = fmt::format(row, "camera", "target", "pixels", "visible", "cd/m2", "surround",
                                 "contrast", "saturated", "crushed");
  for (const ResultEntry& result : study.results) {
    const studies::Sight& sight = result.sight;
    text += fmt::format(row, study.cameras[result.camera].name, study.targets[result.target],
                        fmt::format("{}{}", sight.pixels, sight.cut_by_frame ? "+" : ""),
                        cell(sight.visible_fraction, 100.0, " %"), cell(sight.luminance, 1.0, ""),
                        cell(sight.surround, 1.0, ""), cell(sight.weber, 1.0, ""),
                        cell(sight.saturated, 100.0, " %"), cell(sight.crushed, 100.0, " %"));
  }
  return text +
         "Luminances of the clean picture, 0.2126 R + 0.7152 G + 0.0722 B.\n"
         "+ : reaches the picture's border, more of it may lie outside.\n\n" +
         study_text(study);
}

void run_visibility(const VisibilityCall& call, const Common& common) {
  StudyTask task = task_of(study_of(call.study, call.wanted, call.iris), call, "study visibility");
  run_and_print(std::move(task), common, call.study.json, call.dry_run, visibility_text);
}

void run_orbit(const OrbitCall& call, const Common& common) {
  studies::StudyFile study = study_of(call.study, call.wanted, call.iris);
  constexpr int usual_positions = 36;
  study.usual_positions = call.at.empty() && call.positions == 0;
  const int count = study.usual_positions ? usual_positions : static_cast<int>(call.positions);
  study.positions_deg = call.at.empty() ? studies::even_positions(count) : positions_of(call.at);
  study.timeline = call.at.empty() && count > 1;
  run_and_print(task_of(std::move(study), call, "study orbit"), common, call.study.json,
                call.dry_run);
}

void run_file(const FileCall& call, const Common& common) {
  StudyTask task{studies::read_study_file(call.file), call.folder, "study run " + call.file,
                 call.tone};
  task.part = call.part;
  run_and_print(std::move(task), common, call.json, call.dry_run);
}

}  // namespace

Command add_study_visibility(CLI::App& study) {
  CLI::App* parser =
      add_subcommand(study, "visibility", "How well each camera sees each target of the scene");
  const auto call = std::make_shared<VisibilityCall>();
  add_options(*parser, *call);
  return {parser, [call](const Common& common) { run_visibility(*call, common); }};
}

Command add_study_orbit(CLI::App& study) {
  CLI::App* parser = add_subcommand(
      study, "orbit",
      "How well each camera sees each target along the scene's orbit, from one solution");
  const auto call = std::make_shared<OrbitCall>();
  add_options(*parser, *call);
  add_whole_number(
      *parser, "--positions", call->positions, 1, studies::most_positions,
      "Positions, evenly over one turn from orbit noon (default: 36, or the moments of "
      "the scene's [time])");
  parser->add_option("--at", call->at, "Positions in degrees instead, with commas between")
      ->type_name("LIST")
      ->excludes("--positions");
  return {parser, [call](const Common& common) { run_orbit(*call, common); }};
}

Command add_study_run(CLI::App& study) {
  CLI::App* parser =
      add_subcommand(study, "run", "A study file: scenes, cameras, targets, lamps, orbit, wishes");
  const auto call = std::make_shared<FileCall>();
  parser->add_option("STUDY", call->file, "Study file (TOML)")->required()->type_name("");
  parser->add_option("-o,--output", call->folder, "Folder for the results; made if it is not there")
      ->type_name("DIR")
      ->required();
  add_part_options(*parser, call->part);
  parser->add_flag("--dry-run", call->dry_run, "Only say what would be done, and its price");
  parser->add_flag("--json", call->json, "Results as JSON on standard output");
  add_tone_options(*parser, call->tone, study_tone_help);
  return {parser, [call](const Common& common) { run_file(*call, common); }};
}

}  // namespace earthshine::app
