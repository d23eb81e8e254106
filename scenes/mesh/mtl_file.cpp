// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "base/input/input_file.h"
#include "scenes/mesh/mtl_maps.h"
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

// A material of an MTL library.
struct MtlMaterial {
  std::string name;
  base::Location where;
  std::optional<Rgb> diffuse, emitted;  // default 0, or 1 with a texture
  Rgb specular{0.0};
  std::optional<double> shininess;
  std::optional<double> dissolve;  // d: coverage; 1 - Tr
  Rgb filter{1.0};                 // Tf: transmitted colour
  double ior = 1.0;
  int illumination = 2;  // illum
  MaterialMaps maps;
};

// From this exponent on, the sharpest of the format, the highlight is a mirror reflection.
constexpr double sharpest = 1000.0;

// docs/models.md has this mapping as a table.
Material material_of(const MtlMaterial& source) {
  Material material;
  const MaterialMaps& maps = source.maps;
  if (maps.diffuse.texture || maps.emit.texture || maps.opacity.texture) {
    material.maps = std::make_shared<const MaterialMaps>(maps);
  }
  material.name = material.light_group = source.name;
  const double there = source.dissolve.value_or(1.0);
  const auto factor = [](const std::optional<Rgb>& value, const TextureMap& map) {
    return value.value_or(Rgb(map.texture ? 1.0 : 0.0));
  };
  material.diffuse = there * factor(source.diffuse, maps.diffuse);
  material.emit = factor(source.emitted, maps.emit);
  material.shininess = source.shininess.value_or(material.shininess);
  const int model = source.illumination;
  const bool reflects_surroundings = model >= 3 && model <= 9;
  if (reflects_surroundings && source.shininess.value_or(sharpest) >= sharpest) {
    material.mirror = there * glm::min(source.specular, Rgb(1.0));
  } else if (reflects_surroundings) {
    // All reflected light is blurred by the highlight's lobe: the lobe's albedo is Ks.
    material.specular = there * source.specular * (material.shininess + 2.0) / 2.0;
  } else if (model >= 2) {
    material.specular = there * source.specular;
  }
  if (there < 1.0) {
    material.transmit = (1.0 - there) * source.filter;
    const bool refracts = model == 6 || model == 7;
    if (refracts) material.ior = source.ior;
  }
  return material;
}

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::filesystem::path& path,
            std::span<const std::filesystem::path> folders, Mesh& mesh)
      : lines_(text, path.string(), TextLines::Style::Wavefront),
        path_(path),
        mesh_(mesh),
        maps_(path, folders, mesh.files, mesh.warnings) {
    // Materials of previous libraries.
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
      places_.emplace(mesh.materials[i].name, i);
    }
  }

  void read() {
    while (lines_.next()) {
      const std::string_view keyword = lines_.words().front().text;
      if (keyword == "newmtl") {
        begin();
      } else if (is_used(keyword)) {
        if (!material_) {
          throw Error(Blame::Input, lines_.where(),
                      fmt::format("\"{}\" before any material", keyword),
                      "a material begins with newmtl");
        }
        read_value(keyword);
      } else if (!is_neutral(keyword)) {
        ++passed_over_[std::string(keyword)];
      }
    }
    end();
    report();
  }

 private:
  [[nodiscard]] static bool is_used(std::string_view keyword) {
    constexpr std::string_view used[] = {"Kd", "Ks", "Ke",    "Ns",     "d",      "Tr",
                                         "Tf", "Ni", "illum", "map_Kd", "map_Ke", "map_d"};
    return std::find(std::begin(used), std::end(used), keyword) != std::end(used);
  }

  // Ambient light and the sharpness of reflection maps have no effect in this program.
  [[nodiscard]] static bool is_neutral(std::string_view keyword) {
    return keyword == "Ka" || keyword == "map_Ka" || keyword == "sharpness";
  }

  void begin() {
    end();
    material_.emplace();
    material_->name = lines_.argument();
    material_->where = lines_.where();
    if (!material_->name.empty()) return;
    throw Error(Blame::Input, lines_.where(), "\"newmtl\" has no name",
                "newmtl is followed by a name");
  }

  // The first of several materials with one name is used, as everywhere.
  void end() {
    if (!material_) return;
    const auto [first, fresh] = places_.emplace(material_->name, mesh_.materials.size());
    if (!fresh && repeated_++ == 0) {
      first_repeated_ = fmt::format("{}: the material {} again, as at {}",
                                    base::to_string(material_->where), in_quotes(material_->name),
                                    base::to_string(mesh_.material_places[first->second]));
    }
    mesh_.materials.push_back(material_of(*material_));
    mesh_.material_places.push_back(material_->where);
    material_.reset();
  }

  void read_value(std::string_view keyword) {
    const auto& words = lines_.words();
    if (keyword == "Kd") material_->diffuse = read_colour(lines_, share);
    if (keyword == "Ks") material_->specular = read_colour(lines_, at_least_zero);
    if (keyword == "Ke") material_->emitted = read_colour(lines_, at_least_zero);
    if (keyword == "Ns") material_->shininess = read_colour(lines_, {0.0, 1e6}).r;
    if (keyword == "Ni") material_->ior = std::max(1.0, read_colour(lines_, {0.0, 10.0}).r);
    // "d -halo f", thinner in the middle, is not supported. If both are present, the plain d is
    // used.
    const bool plain = words.size() > 1 && number_in(words[1].text).has_value();
    if (keyword == "d" || keyword == "Tr" || keyword == "Tf") {
      if (!plain) {
        ++passed_over_[fmt::format("{} {}", keyword, words.size() > 1 ? words[1].text : "")];
      } else if (keyword == "Tf") {
        material_->filter = read_colour(lines_, share);
      } else if (keyword == "d") {
        material_->dissolve = read_colour(lines_, share).r;
      } else if (!material_->dissolve) {
        material_->dissolve = 1.0 - read_colour(lines_, share).r;
      }
    }
    if (keyword == "illum") read_model();
    if (keyword.starts_with("map_")) read_map(keyword);
  }

  void read_map(std::string_view keyword) {
    MaterialMaps& maps = material_->maps;
    const bool is_mask = keyword == "map_d";
    TextureMap& map = is_mask ? maps.opacity : keyword == "map_Ke" ? maps.emit : maps.diffuse;
    if (maps_.read(lines_, is_mask, map)) return;
    const bool bare = lines_.words().size() == 1;
    ++passed_over_[fmt::format("{} {}", keyword, bare ? "without a file" : "with options")];
  }

  // Models 0 to 9; model 10 only concerns shadows.
  void read_model() {
    const double model = lines_.number(std::size_t{1});
    if (model >= 0.0 && model <= 9.0 && model == std::floor(model)) {
      material_->illumination = static_cast<int>(model);
    } else {
      ++passed_over_[fmt::format("illum {}", model)];
    }
  }

  void report() {
    if (repeated_ > 0) {
      const std::string more =
          repeated_ > 1 ? fmt::format(" ({} more such)", repeated_ - 1) : std::string();
      mesh_.warnings.push_back(first_repeated_ + more + "; the first is taken");
    }
    if (passed_over_.empty()) return;
    std::string list;
    for (const auto& [keyword, count] : passed_over_) {
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", in_quotes(keyword), count);
      mesh_.unused[keyword] += count;
    }
    mesh_.warnings.push_back(fmt::format(
        "{}: not used, and the picture would change by it: {}; say what these materials are like "
        "in the scene file",
        path_.string(), list));
  }

  TextLines lines_;
  const std::filesystem::path& path_;
  Mesh& mesh_;
  MtlMaps maps_;
  std::optional<MtlMaterial> material_;
  std::unordered_map<std::string, std::size_t> places_;  // index of each material by name
  std::string first_repeated_;
  std::size_t repeated_ = 0;
  std::map<std::string, std::size_t> passed_over_;
};

}  // namespace

