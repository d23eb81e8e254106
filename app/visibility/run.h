// SPDX-License-Identifier: Apache-2.0
// Runs a visibility study and writes its folder: study.json, results.csv, report.html, pictures/.
// Finished work is stored in points/, from which an interrupted run continues.
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
  std::string command;   // the call, for the report
  ToneChoice tone = {};  // of the clean pictures
  PartCall part = {};
};

// Returns the contents of study.json; no value for a part, which writes only points/. Throws
// base::Error for invalid input before any work, and (Work) after everything was written if it was
// interrupted, or if a merge finds work missing.
[[nodiscard]] std::optional<StudyResults> run_study(StudyTask task, const Common& common);

// Runs the study, or with `dry_run` its plan, and prints the result: as JSON, or by `text`.
void run_and_print(StudyTask task, const Common& common, bool json, bool dry_run,
                   std::string (*text)(const StudyResults& study) = study_text);

// Planned work and its cost; throws as run_study. plan_text is for people.
[[nodiscard]] Json plan_study(StudyTask task, const Common& common);
[[nodiscard]] std::string plan_text(const Json& plan);

}  // namespace earthshine::app
