// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

std::string joined(KeyList words) {
  std::string result;
  for (const auto& word : words) result.append(result.empty() ? "" : ", ").append(word);
  return result;
}

std::string nearest(std::string_view word, KeyList words) {
  return did_you_mean(word, std::vector<std::string>(words.begin(), words.end()));
}

std::optional<double> as_number(const TomlNode& node) {
  if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&node.value)) return *number;
  return std::nullopt;
}

}  // namespace

std::string to_string(const Range& range) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  if (low && high && !range.open_low && !range.open_high) {
    return fmt::format("from {:.10g} to {:.10g}", range.low, range.high);
  }
  const std::string from =
      fmt::format("{} {:.10g}", range.open_low ? "above" : "at least", range.low);
  const std::string to =
      fmt::format("{} {:.10g}", range.open_high ? "below" : "at most", range.high);
  if (low && high) return from + " and " + to;
  return low ? from : high ? to : "finite";
}

TableReader::TableReader(const TomlNode& node, std::string title, KeyList keys)
    : node_(node), table_(std::get_if<TomlTable>(&node.value)), label_(std::move(title)) {
  if (table_ == nullptr) {
    throw Error(Blame::Input, node.where,
                fmt::format("{} where {} is wanted", describe(node), label_), {},
                fmt::format("Write {} on a separate line and the keys below it", label_));
  }
  for (const TomlEntry& entry : *table_) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    throw Error(Blame::Input, entry.where,
                fmt::format("unknown key {} in {}", in_quotes(entry.key), label_),
                "allowed keys: " + joined(keys), nearest(entry.key, keys));
  }
}

void TableReader::allow_only(KeyList keys, std::string_view of_what) const {
  for (const TomlEntry& entry : *table_) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    throw Error(
        Blame::Input, entry.where,
        fmt::format("the key \"{}\" of {} does not belong to {}", entry.key, label_, of_what),
        "allowed keys: " + joined(keys));
  }
}

const TomlEntry* TableReader::find(std::string_view key) const { return find_entry(*table_, key); }

const base::Location& TableReader::where(std::string_view key) const {
  const TomlEntry* entry = find(key);
  return entry != nullptr ? entry->where : node_.where;
}

std::string TableReader::read_name() {
  std::string name = required(this->name("name"), "name", "name = \"...\"");
  label_ += " " + in_quotes(name);
  return name;
}

void TableReader::missing(std::string_view key, std::string_view example) const {
  throw Error(Blame::Input, node_.where, fmt::format("{} has no \"{}\"", label_, key), {},
              fmt::format("Add {}", example));
}

void TableReader::fail(std::string_view key, std::string_view found, std::string_view allowed,
                       std::string_view remedy) const {
  throw Error(Blame::Input, where(key), fmt::format("\"{}\" in {} {}", key, label_, found), allowed,
              remedy);
}

double TableReader::checked(const TomlEntry& entry, const TomlNode& node, Range range,
                            std::string_view wanted) const {
  const std::optional<double> number = as_number(node);
  const std::string allowed = range.low == any_number.low && range.high == any_number.high
                                  ? fmt::format("allowed is {}", wanted)
                                  : fmt::format("allowed is {}, {}", wanted, to_string(range));
  if (!number) fail(entry.key, "is " + describe(node), allowed);
  if (!std::isfinite(*number) || !range.holds(*number)) {
    fail(entry.key, fmt::format("is {}", *number), allowed);
  }
  return *number;
}

Vec3 TableReader::three(const TomlEntry& entry, const TomlNode& node, Range range,
                        std::string_view wanted) const {
  const auto* items = std::get_if<TomlArray>(&node.value);
  if (items == nullptr || items->size() != 3) {
    fail(entry.key, "is " + describe(node), fmt::format("allowed is {}", wanted));
  }
  Vec3 result(0.0);
  for (int i = 0; i < 3; ++i) {
    result[i] = checked(entry, (*items)[static_cast<std::size_t>(i)], range, wanted);
  }
  return result;
}

std::optional<bool> TableReader::flag(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<bool>(&entry->node.value);
  if (value == nullptr) fail(key, "is " + describe(entry->node), "allowed is true or false");
  return *value;
}

std::optional<double> TableReader::number(std::string_view key, Range range) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  return checked(*entry, entry->node, range, "a number");
}

