// SPDX-License-Identifier: Apache-2.0
#include "app/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/suggest.h"

namespace earthshine::app {
namespace {

constexpr std::size_t width = 80, column = 26;

// In the order of the help; other options appear under "Options".
struct Group {
  std::string_view title;
  std::vector<std::string_view> options;
};
const std::array<Group, 7>& groups() {
  static const std::array<Group, 7> all = {
      {{"Input", {"set", "scene", "solution", "preset", "fields", "frame", "frames"}},
       {"Camera",
        {"camera", "size", "crop", "only-pixel", "over", "over-style", "over-alpha", "positions",
         "at", "wanted", "iris", "lights", "probe", "cctv", "f-number", "fov"}},
       {"Accuracy",
        {"error", "no-error", "time-limit", "indirect", "no-caustics", "distributed-lights",
         "distributed-over", "all-effects", "paths", "noise", "raw", "reference-factor", "method",
         "off"}},
       {"Parallel runs", {"part", "wait", "ranks", "images"}},
       {"Options", {}},
       {"Output", {"output",  "png",    "range",    "report", "aov",     "per-light",
                   "timings", "json",   "csv",      "glb",    "twin",    "target-resels",
                   "stages",  "list",   "describe", "plain",  "dry-run", "exposure",
                   "curve",   "layers", "serve",    "port"}},
       {"General", {"threads", "seed", "max-memory", "quiet", "help", "version"}}}};
  return all;
}

// Options with several meanings set their group themselves.
std::string group_of(const CLI::Option& option) {
  if (option.get_group() != "Options") return option.get_group();
  for (const Group& group : groups()) {
    for (const std::string_view name : group.options) {
      if (option.check_lname(std::string(name))) return std::string(group.title);
    }
  }
  return "Options";
}

// The text from column `at` on in lines of `width`, later lines indented to this column.
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

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = base::nearest_word(word, known);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

std::vector<std::string> commands_of(const CLI::App& parser) {
  std::vector<std::string> names;
  for (const CLI::App* command : parser.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// An unknown word is the most likely cause of other errors, so it is reported first.
std::string unknown_word(const CLI::App& program) {
  const CLI::App& parser = chosen_parser(program);
  const std::vector<std::string> extras = parser.remaining(false);
  if (extras.empty()) return {};
  const std::string& word = extras.front();
  if (word.size() > 1 && word.front() == '-') {
    std::vector<std::string> known;
    for (const CLI::Option* option : parser.get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
    const std::string plain = word.substr(0, word.find('='));
    const std::string meant = did_you_mean(plain, known);
    return fmt::format(
        "unknown option \"{}\"{}", plain,
        meant.empty() ? fmt::format("; there are {}", fmt::join(known, ", ")) : meant);
  }
  const std::vector<std::string> known = commands_of(parser);
  const std::vector<const CLI::Option*> options = parser.get_options();
  const bool takes_files = std::any_of(options.begin(), options.end(),
                                       [](const CLI::Option* o) { return o->get_positional(); });
  if (known.empty() || takes_files) return fmt::format("unexpected argument \"{}\"", word);
  const std::string nearest = did_you_mean(word, known);
  const bool top = parser.get_parent() == nullptr;
  return fmt::format("unknown {} \"{}\"{} {}: {}", top ? "command" : parser.get_name(), word,
                     nearest.empty() ? "." : nearest, top ? "Commands" : "There are",
                     fmt::join(known, ", "));
}

// The library's error, with a remedy.
std::string found_by_parser(const CLI::App& parser, const CLI::ParseError& error) {
  const std::string what = error.what();
  if (what == "A subcommand is required") {
    const bool top = parser.get_parent() == nullptr;
    return fmt::format("no {} is named. {}: {}", top ? "command" : parser.get_name(),
                       top ? "Commands" : "There are", fmt::join(commands_of(parser), ", "));
  }
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) {
    return what + ". Leave one of the two out";
  }
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) {
    return what + ". Add it, or leave the first out";
  }
  if (const std::size_t at = what.find(": At Most 1 required"); at != std::string::npos) {
    return what.substr(0, at) + " is given more than once. Write it once";
  }
  return what;
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
             "Exit codes: 0 done; 1 the work failed; 2 the call or a file is wrong; 3 done in "
             "part: "
             "the wanted error was not reached, or a camera was skipped.",
             0) +
         "\n";
}

const CLI::App& chosen_parser(const CLI::App& program) {
  const CLI::App* parser = &program;
  while (!parser->get_subcommands().empty()) parser = parser->get_subcommands().front();
  return *parser;
}

std::string problem_of(const CLI::App& program, const CLI::ParseError& error) {
  std::string problem = unknown_word(program);
  if (problem.empty()) problem = found_by_parser(chosen_parser(program), error);
  return problem;
}

}  // namespace earthshine::app
