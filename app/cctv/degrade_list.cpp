// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/degrade_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cctv/cctv.h"
#include "app/console.h"
#include "base/error.h"
#include "degrade/chain.h"
#include "degrade/parts/noise_forms.h"
#include "degrade/settings/presets.h"
#include "degrade/stage/read_setting.h"
#include "scenes/read/scene_file.h"

namespace earthshine::app {
namespace {

using degrade::SettingSource;

struct Row {
  std::string key, unit, source;
  Json value;
};

// Settings in use have a source.
class Rows {
 public:
  explicit Rows(const std::vector<SettingSource>& sources) : sources_(sources) {}

  template <class Value>
  void operator()(const char* key, const Value& value, degrade::Limits, const char* unit,
                  const char*) {
    for (const SettingSource& known : sources_) {
      if (known.key == key) rows_.push_back({key, unit, known.source, setting_json(value)});
    }
  }
  [[nodiscard]] std::vector<Row> take() { return std::move(rows_); }

 private:
  const std::vector<SettingSource>& sources_;
  std::vector<Row> rows_;
};

std::vector<Row> camera_rows(const degrade::ResolvedCamera& camera) {
  Rows rows(camera.sources);
  degrade::visit_camera_fields(camera.camera, rows);
  return rows.take();
}

std::vector<Row> monitor_rows(const degrade::ResolvedCamera& camera) {
  Rows rows(camera.monitor_sources);
  degrade::visit_monitor_fields(camera.monitor, rows);
  return rows.take();
}

Json rows_json(const std::vector<Row>& rows) {
  Json settings = Json::object(), units = Json::object(), sources = Json::object();
  for (const Row& row : rows) {
    settings[row.key] = row.value;
    if (!row.unit.empty()) units[row.key] = row.unit;
    sources[row.key] = row.source;
  }
  return {{"settings", settings}, {"units", units}, {"sources", sources}};
}

std::string value_text(const Json& value) {
  return value.is_number_float() ? degrade::number(value.get<double>())
         : value.is_string()     ? value.get<std::string>()
                                 : value.dump();
}

std::string rows_text(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    const std::string unit = row.unit == "1" ? "" : row.unit;
    text +=
        fmt::format("  {:<21} {:>9} {:<7} {}\n", row.key, value_text(row.value), unit, row.source);
  }
  return text;
}

Json noise_json(const degrade::CctvCamera& camera) {
  const degrade::NoiseWords words = degrade::noise_words(camera);
  Json forms = Json::array();
  for (const degrade::NoiseForm& form : degrade::other_forms(camera)) {
    Json settings = {{"noise", degrade::word_of(form.mode)}};
    for (const auto& [key, value] : form.settings) settings[key] = value;
    forms.push_back(
        {{"settings", settings}, {"exact", form.differs.empty()}, {"differs", form.differs}});
  }
  return {{"a", words.a},
          {"b", words.b},
          {"c", words.c},
          {"snr_db_at_white", words.snr_white_db},
          {"snr_db_at_50_percent", words.snr_half_db},
          {"snr_db_at_5_percent", words.snr_dark_db},
          {"white_over_black_noise_db", words.floor_db},
          {"percent_at_white", words.percent_at_white},
          {"percent_of_signal", words.percent_of_signal},
          {"equivalent_electrons_at_white", words.electrons_at_white},
          {"equivalent_read_electrons", words.read_electrons},
          {"line_sigma_at_white", words.line_sigma_white},
          {"line_snr_db_at_white", words.line_snr_white_db},
          {"gamma_db", words.gamma_db},
          {"other_forms", forms}};
}

std::string noise_text(const degrade::CctvCamera& camera) {
  const degrade::NoiseWords w = degrade::noise_words(camera);
  std::string text =
      "noise of the linear signal, of one resel before the blur: sigma^2(S) = a + b S + c S^2\n";
  if (w.percent_at_white == 0.0) return text + "  none\n";
  text += fmt::format("  a = {:.6g}, b = {:.6g}, c = {:.6g}\n", w.a, w.b, w.c);
  text += fmt::format("  SNR {:.2f} dB at white, {:.2f} dB at 50 %, {:.2f} dB at 5 % of white\n",
                      w.snr_white_db, w.snr_half_db, w.snr_dark_db);
  if (w.a > 0.0) text += fmt::format("  white over the noise of black {:.2f} dB\n", w.floor_db);
  text += fmt::format("  {:.4g} % at white", w.percent_at_white);
  if (w.c > 0.0)
    text += fmt::format("; the part that grows with the signal {:.4g} %", w.percent_of_signal);
  if (w.b > 0.0) {
    text +=
        fmt::format("\n  as {:.6g} electrons at white and {:.4g} of the amplifier would make it",
                    w.electrons_at_white, w.read_electrons);
  }
  text += fmt::format(
      "\n  on the line, after v = S^(1/{:.4g}): sigma {:.4g} and SNR {:.2f} dB at white;"
      " {:+.2f} dB at every level\n",
      camera.gamma, w.line_sigma_white, w.line_snr_white_db, w.gamma_db);
  text += "the same noise in other forms of a [[cctv]]\n";
  for (const degrade::NoiseForm& form : degrade::other_forms(camera)) {
    text += fmt::format("  noise = \"{}\"", degrade::word_of(form.mode));
    for (const auto& [key, value] : form.settings) text += fmt::format(", {} = {:.6g}", key, value);
    text += form.differs.empty() ? "\n" : fmt::format(" ({})\n", form.differs);
  }
  return text;
}

using base::Blame;
using base::Error;
using degrade::did_you_mean;
using degrade::in_quotes;
using degrade::listed;

constexpr std::string_view suffix = ".toml";

struct Argument {
  std::string file;  // "": a built-in camera
  std::string name;  // "": the only one in the file
};

Argument split(const std::string& argument) {
  if (const std::size_t at = argument.find(std::string(suffix) + ":"); at != std::string::npos) {
    const std::size_t end = at + suffix.size();
    return {argument.substr(0, end), argument.substr(end + 1)};
  }
  if (argument.ends_with(suffix)) return {argument, {}};
  return {{}, argument};
}

degrade::ResolvedCamera of_preset(std::string_view option, const std::string& name) {
  if (const degrade::Preset* preset = degrade::find_preset(name)) return degrade::resolve(*preset);
  const std::vector<std::string> names = degrade::preset_names();
  throw Error(Blame::Input, option, "there is no camera " + in_quotes(name),
              "it is " + listed(names) + ", FILE.toml or FILE.toml:NAME",
              did_you_mean(name, names));
}

}  // namespace

