// SPDX-License-Identifier: Apache-2.0
#include "scenes/read/include.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/input/input_file.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

constexpr std::size_t most_nested = 8;
constexpr std::string_view of_scene_alone[] = {"format", "name", "unit"};
constexpr std::string_view file_keys[] = {"mesh",      "file",  "attitude_table", "trajectory",
                                          "angle_deg", "poses", "albedo_grid"};

std::string text_in(const TomlTable& table, std::string_view key) {
  const TomlEntry* entry = find_entry(table, key);
  const auto* text = entry == nullptr ? nullptr : std::get_if<std::string>(&entry->node.value);
  return text == nullptr ? std::string() : *text;
}

// Converts relative file names of a table from the included file's folder to the scene's folder.
void move_files(TomlNode& node, const fs::path& folder) {
  if (auto* items = std::get_if<TomlArray>(&node.value)) {
    for (TomlNode& item : *items) move_files(item, folder);
  }
  auto* table = std::get_if<TomlTable>(&node.value);
  if (table == nullptr) return;
  for (TomlEntry& entry : *table) {
    auto* text = std::get_if<std::string>(&entry.node.value);
    const bool names_file =
        std::find(std::begin(file_keys), std::end(file_keys), entry.key) != std::end(file_keys) ||
        (entry.key == "attitude" && text != nullptr && text->find('.') != std::string::npos);
    if (text != nullptr && names_file) *text = (folder / *text).lexically_normal().string();
    move_files(entry.node, folder);
  }
}

// Adds entries to a list, except for names that it has.
void add_entries(TomlArray& own, TomlArray included, bool in_front) {
  std::erase_if(included, [&](const TomlNode& node) {
    const auto* table = std::get_if<TomlTable>(&node.value);
    const std::string name = table == nullptr ? std::string() : text_in(*table, "name");
    return !name.empty() && std::any_of(own.begin(), own.end(), [&](const TomlNode& other) {
      const auto* mine = std::get_if<TomlTable>(&other.value);
      return mine != nullptr && text_in(*mine, "name") == name;
    });
  });
  own.insert(in_front ? own.begin() : own.end(), std::make_move_iterator(included.begin()),
             std::make_move_iterator(included.end()));
}

class Includer {
 public:
  Includer(const fs::path& scene, std::string unit, std::vector<fs::path>& files)
      : folder_(scene.parent_path()), unit_(std::move(unit)), files_(files) {
    open_.push_back(scene.lexically_normal());
  }

  // `file`: of the tree, relative to the working directory.
  void add(TomlNode& tree, const fs::path& file) {
    auto& root = std::get<TomlTable>(tree.value);
    const TomlEntry* entry = find_entry(root, "include");
    if (entry == nullptr) return;
    const TomlEntry asked = *entry;
    std::erase_if(root, [](const TomlEntry& one) { return one.key == "include"; });
    const auto* items = std::get_if<TomlArray>(&asked.node.value);
    if (items == nullptr) refuse(asked.where, "\"include\" is " + describe(asked.node));
    // A later file replaces entries of an earlier one.
    TomlTable included;
    for (auto item = items->rbegin(); item != items->rend(); ++item) {
      const auto* name = std::get_if<std::string>(&item->value);
      if (name == nullptr || name->empty()) {
        refuse(item->where, "\"include\" holds " + describe(*item));
      }
      merge(included, read(file.parent_path() / *name, item->where), true);
    }
    // The own entries come first: the first camera is the scene's.
    merge(root, std::move(included), false);
  }

 private:
  [[noreturn]] static void refuse(const base::Location& where, const std::string& found) {
    throw Error(Blame::Input, where, found, "allowed is a list of files",
                "Write for instance include = [\"../materials/spacecraft.toml\"]");
  }

  TomlTable read(const fs::path& named, const base::Location& asked_at) {
    const fs::path path = named.lexically_normal();
    if (std::find(open_.begin(), open_.end(), path) != open_.end() || open_.size() > most_nested) {
      throw Error(Blame::Input, asked_at, fmt::format("{} includes itself", path.string()),
                  fmt::format("files may include others, {} deep", most_nested));
    }
    base::check_input_file(path, asked_at);
    files_.push_back(path);
    TomlNode tree = read_toml(path);
    check_unit(std::get<TomlTable>(tree.value), path);
    fs::path away = path.parent_path().lexically_relative(
        folder_.empty() ? fs::path(".") : folder_.lexically_normal());
    if (away.empty()) away = path.parent_path();  // one is absolute, the other one is not
    open_.push_back(path);
    add(tree, path);
    open_.pop_back();
    // File names of nested includes are already relative to the scene; those tables are not moved
    // again.
    TomlTable table = std::get<TomlTable>(std::move(tree.value));
    for (TomlEntry& entry : table) {
      if (entry.where.file == path.string()) move_own(entry.node, path, away);
    }
    return table;
  }

  // Some list entries may come from a nested include.
  static void move_own(TomlNode& node, const fs::path& path, const fs::path& away) {
    if (auto* items = std::get_if<TomlArray>(&node.value)) {
      for (TomlNode& item : *items) {
        if (item.where.file == path.string()) move_files(item, away);
      }
      return;
    }
    move_files(node, away);
  }

  void check_unit(const TomlTable& root, const fs::path& path) const {
    const TomlEntry* unit = find_entry(root, "unit");
    const bool has_lengths = std::any_of(root.begin(), root.end(), [](const TomlEntry& entry) {
      return entry.key == "object" || entry.key == "light" || entry.key == "camera" ||
             entry.key == "joint" || entry.key == "track" || entry.key == "area";
    });
    if (unit == nullptr && !has_lengths) return;
    const std::string own = unit == nullptr ? "m" : text_in(root, "unit");
    if (own == unit_) return;
    throw Error(
        Blame::Input, unit == nullptr ? base::Location{path.string()} : unit->where,
        fmt::format("its unit is {}, that of the scene {}", in_quotes(own), in_quotes(unit_)),
        "a scene and its included files have one unit");
  }

  static void merge(TomlTable& root, TomlTable included, bool in_front) {
    for (TomlEntry& entry : included) {
      if (std::find(std::begin(of_scene_alone), std::end(of_scene_alone), entry.key) !=
          std::end(of_scene_alone)) {
        continue;
      }
      TomlEntry* own = find_entry(root, entry.key);
      if (own == nullptr) {
        root.push_back(std::move(entry));
        continue;
      }
      auto* mine = std::get_if<TomlArray>(&own->node.value);
      auto* theirs = std::get_if<TomlArray>(&entry.node.value);
      if (mine != nullptr && theirs != nullptr) add_entries(*mine, std::move(*theirs), in_front);
    }
  }

  fs::path folder_;
  std::string unit_;
  std::vector<fs::path>& files_;
  std::vector<fs::path> open_;
};

}  // namespace

void add_includes(TomlNode& tree, const fs::path& scene, std::vector<fs::path>& files) {
  const std::string unit = text_in(std::get<TomlTable>(tree.value), "unit");
  Includer(scene, unit.empty() ? "m" : unit, files).add(tree, scene);
}

}  // namespace earthshine::scenes
