// SPDX-License-Identifier: Apache-2.0
// earthshine study visibility: how well each camera sees each target, in the scene as it is.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/study/results.h"
#include "app/study/study.h"
#include "app/visibility/run.h"

namespace earthshine::app {
namespace {

struct VisibilityCall {
  StudyCall study;
  std::vector<std::string> wanted, iris;
  bool dry_run = false;
  ToneChoice tone = {usual_percent, {}};
};

std::string cell(const Number& value, double factor, const char* unit) {
  return value ? fmt::format("{:.3g}{}", factor * *value, unit) : "-";
}

std::string text_of(const StudyResults& study) {
  if (study.results.empty()) return study_text(study);
  std::string text =
      fmt::format("{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "camera", "target",
                  "pixels", "visible", "cd/m2", "surround", "contrast", "saturated", "crushed");
  for (const ResultEntry& result : study.results) {
    const studies::Sight& sight = result.sight;
    text += fmt::format("{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n",
                        study.cameras[result.camera].name, study.targets[result.target],
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

void run(const VisibilityCall& call, const Common& common) {
  StudyTask task{study_of(call.study, call.wanted, call.iris), call.study.folder,
                 "study visibility", call.tone};
  task.part = call.study.part;
  run_and_print(std::move(task), common, call.study.json, call.dry_run, text_of);
}

}  // namespace

Command add_study_visibility(CLI::App& study) {
  CLI::App* parser =
      study.add_subcommand("visibility", "How well each camera sees each target of the scene");
  const auto call = std::make_shared<VisibilityCall>();
  add_study_options(*parser, call->study);
  add_cameras_option(*parser, call->study);
  add_wanted_options(*parser, call->wanted, call->iris);
  add_part_options(*parser, call->study.part);
  parser->add_flag("--dry-run", call->dry_run, "Only say what would be done, and its price");
  add_tone_options(*parser, call->tone, study_tone_help);
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
