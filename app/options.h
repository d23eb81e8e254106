// SPDX-License-Identifier: Apache-2.0
// Options common to several commands, parsed strictly.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "app/command.h"
#include "base/tone.h"

namespace earthshine::app {

// The one place that constructs commands, so that few files instantiate CLI11's classes.
CLI::App* add_subcommand(CLI::App& parent, const std::string& name, const std::string& description);

// SCENE and --set.
void add_scene(CLI::App& command, SceneInput& input);
// Those and --error.
void add_scene_options(CLI::App& command, SceneInput& input);

// --size CxR; empty means the camera's own size.
void add_size_option(CLI::App& command, std::optional<Size>& size);

// Brightness of a PNG: per picture by base::tone_map, or a common white.
struct ToneChoice {
  std::optional<double> percent;          // of the lit pixels, darker than white
  std::optional<double> white_cd_per_m2;  // or white itself
  base::ToneCurve curve = base::ToneCurve::Shoulder;

  [[nodiscard]] bool shared() const { return percent || white_cd_per_m2; }
};
// The common white luminance of these pictures. Needs a shared white.
[[nodiscard]] double white_of(const ToneChoice& tone,
                              const std::vector<const base::Image*>& pictures);
inline constexpr double usual_percent = 99.5;                  // for --exposure auto
inline constexpr double white_of_ev0 = 78.0 / (100.0 * 0.65);  // cd/m^2, at ISO 100
// --exposure own, auto, auto:PERCENT, EV (of ISO 100: white at 1.2 2^EV cd/m^2, by H = 78 lx s /
// ISO for white and H = 0.65 L t / N^2, ISO 12232) or cd/m2; --curve shoulder or clip. `more`:
// further help text of an option.
void add_tone_options(CLI::App& command, ToneChoice& tone, const std::string& more);

// Notes a --curve without effect.
void note_unused_curve(const ToneChoice& tone, bool quiet);

// The words between commas, including empty ones.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

// The number that is the whole text; no value otherwise.
template <class Number>
[[nodiscard]] std::optional<Number> parsed(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  return problem == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

// An integer within [least, most], parsed strictly: no sign for unsigned, no octal, no rounding.
// Throws CLI::ValidationError with the option's name.
[[nodiscard]] std::uint64_t read_whole_number(const std::string& option, const std::string& text,
                                              std::uint64_t least, std::uint64_t most);

// Adds an option for such an integer.
void add_whole_number(CLI::App& command, const std::string& flags, std::uint64_t& value,
                      std::uint64_t least, std::uint64_t most, const std::string& help);

// Adds an option for a finite number within [least, most].
void add_number(CLI::App& command, const std::string& flags, std::optional<double>& value,
                double least, double most, const std::string& help);

// Adds an option with a choice of words, each for a value of `kept`.
template <class Kept, class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Kept& kept,
                        const std::vector<std::pair<std::string, Value>>& choices,
                        const std::string& help) {
  const auto read = [name, &kept, choices](const std::string& text) {
    std::string words;
    for (const auto& [word, value] : choices) {
      if (word == text) {
        kept = value;
        return;
      }
      words += (words.empty() ? "" : ", ") + word;
    }
    throw CLI::ValidationError(name, "\"" + text + "\" is not one of " + words);
  };
  return command.add_option_function<std::string>(name, read, help)->type_name("HOW");
}

// --max-memory SIZE, with a unit: 500MiB, 2GiB.
void add_memory_option(CLI::App& command, std::uint64_t& bytes);

// --time-limit SECONDS above 0.
void add_time_limit(CLI::App& command, double& seconds, const std::string& help);

// Allows repetition of an option, one value each time.
CLI::Option* may_repeat(CLI::Option* option);

// Rejects empty values of given options and commands: an empty string is an error, because it would
// be stored like an absent option. Throws CLI::ValidationError.
void refuse_empty_words(const CLI::App& parser);

}  // namespace earthshine::app
