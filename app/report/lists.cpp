// SPDX-License-Identifier: Apache-2.0
// The report's short sections: notes, answers, scenes and settings, provenance.
#include <fmt/format.h>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/words.h"
#include "scenes/text/message_text.h"
#include "studies/orbit/condition_noise.h"

namespace earthshine::app {
namespace {

std::string table(const std::string& caption, const std::vector<std::string>& heads,
                  const std::string& rows) {
  std::string html = "<div class=\"scroll\" role=\"region\" aria-label=\"" + caption +
                     "\" tabindex=\"0\">\n<table>\n<caption>" + caption + "</caption>\n<thead><tr>";
  for (const std::string& head : heads) html += "<th scope=\"col\">" + head + "</th>";
  return html + "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table>\n</div>\n";
}

std::string text_or_dash(const std::string& text) { return text.empty() ? dash : escaped(text); }

std::string size_text(const CameraEntry& camera) {
  if (!camera.columns || !camera.rows) return dash;
  return fmt::format("{} × {}", *camera.columns, *camera.rows);
}

std::string cameras_table(const StudyResults& study) {
  std::string rows;
  for (const CameraEntry& camera : study.cameras) {
    rows += fmt::format(
        "<tr><th scope=row>{}<td>{}<td>{}<td>{}<td class=t>{}<td class=t>{}<td>{}<td class=t>{}\n",
        escaped(camera.name), escaped(scene_title(study, camera.scene)), size_text(camera),
        figure(camera.fov_deg), camera.cctv.empty() ? "none" : escaped(camera.cctv),
        text_or_dash(camera.iris), figure(camera.relative_noise, Form::Percent),
        text_or_dash(camera.error_text));
  }
  if (rows.empty()) return "";
  return table(
      "Cameras",
      {"Camera", "Scene", "Pixels", "Field of view, °", "CCTV", "Iris", "Noise, %", "Stated error"},
      rows);
}

std::string factors_text(const std::vector<Factor>& factors) {
  std::string text;
  for (const auto& [group, factor] : factors) {
    if (!text.empty()) text += ", ";
    text += escaped(group) + " " + figure(factor.r);
    if (factor.r == factor.g && factor.g == factor.b) continue;
    text += " " + figure(factor.g) + " " + figure(factor.b);
  }
  return text.empty() ? dash : text;
}

std::string conditions_table(const StudyResults& study) {
  std::string rows;
  for (const ConditionEntry& condition : study.conditions) {
    rows += fmt::format(
        "<tr><th scope=row>{}<td class=t>{}<td class=t>{}<td>{}<td>{}<td>{}<td>{}<td "
        "class=t>{}<td>{}\n",
        text_or_dash(condition.name), escaped(scene_title(study, condition.scene)),
        text_or_dash(condition.lamps), figure(condition.position_deg),
        figure(condition.time_s, Form::Count), condition.phase.empty() ? dash : condition.phase,
        figure(condition.sun_share, Form::Percent), factors_text(condition.factors),
        figure(condition.earth_error, Form::Percent));
    if (!condition.pose.empty())
      rows += "<tr><td class=t colspan=9>" + escaped(condition.pose) + "\n";
  }
  if (rows.empty()) return "";
  // In print the summary's columns have this information.
  return "<details class=\"rows unprinted\"><summary>" +
         counted(study.conditions.size(), "condition", "conditions") + "</summary>\n" +
         table("Conditions",
               {"Condition", "Scene", "Lamps", "Position, °", "Time, s", "Phase", "Sun free, %",
                "Lamp factors", "Error of the Earth’s light, %"},
               rows) +
         "</details>\n";
}

// `depth`: nesting level; deeper levels are not shown.
std::string value_html(const Json& value, int depth = 0) {
  if (depth > 6) return "…";
  if (value.is_null()) return dash;
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    const Json inner = text.starts_with("{") || text.starts_with("[")
                           ? Json::parse(text, nullptr, false)
                           : Json(Json::value_t::discarded);
    return inner.is_discarded() ? text_or_dash(text) : value_html(inner, depth + 1);
  }
  if (value.is_object()) {
    std::string html = "<dl>";
    for (const auto& [key, inner] : value.items()) {
      html += "<dt>" + escaped(key) + "</dt><dd>" + value_html(inner, depth + 1) + "</dd>";
    }
    return value.empty() ? dash : html + "</dl>";
  }
  if (value.is_array()) {
    std::string html;
    for (const Json& inner : value)
      html += (html.empty() ? "" : ", ") + value_html(inner, depth + 1);
    return html.empty() ? dash : html;
  }
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return escaped(value.dump());
}

std::string key_values(const std::string& caption, const std::string& key, const Json& values) {
  std::string rows;
  for (const auto& [name, value] : values.items()) {
    rows += "<tr><th scope=row>" + escaped(name) + "<td class=t>" + value_html(value) + "\n";
  }
  return rows.empty() ? "" : table(caption, {key, "Value"}, rows);
}

// "picture s1 A" with the scene's name, omitted in a study of one scene.
std::string stage_of(const StudyResults& study, const StudyCost& cost) {
  std::string stage = cost.stage + " ";
  for (std::size_t k = 0; k < study.scenes.size(); ++k) {
    const std::string id = " " + study.scenes[k].id + " ";
    const std::size_t at = stage.find(id);
    if (at == std::string::npos) continue;
    stage.replace(at, id.size(), study.scenes.size() > 1 ? " " + scene_title(study, k) + " " : " ");
    break;
  }
  stage.pop_back();
  return stage;
}

}  // namespace

