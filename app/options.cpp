// SPDX-License-Identifier: Apache-2.0
#include "app/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"

namespace earthshine::app {
namespace {

constexpr int largest_edge_px = 16384;

// Number and unit: "12EV"; no value without a number.
std::optional<std::pair<double, std::string>> measure_of(const std::string& text) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc() || !std::isfinite(number)) return std::nullopt;
  return std::pair{number, std::string(stop, end)};
}

// No value if `text` is not valid for --exposure.
std::optional<ToneChoice> tone_of(const std::string& text) {
  ToneChoice tone;
  const std::string_view start = "auto:";
  if (text == "own") return tone;
  if (text == "auto") {
    tone.percent = usual_percent;
    return tone;
  }
  const bool by_percent = text.starts_with(start);
  const auto measure = measure_of(by_percent ? text.substr(start.size()) : text);
  if (!measure) return std::nullopt;
  const auto& [number, unit] = *measure;
  if (by_percent) {
    if (!unit.empty() || !(number > 0.0 && number <= 100.0)) return std::nullopt;
    tone.percent = number;
  } else if (unit == "EV") {
    if (std::abs(number) > 60.0) return std::nullopt;
    tone.white_cd_per_m2 = white_of_ev0 * std::exp2(number);
  } else {
    if ((!unit.empty() && unit != "cd/m2") || !(number >= 1e-12 && number <= 1e12)) {
      return std::nullopt;
    }
    tone.white_cd_per_m2 = number;
  }
  return tone;
}

// A share that was written as a percentage or with a decimal comma; "" for anything else.
std::string meant_number(std::string text) {
  std::ranges::replace(text, ',', '.');
  const bool percent = text.ends_with('%');
  if (percent) text.pop_back();
  const auto number = parsed<double>(text);
  if (!number) return {};
  const double share = percent ? *number / 100.0 : *number;
  return share > 0.0 && share <= 1.0 ? fmt::format("{:g}", share) : std::string();
}

}  // namespace

CLI::App* add_subcommand(CLI::App& parent, const std::string& name,
                         const std::string& description) {
  return parent.add_subcommand(name, description);
}

void add_scene(CLI::App& command, SceneInput& input) {
  command.add_option("SCENE", input.path, "Scene file (TOML)")->required()->type_name("");
  may_repeat(command.add_option("--set", input.overrides,
                                "Change a key of the scene: quality.gather_rays=64, "
                                "camera.A.fov_deg=30 (may be repeated)"))
      ->type_name("KEY=VALUE");
}

void add_scene_options(CLI::App& command, SceneInput& input) {
  add_scene(command, input);
  command
      .add_option_function<std::string>(
          "--error",
          [&input](const std::string& text) {
            const auto error = parsed<double>(text);
            if (const std::string meant = meant_number(text); !error && !meant.empty()) {
              throw CLI::ValidationError("--error",
                                         fmt::format("\"{}\"; did you mean {}?", text, meant));
            }
            if (error && *error > 1.0 && *error <= 100.0) {
              throw CLI::ValidationError("--error",
                                         fmt::format("{} means {:g} %; did you mean {:g}?", text,
                                                     100.0 * *error, *error / 100.0));
            }
            if (!error || !(*error > 0.0 && *error <= 1.0)) {
              throw CLI::ValidationError("--error",
                                         "\"" + text + "\" is not a number above 0 and at most 1");
            }
            input.overrides.push_back(fmt::format("quality.error={}", *error));
          },
          "Wanted relative error of pictures and solutions; the same as --set quality.error=E")
      ->type_name("E");
}

double white_of(const ToneChoice& tone, const std::vector<const base::Image*>& pictures) {
  return tone.white_cd_per_m2 ? *tone.white_cd_per_m2 : base::white_at(pictures, *tone.percent);
}

void add_tone_options(CLI::App& command, ToneChoice& tone, const std::string& more) {
  command
      .add_option_function<std::string>(
          "--exposure",
          [&tone](const std::string& text) {
            const std::optional<ToneChoice> read = tone_of(text);
            if (!read) {
              throw CLI::ValidationError(
                  "--exposure", "\"" + text +
                                    "\" is not own, auto, auto:PERCENT (above 0, to 100), EV such "
                                    "as 12EV (-60 to 60) "
                                    "or the luminance of white such as 3000cd/m2 (1e-12 to 1e12)");
            }
            tone.percent = read->percent;
            tone.white_cd_per_m2 = read->white_cd_per_m2;
          },
          "White of PNGs: auto (brighter than 99.5 % of the lit pixels), auto:PERCENT, 12EV, "
          "3000cd/m2, or own, a curve for each picture by its mean" +
              more)
      ->type_name("HOW");
  add_choice<base::ToneCurve, base::ToneCurve>(
      command, "--curve", tone.curve,
      {{"shoulder", base::ToneCurve::Shoulder}, {"clip", base::ToneCurve::Clip}},
      "With --exposure: shoulder (default; bright parts keep their differences), clip (linear up "
      "to white)")
      ->needs("--exposure");
}

