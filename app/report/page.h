// SPDX-License-Identifier: Apache-2.0
// report.html: the results of a visibility study as one self-contained page without network access,
// made from study.json only (docs/visibility.md, "The report").
#pragma once

#include <filesystem>

#include "app/study/results.h"

namespace earthshine::app {

inline constexpr const char* report_file = "report.html";
inline constexpr const char* study_file = "study.json";

struct ReportOptions {
  bool plain = false;  // without the script, even if the program contains it
  bool quiet = false;  // no note on standard error if the program lacks the script
};

// The results in folder/study.json. Throws base::Error (Input) if the file is missing or damaged.
[[nodiscard]] StudyResults read_study(const std::filesystem::path& folder);

// Writes folder/report.html (a temporary file, renamed) from the study's results. Its pictures are
// read from `folder` and embedded. All content is HTML; the script, if the program contains it,
// adds plots, sliders, sorting and filters. Throws base::Error (Input) if a picture is missing,
// (Work) if the file cannot be written.
void write_report(const std::filesystem::path& folder, const StudyResults& study,
                  const ReportOptions& options = {});

}  // namespace earthshine::app