std::optional<int> TableReader::whole(std::string_view key, int low, int high) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const double value = checked(*entry, entry->node, {double(low), double(high)}, "a whole number");
  if (value != std::floor(value)) {
    fail(key, fmt::format("is {}", value),
         fmt::format("allowed is a whole number, from {} to {}", low, high));
  }
  return static_cast<int>(value);
}

std::optional<std::string> TableReader::text(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<std::string>(&entry->node.value);
  const bool printable = value != nullptr && std::none_of(value->begin(), value->end(), [](char c) {
                           return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
                         });
  if (!printable || value->empty()) {
    fail(key, "is " + describe(entry->node),
         "allowed is a string in quotes, on one line, not empty");
  }
  return *value;
}

std::optional<std::string> TableReader::name(std::string_view key) const {
  std::optional<std::string> value = text(key);
  if (value && value->size() > longest_name) {
    fail(key, fmt::format("has {} bytes", value->size()),
         fmt::format("allowed are at most {}", longest_name));
  }
  return value;
}

std::optional<std::string> TableReader::choice(std::string_view key, KeyList choices) const {
  std::optional<std::string> value = text(key);
  if (value && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
    fail(key, fmt::format("is {}", in_quotes(*value)), "allowed are: " + joined(choices),
         nearest(*value, choices));
  }
  return value;
}

std::optional<Rgb> TableReader::colour(std::string_view key, Range range) const {
  return one_or_three(key, range, "a number or [r, g, b]");
}

std::optional<Vec3> TableReader::scale(std::string_view key, Range range) const {
  return one_or_three(key, range, "a number or [x, y, z]");
}

std::optional<Vec3> TableReader::one_or_three(std::string_view key, Range range,
                                              std::string_view wanted) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  if (std::holds_alternative<TomlArray>(entry->node.value)) {
    return three(*entry, entry->node, range, wanted);
  }
  return Vec3(checked(*entry, entry->node, range, wanted));
}

std::optional<Vec3> TableReader::vector(std::string_view key, Range range) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  return three(*entry, entry->node, range, "[x, y, z], three numbers");
}

std::optional<Vec3> TableReader::direction(std::string_view key) const {
  const auto value = vector(key, {-largest_length, largest_length});
  if (!value) return std::nullopt;
  const double size = glm::length(*value);
  if (!(size > 1e-9)) fail(key, "has no length", "allowed is [x, y, z] other than zero");
  return *value / size;
}

std::optional<std::vector<Vec3>> TableReader::points(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  constexpr std::string_view wanted = "an array of points, [[x, y, z], ...]";
  if (items == nullptr)
    fail(key, "is " + describe(entry->node), fmt::format("allowed is {}", wanted));
  std::vector<Vec3> result;
  for (const TomlNode& item : *items) {
    result.push_back(three(*entry, item, {-largest_length, largest_length}, wanted));
  }
  return result;
}

std::optional<double> TableReader::length(std::string_view key, double unit_m, Range range) const {
  range.high = std::min(range.high, largest_length);
  const auto value = number(key, range);
  return value ? std::optional(*value * unit_m) : std::nullopt;
}

std::optional<Vec3> TableReader::position(std::string_view key, double unit_m) const {
  const auto value = vector(key, {-largest_length, largest_length});
  return value ? std::optional(*value * unit_m) : std::nullopt;
}

std::vector<const TomlNode*> named_entries(const TableReader& root, std::string_view key) {
  std::vector<const TomlNode*> result;
  const TomlEntry* entry = root.find(key);
  if (entry == nullptr) return result;
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  if (items == nullptr) {
    throw Error(Blame::Input, entry->where, fmt::format("\"{}\" is {}", key, describe(entry->node)),
                fmt::format("a scene may have several; each begins with [[{}]]", key),
                fmt::format("Write [[{}]]", key));
  }
  for (const TomlNode& item : *items) result.push_back(&item);
  return result;
}

void check_unique(std::span<const std::string> names, std::span<const TomlNode* const> entries,
                  std::string_view title) {
  std::unordered_map<std::string_view, std::size_t> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto [first, fresh] = seen.emplace(names[i], i);
    if (fresh) continue;
    throw Error(Blame::Input, entries[i]->where,
                fmt::format("a second {} is named {}", title, in_quotes(names[i])),
                fmt::format("names are unique; the first stands at {}",
                            base::to_string(entries[first->second]->where)),
                "Give one of them another name");
  }
}

}  // namespace earthshine::scenes
