// SPDX-License-Identifier: Apache-2.0
#include "app/help.h"

#include <array>
#include <string_view>
#include <vector>

namespace earthshine::app {
namespace {

constexpr std::size_t width = 80, column = 26;

// In the order of the help; an option that is in none of them comes under "Options".
struct Group {
  std::string_view title;
  std::vector<std::string_view> options;
};
const std::array<Group, 7>& groups() {
  static const std::array<Group, 7> all = {
      {{"What is read", {"set", "scene", "solution", "preset", "fields", "frame", "frames"}},
       {"What is looked at",
        {"camera", "size", "crop", "only-pixel", "over", "over-style", "over-alpha", "positions",
         "at", "wanted", "iris", "lights", "probe", "cctv", "f-number", "fov"}},
       {"How exactly",
        {"error", "no-error", "time-limit", "indirect", "no-caustics", "distributed-lights",
         "distributed-over", "all-effects", "paths", "noise", "raw", "reference-factor", "method",
         "off"}},
       {"In parts, on many machines", {"part", "wait", "ranks"}},
       {"Options", {}},
       {"What is written",
        {"output", "png", "range", "report", "aov", "per-light", "timings", "json", "csv", "glb",
         "twin", "target-resels", "stages", "list", "describe", "plain", "dry-run", "exposure",
         "curve"}},
       {"As with every command", {"threads", "seed", "max-memory", "quiet", "help", "version"}}}};
  return all;
}

// An option that means one thing here and another there says its group itself.
std::string group_of(const CLI::Option& option) {
  if (option.get_group() != "Options") return option.get_group();
  for (const Group& group : groups()) {
    for (const std::string_view name : group.options) {
      if (option.check_lname(std::string(name))) return std::string(group.title);
    }
  }
  return "Options";
}

// The text from `at` on in lines of `width`, all but the first indented to there.
std::string wrapped(std::string_view text, std::size_t at) {
  std::string out;
  std::size_t used = at;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (used > at && used + 1 + word.size() > width) {
      out += "\n" + std::string(at, ' ');
      used = at;
    }
    if (used > at) {
      out += ' ';
      ++used;
    }
    out += word;
    used += word.size();
  }
  return out;
}

// "  --size CxR              Columns and rows"
std::string entry(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  line += line.size() + 2 <= column ? std::string(column - line.size(), ' ')
                                    : "\n" + std::string(column, ' ');
  return line + wrapped(text, column) + "\n";
}

}  // namespace

std::string words_to(const CLI::App& parser) {
  if (parser.get_parent() == nullptr) return "";
  return words_to(*parser.get_parent()) + parser.get_name() + " ";
}

std::string Help::make_help(const CLI::App* parser, std::string, CLI::AppFormatMode) const {
  std::string usage = "Usage: earthshine " + words_to(*parser) + "[OPTIONS]", arguments, commands;
  for (const CLI::Option* option : parser->get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true);
    usage += option->get_required() ? " " + name : " [" + name + "]";
    if (option->get_expected_max() > 1) usage += " ...";
    arguments += entry(name, option->get_description());
  }
  for (const CLI::App* command : parser->get_subcommands({})) {
    commands += entry(command->get_name(), command->get_description());
  }
  if (!commands.empty()) usage += arguments.empty() ? " COMMAND" : " [COMMAND]";
  std::string text = wrapped(parser->get_description(), 0) + "\n" + wrapped(usage, 0) + "\n";
  if (!arguments.empty()) text += "\nArguments:\n" + arguments;
  for (const Group& group : groups()) {
    std::string inside;
    for (const CLI::Option* option : parser->get_options()) {
      if (!option->nonpositional() || group_of(*option) != group.title) continue;
      std::string name = option->get_name(false, true);
      for (std::size_t at = name.find(','); at != std::string::npos; at = name.find(',', at + 2)) {
        name.insert(at + 1, " ");
      }
      if (!option->get_type_name().empty()) name += " " + option->get_type_name();
      inside += entry(name, option->get_description());
    }
    if (!inside.empty()) text += "\n" + std::string(group.title) + ":\n" + inside;
  }
  if (!commands.empty()) text += "\nCommands:\n" + commands;
  return text + "\n" +
         wrapped(
             "Exit codes: 0 done; 1 the work failed; 2 the call or a file is wrong; 3 done, but "
             "short of the error that the call asked for.",
             0) +
         "\n";
}

}  // namespace earthshine::app
