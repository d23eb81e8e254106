// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/override.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::string_view fixed_keys[] = {"format", "name", "unit"};
constexpr std::string_view plain_tables[] = {"sun",     "earth",   "orbit", "time",   "ambient",
                                             "monitor", "quality", "moon",  "airglow"};
constexpr std::string_view named_tables[] = {"material", "object",       "light", "area", "camera",
                                             "cctv",     "range_sensor", "joint", "track"};

template <std::size_t N>
bool among(std::string_view word, const std::string_view (&words)[N]) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

void move_to(TomlNode& node, const base::Location& where) {
  node.where = where;
  if (auto* items = std::get_if<TomlArray>(&node.value)) {
    for (TomlNode& item : *items) move_to(item, where);
  }
  if (auto* table = std::get_if<TomlTable>(&node.value)) {
    for (TomlEntry& entry : *table) {
      entry.where = where;
      move_to(entry.node, where);
    }
  }
}

TomlNode parse_value(std::string_view text, const base::Location& where) {
  const bool one_line = std::none_of(text.begin(), text.end(),
                                     [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  std::optional<std::string> problem;
  if (one_line) {
    try {
      TomlNode root = parse_toml(fmt::format("value = {}", text), where.file);
      TomlNode value = std::get<TomlTable>(root.value).at(0).node;
      move_to(value, where);
      return value;
    } catch (const Error& error) {
      problem = error.what();
    }
  }
  const bool plain_word = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return std::string_view("[]{}\"'=,#\\").find(c) == std::string_view::npos &&
           static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) < 0x7F;
  });
  if (plain_word) return {where, std::string(text)};
  throw Error(Blame::Input, where, fmt::format("the value {} is not TOML", in_quotes(text)),
              "allowed is a number, true, false, a word, \"a string\" or an array [..., ...]");
}

void set(TomlTable& table, std::string_view key, TomlNode value, const base::Location& where) {
  TomlEntry* entry = find_entry(table, key);
  if (entry == nullptr) {
    table.push_back({std::string(key), where, std::move(value)});
  } else {
    entry->where = where;
    entry->node = std::move(value);
  }
}

TomlTable& plain_table(TomlTable& root, std::string_view name, const base::Location& where) {
  if (find_entry(root, name) == nullptr) set(root, name, {where, TomlTable{}}, where);
  auto* table = std::get_if<TomlTable>(&find_entry(root, name)->node.value);
  if (table == nullptr) {
    throw Error(Blame::Input, where, fmt::format("\"{}\" is not a table in the scene", name), {},
                fmt::format("Write [{}] there", name));
  }
  return *table;
}

// Entries of [[kind]] with this name; the scene reader reports duplicates.
std::vector<TomlTable*> entries_named(TomlTable& root, std::string_view kind, std::string_view name,
                                      const base::Location& where) {
  std::vector<TomlTable*> found;
  std::vector<std::string> names;
  TomlEntry* entry = find_entry(root, kind);
  auto* items = entry == nullptr ? nullptr : std::get_if<TomlArray>(&entry->node.value);
  if (items != nullptr) {
    for (TomlNode& item : *items) {
      auto* table = std::get_if<TomlTable>(&item.value);
      TomlEntry* named = table == nullptr ? nullptr : find_entry(*table, "name");
      const auto* text = named == nullptr ? nullptr : std::get_if<std::string>(&named->node.value);
      if (text == nullptr) continue;
      names.push_back(*text);
      if (*text == name) found.push_back(table);
    }
  }
  if (found.empty()) {
    throw Error(Blame::Input, where, fmt::format("no [[{}]] is named {}", kind, in_quotes(name)),
                names.empty() ? fmt::format("the scene has no [[{}]]", kind)
                              : "the scene has: " + listed(names),
                did_you_mean(name, names));
  }
  return found;
}

bool is_entry(const TomlTable& root, std::string_view kind, std::string_view name) {
  const TomlEntry* entry = find_entry(root, kind);
  const auto* items = entry == nullptr ? nullptr : std::get_if<TomlArray>(&entry->node.value);
  return items != nullptr && std::any_of(items->begin(), items->end(), [&](const TomlNode& item) {
           const auto* table = std::get_if<TomlTable>(&item.value);
           const TomlEntry* named = table == nullptr ? nullptr : find_entry(*table, "name");
           const auto* text =
               named == nullptr ? nullptr : std::get_if<std::string>(&named->node.value);
           return text != nullptr && *text == name;
         });
}

// Whether any object imports the lamps of its mesh.
bool meshes_have_lamps(const TomlTable& root) {
  const TomlEntry* entry = find_entry(root, "object");
  const auto* items = entry == nullptr ? nullptr : std::get_if<TomlArray>(&entry->node.value);
  return items != nullptr && std::any_of(items->begin(), items->end(), [](const TomlNode& item) {
           const auto* table = std::get_if<TomlTable>(&item.value);
           const TomlEntry* lights = table == nullptr ? nullptr : find_entry(*table, "lights");
           const auto* flag = lights == nullptr ? nullptr : std::get_if<bool>(&lights->node.value);
           return flag != nullptr && *flag;
         });
}