void parse_mtl(std::string_view text, const std::filesystem::path& path,
               std::span<const std::filesystem::path> folders, Mesh& mesh) {
  MtlReader(text, path, folders, mesh).read();
}

namespace {

// A name with spaces if such a file exists, else several names.
std::vector<std::filesystem::path> paths_of(const MaterialLibrary& library, const Mesh& mesh,
                                            std::span<const std::filesystem::path> folders) {
  const std::filesystem::path folder = mesh.path.parent_path();
  std::vector<std::filesystem::path> paths{
      confined_path(folder, library.named, folders, library.where)};
  std::error_code ignored;
  if (!std::filesystem::exists(paths.front(), ignored) &&
      library.named.find_first_of(" \t") != std::string::npos) {
    paths.clear();
    TextLines words(library.named, {}, TextLines::Style::Plain);
    while (words.next()) {
      for (const Word& word : words.words()) {
        paths.push_back(confined_path(folder, word.text, folders, library.where));
      }
    }
  }
  return paths;
}

}  // namespace

void list_map_files(Mesh& mesh, std::span<const std::filesystem::path> folders) {
  std::vector<std::filesystem::path> found;
  for (const MaterialLibrary& library : mesh.libraries) {
    try {
      for (const auto& path : paths_of(library, mesh, folders)) {
        list_map_files(base::read_input_file(path, max_library_bytes, library.where), path, found);
      }
    } catch (const Error&) {  // reported when it is read
    }
  }
  mesh.files.insert(mesh.files.end(), found.begin(), found.end());
}

void read_material_libraries(Mesh& mesh, std::span<const std::filesystem::path> folders) {
  const std::vector<MaterialLibrary> libraries = std::move(mesh.libraries);
  mesh.libraries.clear();
  std::set<std::filesystem::path> read;  // some programs write mtllib with every object
  for (const MaterialLibrary& library : libraries) {
    for (const std::filesystem::path& path : paths_of(library, mesh, folders)) {
      if (!read.insert(path.lexically_normal()).second) continue;
      mesh.files.push_back(path);
      parse_mtl(base::read_input_file(path, max_library_bytes, library.where), path, folders, mesh);
    }
  }
  const bool textured =
      std::any_of(mesh.materials.begin(), mesh.materials.end(),
                  [](const Material& material) { return material.maps != nullptr; });
  if (textured) mesh.unused.erase("vt");
}

}  // namespace earthshine::scenes
