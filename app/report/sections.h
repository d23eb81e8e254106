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
[[nodiscard]] std::string orbits_html(const StudyResults& study);
[[nodiscard]] std::string targets_html(const StudyResults& study);
// Of one target; "" where its study has no orbit.
[[nodiscard]] std::string timelines_html(const StudyResults& study, std::size_t target);
// The numbers the script draws the timelines from.
[[nodiscard]] Json timelines_json(const StudyResults& study);
// Throws base::Error (Input) where a picture cannot be read from `folder`.
[[nodiscard]] std::string pictures_html(const StudyResults& study,
                                        const std::filesystem::path& folder);
[[nodiscard]] std::string figures_html(const StudyResults& study);
[[nodiscard]] std::string setup_html(const StudyResults& study);
[[nodiscard]] std::string provenance_html(const StudyResults& study);

// "lamps: all on", with the scene's name before it where there are several scenes or no lamps: what
// a block's table is headed with, escaped.
[[nodiscard]] std::string block_title(const StudyResults& study, const Block& block);

// Attributes by which the script chooses scenes and lamps: " data-scene=… data-lamps=…".
[[nodiscard]] std::string block_data(const StudyResults& study, const Block& block);

// "20° to 160°, 200°, lamps: all on" of a block's conditions, which are given by rising place in
// it; names where they have no position. Escaped.
[[nodiscard]] std::string conditions_text(const StudyResults& study, const Block& block,
                                          const std::vector<std::size_t>& places);

// Angles with their sign: "20 to 160 deg" as "20° to 160°".
[[nodiscard]] std::string degrees(std::string text);

}  // namespace earthshine::app
