// SPDX-License-Identifier: Apache-2.0
// Options of render: less than the whole picture (a part of it, a time), and how light gets around.
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/render_call.h"

namespace earthshine::app {
namespace {

// Whole numbers between the marks of `pattern`: "," and "x" stand for themselves, each # for one.
std::optional<std::vector<int>> numbers_like(std::string_view pattern, std::string_view text) {
  std::vector<int> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (const char mark : pattern) {
    if (mark == '#') {
      int number = 0;
      const auto read = std::from_chars(at, end, number);
      if (read.ec != std::errc() || number < 0 || *at == '-') return std::nullopt;
      at = read.ptr;
      numbers.push_back(number);
    } else if (at == end || *at++ != mark) {
      return std::nullopt;
    }
  }
  return at == end ? std::optional(numbers) : std::nullopt;
}

}  // namespace

void add_window_options(CLI::App& parser, RenderCall& call) {
  parser
      .add_option_function<std::string>(
          "--crop",
          [&call](const std::string& text) {
            const auto n = numbers_like("#,#,#x#", text);
            if (!n || (*n)[2] < 1 || (*n)[3] < 1) {
              throw CLI::ValidationError(
                  "--crop", "\"" + text +
                                "\" is not X,Y,COLUMNSxROWS in whole pixels from the top left "
                                "corner, such as 100,40,64x64");
            }
            call.crop = raytrace::Window{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
          },
          "Only this part of the picture, as it is in the whole one")
      ->type_name("X,Y,CxR");
  parser
      .add_option_function<std::string>(
          "--only-pixel",
          [&call](const std::string& text) {
            const auto n = numbers_like("#,#", text);
            if (!n) {
              throw CLI::ValidationError(
                  "--only-pixel", "\"" + text +
                                      "\" is not X,Y in whole pixels from the top left corner, "
                                      "such as 100,40");
            }
            call.crop = raytrace::Window{(*n)[0], (*n)[1], 1, 1};
            call.only_pixel = true;
          },
          "Replays one pixel and prints all of it; -o is not needed")
      ->type_name("X,Y")
      ->excludes("--crop");
  parser
      .add_option_function<std::string>(
          "--time-limit",
          [&call](const std::string& text) {
            const char* end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, call.time_limit_s);
            if (read.ec == std::errc() && read.ptr == end && call.time_limit_s > 0.0 &&
                call.time_limit_s <= 1e7) {
              return;
            }
            throw CLI::ValidationError("--time-limit",
                                       "\"" + text + "\" is not a number of seconds above 0");
          },
          "The best picture in that time; the bytes then differ between runs")
      ->type_name("SECONDS");
}

void add_indirect_options(CLI::App& parser, RenderCall& call) {
  using raytrace::Indirect;
  const std::map<std::string, Indirect> names = {{"radiosity", Indirect::Radiosity},
                                                 {"distributed", Indirect::Distributed},
                                                 {"none", Indirect::None},
                                                 {"paths", Indirect::Paths}};
  parser
      .add_option_function<std::string>(
          "--indirect",
          [&call, names](const std::string& text) {
            const auto known = names.find(text);
            if (known == names.end()) {
              throw CLI::ValidationError(
                  "--indirect",
                  "\"" + text + "\" is not one of radiosity, distributed, none, paths");
            }
            call.indirect = known->second;
          },
          "radiosity (default), distributed (many lights, no interreflection), none, paths (slow "
          "reference)")
      ->type_name("HOW");
  add_whole_number(parser, "--distributed-lights", call.distributed_lights, 1, 1U << 20U,
                   "Lights of --indirect distributed (default 64)");
  parser
      .add_option("--distributed-over", call.distributed_over,
                  "Spread the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
}

}  // namespace earthshine::app
