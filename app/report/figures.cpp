// SPDX-License-Identifier: Apache-2.0
// All results with their numbers.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/words.h"

namespace earthshine::app {
namespace {

// With more results a page with all numbers would be too large.
constexpr std::size_t most_in_full = 1200;
constexpr std::size_t most_open = 40;

struct Columns {
  std::vector<std::size_t> sight, signal;  // indices into sight_columns, signal_columns
  bool groups = true;                      // lit by, light by, decided by
};

std::string head(std::span<const FigureColumn> all, const std::vector<std::size_t>& shown,
                 bool verdict) {
  std::string html =
      "<thead><tr><th scope=\"col\">Condition</th><th scope=\"col\" data-key=\"camera\">Camera</th>"
      "<th scope=\"col\" data-key=\"target\">Target</th>";
  if (verdict) html += "<th scope=\"col\" data-key=\"verdict\">Verdict</th>";
  for (const std::size_t k : shown) html += fmt::format("<th scope=\"col\">{}</th>", all[k].title);
  return html;
}

std::string lead(const StudyResults& study, const ResultEntry& result) {
  return "<th scope=row>" + escaped(place_of(study.conditions[result.condition])) + "<td>" +
         escaped(study.cameras[result.camera].name) + "<td>" +
         escaped(study.targets[result.target]);
}

std::vector<GroupShare> shares_of(const std::vector<studies::LightShare>& light_from) {
  std::vector<GroupShare> shares;
  for (const studies::LightShare& light : light_from) {
    shares.push_back({(light.reflected ? "by way of " : "") + light.from, light.share});
  }
  return shares;
}

std::string sight_row(const StudyResults& study, std::size_t index, const Columns& columns) {
  const ResultEntry& result = study.results[index];
  std::string html =
      fmt::format("<tr id=r{}>{}<td class=v{}>{}", index, lead(study, result),
                  static_cast<int>(result.sight.verdict), words_of(result.sight.verdict).text);
  for (const std::size_t k : columns.sight) {
    html += "<td>" + figure(sight_columns[k].of(result), sight_columns[k].form);
    if (sight_columns[k].of == sight_of<&studies::Sight::pixels> && result.sight.cut_by_frame)
      html += "+";
  }
  if (columns.groups) {
    html += "<td class=t>" + shares_text(result.lit_by, Form::Percent) + "<td class=t>" +
            shares_text(result.light_by, Form::Plain) + "<td class=t>" +
            shares_text(shares_of(result.light_from), Form::Percent);
  }
  if (columns.groups) {
    const std::string decides = deciding_figure(result);
    html += "<td class=t>" + (decides.empty() ? dash : decides);
  }
  html += "<td class=t>" + (result.why.empty() ? dash : escaped(result.why));
  return html + "\n";
}

std::string signal_row(const StudyResults& study, std::size_t index, const Columns& columns) {
  const ResultEntry& result = study.results[index];
  std::string html = "<tr>" + lead(study, result);
  for (const std::size_t k : columns.signal) {
    html += "<td>" + figure(signal_columns[k].of(result), signal_columns[k].form);
  }
  return html + "\n";
}

bool has_signal(const ResultEntry& result) {
  return std::any_of(signal_columns.begin(), signal_columns.end(),
                     [&](const FigureColumn& column) { return column.of(result).has_value(); });
}

std::string details(const StudyResults& study, const std::string& title, const Block& block,
                    bool open, const std::string& table) {
  return fmt::format(
      "<details class=\"rows unprinted\"{}{}>\n<summary>{}</summary>\n"
      "<div class=\"scroll\" role=\"region\" aria-label=\"{}\" tabindex=\"0\">\n{}</div>\n"
      "</details>\n",
      block_data(study, block), open ? " open" : "", title, title, table);
}

std::string tables(const StudyResults& study, const Block& block, const Columns& columns,
                   bool open) {
  const std::vector<std::size_t> results = results_of(study, block);
  if (results.empty()) return "";
  const std::string title = block_title(study, block);
  const auto start = [&](const std::string& what) {
    return "<table class=\"figures\">\n<caption>" + title + ": " + what + "</caption>\n";
  };
  std::string sight = start("what is seen") + head(sight_columns, columns.sight, true);
  if (columns.groups) {
    sight +=
        "<th scope=\"col\">lit by</th><th scope=\"col\">light by, cd/m²</th>"
        "<th scope=\"col\">comes last from, %</th><th scope=\"col\">decided by</th>";
  }
  sight += "<th scope=\"col\">why not</th>";
  sight += "</tr></thead>\n<tbody>\n";
  std::string signal;
  for (const std::size_t k : results) {
    sight += sight_row(study, k, columns);
    if (!columns.signal.empty() && has_signal(study.results[k])) {
      signal += signal_row(study, k, columns);
    }
  }
  std::string html =
      details(study, title + ": what is seen, " + counted(results.size(), "row", "rows"), block,
              open, sight + "</tbody>\n</table>\n");
  if (!signal.empty()) {
    html += details(study, title + ": signal, monitor and eye", block, false,
                    start("signal, monitor and eye") + head(signal_columns, columns.signal, false) +
                        "</tr></thead>\n<tbody>\n" + signal + "</tbody>\n</table>\n");
  }
  return html;
}

}  // namespace

std::string figures_html(const StudyResults& study) {
  if (study.results.empty()) return "";
  const bool full = study.results.size() <= most_in_full;
  Columns columns;
  columns.groups = full;
  for (std::size_t k = 0; k < sight_columns.size(); ++k) {
    if (full || sight_columns[k].brief) columns.sight.push_back(k);
  }
  for (std::size_t k = 0; full && k < signal_columns.size(); ++k) columns.signal.push_back(k);
  std::string html =
      "<p>Luminances are of the clean picture, 0.2126 R + 0.7152 G + 0.0722 B. P: probability. "
      "lit: share of the visible part that "
      "a lamp or the Sun reaches directly. comes last from: straight from a source, or by way of "
      "what "
      "reflects it on. +: cut by the picture’s border.</p>\n";
  if (!full) {
    html += fmt::format(
        "<p>Of {} results these tables have the columns that decide; study.json and the CSV files "
        "beside this page have every figure.</p>\n",
        study.results.size());
  }
  html += fmt::format(
      "<p class=\"paper\">On paper these tables are left out; results.csv has all {} "
      "results.</p>\n",
      study.results.size());
  for (const Block& block : blocks_of(study)) {
    html += tables(study, block, columns, study.results.size() <= most_open);
  }
  return html;
}

}  // namespace earthshine::app