void note_unused_curve(const ToneChoice& tone, bool quiet) {
  if (quiet || tone.shared() || tone.curve == base::ToneCurve::Shoulder) return;
  note("note: --curve has no effect: --exposure own shows each picture by its own curve");
}

void add_size_option(CLI::App& command, std::optional<Size>& size) {
  const auto read = [&size](const std::string& text) {
    Size found;
    const char* end = text.data() + text.size();
    const auto columns = std::from_chars(text.data(), end, found.columns);
    const bool has_x = columns.ec == std::errc() && columns.ptr != end && *columns.ptr == 'x';
    const auto rows = has_x ? std::from_chars(columns.ptr + 1, end, found.rows) : columns;
    if (!has_x || rows.ec != std::errc() || rows.ptr != end || found.columns < 1 ||
        found.rows < 1 || found.columns > largest_edge_px || found.rows > largest_edge_px) {
      throw CLI::ValidationError(
          "--size", fmt::format("\"{}\" is not COLUMNSxROWS, each from 1 to {}, such as 512x384",
                                text, largest_edge_px));
    }
    size = found;
  };
  command
      .add_option_function<std::string>("--size", read, "Columns and rows (default: the camera's)")
      ->type_name("CxR");
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

std::uint64_t read_whole_number(const std::string& option, const std::string& text,
                                std::uint64_t least, std::uint64_t most) {
  const auto number = parsed<std::uint64_t>(text);
  if (!number || *number < least || *number > most) {
    throw CLI::ValidationError(
        option, fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most));
  }
  return *number;
}

void add_whole_number(CLI::App& command, const std::string& flags, std::uint64_t& value,
                      std::uint64_t least, std::uint64_t most, const std::string& help) {
  const auto read = [&value, least, most, flags](const std::string& text) {
    value = read_whole_number(flags, text, least, most);
  };
  command.add_option_function<std::string>(flags, read, help)->type_name("N");
}

void add_number(CLI::App& command, const std::string& flags, std::optional<double>& value,
                double least, double most, const std::string& help) {
  const auto read = [&value, least, most, flags](const std::string& text) {
    const auto number = parsed<double>(text);
    if (!number || !(*number >= least && *number <= most)) {
      throw CLI::ValidationError(
          flags, fmt::format("\"{}\" is not a number from {} to {}", text, least, most));
    }
    value = number;
  };
  command.add_option_function<std::string>(flags, read, help)->type_name("X");
}

void add_memory_option(CLI::App& command, std::uint64_t& bytes) {
  command
      .add_option_function<std::string>(
          "--max-memory",
          [&bytes](const std::string& text) {
            double size = 0.0;
            const char* end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, size);
            const std::string unit(read.ptr, end);
            const double scale = unit == "MiB" ? 0x1p20 : unit == "GiB" ? 0x1p30 : 0.0;
            if (read.ec != std::errc() || scale == 0.0 || !(size * scale >= 0x1p20) ||
                size * scale > 0x1p50) {
              throw CLI::ValidationError(
                  "--max-memory",
                  "\"" + text + "\" is not a size of 1MiB or more, such as 500MiB or 2GiB");
            }
            bytes = static_cast<std::uint64_t>(size * scale);
          },
          "Memory that the work may take (default: what is free)")
      ->type_name("SIZE");
}

void add_time_limit(CLI::App& command, double& seconds, const std::string& help) {
  command
      .add_option_function<std::string>(
          "--time-limit",
          [&seconds](const std::string& text) {
            seconds = parsed<double>(text).value_or(0.0);
            if (seconds > 0.0 && seconds <= 1e7) return;
            throw CLI::ValidationError(
                "--time-limit",
                "\"" + text + "\" is not a number of seconds above 0 and up to 10000000");
          },
          help)
      ->type_name("SECONDS");
}

CLI::Option* may_repeat(CLI::Option* option) {
  return option->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

void refuse_empty_words(const CLI::App& parser) {
  for (const CLI::Option* option : parser.get_options()) {
    if (std::ranges::count(option->results(), "") == 0) continue;
    throw CLI::ValidationError(option->get_name(),
                               "is an empty word, as the shell makes of a variable that is not "
                               "set. Write what is meant, or leave it out");
  }
  for (const CLI::App* command : parser.get_subcommands()) refuse_empty_words(*command);
}

}  // namespace earthshine::app
