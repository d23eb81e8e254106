// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/model.h"
#include "scenes/text/message_text.h"
#include "scenes/text/table_reader.h"

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

enum class Kind { Number, Whole, Word, Truth, Table, Tables };

struct Rule {
  std::string_view keys;  // ends of the keys from the top, joined by '/', without list indices
  Kind kind;
  Range range = any_number;  // of each number
  std::size_t count = 0;     // of numbers; 0: no list
  std::string_view otherwise =
      {};                       // instead of a number out of range, for the warning; empty: error
  std::string_view words = {};  // the allowed ones of a Word
};

constexpr std::size_t any_count = SIZE_MAX;  // a list, or a table, of any length
constexpr Range whole{0.0, 2147483647.0};    // tinygltf stores 32 bits
constexpr Range length{-1e15, 1e15};
constexpr std::string_view none = "taken as none", brought = "the nearest allowed is taken";

// Values that change the picture or the memory used. tinygltf uses the default of an optional value
// of the wrong type and drops primitives that are no tables; it checks required values itself.
constexpr Rule rules[] = {
    {"/primitives, /targets", Kind::Tables},
    {"/pbrMetallicRoughness, Texture", Kind::Table},
    {"/scene, /nodes/mesh, /nodes/camera, /nodes/skin, /primitives/indices, /primitives/material, "
     "/skins/inverseBindMatrices, /textures/source, /textures/sampler, Texture/index",
     Kind::Whole, whole, 0, none},
    {"/buffers/byteLength, /bufferViews/buffer, /bufferViews/byteOffset, /bufferViews/byteLength, "
     "/bufferViews/byteStride, /accessors/bufferView, /accessors/byteOffset, "
     "/accessors/componentType, /accessors/count, /sparse/count, /sparse/indices/bufferView, "
     "/sparse/indices/byteOffset, /sparse/indices/componentType, /sparse/values/bufferView, "
     "/sparse/values/byteOffset, /images/bufferView, /primitives/mode, /targets/POSITION, "
     "/targets/NORMAL, /texCoord, /KHR_lights_punctual/light, /samplers/wrapS, /samplers/wrapT, "
     "/samplers/magFilter",
     Kind::Whole, whole},
    {"/scenes/nodes, /nodes/children, /skins/joints, /primitives/attributes, "
     "/EXT_mesh_gpu_instancing/attributes",
     Kind::Whole, whole, any_count},
    {"/weights", Kind::Number, length, any_count},
    {"/nodes/matrix", Kind::Number, length, 16},
    {"/nodes/rotation", Kind::Number, length, 4},
    {"/nodes/translation, /nodes/scale", Kind::Number, length, 3},
    {"/KHR_texture_transform/offset, /KHR_texture_transform/scale", Kind::Number, length, 2},
    {"/KHR_texture_transform/rotation", Kind::Number, length},
    {"/doubleSided, /accessors/normalized", Kind::Truth},
    {"/materials/alphaMode", Kind::Word, {}, 0, {}, "OPAQUE, MASK, BLEND"},
    {"/alphaCutoff, /ior, /thicknessFactor", Kind::Number, at_least_zero},
    {"/lights/range", Kind::Number},
    {"/metallicFactor, /roughnessFactor, /glossinessFactor, /transmissionFactor, "
     "/KHR_materials_specular/specularFactor",
     Kind::Number, share, 0, brought},
    {"/emissiveFactor, /lights/color, /KHR_materials_pbrSpecularGlossiness/specularFactor",
     Kind::Number, share, 3, brought},
    {"/baseColorFactor, /diffuseFactor", Kind::Number, share, 4, brought},
    {"/specularColorFactor", Kind::Number, {0.0, 1e3}, 3, brought},
    {"/emissiveStrength", Kind::Number, {0.0, 1e12}, 0, brought},
    {"/lights/intensity", Kind::Number, light_strength, 0, brought},
    {"/innerConeAngle, /outerConeAngle", Kind::Number, {0.0, base::pi / 2.0}, 0, brought},
    {"/yfov", Kind::Number, {0.0, base::pi, true, true}, 0, "the camera is left out"},
    {"/aspectRatio", Kind::Number, {0.0, 32.0, true, true}, 0, "1 is taken"}};

// Whether `holds` is true of one of the words, which ", " separates.
template <class Holds>
bool any_word(std::string_view words, Holds holds) {
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(", ", at), words.size());
    if (holds(words.substr(at, end - at))) return true;
    at = end + 2;
  }
  return false;
}

constexpr Rule extension_rule{{}, Kind::Table};

const Rule* rule_for(std::string_view keys) {
  const auto* const found = std::find_if(std::begin(rules), std::end(rules), [&](const Rule& rule) {
    return any_word(rule.keys, [&](std::string_view end) { return keys.ends_with(end); });
  });
  return found == std::end(rules) ? nullptr : found;
}

std::string described(const Json& value) {
  if (value.is_object()) return "a table";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return printable(text, 80);
}

std::string allowed(const Rule& rule) {
  if (rule.kind == Kind::Table) return "a table, {...}";
  if (rule.kind == Kind::Tables) return "a list of tables, [{...}, ...]";
  if (rule.kind == Kind::Truth) return "true or false";
  if (rule.kind == Kind::Word) return std::string(rule.words);
  const std::string_view kind = rule.kind == Kind::Number ? "number" : "whole number";
  const std::string which = rule.count == 0           ? fmt::format("a {}", kind)
                            : rule.count == any_count ? fmt::format("{}s", kind)
                                                      : fmt::format("{} {}s", rule.count, kind);
  return which + ", " + to_string(rule.range);
}

class Values {
 public:
  explicit Values(const std::filesystem::path& path) : path_(path) {}

