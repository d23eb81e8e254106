// SPDX-License-Identifier: Apache-2.0
// Sections of the report, each HTML from <section> to </section>, or "" if the study has no data
// for it. page.cpp defines their order.
#pragma once

#include <filesystem>
#include <string>

#include "app/report/data.h"

namespace earthshine::app {

struct ReportSection {
  const char* id;
  const char* title;
  std::string html;  // below the heading; "": nothing to show
};

[[nodiscard]] std::string short_html(const StudyResults& study);
[[nodiscard]] std::string notes_html(const StudyResults& study);
[[nodiscard]] std::string answers_html(const StudyResults& study);
[[nodiscard]] std::string matrix_html(const StudyResults& study);
[[nodiscard]] std::string orbits_html(const StudyResults& study);
[[nodiscard]] std::string targets_html(const StudyResults& study);
// For one target; "" without an orbit.
[[nodiscard]] std::string timelines_html(const StudyResults& study, std::size_t target);
// Data of the timelines for the script.
[[nodiscard]] Json timelines_json(const StudyResults& study);
// Throws base::Error (Input) if a picture cannot be read from `folder`.
[[nodiscard]] std::string pictures_html(const StudyResults& study,
                                        const std::filesystem::path& folder);
[[nodiscard]] std::string figures_html(const StudyResults& study);
[[nodiscard]] std::string setup_html(const StudyResults& study);
[[nodiscard]] std::string provenance_html(const StudyResults& study);

// Heading of a block's table: "lamps: all on", preceded by the scene's name if there are several
// scenes or no lamps. Escaped.
[[nodiscard]] std::string block_title(const StudyResults& study, const Block& block);

// Attributes for the script's selection of scenes and lamps: " data-scene=… data-lamps=…".
[[nodiscard]] std::string block_data(const StudyResults& study, const Block& block);

// "20° to 160°, 200°, lamps: all on" for a block's conditions, by ascending index; their names if
// they have no position. Escaped.
[[nodiscard]] std::string conditions_text(const StudyResults& study, const Block& block,
                                          const std::vector<std::size_t>& places);

// Replaces the unit of angles: "20 to 160 deg" becomes "20° to 160°".
[[nodiscard]] std::string degrees(std::string text);

}  // namespace earthshine::app
