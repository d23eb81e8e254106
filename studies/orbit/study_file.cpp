// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenes/read/mission.h"
#include "scenes/read/scene_parts.h"
#include "scenes/text/toml_file.h"

namespace earthshine::studies {
namespace {

using base::Blame;
using base::Error;
using scenes::TableReader;
using scenes::TomlArray;
using scenes::TomlEntry;
using scenes::TomlNode;
using scenes::TomlTable;

constexpr std::string_view root_keys[] = {
    "format", "name",    "scenes",        "scene", "set",         "cameras", "targets",
    "size",   "wanted",  "iris",          "orbit", "lamps",       "picture", "pair",
    "cctv",   "monitor", "camera_models", "seen",  "earth_cells", "time"};
constexpr std::string_view orbit_keys[] = {"positions", "positions_deg"};
constexpr std::string_view lamps_keys[] = {"name", "set", "others"};
constexpr std::string_view others_words[] = {"as-they-are", "off"};
constexpr std::string_view iris_words[] = {"fixed", "peak", "normal", "average"};
constexpr std::string_view picture_keys[] = {"name",  "title", "camera", "position_deg", "time",
                                             "lamps", "shows", "lights", "cctv"};
constexpr std::string_view shows_words[] = {"clean", "cctv", "distributed", "distributed-cctv"};
constexpr std::string_view pair_keys[] = {"title", "left", "right"};
constexpr int most_side = 16384;

std::vector<std::string> texts(const TableReader& table, std::string_view key) {
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr) return {};
  const auto* items = std::get_if<TomlArray>(&entry->node.value);
  std::vector<std::string> list;
  for (std::size_t k = 0; items != nullptr && k < items->size(); ++k) {
    const auto* text = std::get_if<std::string>(&(*items)[k].value);
    if (text == nullptr || text->empty()) {
      table.fail(key, "holds " + scenes::describe((*items)[k]), "allowed is a list of strings");
    }
    if (std::find(list.begin(), list.end(), *text) != list.end()) {
      table.fail(key, fmt::format("holds \"{}\" twice", *text), {}, "Name it once");
    }
    list.push_back(*text);
  }
  if (list.empty()) {
    table.fail(key, "is " + scenes::describe(entry->node),
               "allowed is a list of strings with one or more",
               key == "scenes" ? "Name a scene file" : "Leave the key out");
  }
  return list;
}

void read_size(StudyFile& study, const TableReader& root) {
  const std::optional<std::string> size = root.text("size");
  if (!size) return;
  int columns = 0, rows = 0;
  const char* const end = size->data() + size->size();
  const auto first = std::from_chars(size->data(), end, columns);
  const bool has_x = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = has_x ? std::from_chars(first.ptr + 1, end, rows) : first;
  const bool whole = has_x && second.ec == std::errc() && second.ptr == end;
  if (!whole || columns < 1 || rows < 1 || columns > most_side || rows > most_side) {
    root.fail("size", fmt::format("is \"{}\"", *size),
              fmt::format("allowed is \"COLUMNSxROWS\", each from 1 to {}", most_side),
              "Write for instance size = \"512x512\"");
  }
  study.columns = columns;
  study.rows = rows;
}

void read_positions(StudyFile& study, const TableReader& root) {
  const TomlEntry* entry = root.find("orbit");
  if (const TomlEntry* time = root.find("time")) {
    if (entry != nullptr) {
      root.fail("time", "cannot be combined with [orbit]",
                "a study goes along time or along positions");
    }
    study.time = scenes::read_time(time->node);
  }
  if (entry == nullptr) return;
  const TableReader orbit(entry->node, "[orbit]", orbit_keys);
  const std::optional<int> count = orbit.whole("positions", 1, most_positions);
  const TomlEntry* list = orbit.find("positions_deg");
  if (count.has_value() == (list != nullptr)) {
    orbit.fail(count ? "positions_deg" : "positions",
               count ? "cannot be combined with \"positions\"" : "is missing",
               "allowed is either positions = 36 or positions_deg = [0, 90]");
  }
  if (count) {
    study.positions_deg = even_positions(*count);
    study.timeline = *count > 1;
    return;
  }
  const auto* items = std::get_if<TomlArray>(&list->node.value);
  for (std::size_t k = 0; items != nullptr && k < items->size(); ++k) {
    const TomlNode& item = (*items)[k];
    const auto* whole = std::get_if<std::int64_t>(&item.value);
    const auto* real = std::get_if<double>(&item.value);
    const double value = whole != nullptr  ? static_cast<double>(*whole)
                         : real != nullptr ? *real
                                           : std::nan("");
    if (!(std::abs(value) <= 360.0)) {
      orbit.fail("positions_deg", "holds " + scenes::describe(item),
                 "allowed are numbers from -360 to 360");
    }
    if (stands_among(study.positions_deg, value)) {
      orbit.fail("positions_deg", fmt::format("holds the place of {:g} twice", value), {},
                 "Name it once");
    }
    study.positions_deg.push_back(value);
  }
  if (study.positions_deg.empty() ||
      study.positions_deg.size() > static_cast<std::size_t>(most_positions)) {
    orbit.fail("positions_deg", "is " + scenes::describe(list->node),
               fmt::format("allowed is a list of 1 to {} numbers", most_positions));
  }
  std::sort(study.positions_deg.begin(), study.positions_deg.end());
}

LampSetting read_lamps(const TomlNode& node) {
  TableReader table(node, "[[lamps]]", lamps_keys);
  LampSetting setting;
  setting.name = table.read_name();
  setting.where = table.where();
  setting.others_off = table.choice("others", others_words).value_or("as-they-are") == "off";
  const TomlEntry* set = table.find("set");
  if (set == nullptr) return setting;
  const auto* factors = std::get_if<TomlTable>(&set->node.value);
  if (factors == nullptr) {
    table.fail("set", "is " + scenes::describe(set->node),
               "allowed is a table of factors by lamp or light group",
               "Write for instance set = { bay-lamps = 0.5 }");
  }
  std::vector<std::string_view> keys;
  for (const TomlEntry& entry : *factors) keys.push_back(entry.key);
  const TableReader reader(set->node, table.label(), keys);
  for (const TomlEntry& entry : *factors) {
    setting.factors[entry.key] = *reader.colour(entry.key);
  }
  return setting;
}

PictureWish read_picture(const TomlNode& node, std::vector<std::string>& warnings) {
  TableReader table(node, "[[picture]]", picture_keys);
  PictureWish wish;
  wish.where = table.where();
  wish.name = table.read_name();
  wish.title = table.text("title").value_or(wish.name);
  wish.camera = table.required(table.text("camera"), "camera", "camera = \"B\"");
  wish.position_deg = table.number("position_deg", {-360.0, 360.0});
  wish.time = scenes::read_moment(table, "time");
  if (wish.time && wish.position_deg) {
    table.fail("time", "cannot be combined with \"position_deg\"",
               "a picture is at one of the two");
  }
  wish.lamps = table.text("lamps").value_or("");
  const std::string shows = table.choice("shows", shows_words).value_or("clean");
  const auto* found = std::find(std::begin(shows_words), std::end(shows_words), shows);
  wish.shows = static_cast<Shows>(found - std::begin(shows_words));
  wish.lights = table.whole("lights", 2, 65536).value_or(wish.lights);
  wish.cctv = table.text("cctv").value_or("");
  const bool spreads = wish.shows == Shows::Distributed || wish.shows == Shows::DistributedCctv;
  const bool films = wish.shows == Shows::Cctv || wish.shows == Shows::DistributedCctv;
  for (const auto& [key, used] : {std::pair{"lights", spreads}, {"cctv", films}}) {
    if (used || !table.has(key)) continue;
    warnings.push_back(fmt::format("{}: \"{}\" in {} has no effect: it shows \"{}\"",
                                   base::to_string(table.where(key)), key, table.label(), shows));
  }
  return wish;
}

void read_pictures(StudyFile& study, const TableReader& root) {
  const auto entries = scenes::named_entries(root, "picture");
  std::vector<std::string> names;
  for (const TomlNode* entry : entries) {
    study.pictures.push_back(read_picture(*entry, study.warnings));
    names.push_back(study.pictures.back().name);
  }
  scenes::check_unique(names, entries, "[[picture]]");
  for (const TomlNode* entry : scenes::named_entries(root, "pair")) {
    const TableReader table(*entry, "[[pair]]", pair_keys);
    PairWish pair;
    for (const auto& [key, text] :
         {std::pair{"title", &pair.title}, {"left", &pair.left}, {"right", &pair.right}}) {
      *text = table.required(table.text(key), key, fmt::format("{} = \"...\"", key));
    }
    for (const auto& [key, name] : {std::pair{"left", pair.left}, {"right", pair.right}}) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        table.fail(key, fmt::format("names the picture \"{}\", which is not there", name),
                   "allowed are names of [[picture]] tables");
      }
    }
    study.pairs.push_back(std::move(pair));
  }
}

