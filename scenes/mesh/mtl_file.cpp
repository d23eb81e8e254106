// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string>

#include "base/input/input_file.h"
#include "scenes/mesh/obj_file.h"
#include "scenes/text/confined_path.h"
#include "scenes/text/message_text.h"
#include "scenes/text/table_reader.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t max_library_bytes = std::size_t{16} << 20;

// "Kd r g b", or "Kd r" for grey.
Rgb read_colour(const TextLines& lines, Range range) {
  const auto& words = lines.words();
  Rgb colour(lines.number(std::size_t{1}));
  if (words.size() > 2) {
    colour.g = lines.number(std::size_t{2});
    colour.b = lines.number(std::size_t{3});
  }
  for (int c = 0; c < 3; ++c) {
    if (range.holds(colour[c])) continue;
    throw Error(Blame::Input, lines.where(words[1]),
                fmt::format("\"{}\" is {}", words.front().text, colour[c]),
                fmt::format("allowed are numbers, {}", to_string(range)));
  }
  return colour;
}

// Whether the words after the keyword are all that number.
bool all_are(const std::vector<Word>& words, double wanted) {
  for (std::size_t k = 1; k < words.size(); ++k) {
    double number = 0.0;
    const char* const end = words[k].text.data() + words[k].text.size();
    const auto [stop, problem] = std::from_chars(words[k].text.data(), end, number);
    if (problem != std::errc() || stop != end || number != wanted) return false;
  }
  return words.size() > 1;
}

// Ambient light, the number of a lighting model and an index of refraction alone change nothing
// here, nor does an opaque material that says so.
bool changes_the_picture(const TextLines& lines) {
  constexpr std::string_view without_effect[] = {"Ka", "map_Ka", "illum", "Ni", "sharpness"};
  const std::string_view keyword = lines.words().front().text;
  if (std::find(std::begin(without_effect), std::end(without_effect), keyword) !=
      std::end(without_effect)) {
    return false;
  }
  const bool opaque = ((keyword == "d" || keyword == "Tf") && all_are(lines.words(), 1.0)) ||
                      (keyword == "Tr" && all_are(lines.words(), 0.0));
  return !opaque;
}

}  // namespace

void parse_mtl(std::string_view text, const std::filesystem::path& path, Mesh& mesh) {
  TextLines lines(text, path.string(), TextLines::Style::Wavefront);
  Material* material = nullptr;
  std::map<std::string, std::size_t> passed_over;
  while (lines.next()) {
    const std::string_view keyword = lines.words().front().text;
    if (keyword == "newmtl") {
      Material fresh;
      fresh.name = lines.argument();
      fresh.light_group = fresh.name;
      if (fresh.name.empty()) {
        throw Error(Blame::Input, lines.where(), "\"newmtl\" has no name",
                    "newmtl is followed by a name");
      }
      mesh.materials.push_back(std::move(fresh));
      mesh.material_places.push_back(lines.where());
      material = &mesh.materials.back();
      continue;
    }
    const bool used = keyword == "Kd" || keyword == "Ks" || keyword == "Ke" || keyword == "Ns";
    if (!used) {
      if (changes_the_picture(lines)) ++passed_over[std::string(keyword)];
      continue;
    }
    if (material == nullptr) {
      throw Error(Blame::Input, lines.where(), fmt::format("\"{}\" before any material", keyword),
                  "a material begins with newmtl");
    }
    if (keyword == "Kd") material->diffuse = read_colour(lines, share);
    if (keyword == "Ks") material->specular = read_colour(lines, at_least_zero);
    if (keyword == "Ke") material->emit = read_colour(lines, at_least_zero);
    if (keyword == "Ns") material->shininess = read_colour(lines, {0.0, 1e6}).r;
  }
  if (passed_over.empty()) return;
  std::string list;
  for (const auto& [keyword, count] : passed_over) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", in_quotes(keyword), count);
    mesh.unused[keyword] += count;
  }
  mesh.warnings.push_back(
      fmt::format("{}: not used, and the picture would change by it: {}; say diffuse, specular and "
                  "transmit of these materials in the scene file",
                  path.string(), list));
}

void read_material_libraries(Mesh& mesh, std::span<const std::filesystem::path> folders) {
  const std::vector<MaterialLibrary> libraries = std::move(mesh.libraries);
  mesh.libraries.clear();
  const std::filesystem::path folder = mesh.path.parent_path();
  for (const MaterialLibrary& library : libraries) {
    // A name with spaces, if there is such a file, else several names.
    std::vector<std::string> names{library.named};
    std::error_code ignored;
    if (!std::filesystem::exists(confined_path(folder, library.named, folders, library.where),
                                 ignored) &&
        library.named.find_first_of(" \t") != std::string::npos) {
      names.clear();
      TextLines words(library.named, {}, TextLines::Style::Plain);
      while (words.next()) {
        for (const Word& word : words.words()) names.emplace_back(word.text);
      }
    }
    for (const std::string& name : names) {
      const auto path = confined_path(folder, name, folders, library.where);
      mesh.files.push_back(path);
      parse_mtl(base::read_input_file(path, max_library_bytes, library.where), path, mesh);
    }
  }
}

}  // namespace earthshine::scenes
