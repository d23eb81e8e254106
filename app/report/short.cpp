// SPDX-License-Identifier: Apache-2.0
// For each target the camera that detects it most often, and the obstacles where it does not.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "app/report/sections.h"
#include "app/report/text.h"

namespace earthshine::app {
namespace {

struct Tally {
  std::size_t camera = 0, seen = 0, in_view = 0, all = 0;
  std::map<std::string, std::size_t> hindrances;  // how often each is the first one
};

std::string hindrance_of(const ResultEntry& result) {
  if (result.reasons.empty()) return words_of(result.sight.verdict).text;
  const studies::Reason& first = result.reasons.front();
  const std::string cause(word_of(first.cause));
  return first.by.empty() ? cause : cause + " by " + first.by;
}

// Sorted by the number of detections, descending; among equal ones by how often it is in view.
std::vector<Tally> tallies_of(const StudyResults& study, const std::vector<std::size_t>& results) {
  std::vector<Tally> tallies;
  for (const std::size_t k : results) {
    const ResultEntry& result = study.results[k];
    auto tally = std::find_if(tallies.begin(), tallies.end(),
                              [&](const Tally& t) { return t.camera == result.camera; });
    if (tally == tallies.end()) {
      tallies.emplace_back().camera = result.camera;
      tally = std::prev(tallies.end());
    }
    ++tally->all;
    if (result.sight.verdict != studies::Verdict::OutOfView) ++tally->in_view;
    if (is_seen(result.sight.verdict)) {
      ++tally->seen;
    } else {
      ++tally->hindrances[hindrance_of(result)];
    }
  }
  std::stable_sort(tallies.begin(), tallies.end(), [](const Tally& a, const Tally& b) {
    return std::pair(a.seen, a.in_view) > std::pair(b.seen, b.in_view);
  });
  return tallies;
}

std::string hindrances_text(const Tally& tally) {
  constexpr std::size_t most_named = 3;
  std::vector<std::pair<std::string, std::size_t>> order(tally.hindrances.begin(),
                                                         tally.hindrances.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t k = 0; k < std::min(order.size(), most_named); ++k) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", escaped(order[k].first),
                        order[k].second);
  }
  return text.empty() ? dash : text + (order.size() > most_named ? ", …" : "");
}

std::string short_row(const StudyResults& study, const std::string& title, std::size_t target,
                      const std::vector<std::size_t>& results) {
  const std::vector<Tally> tallies = tallies_of(study, results);
  const Tally& best = tallies.front();
  std::string others;
  for (std::size_t k = 1; k < tallies.size(); ++k) {
    others += fmt::format("{}{} {}", others.empty() ? "" : ", ",
                          escaped(study.cameras[tallies[k].camera].name), tallies[k].seen);
  }
  return fmt::format(
      "<tr><th scope=row>{}<td class=t>{}<td class=t>{}<td class=whole>{} of {}<td class=t>{}<td "
      "class=t>{}\n",
      escaped(study.targets[target]), title,
      best.seen > 0 ? escaped(study.cameras[best.camera].name) : std::string("none"), best.seen,
      best.all, others.empty() ? dash : others, hindrances_text(best));
}

}  // namespace

std::string short_html(const StudyResults& study) {
  constexpr std::size_t most_rows_in_short = 24;
  std::string rows;
  std::size_t count = 0;
  for (const Block& block : blocks_of(study)) {
    std::map<std::size_t, std::vector<std::size_t>> by_target;
    for (const std::size_t k : results_of(study, block)) {
      by_target[study.results[k].target].push_back(k);
    }
    for (const auto& [target, results] : by_target) {
      if (++count > most_rows_in_short) continue;
      rows += short_row(study, block_title(study, block), target, results);
    }
  }
  if (rows.empty()) return "";
  std::string html =
      "<div class=\"scroll\" role=\"region\" aria-label=\"Best camera of each target\" "
      "tabindex=\"0\">\n<table>\n"
      "<caption>Best camera for each target</caption>\n<thead><tr>";
  for (const char* head :
       {"Target", "Conditions", "Best camera", "Detected", "Other cameras", "Main obstacles"}) {
    const bool number = std::string_view(head) == "Detected";
    html += fmt::format("<th scope=\"col\"{}>{}</th>", number ? "" : " class=\"t\"", head);
  }
  html += "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table>\n</div>\n";
  if (count > most_rows_in_short) {
    html += fmt::format("<p>{} of {} rows; the summary below has all.</p>\n", most_rows_in_short,
                        count);
  }
  return html;
}

}  // namespace earthshine::app
