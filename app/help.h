// SPDX-License-Identifier: Apache-2.0
// What --help shows: options in groups, lines of at most 80 columns, broken between words; and what
// is said of a call that the parser of command lines refused.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace earthshine::app {

class Help : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* parser, std::string name,
                                      CLI::AppFormatMode mode) const override;
};

// The words that lead to a command, each with a blank behind: "", "render ", "study compare ".
[[nodiscard]] std::string words_to(const CLI::App& parser);

// The command that the call reached: the study of a study, else the command, else the program.
[[nodiscard]] const CLI::App& chosen_parser(const CLI::App& program);
// What is wrong with the call, and what to do about it.
[[nodiscard]] std::string problem_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace earthshine::app