void read_cameras(StudyFile& study, const TableReader& root) {
  study.cameras = texts(root, "cameras");
  study.targets = texts(root, "targets");
  study.iris = texts(root, "iris");
  for (const std::string& mode : study.iris) {
    if (std::find(std::begin(iris_words), std::end(iris_words), mode) == std::end(iris_words)) {
      root.fail("iris", fmt::format("holds \"{}\"", mode),
                "allowed are \"fixed\", \"peak\", \"normal\" and \"average\"");
    }
  }
  for (const TomlNode* entry : scenes::named_entries(root, "cctv")) {
    study.cctv.cctv.push_back(scenes::read_settings(*entry, "[[cctv]]", true));
  }
  if (const TomlEntry* entry = root.find("monitor")) {
    study.cctv.monitor = scenes::read_settings(entry->node, "[monitor]", false);
  }
  if (const TomlEntry* entry = root.find("camera_models")) {
    const auto* models = std::get_if<TomlTable>(&entry->node.value);
    if (models == nullptr) {
      root.fail("camera_models", "is " + scenes::describe(entry->node),
                "allowed is a table of CCTV cameras by camera",
                "Write for instance camera_models = { A = \"ccd-colour\" }");
    }
    for (const TomlEntry& model : *models) {
      const auto* name = std::get_if<std::string>(&model.node.value);
      if (name == nullptr) {
        root.fail("camera_models",
                  fmt::format("has {} for \"{}\"", scenes::describe(model.node), model.key),
                  "allowed is the name of a [[cctv]] table or of a camera that ships");
      }
      study.camera_models[model.key] = *name;
    }
  }
}

