// SPDX-License-Identifier: Apache-2.0
// A part for each target: its timelines, and why it is not identified. Conditions with the same
// causes share a row, which states the worst of them.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/words.h"

namespace earthshine::app {
namespace {

constexpr std::size_t most_rows = 600;
// Up to this number of targets, each is printed on its own page.
constexpr std::size_t most_paged = 3;

struct Entry {
  std::string key;
  std::size_t worst;                // index of the result
  std::vector<std::size_t> places;  // indices in the block's conditions
};

std::string key_of(const ResultEntry& result) {
  std::string key = fmt::format("{} {}", result.camera, static_cast<int>(result.sight.verdict));
  for (const studies::Reason& reason : result.reasons) {
    key += fmt::format("\n{}\t{}", word_of(reason.cause), reason.by);
  }
  return key;
}

double detected(const ResultEntry& result) {
  return chance_of<&studies::Probability::detect>(result).value_or(1.0);
}

std::vector<Entry> entries_of(const StudyResults& study, const Block& block, std::size_t target) {
  std::vector<Entry> entries;
  for (const std::size_t k : results_of(study, block)) {
    const ResultEntry& result = study.results[k];
    if (result.target != target || (result.why.empty() && result.reasons.empty())) continue;
    const std::string key = key_of(result);
    const auto place = static_cast<std::size_t>(
        std::find(block.conditions.begin(), block.conditions.end(), result.condition) -
        block.conditions.begin());
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry& entry) { return entry.key == key; });
    if (found == entries.end()) {
      entries.push_back({key, k, {place}});
      continue;
    }
    found->places.push_back(place);
    if (detected(result) < detected(study.results[found->worst])) found->worst = k;
  }
  return entries;
}

std::string row(const StudyResults& study, const Block& block, const Entry& entry) {
  const ResultEntry& worst = study.results[entry.worst];
  const std::string decides = deciding_figure(worst);
  std::string why = escaped(worst.why);
  if (entry.places.size() > 1 && !why.empty()) {
    why = "At " + escaped(place_of(study.conditions[worst.condition])) + ": " + why;
  }
  return fmt::format(
      "<tr{}><th scope=row>{}<td class=v{}>{}<td class=t>{}<td class=t>{}<td class=t>{}\n",
      block_data(study, block), escaped(study.cameras[worst.camera].name),
      static_cast<int>(worst.sight.verdict), words_of(worst.sight.verdict).text,
      conditions_text(study, block, entry.places), decides.empty() ? dash : decides,
      why.empty() ? dash : why);
}

// Counts its rows in `shown`; rows beyond most_rows in `left_out`.
std::string ledger(const StudyResults& study, std::size_t target, std::size_t& shown,
                   std::size_t& left_out) {
  std::string rows;
  for (const Block& block : blocks_of(study)) {
    for (const Entry& entry : entries_of(study, block, target)) {
      if (shown == most_rows) {
        ++left_out;
        continue;
      }
      rows += row(study, block, entry);
      ++shown;
    }
  }
  if (rows.empty()) return "";
  const std::string title = "Why " + escaped(study.targets[target]) + " is not identified";
  return fmt::format(
      "<div class=\"scroll rows\" role=\"region\" aria-label=\"{0}\" tabindex=\"0\">\n"
      "<table class=\"ledger\">\n<caption>{0}</caption>\n<thead><tr>"
      "<th scope=\"col\" data-key=\"camera\">Camera</th>"
      "<th scope=\"col\" data-key=\"verdict\">Verdict</th><th scope=\"col\">Conditions</th>"
      "<th scope=\"col\">Decided by</th><th scope=\"col\">Why, at worst</th></tr></thead>\n"
      "<tbody>\n{1}</tbody>\n</table>\n</div>\n",
      title, rows);
}

}  // namespace

std::string targets_html(const StudyResults& study) {
  if (study.results.empty()) return "";
  std::string html;
  std::size_t shown = 0, left_out = 0;
  for (std::size_t target = 0; target < study.targets.size(); ++target) {
    const std::string lines = timelines_html(study, target),
                      why = ledger(study, target, shown, left_out);
    html += fmt::format(
        "<section class=\"target\" data-target=\"{0}\">\n<h3>{0}</h3>\n{1}{2}</section>\n",
        escaped(study.targets[target]), lines,
        why.empty() ? "<p>Identified under every condition.</p>\n" : why);
  }
  std::string head =
      "<p>Probabilities of detection, recognition and identification, the target’s luminance, and "
      "for each verdict short of identified the figure that decides it beside its threshold. "
      "Conditions with the same causes share a row. A probability after <em>without it</em> is "
      "that of detection were this cause alone taken away.</p>\n";
  if (left_out > 0) {
    head +=
        fmt::format("<p>{} of {} rows; study.json has the rest.</p>\n", shown, shown + left_out);
  }
  return head +
         fmt::format("<div class=\"targets{}\">\n",
                     study.targets.size() <= most_paged ? " paged" : "") +
         html + "</div>\n";
}

}  // namespace earthshine::app
