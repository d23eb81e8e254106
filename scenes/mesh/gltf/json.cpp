// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/json.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/rules.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;
using Json = nlohmann::json;

// tinygltf's JSON reader and its values recurse; a deep text would overflow the stack.
void check_depth(std::string_view json, const std::filesystem::path& path) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > max_json_depth) {
      throw Error(Blame::Input, base::Location{path.string()}, "the JSON is nested too deeply",
                  fmt::format("allowed are {} levels", max_json_depth));
    }
  }
}

constexpr std::size_t glb_header = 20;  // of the file and of its first chunk, which is the JSON

// The JSON chunk of a GLB, or the whole text of a glTF file.
std::string_view json_of(std::string_view bytes, bool binary, const std::filesystem::path& path) {
  if (!binary) return bytes;
  std::uint32_t length = 0;
  if (bytes.size() >= glb_header) std::memcpy(&length, bytes.data() + 12, sizeof length);
  if (bytes.size() < glb_header || length > bytes.size() - glb_header) {
    throw Error(Blame::Input, base::Location{path.string()},
                fmt::format("a GLB file of {} bytes is cut off", bytes.size()),
                "it holds a header of 20 bytes and what this announces");
  }
  return bytes.substr(glb_header, length);
}

// The file with its JSON text replaced, padded to a multiple of four.
std::string with_text(std::string_view bytes, bool binary, std::size_t old_length,
                      std::string text) {
  if (!binary) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string made(bytes.substr(0, glb_header));
  made += text;
  made += bytes.substr(glb_header + old_length);
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::memcpy(made.data() + at, &number, sizeof number);
  };
  put(8, made.size());
  put(12, text.size());
  return made;
}

const GltfRule* rule_for(std::string_view path) {
  for (const GltfRule& rule : gltf_rules::all) {
    const bool any = rule.path.front() == '*';
    if (any ? path.ends_with(rule.path.substr(1)) : path == rule.path) return &rule;
  }
  return nullptr;
}

std::string described(const Json& value) {
  if (value.is_object()) return "a table";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return printable(text, 80);
}

class Values {
 public:
  explicit Values(const std::filesystem::path& path) : path_(path) {}

