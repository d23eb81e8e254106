// SPDX-License-Identifier: Apache-2.0
// Timelines over the orbit: text here, plots by the script.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/json_fields.h"
#include "app/study/words.h"

namespace earthshine::app {
namespace {

// Probability from which a target counts as detected in the text.
constexpr double likely = 0.5;

bool has_positions(const Timeline& line) {
  return std::all_of(line.utc.begin(), line.utc.end(),
                     [](const std::string& utc) { return utc.empty(); }) &&
         std::all_of(line.position_deg.begin(), line.position_deg.end(),
                     [](const Number& x) { return x.has_value(); });
}

std::string place(const Timeline& line, std::size_t k) {
  if (!line.utc[k].empty()) return line.utc[k];
  if (line.position_deg[k]) return fmt::format("{:.6g}°", *line.position_deg[k]);
  if (line.time_s[k]) return fmt::format("{:.6g} s", *line.time_s[k]);
  return fmt::format("place {}", k + 1);
}

// "20° to 160°, 200°": intervals in which `holds` is true.
template <class Holds>
std::string runs(const Timeline& line, Holds holds) {
  std::string text;
  const std::size_t count = line.position_deg.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (!holds(k)) continue;
    const std::size_t start = k;
    while (k + 1 < count && holds(k + 1)) ++k;
    if (!text.empty()) text += ", ";
    text += place(line, start);
    if (k > start) text += " to " + place(line, k);
  }
  return text;
}

// Text for a target without a probability at any position.
std::string unseen_text(const Timeline& line) {
  const auto where = [&](studies::Verdict verdict) {
    return runs(line, [&](std::size_t k) { return line.verdict[k] == verdict; });
  };
  const std::string hidden = where(studies::Verdict::Hidden),
                    outside = where(studies::Verdict::OutOfView);
  if (hidden.empty() && outside.empty()) return "No result.";
  if (hidden.empty()) return "Outside the camera’s view.";
  if (outside.empty()) return "In the camera’s view, but hidden at every position.";
  return "Hidden at " + hidden + "; outside the camera’s view at " + outside + ".";
}

std::string in_words(const Timeline& line) {
  const std::size_t count = line.position_deg.size();
  std::size_t known = 0, seen = 0, best = count, worst = count;
  for (std::size_t k = 0; k < count; ++k) {
    if (!line.detect[k]) continue;
    ++known;
    if (*line.detect[k] >= likely) ++seen;
    if (best == count || *line.detect[k] > *line.detect[best]) best = k;
    if (worst == count || *line.detect[k] < *line.detect[worst]) worst = k;
  }
  std::string text;
  if (known == 0) {
    text = unseen_text(line);
  } else if (seen == 0) {
    text = fmt::format("Nowhere likely to be detected; at best {} at {}.",
                       figure(line.detect[best], Form::Chance), place(line, best));
  } else {
    const std::string least = figure(line.detect[worst], Form::Chance),
                      most = figure(line.detect[best], Form::Chance);
    text = fmt::format("Likely detected (P at least 0.5) at {} of {}: {}. {}.", seen,
                       counted(count, "position", "positions"),
                       seen == count
                           ? "everywhere"
                           : runs(line, [&](std::size_t k) { return line.detect[k] >= likely; }),
                       least == most ? "P is " + most + " throughout"
                                     : fmt::format("Between {} at {} and {} at {}", least,
                                                   place(line, worst), most, place(line, best)));
  }
  const std::string dark = runs(line, [&](std::size_t k) { return line.sun_share[k] == 0.0; });
  const std::string dusk =
      runs(line, [&](std::size_t k) { return line.sun_share[k] > 0.0 && line.sun_share[k] < 1.0; });
  if (!dark.empty()) text += " Eclipse: " + dark + ".";
  if (!dusk.empty()) text += " Penumbra: " + dusk + ".";
  return text;
}

// Rounded to the plot's resolution, to keep the page small.
Json rounded(const std::vector<Number>& values) {
  Json list = Json::array();
  for (const Number& value : values) list.push_back(value ? with_four_digits(*value) : Json());
  return list;
}

}  // namespace

std::string timelines_html(const StudyResults& study, std::size_t target) {
  const std::vector<Timeline> lines = timelines_of(study);
  std::string html;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Timeline& line = lines[k];
    if (line.target != study.targets[target]) continue;
    std::string title = fmt::format("Camera {}, {}", escaped(line.camera), escaped(line.target));
    if (!line.lamps.empty()) title += ", lamps: " + escaped(line.lamps);
    const std::string scene = escaped(scene_title(study, line.scene));
    if (study.scenes.size() > 1) title += " (" + scene + ")";
    html += fmt::format(
        "<figure class=\"timeline\" data-line=\"{}\" data-camera=\"{}\" data-target=\"{}\" "
        "data-scene=\"{}\" data-lamps=\"{}\">\n<figcaption>{}</figcaption>\n<p>{}</p>\n</figure>\n",
        k, escaped(line.camera), escaped(line.target), scene, escaped(line.lamps), title,
        in_words(line));
  }
  return html.empty() ? "" : "<div class=\"timelines\">\n" + html + "</div>\n";
}

Json timelines_json(const StudyResults& study) {
  Json lines = Json::array();
  for (const Timeline& line : timelines_of(study)) {
    const bool positions = has_positions(line);
    lines.push_back({{"axis", positions ? "position" : "time"},
                     {"x", rounded(positions ? line.position_deg : line.time_s)},
                     {"sun", rounded(line.sun_share)},
                     {"detect", rounded(line.detect)},
                     {"recognise", rounded(line.recognise)},
                     {"identify", rounded(line.identify)},
                     {"luminance", rounded(line.luminance)},
                     {"weber", rounded(line.weber)}});
  }
  return lines;
}

}  // namespace earthshine::app
