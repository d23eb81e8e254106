// SPDX-License-Identifier: Apache-2.0
#include "app/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <tuple>

#include "app/report/sections.h"
#include "app/study/words.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";           // U+FFFD
constexpr std::string_view first_strong_isolate = "\xE2\x81\xA8";  // U+2068
constexpr std::string_view pop_isolate = "\xE2\x81\xA9";           // U+2069

// Code point of a UTF-8 character of two or three bytes.
unsigned code_of(std::string_view character) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(character[k]); };
  if (character.size() == 2) return (byte(0) & 0x1FU) << 6U | (byte(1) & 0x3FU);
  if (character.size() != 3) return 0;
  return (byte(0) & 0x0FU) << 12U | (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU);
}

// Characters that end a paragraph and thus an isolate (UAX #9, class B).
bool ends_paragraph(unsigned code) { return (code >= 0x80 && code <= 0x9F) || code == 0x2029; }

// U+2066 to U+2068 begin an isolate.
bool begins_isolate(unsigned code) { return code >= 0x2066 && code <= 0x2068; }

// Whether the text may be written from right to left: marks, embeddings, overrides and isolates;
// letters from Hebrew to Arabic Extended-A and their presentation forms; all characters of four
// bytes, among them the ancient scripts of the Near East.
bool may_be_right_to_left(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = std::max<std::size_t>(1, base::utf8_length(text.substr(at)));
    const unsigned code = code_of(text.substr(at, length));
    const bool right_to_left =
        length == 4 || (code >= 0x590 && code <= 0x8FF) || (code >= 0x200E && code <= 0x200F) ||
        (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
        (code >= 0xFB1D && code <= 0xFEFC);
    if (right_to_left) return true;
    at += length;
  }
  return false;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string html;
  html.reserve(text.size() + text.size() / 8);
  const bool isolated = may_be_right_to_left(text);
  if (isolated) html += first_strong_isolate;
  std::size_t open = 0;  // open isolates in the text itself
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const auto code = static_cast<unsigned char>(c);
    const std::size_t length = base::utf8_length(text.substr(at));
    const std::string_view character = text.substr(at, std::max<std::size_t>(1, length));
    const unsigned wide = code_of(character);
    const bool pops = character == pop_isolate;
    if (length == 0 || code == 0x7F || (code < 0x20 && c != '\t' && c != '\n') ||
        (length > 1 && ends_paragraph(wide)) || (pops && open == 0)) {
      html += replacement;
    } else if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else if (c == '>') {
      html += "&gt;";
    } else if (c == '"') {
      html += "&quot;";
    } else if (c == '\'') {
      html += "&#39;";
    } else {
      if (begins_isolate(wide)) ++open;
      if (pops) --open;
      html += character;
    }
    at += character.size();
  }
  if (!isolated) return html;
  for (; open > 0; --open) html += pop_isolate;
  html += pop_isolate;
  return html;
}

std::string island(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&') {
      text += fmt::format("\\u{:04x}", c);
    } else {
      text += c;
    }
  }
  return text;
}

