// SPDX-License-Identifier: Apache-2.0
// Options that several commands have, read strictly.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

// SCENE, --set and --error.
void add_scene_options(CLI::App& command, SceneInput& input);

// --size CxR; stays empty where the camera's own size is meant.
void add_size_option(CLI::App& command, std::optional<Size>& size);

// The words between the commas, also empty ones.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

// A whole number within [least, most], read strictly: no sign for unsigned, no octal, no rounding.
// Throws CLI::ValidationError with the option's name.
[[nodiscard]] std::uint64_t read_whole_number(const std::string& option, const std::string& text,
                                              std::uint64_t least, std::uint64_t most);

// An option that takes such a number.
void add_whole_number(CLI::App& command, const std::string& flags, std::uint64_t& value,
                      std::uint64_t least, std::uint64_t most, const std::string& help);

// An option that takes a finite number within [least, most].
void add_number(CLI::App& command, const std::string& flags, std::optional<double>& value,
                double least, double most, const std::string& help);

// --max-memory SIZE, with a unit: 500MiB, 2GiB.
void add_memory_option(CLI::App& command, std::uint64_t& bytes);

// --time-limit SECONDS above 0.
void add_time_limit(CLI::App& command, double& seconds, const std::string& help);

// Refuses an empty word, such as that of a variable that the shell does not know.
[[nodiscard]] CLI::Validator not_empty();

}  // namespace earthshine::app