  // Checks a table and all tables below it. `keys` and `place` name its position:
  // "materials/extensions" and "materials[2].extensions".
  void check(Json& table, const std::string& keys, const std::string& place) {
    for (auto entry = table.begin(); entry != table.end(); ++entry) {
      Json& value = entry.value();
      if (entry.key() == "extras" || entry.key().empty() || value.is_null()) continue;
      const std::string below = keys.empty() ? entry.key() : keys + "/" + entry.key();
      const std::string here = place.empty() ? entry.key() : place + "." + entry.key();
      const GltfRule* rule = rule_for(below);
      if (rule != nullptr) check_value(*rule, value, here);
      const bool is_extension = keys == "extensions" || keys.ends_with("/extensions");
      if (is_extension && rule == nullptr) continue;  // its contents are not checked
      if (value.is_object()) check(value, below, here);
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        if (value[i].is_object()) check(value[i], below, fmt::format("{}[{}]", here, i));
      }
    }
  }

  void check_top(Json& top) {
    top_ = &top;
    check(top, {}, {});
  }

  [[nodiscard]] bool rewritten() const { return rewritten_; }

  void report(std::vector<std::string>& warnings) const {
    for (const auto& [rule, note] : notes_) {
      const std::string more =
          note.count > 1 ? fmt::format(" ({} more such)", note.count - 1) : std::string();
      warnings.push_back(fmt::format("{}: {}{}; allowed: {}; {}", path_.string(), note.first, more,
                                     note.allowed, rule->otherwise));
    }
  }

 private:
  struct Note {
    std::string first, allowed;
    std::size_t count = 0;
  };

  void check_value(const GltfRule& rule, Json& value, const std::string& place) {
    switch (rule.kind) {
      case GltfKind::Table:
        if (!value.is_object()) refuse(rule, value, place);
        return;
      case GltfKind::Texture:
        if (!value.is_object()) refuse(rule, value, place);
        for (const GltfRule& entry : gltf_rules::of_texture) {
          const auto found = value.find(entry.path);
          if (found != value.end())
            check_value(entry, *found, fmt::format("{}.{}", place, entry.path));
        }
        return;
      case GltfKind::Tables:
        if (!value.is_array()) refuse(rule, value, place);
        for (const Json& entry : value) {
          if (!entry.is_object()) refuse(rule, entry, place);
        }
        return;
      case GltfKind::Truth:
        if (!value.is_boolean()) refuse(rule, value, place);
        return;
      case GltfKind::Word:
        if (!value.is_string() || !is_among(rule.words, value.get_ref<const std::string&>())) {
          refuse(rule, value, place);
        }
        return;
      case GltfKind::Number:
      case GltfKind::Whole:
      case GltfKind::Entry:
        check_numbers(rule, value, place);
    }
  }

  void check_numbers(const GltfRule& rule, Json& value, const std::string& place) {
    if (rule.count == 0) {
      check_number(rule, value, place);
      return;
    }
    const bool is_list = value.is_array() || (value.is_object() && rule.count == any_count);
    if (!is_list || (rule.count != any_count && value.size() != rule.count)) {
      refuse(rule, value, place);
    }
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
      check_number(rule, entry.value(),
                   value.is_object() ? place + "." + entry.key()
                                     : fmt::format("{}[{}]", place, entry - value.begin()));
    }
  }

  void check_number(const GltfRule& rule, Json& value, const std::string& place) {
    if (!value.is_number()) refuse(rule, value, place);
    const auto number = value.get<double>();
    if (rule.kind != GltfKind::Number && value.is_number_float()) {
      if (number != std::floor(number) || std::abs(number) > 1e15) refuse(rule, value, place);
      value = static_cast<std::int64_t>(number);
      rewritten_ = true;
    }
    const bool is_listed =
        rule.words.empty() || rule.kind == GltfKind::Entry || is_among(rule.words, value.dump());
    // pi / 2 rounded to a float exceeds pi / 2.
    constexpr double rounding = 1e-6;
    const Range range = range_of(rule);
    const bool is_in_range =
        range.holds(number) || range.holds(number - rounding) || range.holds(number + rounding);
    if (is_listed && is_in_range) return;
    if (rule.otherwise.empty()) refuse(rule, value, place);
    const std::string found = described(value);
    if (rule.otherwise == gltf_rules::none) {
      value = -1;  // tinygltf's "none"; a truncated large number could be a valid index
      rewritten_ = true;
    }
    Note& note = notes_[&rule];
    if (note.count++ > 0) return;
    note.first = fmt::format("{} is {}", place, found);
    note.allowed = allowed(rule);
  }

  [[nodiscard]] static bool is_among(std::string_view words, std::string_view word) {
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t end = std::min(words.find(", ", at), words.size());
      if (words.substr(at, end - at) == word) return true;
      at = end + 2;
    }
    return false;
  }

  [[nodiscard]] Range range_of(const GltfRule& rule) const {
    Range range = rule.range;
    if (rule.kind == GltfKind::Entry) {
      const auto list = top_->find(rule.words);
      range.high = list == top_->end() ? -1.0 : static_cast<double>(list->size()) - 1.0;
    }
    return range;
  }

  [[nodiscard]] std::string allowed(const GltfRule& rule) const {
    if (rule.kind == GltfKind::Table || rule.kind == GltfKind::Texture) return "a table, {...}";
    if (rule.kind == GltfKind::Tables) return "a list of tables, [{...}, ...]";
    if (rule.kind == GltfKind::Truth) return "true or false";
    const Range range = range_of(rule);
    if (rule.kind == GltfKind::Entry && range.high < 0.0) {
      return fmt::format("none, as the file has no {}", rule.words);
    }
    if (rule.kind != GltfKind::Entry && !rule.words.empty()) return std::string(rule.words);
    const std::string_view whole = rule.kind == GltfKind::Number ? "" : "whole ";
    const std::string which = rule.count == 0 ? fmt::format("a {}number", whole)
                              : rule.count == any_count
                                  ? fmt::format("{}numbers", whole)
                                  : fmt::format("{} {}numbers", rule.count, whole);
    return which + ", " + to_string(range);
  }

  [[noreturn]] void refuse(const GltfRule& rule, const Json& value,
                           const std::string& place) const {
    throw Error(Blame::Input, base::Location{path_.string()},
                fmt::format("{} is {}", place, described(value)), "allowed: " + allowed(rule),
                "Write it as glTF 2.0 has it, or leave it out");
  }

  const std::filesystem::path& path_;
  const Json* top_ = nullptr;
  bool rewritten_ = false;
  std::map<const GltfRule*, Note> notes_;
};

}  // namespace

std::optional<std::string> check_gltf_text(std::string_view bytes,
                                           const std::filesystem::path& path,
                                           std::vector<std::string>& warnings) {
  const bool binary = bytes.starts_with("glTF");
  const std::string_view text = json_of(bytes, binary, path);
  check_depth(text, path);
  Json top = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!top.is_object()) return std::nullopt;  // tinygltf reports the error
  Values values(path);
  values.check_top(top);
  values.report(warnings);
  if (!values.rewritten()) return std::nullopt;
  return with_text(bytes, binary, text.size(),
                   top.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace earthshine::scenes
