// SPDX-License-Identifier: Apache-2.0
// earthshine manual and completion: the man page and the shells' completions, from the table of
// options of --help.
#include <fmt/format.h>

#include <functional>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/help.h"
#include "app/options.h"

namespace earthshine::app {
namespace {

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Visits the commands with an action, each after its parent.
void for_each_command(const CLI::App& parser,
                      const std::function<void(const CLI::App& command)>& visit) {
  for (const CLI::App* command : parser.get_subcommands({})) {
    visit(*command);
    for_each_command(*command, visit);
  }
}

std::vector<const CLI::Option*> options_of(const CLI::App& parser) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : parser.get_options()) {
    if (option->nonpositional()) options.push_back(option);
  }
  return options;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// Escapes text for roff, where a line that begins with . or ' is a request.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (safe.starts_with('.') || safe.starts_with('\'')) safe = "\\&" + safe;
  return safe;
}

std::string option_pages(const CLI::App& parser) {
  std::string text;
  for (const CLI::Option* option : parser.get_options()) {
    std::string name = option->get_positional()
                           ? option->get_name(true)
                           : fmt::format("{}", fmt::join(names_of(*option), ", "));
    if (!option->get_positional() && !option->get_type_name().empty()) {
      name += " " + option->get_type_name();
    }
    text += ".TP\n\\fB" + roff(name) + "\\fR\n" + roff(option->get_description()) + "\n";
  }
  return text;
}

std::string manual(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH EARTHSHINE 1 \"\" \"earthshine {}\" \"User Commands\"\n.SH NAME\nearthshine \\- {}\n"
      ".SH SYNOPSIS\n\\fBearthshine\\fR COMMAND [OPTIONS]\n.SH OPTIONS\n",
      EARTHSHINE_VERSION, roff(program.get_description()));
  text += option_pages(program) + ".SH COMMANDS\n";
  for_each_command(program, [&](const CLI::App& command) {
    text += ".SS " + roff("earthshine " + words_to(command)) + "\n" +
            roff(command.get_description()) + ".\n" + option_pages(command);
  });
  return text +
         ".SH EXIT STATUS\n0 done; 1 the work failed; 2 the call or a file is wrong; 3 done, but "
         "short of the error that the call asked for.\n.SH SEE ALSO\n"
         "/usr/share/doc/earthshine\n";
}

// Name of a case: "render" gives "__render".
std::string joined(const CLI::App& command) {
  std::string words = words_to(command);
  if (!words.empty()) words.pop_back();
  return words;
}

std::string words_after(const CLI::App& parser) {
  std::vector<std::string> words;
  for (const CLI::App* command : parser.get_subcommands({})) words.push_back(command->get_name());
  for (const CLI::Option* option : options_of(parser)) {
    for (const std::string& name : names_of(*option)) words.push_back(name);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash(const CLI::App& program) {
  std::string cases;
  for_each_command(program, [&](const CLI::App& command) {
    cases += fmt::format("    \"{}\") words=\"{}\" ;;\n", joined(command), words_after(command));
  });
  return "# bash completion of earthshine\n_earthshine() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} path= word words\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    [[ $word == [a-z]* && $word != *.* && $word != */* ]] || break\n"
         "    path=${path:+$path }$word\n  done\n  case $path in\n" +
         cases + fmt::format("    *) words=\"{}\" ;;\n", words_after(program)) +
         "  esac\n"
         "  if [[ $current == -* || -z $path ]]; then COMPREPLY=($(compgen -W \"$words\" -- "
         "\"$current\"))\n"
         "  else COMPREPLY=($(compgen -W \"${words%% -*}\" -- \"$current\") $(compgen -f -- "
         "\"$current\")); fi\n"
         "}\ncomplete -o filenames -F _earthshine earthshine\n";
}

std::string zsh_text(const std::string& text) {
  return replaced(replaced(replaced(replaced(text, "'", "'\\''"), "[", "("), "]", ")"), ":", "\\:");
}

std::string zsh(const CLI::App& program) {
  std::string cases, commands;
  for_each_command(program, [&](const CLI::App& command) {
    cases += fmt::format("    '{}')\n      _arguments", joined(command));
    for (const CLI::Option* option : options_of(command)) {
      for (const std::string& name : names_of(*option)) {
        cases += fmt::format(" \\\n        '{}[{}]{}'", name, zsh_text(option->get_description()),
                             option->get_type_name().empty() ? "" : ":value:_files");
      }
    }
    cases += " '*:file:_files' ;;\n";
  });
  for (const CLI::App* command : program.get_subcommands({})) {
    commands += fmt::format(" '{}:{}'", command->get_name(), zsh_text(command->get_description()));
  }
  return "#compdef earthshine\n_earthshine() {\n  local path=() word\n"
         "  for word in ${words[2,CURRENT-1]}; do\n"
         "    [[ $word == [a-z]* && $word != *.* && $word != */* ]] || break\n"
         "    path+=($word)\n  done\n  case \"$path\" in\n" +
         cases + "    *) local commands=(" + commands +
         ")\n      _describe command commands ;;\n  esac\n}\n_earthshine \"$@\"\n";
}

std::string fish(const CLI::App& program) {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
  };
  std::string text = "# fish completion of earthshine\n";
  for (const CLI::App* command : program.get_subcommands({})) {
    text += fmt::format("complete -c earthshine -n __fish_use_subcommand -a {} -d {}\n",
                        command->get_name(), quoted(command->get_description()));
  }
  for_each_command(program, [&](const CLI::App& command) {
    std::string seen;
    for (const CLI::App* at = &command; at->get_parent() != nullptr; at = at->get_parent()) {
      seen =
          "__fish_seen_subcommand_from " + at->get_name() + (seen.empty() ? "" : "; and ") + seen;
    }
    for (const CLI::App* inner : command.get_subcommands({})) {
      text += fmt::format("complete -c earthshine -n {} -a {} -d {}\n", quoted(seen),
                          inner->get_name(), quoted(inner->get_description()));
    }
    for (const CLI::Option* option : options_of(command)) {
      std::string names;
      for (const std::string& name : option->get_snames()) names += " -s " + name;
      for (const std::string& name : option->get_lnames()) names += " -l " + name;
      text += fmt::format("complete -c earthshine -n {}{}{} -d {}\n", quoted(seen), names,
                          option->get_type_name().empty() ? "" : " -r",
                          quoted(option->get_description()));
    }
  });
  return text;
}

using Writer = std::string (*)(const CLI::App& program);

}  // namespace

Command add_manual(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "manual", "The man page: earthshine manual | man -l -");
  return {parser, [&program](const Common&) { print(manual(program)); }};
}

Command add_completion(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "completion", "What a shell completes of a call, as its script");
  const auto writer = std::make_shared<Writer>(bash);
  add_choice<Writer, Writer>(*parser, "SHELL", *writer,
                             {{"bash", bash}, {"zsh", zsh}, {"fish", fish}}, "bash, zsh or fish")
      ->required();
  return {parser, [&program, writer](const Common&) { print((*writer)(program)); }};
}

}  // namespace earthshine::app
