// SPDX-License-Identifier: Apache-2.0
// A visibility study from its plan to its folder: study.json, results.csv, report.html, pictures/.
// What is finished is kept in points/, so that a run that was ended goes on from there.
#pragma once

#include <optional>
#include <string>

#include "app/options.h"
#include "app/parts/part.h"
#include "app/study/results.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

inline constexpr const char* results_table = "results.csv";

inline constexpr const char* study_tone_help =
    "; default own, each picture by its own white, and by one white for all at the report's button";

struct StudyTask {
  studies::StudyFile study;
  std::string folder;
  std::string command;   // what was called, for the report
  ToneChoice tone = {};  // of the clean pictures
  PartCall part = {};
};

// What study.json has; of a part, which writes nothing but points/, nothing. Throws base::Error for
// bad input before any work is done, and (Work) after everything was written if it was interrupted,
// or where a merge finds work missing.
[[nodiscard]] std::optional<StudyResults> run_study(StudyTask task, const Common& common);

// The same, or with `dry_run` its plan, on standard output: as JSON, or as `text` has it.
void run_and_print(StudyTask task, const Common& common, bool json, bool dry_run,
                   std::string (*text)(const StudyResults& study) = study_text);

// What would be done and its price; throws as run_study. For people: plan_text.
[[nodiscard]] Json plan_study(StudyTask task, const Common& common);
[[nodiscard]] std::string plan_text(const Json& plan);

}  // namespace earthshine::app