// A scene file has other tables, and no `scene` key.
void refuse_scene(const TomlTable& root) {
  if (find_entry(root, "scene") != nullptr || find_entry(root, "scenes") != nullptr) return;
  for (const char* key : {"object", "material", "camera", "light"}) {
    const TomlEntry* const entry = find_entry(root, key);
    if (entry == nullptr) continue;
    throw Error(Blame::Input, entry->where, fmt::format("[[{}]] makes this a scene file", key),
                "a study file is wanted here, which names its scene",
                "Give it to earthshine study visibility or study orbit, or write a study file with "
                "scene = \"FILE.toml\"");
  }
}

}  // namespace

StudyFile read_study_file(const std::filesystem::path& path) {
  const TomlNode tree = scenes::read_toml(path);
  refuse_scene(std::get<TomlTable>(tree.value));
  const TableReader root(tree, "the study", root_keys);
  scenes::check_format(root);
  StudyFile study;
  study.path = path;
  for (const TomlEntry& entry : std::get<TomlTable>(tree.value)) {
    study.where[entry.key] = entry.where;
  }
  study.name = root.text("name").value_or(path.stem().string());
  const std::optional<std::string> scene = root.text("scene");
  if (scene && root.has("scenes")) {
    root.fail("scenes", "cannot be combined with \"scene\"", {}, "Keep one of them");
  }
  const std::vector<std::string> scenes = scene ? std::vector{*scene} : texts(root, "scenes");
  if (scenes.empty()) root.missing("scene", "scene = \"bay.toml\"");
  for (const std::string& file : scenes) study.scenes.push_back(path.parent_path() / file);
  study.overrides = texts(root, "set");
  read_cameras(study, root);
  read_size(study, root);
  read_positions(study, root);
  const auto lamps = scenes::named_entries(root, "lamps");
  std::vector<std::string> names;
  for (const TomlNode* node : lamps) {
    study.lamps.push_back(read_lamps(*node));
    names.push_back(study.lamps.back().name);
  }
  scenes::check_unique(names, lamps, "[[lamps]]");
  if (study.lamps.empty()) study.lamps.push_back(lamps_as_they_are());
  for (const std::string& wanted : texts(root, "wanted")) {
    study.wanted.push_back(read_wanted(wanted, root.where("wanted")));
  }
  study.seen_probability =
      root.number("seen", {0.0, 1.0, true, true}).value_or(study.seen_probability);
  if (const auto cells = root.whole("earth_cells", 2, 4096)) {
    study.basis.disc_cells = study.basis.sphere_cells = static_cast<std::size_t>(*cells);
  }
  read_pictures(study, root);
  return study;
}

}  // namespace earthshine::studies