void refuse_beside(const std::string& asked, const CLI::App& degrade,
                   std::vector<std::string> own) {
  own.insert(own.end(), {"--threads", "--seed", "--max-memory", "--quiet"});
  std::vector<std::string> others;
  for (const CLI::Option* option : degrade.get_options()) {
    if (option->count() == 0 || std::ranges::find(own, option->get_name()) != own.end()) continue;
    others.push_back(option->get_name());
  }
  if (others.empty()) return;
  throw Error(Blame::Input, "degrade",
              fmt::format("{} makes no picture and takes no {}", asked, fmt::join(others, ", ")),
              {}, "Leave out the one or the other");
}

Json camera_json(const degrade::ResolvedCamera& camera) {
  Json json = {{"name", camera.name}, {"about", camera.about}};
  json.update(rows_json(camera_rows(camera)));
  json["noise"] = noise_json(camera.camera);
  json["monitor"] = rows_json(monitor_rows(camera));
  return json;
}

std::string describe_camera(const degrade::ResolvedCamera& camera) {
  return fmt::format("{}{}{}\n{}\n{}\nmonitor\n{}", camera.name, camera.about.empty() ? "" : ": ",
                     camera.about, rows_text(camera_rows(camera)), noise_text(camera.camera),
                     rows_text(monitor_rows(camera)));
}

void list_cameras(bool as_json) {
  Json cameras = Json::array(), stages = Json::array();
  std::string text = "presets (--describe NAME shows all settings with their sources)\n";
  for (const degrade::Preset& preset : degrade::presets()) {
    cameras.push_back(camera_json(degrade::resolve(preset)));
    text += fmt::format("  {:<18} {}\n  {:<18} {}\n", preset.name, preset.about, "",
                        degrade::describe_noise(preset.camera));
  }
  text += "\nstages, in order\n";
  for (const degrade::Stage& stage : degrade::stages()) {
    stages.push_back({{"name", stage.name},
                      {"part", stage.part == degrade::Part::Monitor ? "monitor" : "camera"},
                      {"in", stage.in},
                      {"out", stage.out},
                      {"law", stage.formula}});
    text += fmt::format("  {:<18} {}\n", stage.name, stage.formula);
  }
  print(as_json ? dump({{"presets", cameras}, {"stages", stages}}) : text);
}

void print_camera(const degrade::ResolvedCamera& camera, bool as_json) {
  print(as_json ? dump(camera_json(camera)) : describe_camera(camera));
}

degrade::ResolvedCamera camera_of_argument(std::string_view option, const std::string& argument) {
  const auto [file, name] = split(argument);
  if (file.empty()) return of_preset(option, name);
  const scenes::Scene scene = scenes::read_camera_file(file);
  degrade::check_settings(scene);
  std::vector<std::string> names;
  for (const scenes::SettingTable& table : scene.cctv) names.push_back(table.name);
  if (names.empty()) {
    throw Error(Blame::Input, file, "has no [[cctv]]", {},
                "Add [[cctv]] with name = \"...\" or take a camera that ships");
  }
  if (name.empty() && names.size() == 1 && argument == file) {
    return degrade::resolve(scene, names.front());
  }
  for (const std::string& known : names) {
    if (known == name) return degrade::resolve(scene, name);
  }
  if (argument == file) {
    throw Error(Blame::Input, option,
                in_quotes(file) + " has " + std::to_string(names.size()) + " cameras",
                "they are " + listed(names), "Name one: " + file + ":" + names.front());
  }
  throw Error(Blame::Input, option, in_quotes(file) + " has no camera " + in_quotes(name),
              "it has " + listed(names), did_you_mean(name, names));
}

std::string file_of_camera(const std::string& argument) { return split(argument).file; }

}  // namespace earthshine::app
