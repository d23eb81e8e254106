// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/mtl_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/input/input_file.h"
#include "scenes/mesh.h"
#include "scenes/text/confined_path.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

struct Option {
  std::string_view name;
  std::size_t least, most;  // number of values
  bool changes_nothing;     // in this program
};
// From the format's text. -bm is for bump maps; -imfchan names the channel of a mask.
constexpr Option options[] = {
    {"-s", 1, 3, false},      {"-o", 1, 3, false},     {"-clamp", 1, 1, false},
    {"-t", 1, 3, true},       {"-blendu", 1, 1, true}, {"-blendv", 1, 1, true},
    {"-cc", 1, 1, true},      {"-texres", 1, 1, true}, {"-boost", 1, 1, true},
    {"-imfchan", 1, 1, true}, {"-type", 1, 1, true}};

}  // namespace

bool MtlMaps::read(const TextLines& line, bool is_mask, TextureMap& map) {
  const auto& words = line.words();
  glm::dvec2 scale(1.0), shift(0.0);
  TextureReading reading;
  reading.is_mask = is_mask;
  reading.is_srgb = !is_mask;
  std::size_t at = 1;
  while (at < words.size() && words[at].text.starts_with('-')) {
    const auto* const option =
        std::find_if(std::begin(options), std::end(options),
                     [&](const Option& known) { return known.name == words[at].text; });
    if (option == std::end(options)) return false;
    // Too few words for the option's values and a file name.
    if (at + option->least + 1 >= words.size()) return false;
    std::vector<double> numbers;
    std::size_t used = 1;
    // Values may be fewer: "-s 2 floor.png" has one.
    for (; used <= option->most && at + used < words.size(); ++used) {
      if (used > option->least && !number_in(words[at + used].text)) break;
      if (option->most > 1) numbers.push_back(line.number(words[at + used]));
    }
    const auto component = [&](std::size_t k, double otherwise) {
      return k < numbers.size() ? numbers[k] : otherwise;
    };
    if (option->name == "-s") scale = {component(0, 1.0), component(1, 1.0)};
    if (option->name == "-o") shift = {component(0, 0.0), component(1, 0.0)};
    if (option->name == "-clamp") {
      const Word& word = words[at + 1];
      const std::string value = lower_case(std::string(word.text));
      if (value == "on") reading.wrap_u = reading.wrap_v = Wrap::Clamp;
      if (value != "on" && value != "off") {
        throw base::Error(base::Blame::Input, line.where(word),
                          fmt::format("\"-clamp\" is {}", in_quotes(word.text)),
                          "allowed are on and off");
      }
    }
    at += used;
  }
  if (at >= words.size()) return false;
  // The rest of the line: names may contain blanks.
  const char* const first = words[at].text.data();
  const char* const last = words.back().text.data() + words.back().text.size();
  reading.name.assign(first, last);
  std::replace(reading.name.begin(), reading.name.end(), '\\', '/');
  const base::Location where = line.where(words[at]);
  map.texture = shelf_.take(reading, [&] {
    const auto path = confined_path(library_.parent_path(), reading.name, folders_, where);
    files_.push_back(path);
    return base::read_input_file(path, max_mesh_bytes, where);
  });
  // v points up in these files, here down from the upper edge: with w = 1 - v and the format's v' =
  // o + s v, w' = 1 - v' = (1 - o - s) + s w.
  TextureTransform transform;
  transform.matrix = glm::dmat2(scale.x, 0.0, 0.0, scale.y);
  transform.shift = {shift.x, 1.0 - shift.y - scale.y};
  map.transform = std::make_shared<const TextureTransform>(transform);
  return true;
}

void list_map_files(std::string_view text, const std::filesystem::path& library,
                    std::vector<std::filesystem::path>& files) {
  constexpr std::string_view others[] = {"bump", "norm", "disp", "decal", "refl"};
  constexpr std::size_t most_words = 64;  // options and a name with blanks
  std::set<std::string, std::less<>> seen;
  TextLines lines(text, library.string(), TextLines::Style::Wavefront);
  while (lines.next()) {
    const auto& words = lines.words();
    const std::string keyword = lower_case(std::string(words.front().text));
    const bool names_picture =
        keyword.starts_with("map_") || std::ranges::find(others, keyword) != std::end(others);
    if (!names_picture || !seen.emplace(lines.argument()).second) continue;
    // The name follows the options and may contain blanks.
    for (std::size_t k = 1; k < std::min(words.size(), most_words); ++k) {
      const char* const last = words.back().text.data() + words.back().text.size();
      std::string name(words[k].text.data(), last);
      std::replace(name.begin(), name.end(), '\\', '/');
      std::erase(name, '"');
      std::error_code ignored;
      const std::filesystem::path path = library.parent_path() / name;
      if (!std::filesystem::is_regular_file(path, ignored)) continue;
      files.push_back(path);
      break;
    }
  }
}

}  // namespace earthshine::scenes
