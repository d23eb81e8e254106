// SPDX-License-Identifier: Apache-2.0
// What --help shows: options in groups, lines of at most 80 columns, broken between words.
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

}  // namespace earthshine::app
