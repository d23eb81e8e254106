// SPDX-License-Identifier: Apache-2.0
// Reads settings of a scene's table into a struct with visit_fields (fields.h). All errors are
// base::Error (Input) with the key's position, the value found and the allowed values.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "degrade/stage/fields.h"
#include "scenes/scene.h"
#include "scenes/text/message_text.h"

namespace earthshine::degrade {

using scenes::did_you_mean, scenes::in_quotes;

// Without trailing zeros; with a decimal point in any locale.
[[nodiscard]] std::string number(double value);

// The value of a setting; words are in quotes.
[[nodiscard]] std::string as_written(const scenes::Setting& setting);

// Position of the key, or of the table if it does not have the key.
[[nodiscard]] const base::Location& place_of(const scenes::SettingTable& table,
                                             std::string_view key);

// "a, b or c".
template <class Words>
std::string listed(const Words& words) {
  std::string text;
  std::size_t left = std::size(words);
  for (const auto& word : words) {
    text += in_quotes(word);
    if (--left > 0) text += left == 1 ? " or " : ", ";
  }
  return text;
}

template <class T>
T value_of(const scenes::Setting& setting) {
  if (const T* value = std::get_if<T>(&setting.value)) return *value;
  const char* const wanted = std::is_same_v<T, bool>     ? "true or false"
                             : std::is_same_v<T, double> ? "a number"
                                                         : "a word in quotes";
  throw base::Error(
      base::Blame::Input, setting.where,
      in_quotes(setting.key) + " is " + as_written(setting) + ", a value of the wrong kind",
      std::string("it must be ") + wanted);
}

void read_value(const scenes::Setting& setting, bool& field, Limits limits);
void read_value(const scenes::Setting& setting, double& field, Limits limits);
void read_value(const scenes::Setting& setting, int& field, Limits limits);

template <class E>
requires std::is_enum_v<E>
void read_value(const scenes::Setting& setting, E& field, Limits) {
  const std::string word = value_of<std::string>(setting);
  const auto words = words_of(E{});
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) {
      field = static_cast<E>(i);
      return;
    }
  }
  throw base::Error(base::Blame::Input, setting.where,
                    in_quotes(setting.key) + " is " + in_quotes(word),
                    "it must be " + listed(words), did_you_mean(word, words));
}

// Assigns one setting of `table` to the field of its name; `visit` iterates over the fields of
// `target`.
template <class Target, class Visit>
void read_setting(const scenes::Setting& setting, std::string_view table, Target& target,
                  Visit visit, std::vector<std::string> other_keys) {
  bool known = false;
  visit(target, [&](const char* key, auto& field, Limits limits, const char*, const char*) {
    other_keys.emplace_back(key);
    if (setting.key != key) return;
    known = true;
    read_value(setting, field, limits);
  });
  if (known) return;
  throw base::Error(base::Blame::Input, setting.where,
                    "unknown key " + in_quotes(setting.key) + " in " + std::string(table),
                    "allowed keys: " + listed(other_keys), did_you_mean(setting.key, other_keys));
}

}  // namespace earthshine::degrade