std::string base64(std::string_view bytes) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word <<= 8U;
      if (at + k < bytes.size()) word |= static_cast<unsigned char>(bytes[at + k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += at + k <= bytes.size() ? digits[(word >> (18 - 6 * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string figure(const Number& value, Form form) {
  if (!value || !std::isfinite(*value)) return dash;
  const double x = form == Form::Percent ? 100.0 * *value : *value;
  if (form == Form::Count) return fmt::format("{:.0f}", x);
  if (form == Form::Chance) {
    if (x > 0.995 && x < 1.0) return "&gt;0.99";
    if (x > 0.0 && x < 0.005) return "&lt;0.01";
    return fmt::format("{:.2f}", x);
  }
  const double size = std::fabs(x);
  return size >= 999.5 && size < 1e7 ? fmt::format("{:.0f}", x) : fmt::format("{:.3g}", x);
}

std::string shares_text(const std::vector<GroupShare>& shares, Form form) {
  std::string text;
  for (const GroupShare& share : shares) {
    if (!text.empty()) text += ", ";
    text += escaped(share.group) + " " + figure(share.value, form);
    if (form == Form::Percent && share.value) text += " %";
  }
  return text.empty() ? dash : text;
}

std::string place_of(const ConditionEntry& condition) {
  if (!condition.utc.empty()) return condition.utc;
  if (!condition.position_deg) return condition.name.empty() ? condition.id : condition.name;
  return fmt::format("{:.6g}°", *condition.position_deg);
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// Groups a study's conditions into tables.
std::vector<Block> blocks_of(const StudyResults& study) {
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < study.conditions.size(); ++k) {
    const ConditionEntry& condition = study.conditions[k];
    const std::string lamps = condition.position_deg ? "\n" + condition.lamps : "";
    const auto same = [&](const Block& block) {
      return block.scene == condition.scene && block.lamps == lamps;
    };
    const auto found = std::find_if(blocks.begin(), blocks.end(), same);
    if (found == blocks.end()) {
      blocks.push_back({condition.scene, lamps, {k}});
    } else {
      found->conditions.push_back(k);
    }
  }
  for (Block& block : blocks) {
    if (block.lamps.empty()) continue;
    block.lamps.erase(0, 1);  // the mark of an orbit
    std::stable_sort(block.conditions.begin(), block.conditions.end(),
                     [&](std::size_t a, std::size_t b) {
                       return *study.conditions[a].position_deg < *study.conditions[b].position_deg;
                     });
  }
  return blocks;
}

std::vector<std::size_t> results_of(const StudyResults& study, const Block& block) {
  std::map<std::size_t, std::size_t> places;
  for (std::size_t k = 0; k < block.conditions.size(); ++k) places[block.conditions[k]] = k;
  std::vector<std::size_t> results;
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    if (places.count(study.results[k].condition) != 0) results.push_back(k);
  }
  std::sort(results.begin(), results.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t k) {
      const ResultEntry& result = study.results[k];
      return std::tuple(result.camera, result.target, places[result.condition]);
    };
    return key(a) < key(b);
  });
  return results;
}

std::string block_title(const StudyResults& study, const Block& block) {
  const std::string lamps = block.lamps.empty() ? "" : "lamps: " + escaped(block.lamps);
  if (study.scenes.size() == 1 && !lamps.empty()) return lamps;
  const std::string title = escaped(scene_title(study, block.scene));
  return lamps.empty() ? title : title + ", " + lamps;
}

std::string block_data(const StudyResults& study, const Block& block) {
  return fmt::format(" data-scene=\"{}\" data-lamps=\"{}\"",
                     escaped(scene_title(study, block.scene)), escaped(block.lamps));
}

std::string degrees(std::string text) {
  constexpr std::string_view unit = " deg", to = " to ";
  for (std::size_t at = 0; (at = text.find(unit, at)) != std::string::npos;) {
    const std::size_t end = at + unit.size();
    if (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0) {
      at = end;  // "degrees"
      continue;
    }
    text.replace(at, unit.size(), "°");
    const std::size_t between = text.rfind(to, at), comma = text.rfind(',', at);
    if (between != std::string::npos && (comma == std::string::npos || between > comma) &&
        between > 0 && std::isdigit(static_cast<unsigned char>(text[between - 1])) != 0) {
      text.insert(between, "°");
    }
  }
  return text;
}

std::string conditions_text(const StudyResults& study, const Block& block,
                            const std::vector<std::size_t>& places) {
  const bool several = study.scenes.size() > 1 || !block.lamps.empty();
  const std::string under = several ? ", " + block_title(study, block) : std::string();
  if (places.size() == block.conditions.size() && places.size() > 1) {
    return (study.conditions[block.conditions.front()].position_deg ? "every position"
                                                                    : "every condition") +
           under;
  }
  std::string text;
  for (std::size_t k = 0; k < places.size();) {
    std::size_t last = k;
    const auto condition = [&](std::size_t place) -> const ConditionEntry& {
      return study.conditions[block.conditions[places[place]]];
    };
    if (condition(k).position_deg) {
      while (last + 1 < places.size() && places[last + 1] == places[last] + 1) ++last;
    }
    if (!text.empty()) text += ", ";
    text += escaped(place_of(condition(k)));
    if (last > k) text += " to " + escaped(place_of(condition(last)));
    k = last + 1;
  }
  return text + under;
}

}  // namespace earthshine::app