  // Checks a table and all tables below it. `keys` and `place` name its position:
  // "/materials/extensions" and "materials[2].extensions".
  void check(Json& table, const std::string& keys, const std::string& place) {
    for (auto entry = table.begin(); entry != table.end(); ++entry) {
      Json& value = entry.value();
      if (entry.key() == "extras" || value.is_null()) continue;
      const bool is_extension = keys.ends_with("/extensions");
      if (is_extension && !is_read_extension(entry.key())) continue;
      const std::string below = keys + "/" + entry.key();
      const std::string here = place.empty() ? entry.key() : place + "." + entry.key();
      const Rule* rule = is_extension ? &extension_rule : rule_for(below);
      if (rule != nullptr) check_value(*rule, value, below, here);
      if (value.is_object()) check(value, below, here);
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        if (value[i].is_object()) check(value[i], below, fmt::format("{}[{}]", here, i));
      }
    }
  }

  [[nodiscard]] bool rewritten() const { return rewritten_; }

  void report(std::vector<std::string>& warnings) const {
    for (const auto& [keys, note] : notes_) {
      const std::string more =
          note.count > 1 ? fmt::format(" ({} more such)", note.count - 1) : std::string();
      warnings.push_back(fmt::format("{}: {}{}; allowed: {}; {}", path_.string(), note.first, more,
                                     allowed(*note.rule), note.rule->otherwise));
    }
  }

 private:
  struct Note {
    const Rule* rule = nullptr;
    std::string first;
    std::size_t count = 0;
  };

  void check_value(const Rule& rule, Json& value, const std::string& keys,
                   const std::string& place) {
    bool is_kind = true;
    if (rule.kind == Kind::Table) {
      is_kind = value.is_object();
    } else if (rule.kind == Kind::Tables) {
      is_kind = value.is_array() && std::all_of(value.begin(), value.end(), [](const Json& entry) {
                  return entry.is_object();
                });
    } else if (rule.kind == Kind::Truth) {
      is_kind = value.is_boolean();
    } else if (rule.kind == Kind::Word) {
      is_kind = value.is_string() && any_word(rule.words, [&](std::string_view word) {
                  return word == value.get_ref<const std::string&>();
                });
    } else if (rule.count == 0) {
      check_number(rule, value, keys, place);
    } else if (rule.count == any_count ? value.is_structured()
                                       : value.is_array() && value.size() == rule.count) {
      for (auto entry = value.begin(); entry != value.end(); ++entry) {
        check_number(rule, entry.value(), keys,
                     value.is_object() ? place + "." + entry.key()
                                       : fmt::format("{}[{}]", place, entry - value.begin()));
      }
    } else {
      is_kind = false;
    }
    if (!is_kind) refuse(rule, value, place);
  }

  void check_number(const Rule& rule, Json& value, const std::string& keys,
                    const std::string& place) {
    if (!value.is_number()) refuse(rule, value, place);
    const auto number = value.get<double>();
    if (rule.kind == Kind::Whole && value.is_number_float()) {
      if (number != std::floor(number) || std::abs(number) > 1e15) refuse(rule, value, place);
      value = static_cast<std::int64_t>(number);
      rewritten_ = true;
    }
    // pi / 2 rounded to a float exceeds pi / 2.
    constexpr double rounding = 1e-6;
    if (rule.range.holds(number) || rule.range.holds(number - rounding) ||
        rule.range.holds(number + rounding)) {
      return;
    }
    if (rule.otherwise.empty()) refuse(rule, value, place);
    Note& note = notes_[keys];
    if (note.count++ == 0) {
      note.rule = &rule;
      note.first = fmt::format("{} is {}", place, described(value));
    }
    if (rule.otherwise == none) {
      value = -1;  // tinygltf's "none"; a truncated large number could be a valid index
      rewritten_ = true;
    }
  }

  [[noreturn]] void refuse(const Rule& rule, const Json& value, const std::string& place) const {
    throw Error(Blame::Input, base::Location{path_.string()},
                fmt::format("{} is {}", place, described(value)), "allowed: " + allowed(rule),
                "Write it as glTF 2.0 has it, or leave it out");
  }

  const std::filesystem::path& path_;
  bool rewritten_ = false;
  std::map<std::string, Note> notes_;  // by the keys of the value
};

// tinygltf hands over the bytes of a picture in a buffer view without checking that they exist.
void check_pictures(const Json& top, const std::filesystem::path& path) {
  const Json missing = Json::object();
  const auto number = [](const Json& table, const char* key) {
    const auto found = table.find(key);
    return found != table.end() && found->is_number() ? found->get<std::size_t>() : 0;
  };
  const auto entry = [&](const char* list, std::size_t index) -> const Json& {
    const auto found = top.find(list);
    const bool exists = found != top.end() && found->is_array() && index < found->size();
    return exists && found->at(index).is_object() ? found->at(index) : missing;
  };
  const auto images = top.find("images");
  for (std::size_t i = 0; images != top.end() && i < images->size(); ++i) {
    if (!entry("images", i).contains("bufferView")) continue;
    const Json& view = entry("bufferViews", number(entry("images", i), "bufferView"));
    const std::size_t end = number(view, "byteOffset") + number(view, "byteLength");
    const std::size_t held = number(entry("buffers", number(view, "buffer")), "byteLength");
    if (end <= held) continue;
    gltf_fail(path, fmt::format("images[{}] ends at byte {} of its buffer", i, end),
              fmt::format("the buffer has {}", held));
  }
}

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
  values.check(top, {}, {});
  values.report(warnings);
  check_pictures(top, path);
  if (!values.rewritten()) return std::nullopt;
  return with_text(bytes, binary, text.size(),
                   top.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace earthshine::scenes