constexpr std::string_view strength_keys[] = {"intensity", "exitance", "flux", "illuminance"};

bool is_zero(const TomlNode& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return *whole == 0;
  if (const auto* number = std::get_if<double>(&value.value)) return *number == 0.0;
  const auto* items = std::get_if<TomlArray>(&value.value);
  return items != nullptr && !items->empty() && std::all_of(items->begin(), items->end(), is_zero);
}

bool switches_lamps_off(std::string_view key, const TomlNode& value) {
  return among(key, strength_keys) && is_zero(value);
}

// Sets the key that gives the strength of a [[light]] of any type. A measured light gets a flux,
// which all types accept; its colour is only a hue.
void set_dark(TomlTable& light, const base::Location& where) {
  const TomlNode none{where, std::int64_t{0}};
  for (const std::string_view key : strength_keys) {
    if (find_entry(light, key) == nullptr) continue;
    set(light, key, none, where);
    return;
  }
  std::erase_if(light, [](const TomlEntry& entry) { return entry.key == "color"; });
  set(light, "flux", none, where);
}

}  // namespace

void switch_off(Scene& scene, const std::vector<LampOff>& off) {
  for (const LampOff& wanted : off) {
    const auto lamp = std::find_if(scene.lamps.begin(), scene.lamps.end(),
                                   [&](const Lamp& one) { return one.name == wanted.name; });
    if (lamp == scene.lamps.end()) {
      std::vector<std::string> names;
      for (const Lamp& one : scene.lamps) names.push_back(one.name);
      throw Error(Blame::Input, wanted.where,
                  fmt::format("no light is named {}", in_quotes(wanted.name)),
                  names.empty() ? "the scene has none" : "the scene has: " + listed(names),
                  did_you_mean(wanted.name, names));
    }
    lamp->intensity_cd = lamp->exitance = Rgb(0.0);
  }
}

void apply_override(TomlNode& root, const std::string& setting,
                    const std::optional<base::Location>& asked_at, std::vector<LampOff>& off) {
  const std::string origin = asked_at ? base::to_string(*asked_at) + ": set " : "--set ";
  const base::Location where{origin + printable(setting, 200)};
  const std::size_t equals = setting.find('=');
  const std::string_view path = std::string_view(setting).substr(0, equals);
  const std::size_t first_dot = path.find('.');
  const std::size_t last_dot = path.rfind('.');
  const std::string_view head = path.substr(0, first_dot);
  if (equals == std::string::npos || equals == 0) {
    throw Error(Blame::Input, where, "not of the form key=value",
                "for example quality.error=0.05 or light.NAME.intensity=0");
  }
  auto& table = std::get<TomlTable>(root.value);
  TomlNode value = parse_value(std::string_view(setting).substr(equals + 1), where);

  if (among(head, fixed_keys) && first_dot == std::string_view::npos) {
    set(table, head, std::move(value), where);
  } else if (among(head, plain_tables)) {
    if (first_dot == std::string_view::npos || first_dot != last_dot ||
        last_dot + 1 == path.size()) {
      throw Error(Blame::Input, where, fmt::format("{} does not name one key", in_quotes(path)),
                  fmt::format("keys of [{0}] are set as {0}.KEY=VALUE", head));
    }
    set(plain_table(table, head, where), path.substr(last_dot + 1), std::move(value), where);
  } else if (among(head, named_tables)) {
    if (first_dot == last_dot || last_dot + 1 == path.size()) {
      throw Error(Blame::Input, where,
                  fmt::format("{} does not name one key of one entry", in_quotes(path)),
                  fmt::format("keys of [[{0}]] are set as {0}.NAME.KEY=VALUE", head));
    }
    const std::string_view name = path.substr(first_dot + 1, last_dot - first_dot - 1);
    const bool switches_off =
        head == "light" && switches_lamps_off(path.substr(last_dot + 1), value);
    if (switches_off && meshes_have_lamps(table) && !is_entry(table, head, name)) {
      off.push_back({std::string(name), where});
      return;
    }
    for (TomlTable* entry : entries_named(table, head, name, where)) {
      const std::string_view key = path.substr(last_dot + 1);
      if (switches_off && find_entry(*entry, key) == nullptr) {
        set_dark(*entry, where);
      } else {
        set(*entry, key, value, where);
      }
    }
  } else {
    std::vector<std::string> known;
    known.insert(known.end(), std::begin(fixed_keys), std::end(fixed_keys));
    known.insert(known.end(), std::begin(plain_tables), std::end(plain_tables));
    known.insert(known.end(), std::begin(named_tables), std::end(named_tables));
    throw Error(Blame::Input, where, fmt::format("unknown key {}", in_quotes(head)),
                "a setting begins with one of: " + listed(known), did_you_mean(head, known));
  }
}

}  // namespace earthshine::scenes
