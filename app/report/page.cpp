// SPDX-License-Identifier: Apache-2.0
#include "app/report/page.h"

#include <fmt/format.h>

#include <array>
#include <set>
#include <string_view>
#include <vector>

#include "app/console.h"
#include "app/report/assets.h"
#include "app/report/data.h"
#include "app/report/sections.h"
#include "app/report/text.h"
#include "base/files/output_file.h"

namespace earthshine::app {
namespace {

std::string head(const StudyResults& study, bool plain) {
  // Nothing may be loaded; only the program's own script may run.
  const std::string scripts = plain ? "'none'" : "'" + std::string(report_script_hash()) + "'";
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src {}; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}: visibility</title>\n<style>\n{}</style>\n</head>\n<body>\n",
      scripts, escaped(study.name.empty() ? "Study" : study.name), report_style());
}

std::string in_short(const StudyResults& study) {
  std::array<std::size_t, verdict_words.size()> counts{};
  for (const ResultEntry& result : study.results)
    ++counts[static_cast<std::size_t>(result.sight.verdict)];
  // Several scenes may have the same camera.
  std::set<std::string_view> cameras;
  for (const CameraEntry& camera : study.cameras) cameras.insert(camera.name);
  const std::string scenes =
      study.scenes.size() > 1 ? fmt::format("{} scenes, ", study.scenes.size()) : "";
  std::string text = scenes + counted(cameras.size(), "camera", "cameras") + ", " +
                     counted(study.targets.size(), "target", "targets") + ", " +
                     counted(study.conditions.size(), "condition", "conditions") + ": " +
                     counted(study.results.size(), "result", "results");
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] > 0) text += fmt::format(", {} {}", counts[k], verdict_words[k].text);
  }
  return text + ".";
}

std::string header(const StudyResults& study, bool plain) {
  std::string html = fmt::format(
      "<a class=\"skip\" href=\"#content\">Skip to the content</a>\n<header>\n<h1>{}</h1>\n"
      "<p>Study visibility, by earthshine {}. {}</p>\n",
      escaped(study.name.empty() ? "Study" : study.name), escaped(study.version), in_short(study));
  if (!study.complete) {
    html +=
        "<p class=\"banner\" role=\"note\"><strong>Not complete.</strong> The study was stopped "
        "early. What is here is right, but not all that was asked for is here.</p>\n";
  }
  if (plain) {
    html +=
        "<p class=\"plain\" role=\"note\">The plain report: the same content without plots, "
        "sliders, sorting and filters.</p>\n";
  }
  return html + orbits_html(study) + "</header>\n";
}

std::vector<ReportSection> sections_of(const StudyResults& study,
                                       const std::filesystem::path& folder, bool plain) {
  std::vector<ReportSection> sections = {
      {"short", "Best cameras", short_html(study)},
      {"answers", "Answers", answers_html(study)},
      {"notes", "Notes", notes_html(study)},
      {"summary", "Summary", matrix_html(study)},
      {"targets", "Targets", targets_html(study)},
      {"pictures", "Pictures", pictures_html(study, folder)},
      {"figures", "All figures", figures_html(study)},
      {"setup", "Scenes, cameras, conditions, settings", setup_html(study)},
      {"provenance", "Provenance and cost", provenance_html(study)},
  };
  if (!plain) {
    sections.push_back({"licences", "Licences of this page’s script",
                        "<details><summary>Libraries and their licences</summary>\n<pre "
                        "tabindex=\"0\">" +
                            escaped(report_licences()) + "</pre>\n</details>\n"});
  }
  return sections;
}

std::string body(const std::vector<ReportSection>& sections) {
  std::string contents = "<nav aria-label=\"Contents\">\n<ul>\n", content;
  for (const ReportSection& section : sections) {
    if (section.html.empty()) continue;
    contents += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, section.title);
    content += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n"
        "<h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n",
        section.id, section.title, section.html);
  }
  return contents + "</ul>\n</nav>\n<main id=\"content\" tabindex=\"-1\">\n" + content +
         "</main>\n";
}

std::string scripts(const StudyResults& study) {
  const Json data = {{"format", 1}, {"timelines", timelines_json(study)}};
  // The policy's hash is of the script's bytes: the element must contain nothing else.
  return fmt::format(
      "<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script>\n",
      island(data), report_script());
}

}  // namespace

void write_report(const std::filesystem::path& folder, const StudyResults& study,
                  const ReportOptions& options) {
  const bool plain = options.plain || report_script().empty();
  std::string page =
      head(study, plain) + header(study, plain) + body(sections_of(study, folder, plain));
  if (!plain) page += scripts(study);
  base::write_text(folder / report_file, page + "</body>\n</html>\n");
  if (plain && !options.plain && !options.quiet) {
    note(
        "note: this program was built without Node.js: report.html is the plain one, without "
        "plots and sliders");
  }
}

}  // namespace earthshine::app