std::string notes_html(const StudyResults& study) {
  std::string html;
  for (const std::string& note : study.notes) html += "<li>" + escaped(note) + "</li>\n";
  return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
}

std::string answers_html(const StudyResults& study) {
  std::string html;
  for (const AnswerEntry& answer : study.answers) {
    html += fmt::format("<li class=\"answer {}\"><strong>{} {}</strong>: {}",
                        answer.found ? "found" : "not-found", answer.found ? "✓" : "✗",
                        escaped(answer.wanted), degrees(escaped(answer.text)));
    std::string facts;
    const auto fact = [&facts](const char* name, const std::string& value) {
      if (!value.empty()) facts += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
    };
    if (answer.found) {
      fact("camera", escaped(answer.camera));
      fact("iris", escaped(answer.iris));
      fact("lamps", escaped(answer.lamps));
      fact("detected at", degrees(arcs_text(answer.arcs_deg)));
      const std::string at =
          answer.darkest_deg ? " at " + figure(answer.darkest_deg) + "°, where it is darkest" : "";
      fact("this camera needs", answer.least_factor
                                    ? scenes::percent(*answer.least_factor) + " of these lamps" + at
                                    : "");
    }
    if (!facts.empty()) html += "<dl>" + facts + "</dl>";
    html += "</li>\n";
  }
  return html.empty() ? "" : "<ul class=\"answers\">\n" + html + "</ul>\n";
}

std::string setup_html(const StudyResults& study) {
  std::string scenes;
  for (const SceneEntry& scene : study.scenes) {
    scenes += "<tr><th scope=row>" + text_or_dash(scene.name) + "<td class=t>" +
              text_or_dash(scene.path) + "\n";
  }
  return (scenes.empty() ? "" : table("Scenes", {"Scene", "File"}, scenes)) + cameras_table(study) +
         conditions_table(study) + key_values("Settings", "Setting", study.settings);
}

std::string provenance_html(const StudyResults& study) {
  std::string costs;
  for (const StudyCost& cost : study.costs) {
    costs += fmt::format("<tr><th scope=row>{}<td>{}<td>{}\n", escaped(stage_of(study, cost)),
                         figure(cost.seconds), cost.rays ? fmt::format("{}", *cost.rays) : dash);
  }
  return key_values("Provenance", "Of", study.provenance) +
         (costs.empty() ? "" : table("Cost", {"Stage", "Seconds", "Rays"}, costs));
}

}  // namespace earthshine::app
