// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "scenes/text/confined_path.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// Other keywords of OBJ files: texture, normals, smoothing, lines, points, curves, display hints.
constexpr std::string_view passed_over[] = {
    "vt",       "vn",     "vp",         "s",         "l",    "p",    "mg",   "bevel", "c_interp",
    "d_interp", "lod",    "deg",        "cstype",    "bmat", "step", "curv", "curv2", "surf",
    "parm",     "trim",   "hole",       "scrv",      "sp",   "end",  "con",  "ctech", "stech",
    "maplib",   "usemap", "shadow_obj", "trace_obj", "call", "csh"};
constexpr std::size_t most_warnings = 10;

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::filesystem::path& path,
            std::span<const std::filesystem::path> folders, VertexNormals normals)
      : lines_(text, path.string(), TextLines::Style::Wavefront),
        folders_(folders),
        shaped_by_normals_(normals == VertexNormals::Shape) {
    mesh_.path = path;
  }

  Mesh read() {
    while (lines_.next()) {
      const std::string_view keyword = lines_.words().front().text;
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "g") {
        groups_.clear();
        for (std::size_t i = 1; i < lines_.words().size(); ++i) {
          groups_.emplace_back(lines_.words()[i].text);
        }
        part_set_ = no_index;
      } else if (keyword == "o") {
        object_ = lines_.argument();
        part_set_ = no_index;
      } else if (keyword == "usemtl") {
        const std::string name(lines_.argument());
        material_ = name.empty() ? no_index : number_of(name, mesh_.material_names, materials_);
      } else if (keyword == "mtllib") {
        note_library();
      } else if (keyword == "vt" && !mesh_.libraries.empty()) {
        read_coordinates();
      } else if (keyword == "vn") {
        read_normal();
      } else if (std::find(std::begin(passed_over), std::end(passed_over), keyword) ==
                 std::end(passed_over)) {
        warn_once(keyword);
      } else if (keyword != "end") {
        count_unused(keyword);
      }
    }
    return std::move(mesh_);
  }

 private:
  // Caches the last keyword: lines of one kind follow each other by the million.
  void count_unused(std::string_view keyword) {
    if (last_unused_ == nullptr || last_keyword_ != keyword) {
      last_keyword_ = keyword;
      last_unused_ = &mesh_.unused[last_keyword_];
    }
    ++*last_unused_;
  }

  void read_vertex() {
    // A weight, a colour, or both may follow x y z.
    mesh_.vertices.push_back(lines_.vector());
    if (mesh_.vertices.size() >= no_index) {
      throw Error(Blame::Input, lines_.where(), "too many vertices", "a mesh has fewer than 2^32");
    }
  }

  void read_normal() {
    if (shaped_by_normals_) {
      mesh_.normals.emplace_back(lines_.vector());
      return;
    }
    count_unused("vn");
    glm::vec3 normal(0.0F);
    for (std::size_t c = 0; c < 3 && c + 1 < lines_.words().size(); ++c) {
      const auto number = number_in(lines_.words()[c + 1].text);
      normal[static_cast<int>(c)] = number ? static_cast<float>(*number) : std::nanf("");
    }
    const bool sound = std::isfinite(glm::length(normal));
    mesh_.normals.push_back(sound ? normal : glm::vec3(0.0F));
  }

  // Texture coordinates are useful only with a library, whose materials may have textures. v points
  // up in these files.
  void read_coordinates() {
    count_unused("vt");
    const bool has_v = lines_.words().size() > 2;
    mesh_.uv.emplace_back(lines_.number(std::size_t{1}),
                          1.0 - (has_v ? lines_.number(std::size_t{2}) : 0.0));
  }

  void read_face() {
    const auto& words = lines_.words();
    const std::size_t count = words.size() - 1;
    if (count < 3 || count > max_polygon_corners) {
      throw Error(Blame::Input, lines_.where(words.front()),
                  fmt::format("a face of {} corners", count),
                  fmt::format("a face has from 3 to {}", max_polygon_corners));
    }
    if (mesh_.indices.size() + count >= no_index) {
      throw Error(Blame::Input, lines_.where(), "too many corners", "a mesh has fewer than 2^32");
    }
    corners_.clear();
    if (!mesh_.uv.empty()) mesh_.uv_indices.resize(mesh_.indices.size(), no_index);
    if (!mesh_.normals.empty()) mesh_.normal_indices.resize(mesh_.indices.size(), no_index);
    for (std::size_t i = 1; i < words.size(); ++i) {
      std::int64_t coordinates = 0, normal = 0;
      corners_.push_back(vertex_of(words[i], coordinates, normal));
      if (!mesh_.uv.empty()) {
        mesh_.uv_indices.push_back(attribute_of(coordinates, mesh_.uv.size()));
      }
      if (!mesh_.normals.empty()) {
        mesh_.normal_indices.push_back(attribute_of(normal, mesh_.normals.size()));
      }
    }
    add_polygon(mesh_, corners_, part_set(), material_, static_cast<std::uint32_t>(lines_.line()));
  }

  // "v", "v/vt", "v//vn" or "v/vt/vn"; v counts from 1, or backward from the last vertex with -1.
  // `coordinates`: vt, `normal`: vn, or 0.
  std::uint32_t vertex_of(const Word& word, std::int64_t& coordinates, std::int64_t& normal) {
    const std::size_t slash = word.text.find('/');
    std::int64_t number = 0;
    bool sound = parse_whole(word.text.substr(0, slash), number);
    int slashes = 0;
    for (std::size_t at = slash; at != std::string_view::npos && sound;) {
      const std::size_t next = word.text.find('/', at + 1);
      const std::string_view field =
          word.text.substr(at + 1, next == std::string_view::npos ? next : next - at - 1);
      std::int64_t& number_there = slashes == 0 ? coordinates : normal;
      sound = (field.empty() || parse_whole(field, number_there)) && ++slashes <= 2;
      at = next;
    }
    if (!sound) {
      throw Error(Blame::Input, lines_.where(word),
                  fmt::format("the corner {}", in_quotes(word.text)),
                  "a corner is v, v/vt, v//vn or v/vt/vn, whole numbers");
    }
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    const bool in_range = number > 0 ? number <= count : number < 0 && number >= -count;
    if (!in_range) {
      throw Error(Blame::Input, lines_.where(word),
                  fmt::format("vertex index {} is out of range", number),
                  fmt::format("allowed are 1 to {0} and -{0} to -1, the vertices so far", count));
    }
    return static_cast<std::uint32_t>(number > 0 ? number - 1 : count + number);
  }

  // A corner with an invalid index of coordinates or normal has none: they are often unused.
  [[nodiscard]] static std::uint32_t attribute_of(std::int64_t number, std::size_t size) {
    const auto count = static_cast<std::int64_t>(size);
    if (number < 0) number += count + 1;
    return number < 1 || number > count ? no_index : static_cast<std::uint32_t>(number - 1);
  }

  std::uint32_t part_set() {
    if (part_set_ != no_index) return part_set_;
    std::vector<std::uint32_t> set;
    for (const std::string& group : groups_)
      set.push_back(number_of(group, mesh_.part_names, parts_));
    if (!object_.empty()) set.push_back(number_of(object_, mesh_.part_names, parts_));
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    const auto [entry, fresh] =
        sets_.emplace(set, static_cast<std::uint32_t>(mesh_.part_sets.size()));
    if (fresh) mesh_.part_sets.push_back(set);
    part_set_ = entry->second;
    return part_set_;
  }

  void note_library() {
    const auto& words = lines_.words();
    if (words.size() < 2) {
      throw Error(Blame::Input, lines_.where(words.front()), "\"mtllib\" names no file",
                  "mtllib is followed by a file name");
    }
    const base::Location where = lines_.where(words[1]);
    // Checked even if it is never read, so that a mesh with foreign paths is noticed.
    mesh_.files.push_back(
        confined_path(mesh_.path.parent_path(), lines_.argument(), folders_, where));
    mesh_.libraries.push_back({std::string(lines_.argument()), where});
  }

  void warn_once(std::string_view keyword) {
    if (unknown_.size() > most_warnings || !unknown_.emplace(keyword).second) return;
    mesh_.warnings.push_back(
        fmt::format("{}: {}", base::to_string(lines_.where(lines_.words().front())),
                    unknown_.size() > most_warnings
                        ? std::string("and further unknown keywords, ignored")
                        : fmt::format("the unknown keyword {} is ignored", in_quotes(keyword))));
  }

  TextLines lines_;
  std::span<const std::filesystem::path> folders_;
  bool shaped_by_normals_;
  Mesh mesh_;
  std::string last_keyword_;
  std::size_t* last_unused_ = nullptr;  // counter of that keyword, in mesh_
  std::vector<std::string> groups_;
  std::string object_;
  std::uint32_t part_set_ = no_index;
  std::uint32_t material_ = no_index;
  std::vector<std::uint32_t> corners_;
  std::unordered_map<std::string, std::uint32_t> parts_, materials_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> sets_;
  std::set<std::string, std::less<>> unknown_;
};

}  // namespace

Mesh parse_obj(std::string_view text, const std::filesystem::path& path,
               std::span<const std::filesystem::path> folders, VertexNormals normals) {
  return ObjReader(text, path, folders, normals).read();
}

}  // namespace earthshine::scenes
