// SPDX-License-Identifier: Apache-2.0
// earthshine relight: changes lamp settings in a picture with a layer per light group.
#include "app/tools/relight.h"

#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/provenance.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "scenes/text/table_reader.h"
#include "studies/relight.h"

namespace earthshine::app {
namespace {

struct RelightCall {
  std::string input, output, png;
  std::vector<std::string> settings;  // GROUP=FACTOR or GROUP=R,G,B
  bool json = false;
};

[[noreturn]] void refuse_setting(const std::string& setting) {
  throw base::Error(base::Blame::Input, "--set",
                    fmt::format("\"{}\" is not a group and its factor", setting),
                    "factors are from 0 to 1e+15, one or three (R,G,B)",
                    "Write GROUP=FACTOR, for instance bay-lamps=0.5");
}

double factor_of(const std::string& text, const std::string& setting) {
  std::size_t read = 0;
  double factor = -1.0;
  try {
    factor = std::stod(text, &read);
  } catch (const std::exception&) {
    refuse_setting(setting);
  }
  if (read != text.size() || !(factor >= 0.0 && factor <= scenes::light_strength.high)) {
    refuse_setting(setting);
  }
  return factor;
}

std::map<std::string, Rgb> factors_of(const std::vector<std::string>& settings) {
  std::map<std::string, Rgb> factors;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.rfind('=');
    if (equals == std::string::npos || equals == 0) refuse_setting(setting);
    const std::vector<std::string> words = split_at_commas(setting.substr(equals + 1));
    if (words.size() != 1 && words.size() != 3) refuse_setting(setting);
    Rgb factor(0.0);
    for (int c = 0; c < 3; ++c) {
      factor[c] = factor_of(words[words.size() == 3 ? static_cast<std::size_t>(c) : 0], setting);
    }
    const std::string group = setting.substr(0, equals);
    if (!factors.emplace(group, factor).second) {
      throw base::Error(base::Blame::Input, "--set",
                        fmt::format("names the group \"{}\" twice", group), {},
                        "Give it one factor");
    }
  }
  return factors;
}

std::vector<std::string> object_names(const base::ExrHeader& header) {
  for (const auto& [name, value] : header.text) {
    if (name != "earthshine:objects") continue;
    const Json names = Json::parse(value, nullptr, false);
    if (names.is_array()) {
      try {
        return names.get<std::vector<std::string>>();
      } catch (const Json::exception&) {
        break;  // of another program
      }
    }
  }
  return {};
}

Json report_of(const base::Image& image, const base::ExrHeader& header,
               const std::map<std::string, Rgb>& factors) {
  Json report = {{"columns", image.width}, {"rows", image.height}, {"groups", Json::array()}};
  for (const std::string& group : studies::lit_groups(image)) {
    const auto found = factors.find(group);
    const Rgb factor = found == factors.end() ? Rgb(1.0) : found->second;
    report["groups"].push_back({{"name", group}, {"factor", {factor.r, factor.g, factor.b}}});
  }
  const std::vector<std::string> names = object_names(header);
  report["objects"] = Json::array();
  for (const auto& [number, light] : studies::light_of_objects(image)) {
    const auto k = static_cast<std::size_t>(number);
    report["objects"].push_back({{"name", k < names.size() ? names[k] : std::to_string(number)},
                                 {"pixels", light.pixels},
                                 {"luminance", light.luminance},
                                 {"by_group", light.by_group}});
  }
  return report;
}

}  // namespace

void relight(base::ExrFile& file, const std::vector<std::string>& settings,
             const std::string& source) {
  const std::map<std::string, Rgb> factors = factors_of(settings);
  studies::relight(file.image, factors, source);
  // The stated error is valid for the original lights only.
  std::erase_if(file.header.numbers, [&](const auto& one) {
    return !factors.empty() && one.first.starts_with("earthshine:error.");
  });
  std::string said;
  for (const std::string& setting : settings) said += (said.empty() ? "" : " ") + setting;
  if (!said.empty()) file.header.text.emplace_back("earthshine:relight", said);
}

namespace {

void run(const RelightCall& call, const Common& common) {
  if (call.output.empty() && call.png.empty()) {
    throw base::Error(base::Blame::Input, "relight", "-o is missing", {},
                      "Name a file to write: -o OUT.exr, or --png OUT.png");
  }
  const std::map<std::string, Rgb> factors = factors_of(call.settings);
  check_outputs({call.output, call.png}, {call.input});
  refuse_other_kind("-o", call.output, {".exr"});
  refuse_other_kind("--png", call.png, {".png"});
  base::ExrFile file = base::read_exr(call.input);
  relight(file, call.settings, call.input);
  if (!call.output.empty()) base::write_exr(call.output, file.image, file.header);
  if (!call.png.empty()) {
    const base::ToneMapped tone = base::tone_map(file.image);
    base::write_png(call.png, file.image.width, file.image.height, 3, tone.rgb,
                    partial_mark(file.header));
  }
  if (call.json) {
    print(dump(report_of(file.image, file.header, factors)));
  } else if (!common.quiet) {
    note(fmt::format("{} light groups", studies::lit_groups(file.image).size()));
  }
}

}  // namespace

Command add_relight(CLI::App& program) {
  CLI::App* parser = add_subcommand(
      program, "relight", "Other lamp settings of a picture with a layer per light group, at once");
  const auto call = std::make_shared<RelightCall>();
  parser->add_option("FRAME", call->input, "EXR file that render --per-light wrote")
      ->required()
      ->type_name("");
  parser
      ->add_option("--set", call->settings,
                   "Times the light of a group; GROUP=R,G,B by colour; may be repeated")
      ->type_name("GROUP=FACTOR");
  parser->add_option("-o,--output", call->output, "EXR file to write")->type_name("OUT.exr");
  parser->add_option("--png", call->png, "Tone-mapped PNG to write")->type_name("OUT.png");
  parser->add_flag("--json", call->json,
                   "JSON on standard output: objects and their light by group");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
