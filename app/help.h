// SPDX-License-Identifier: Apache-2.0
// Formats --help: options in groups, lines of at most 80 columns, broken between words; and
// messages for calls that the command-line parser rejects.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace earthshine::app {

class Help : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* parser, std::string name,
                                      CLI::AppFormatMode mode) const override;
};

// The words of a command, each with a trailing blank: "", "render ", "study compare ".
[[nodiscard]] std::string words_to(const CLI::App& parser);

// The command of the call: the study of `study`, else the command, else the program.
[[nodiscard]] const CLI::App& chosen_parser(const CLI::App& program);
// The error in the call, and a remedy.
[[nodiscard]] std::string problem_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace earthshine::app
