// SPDX-License-Identifier: Apache-2.0
// report.html: what a visibility study found, as one page that needs nothing beside it and no
// network. Drawn from study.json alone (docs/visibility.md, "The report").
#pragma once

#include <filesystem>

#include "app/study/results.h"

namespace earthshine::app {

inline constexpr const char* report_file = "report.html";
inline constexpr const char* study_file = "study.json";

struct ReportOptions {
  bool plain = false;  // without the script, also where the program has it
  bool quiet = false;  // no note on standard error where the program was built without it
};

// Writes folder/report.html, aside and renamed, from the study's results; its pictures
// are read from `folder` and put into the page. The whole content is HTML; the script, where the
// program was built with it, adds plots, sliders, sorting and filters.
// Throws base::Error (Input) where a picture is missing, (Work) where the file cannot be written.
void write_report(const std::filesystem::path& folder, const StudyResults& study,
                  const ReportOptions& options = {});

}  // namespace earthshine::app
