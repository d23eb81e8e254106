// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/stl_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;  // normal, three vertices, two bytes of attributes

std::size_t facet_count(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

void add_triangle(Mesh& mesh, const std::array<Vec3, 3>& corners, std::uint32_t part_set,
                  std::uint32_t line) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  add_polygon(mesh, std::array{first, first + 1, first + 2}, part_set, no_index, line);
}

void read_binary(std::string_view bytes, Mesh& mesh) {
  const std::size_t count = facet_count(bytes);
  mesh.part_sets.emplace_back();
  for (std::size_t i = 0; i < count; ++i) {
    float numbers[9];
    std::memcpy(numbers, bytes.data() + header_bytes + facet_bytes * i + 12, sizeof numbers);
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 9; ++k) {
      const double x = static_cast<double>(numbers[k]);
      if (!(std::abs(x) <= largest_coordinate)) {
        throw Error(Blame::Input,
                    base::Location{fmt::format("{}, triangle {}", mesh.path.string(), i + 1)},
                    fmt::format("a coordinate of {}", x),
                    fmt::format("coordinates are finite and at most {}", largest_coordinate));
      }
      corners[k / 3][static_cast<int>(k % 3)] = x;
    }
    add_triangle(mesh, corners, 0, 0);
  }
}

// facet normal nx ny nz / outer loop / three times vertex x y z / endloop / endfacet, in solids.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, Mesh& mesh)
      : lines_(text, mesh.path.string(), TextLines::Style::Plain), mesh_(mesh) {}

  void read() {
    bool ended = true;
    while (lines_.next()) {
      const std::string_view keyword = lines_.words().front().text;
      if (keyword == "solid") {
        begin_solid();
        ended = false;
      } else if (keyword == "facet") {
        read_facet();
      } else if (keyword == "endsolid") {
        ended = true;
      } else {
        unexpected("solid, facet or endsolid");
      }
    }
    // Facets end at line ends: nothing else distinguishes a complete file from a truncated one.
    if (!ended) {
      throw Error(Blame::Input, lines_.where(), "the file ends within a solid",
                  "\"endsolid\" is wanted",
                  "The file is cut off; if it is whole, add the line endsolid at its end");
    }
  }

 private:
  void begin_solid() {
    std::vector<std::uint32_t> set;
    const std::string name(lines_.argument());
    if (!name.empty()) set.push_back(number_of(name, mesh_.part_names, parts_));
    part_set_ = static_cast<std::uint32_t>(mesh_.part_sets.size());
    mesh_.part_sets.push_back(std::move(set));
  }

  void read_facet() {
    const auto line = static_cast<std::uint32_t>(lines_.line());
    expect("outer");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect("vertex");
      corner = lines_.vector();
    }
    expect("endloop");
    expect("endfacet");
    if (mesh_.part_sets.empty()) mesh_.part_sets.emplace_back();
    add_triangle(mesh_, corners, part_set_, line);
  }

  void expect(std::string_view keyword) {
    if (!lines_.next()) {
      throw Error(Blame::Input, lines_.where(), "the file ends within a facet",
                  fmt::format("\"{}\" is wanted", keyword));
    }
    if (lines_.words().front().text != keyword) unexpected(keyword);
  }

  [[noreturn]] void unexpected(std::string_view wanted) const {
    const Word& word = lines_.words().front();
    throw Error(Blame::Input, lines_.where(word),
                fmt::format("{} in an ascii STL file", in_quotes(word.text)),
                fmt::format("wanted is {}", wanted));
  }

  TextLines lines_;
  Mesh& mesh_;
  std::uint32_t part_set_ = 0;
  std::unordered_map<std::string, std::uint32_t> parts_;
};

}  // namespace

Mesh parse_stl(std::string_view bytes, const std::filesystem::path& path) {
  Mesh mesh;
  mesh.path = path;
  // Decided by file size, not by the word "solid", with which many binary files begin.
  const bool binary = bytes.size() >= header_bytes &&
                      bytes.size() == header_bytes + facet_bytes * facet_count(bytes);
  if (binary) {
    read_binary(bytes, mesh);
  } else if (bytes.substr(0, bytes.find_first_not_of(" \t\r\n") + 5).ends_with("solid") &&
             bytes.find('\0') == std::string_view::npos) {
    AsciiReader(bytes, mesh).read();
  } else {
    throw Error(Blame::Input, base::Location{path.string()},
                bytes.size() < header_bytes
                    ? fmt::format("a file of {} bytes", bytes.size())
                    : fmt::format("a file of {} bytes that announces {} triangles", bytes.size(),
                                  facet_count(bytes)),
                "binary STL has exactly 84 + 50 n bytes; ascii STL begins with \"solid\"",
                "The file is cut off or not STL");
  }
  return mesh;
}

}  // namespace earthshine::scenes
