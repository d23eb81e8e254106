// SPDX-License-Identifier: Apache-2.0
// The sections of the report, each HTML from <section> to </section>, or "" where the study has
// nothing for it. Their order on the page is page.cpp's.
#pragma once

#include <filesystem>
#include <string>

#include "app/report/data.h"

namespace earthshine::app {

struct ReportSection {
  const char* id;
  const char* title;
  std::string html;  // what stands below the heading; "": nothing to show
};

[[nodiscard]] std::string short_html(const StudyResults& study);
[[nodiscard]] std::string notes_html(const StudyResults& study);
[[nodiscard]] std::string answers_html(const StudyResults& study);
[[nodiscard]] std::string matrix_html(const StudyResults& study);
[[nodiscard]] std::string timelines_html(const StudyResults& study);
// The numbers the script draws the timelines from.
[[nodiscard]] Json timelines_json(const StudyResults& study);
// Throws base::Error (Input) where a picture cannot be read from `folder`.
[[nodiscard]] std::string pictures_html(const StudyResults& study,
                                        const std::filesystem::path& folder);
[[nodiscard]] std::string ledger_html(const StudyResults& study);
[[nodiscard]] std::string figures_html(const StudyResults& study);
[[nodiscard]] std::string setup_html(const StudyResults& study);
[[nodiscard]] std::string provenance_html(const StudyResults& study);

// "lamps: all on", with the scene's name before it where there are several scenes or no lamps: what
// a block's table is headed with, escaped.
[[nodiscard]] std::string block_title(const StudyResults& study, const Block& block);

// "positions 20° to 160°, 200°" of a block's conditions, which are given by rising place in it;
// names where they have no position. Escaped.
[[nodiscard]] std::string places_text(const StudyResults& study, const Block& block,
                                      const std::vector<std::size_t>& places);

}  // namespace earthshine::app
