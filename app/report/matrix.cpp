// SPDX-License-Identifier: Apache-2.0
// The summary: rows are camera and target, columns are conditions, cells show the verdict.
#include <fmt/format.h>

#include <map>

#include "app/report/sections.h"
#include "app/report/text.h"

namespace earthshine::app {
namespace {

std::string legend() {
  std::string html = "<ul class=\"legend\" aria-label=\"Verdicts\">";
  for (std::size_t k = 0; k < verdict_words.size(); ++k) {
    html += fmt::format("<li><span class=\"mark v{}\" aria-hidden=\"true\">{}</span> {}</li>", k,
                        verdict_words[k].mark, verdict_words[k].text);
  }
  return html + "</ul>\n";
}

// Adjacent conditions of the same phase share a heading.
std::string phase_row(const StudyResults& study, const Block& block) {
  std::string cells;
  bool known = false;
  for (std::size_t k = 0; k < block.conditions.size();) {
    const std::string& phase = study.conditions[block.conditions[k]].phase;
    std::size_t end = k + 1;
    while (end < block.conditions.size() &&
           study.conditions[block.conditions[end]].phase == phase) {
      ++end;
    }
    known = known || !phase.empty();
    // A narrow heading is written vertically, so that it does not widen its columns.
    cells += fmt::format(
        "<th scope=\"colgroup\" colspan=\"{}\" class=\"phase {}{}\"><span>{}</span></th>", end - k,
        phase.empty() ? "none" : phase, end - k < 4 ? " narrow" : "", phase.empty() ? dash : phase);
    k = end;
  }
  return known ? "<tr><td colspan=\"3\"></td>" + cells + "</tr>\n" : "";
}

std::string column_row(const StudyResults& study, const Block& block) {
  std::string html =
      "<tr><th scope=\"col\" data-key=\"camera\">Camera</th>"
      "<th scope=\"col\" data-key=\"target\">Target</th><th scope=\"col\">Detected</th>";
  for (const std::size_t k : block.conditions) {
    html += "<th scope=\"col\" class=\"place\"><span>" + escaped(place_of(study.conditions[k])) +
            "</span></th>";
  }
  return html + "</tr>\n";
}

using ThumbnailOf = std::map<std::pair<std::size_t, std::size_t>, std::size_t>;

ThumbnailOf thumbnails_of(const StudyResults& study) {
  ThumbnailOf found;
  for (std::size_t k = 0; k < study.thumbnails.size(); ++k) {
    found[{study.thumbnails[k].camera, study.thumbnails[k].condition}] = k;
  }
  return found;
}

// shown: its thumbnail, "" for none.
std::string cell(const StudyResults& study, std::size_t result, const std::string& shown) {
  const studies::Verdict verdict = study.results[result].sight.verdict;
  const VerdictWords& words = words_of(verdict);
  return fmt::format("<td class=v{} data-r={}{}>{}<i>{}</i>", static_cast<int>(verdict), result,
                     shown, words.mark, words.rest);
}

std::string row(const StudyResults& study, const Block& block, std::size_t camera,
                std::size_t target, const std::map<std::size_t, std::size_t>& by_condition,
                const ThumbnailOf& thumbnails) {
  std::string cells, shown;
  std::size_t seen = 0;
  for (const std::size_t k : block.conditions) {
    // Between two thumbnails no verdict of this camera changes: uses the previous one.
    const auto small = thumbnails.find({camera, k});
    if (small != thumbnails.end()) shown = fmt::format(" data-p={}", small->second);
    const auto found = by_condition.find(k);
    if (found == by_condition.end()) {
      cells += "<td class=vx>·<i> no result</i>";
    } else {
      cells += cell(study, found->second, shown);
      if (is_seen(study.results[found->second].sight.verdict)) ++seen;
    }
  }
  return fmt::format("<tr><th scope=row>{}<th scope=row>{}<td class=n>{}/{}{}\n",
                     escaped(study.cameras[camera].name), escaped(study.targets[target]), seen,
                     by_condition.size(), cells);
}

std::string table(const StudyResults& study, const Block& block) {
  std::map<std::pair<std::size_t, std::size_t>, std::map<std::size_t, std::size_t>> rows;
  for (const std::size_t k : results_of(study, block)) {
    const ResultEntry& result = study.results[k];
    rows[{result.camera, result.target}][result.condition] = k;
  }
  if (rows.empty()) return "";
  const ThumbnailOf thumbnails = thumbnails_of(study);
  const std::string title = block_title(study, block);
  std::string html = fmt::format(
      "<div class=\"scroll\" role=\"region\" aria-label=\"Summary: {}\" tabindex=\"0\"{}>\n<table "
      "class=\"matrix{}\">\n<caption>{}</caption>\n"
      "<colgroup><col class=\"name\"><col class=\"name\"><col class=\"seen\"><col "
      "span=\"{}\"></colgroup>\n"
      "<thead>\n",
      title, block_data(study, block), block.conditions.size() > 8 ? " many" : "", title,
      block.conditions.size());
  html += phase_row(study, block) + column_row(study, block) + "</thead>\n<tbody>\n";
  for (const auto& [names, by_condition] : rows) {
    html += row(study, block, names.first, names.second, by_condition, thumbnails);
  }
  return html + "</tbody>\n</table>\n</div>\n";
}

std::string nothing(const StudyResults& study) {
  if (study.cameras.empty()) return "<p>The study has no camera, so there is nothing to see.</p>\n";
  if (study.targets.empty()) {
    return "<p>The scene marks no object as a target, so there is nothing to look for.</p>\n";
  }
  if (study.conditions.empty()) return "<p>The study has no condition to look under.</p>\n";
  return "<p>There is no result yet.</p>\n";
}

}  // namespace

std::string matrix_html(const StudyResults& study) {
  if (study.results.empty()) return nothing(study);
  std::string html =
      "<p>The verdict on each target by each camera. <em>Detected</em> counts the conditions under "
      "which it is at least detected.</p>\n";
  bool none_in_view = true;
  for (const ResultEntry& result : study.results) {
    none_in_view = none_in_view && result.sight.verdict >= studies::Verdict::OutOfView;
  }
  if (none_in_view) html += "<p><strong>No camera has a target in view.</strong></p>\n";
  html += legend();
  for (const Block& block : blocks_of(study)) html += table(study, block);
  return html;
}

}  // namespace earthshine::app
