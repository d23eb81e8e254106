// SPDX-License-Identifier: Apache-2.0
// The ledger: why a target is not identified, each cause with what it takes. Conditions in which
// the causes are the same share a row, which tells of the worst of them.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/report/sections.h"
#include "app/report/text.h"

namespace earthshine::app {
namespace {

constexpr std::size_t most_rows = 600;

struct Entry {
  std::string key;
  std::size_t worst;                // result
  std::vector<std::size_t> places;  // in the block's conditions
  std::vector<std::size_t> results;
};

std::string key_of(const ResultEntry& result) {
  std::string key =
      fmt::format("{} {} {}", result.camera, result.target, static_cast<int>(result.sight.verdict));
  for (const studies::Reason& reason : result.reasons) {
    key += fmt::format("\n{}\t{}", word_of(reason.cause), reason.by);
  }
  return key;
}

double detected(const ResultEntry& result) {
  return chance_of<&studies::Probability::detect>(result).value_or(1.0);
}

std::vector<Entry> entries_of(const StudyResults& study, const Block& block) {
  std::vector<Entry> entries;
  std::size_t first = 0;  // entries of the present camera and target start here
  const ResultEntry* before = nullptr;
  for (const std::size_t k : results_of(study, block)) {
    const ResultEntry& result = study.results[k];
    if (before != nullptr && (before->camera != result.camera || before->target != result.target)) {
      first = entries.size();
    }
    before = &result;
    if (result.why.empty() && result.reasons.empty()) continue;
    const std::string key = key_of(result);
    const auto place = static_cast<std::size_t>(
        std::find(block.conditions.begin(), block.conditions.end(), result.condition) -
        block.conditions.begin());
    const auto found =
        std::find_if(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
                     [&](const Entry& entry) { return entry.key == key; });
    if (found == entries.end()) {
      entries.push_back({key, k, {place}, {k}});
      continue;
    }
    found->places.push_back(place);
    found->results.push_back(k);
    if (detected(result) < detected(study.results[found->worst])) found->worst = k;
  }
  return entries;
}

// "0.2" or "0.2 to 0.7" over the conditions of an entry.
std::string range_text(const StudyResults& study, const Entry& entry, std::size_t reason,
                       Number studies::Reason::*member, Form form) {
  Number low, high;
  for (const std::size_t k : entry.results) {
    const Number value = study.results[k].reasons[reason].*member;
    if (!value) continue;
    low = std::min(low.value_or(*value), *value);
    high = std::max(high.value_or(*value), *value);
  }
  const std::string from = figure(low, form), to = figure(high, form);
  return from == to ? from : from + " to " + to;
}

std::string causes_html(const StudyResults& study, const Entry& entry) {
  const std::vector<studies::Reason>& reasons = study.results[entry.worst].reasons;
  if (reasons.empty()) return dash;
  std::string html = "<ul>";
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    const studies::Reason& reason = reasons[k];
    html += "<li><strong>" + escaped(word_of(reason.cause)) + "</strong>";
    if (!reason.by.empty()) html += " by " + escaped(reason.by);
    const std::string share = range_text(study, entry, k, &studies::Reason::share, Form::Percent);
    if (share != dash) html += ", " + share + " %";
    const std::string without =
        range_text(study, entry, k, &studies::Reason::probability_without, Form::Chance);
    if (without != dash) html += ", P without it " + without;
    if (!reason.text.empty() && reason.text != study.results[entry.worst].why) {
      html += ": " + escaped(reason.text);
    }
  }
  return html + "</ul>";
}

std::string row(const StudyResults& study, const Block& block, const Entry& entry) {
  const ResultEntry& worst = study.results[entry.worst];
  std::string why = escaped(worst.why);
  if (entry.results.size() > 1 && !why.empty()) {
    why = "At " + escaped(place_of(study.conditions[worst.condition])) + ": " + why;
  }
  return fmt::format(
      "<tr><th scope=row>{}<td>{}<td class=v{}>{}<td class=t>{}<td class=t>{}<td class=t>{}\n",
      escaped(study.cameras[worst.camera].name), escaped(study.targets[worst.target]),
      static_cast<int>(worst.sight.verdict), words_of(worst.sight.verdict).text,
      places_text(study, block, entry.places), why, causes_html(study, entry));
}

}  // namespace

std::string ledger_html(const StudyResults& study) {
  if (study.results.empty()) return "";
  std::string html;
  std::size_t shown = 0, left_out = 0;
  for (const Block& block : blocks_of(study)) {
    std::string rows;
    for (const Entry& entry : entries_of(study, block)) {
      if (shown == most_rows) {
        ++left_out;
        continue;
      }
      rows += row(study, block, entry);
      ++shown;
    }
    if (rows.empty()) continue;
    const std::string title = block_title(study, block);
    html += fmt::format(
        "<div class=\"scroll rows\" role=\"region\" aria-label=\"Ledger: {}\" tabindex=\"0\" "
        "data-lamps=\"{}\">\n<table class=\"ledger\">\n<caption>{}</caption>\n<thead><tr>"
        "<th scope=\"col\" data-key=\"camera\">Camera</th>"
        "<th scope=\"col\" data-key=\"target\">Target</th>"
        "<th scope=\"col\" data-key=\"verdict\">Verdict</th><th scope=\"col\">Where</th>"
        "<th scope=\"col\">Why</th><th scope=\"col\">Causes</th></tr></thead>\n"
        "<tbody>\n{}</tbody>\n</table>\n</div>\n",
        title, escaped(block.lamps), title, rows);
  }
  if (html.empty()) return "<p>Every target is identified under every condition.</p>\n";
  std::string head =
      "<p>Conditions with the same causes share a row, which tells of the worst of them. "
      "<em>P without it</em>: the probability of detection were that cause alone taken "
      "away.</p>\n";
  if (left_out > 0) {
    head +=
        fmt::format("<p>{} of {} rows; study.json has the rest.</p>\n", shown, shown + left_out);
  }
  return head + html;
}

}  // namespace earthshine::app
