// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/ply_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "scenes/mesh/ply_values.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr const char* strips_named = "tristrips";

struct Property {
  std::string name;
  PlyType type = PlyType::Float32;
  std::optional<PlyType> count_type;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<Element> elements;
  std::size_t bytes = 0;
  int lines = 0;
};

PlyType type_of(const TextLines& lines, const Word& word) {
  const auto type = ply_type(word.text);
  if (type) return *type;
  throw Error(Blame::Input, lines.where(word), fmt::format("the type {}", in_quotes(word.text)),
              "PLY has char, uchar, short, ushort, int, uint, float, double, and int8 ... float64");
}

[[noreturn]] void bad_header(const TextLines& lines, std::string_view wanted) {
  throw Error(Blame::Input, lines.where(), "this line of the PLY header cannot be read",
              fmt::format("wanted is {}", wanted));
}

void read_header_line(const TextLines& lines, Header& header, bool& has_format) {
  const auto& words = lines.words();
  const std::string_view keyword = words[0].text;
  if (keyword == "format") {
    const auto encoding = words.size() >= 2 ? ply_encoding(words[1].text) : std::nullopt;
    const bool other_version = words.size() > 2 && words[2].text != "1.0" && words[2].text != "1";
    if (!encoding || other_version)
      bad_header(lines, "format ascii, binary_little_endian or binary_big_endian, and 1.0");
    header.encoding = *encoding;
    has_format = true;
  } else if (keyword == "element") {
    std::int64_t count = 0;
    if (words.size() != 3 || !parse_whole(words[2].text, count) || count < 0) {
      bad_header(lines, "element NAME COUNT");
    }
    header.elements.push_back({std::string(words[1].text), static_cast<std::uint64_t>(count), {}});
  } else if (keyword == "property") {
    const bool list = words.size() == 5 && words[1].text == "list";
    if ((!list && words.size() != 3) || header.elements.empty()) {
      bad_header(lines, "property TYPE NAME or property list TYPE TYPE NAME, after an element");
    }
    Property property;
    property.name = words.back().text;
    property.type = type_of(lines, words[words.size() - 2]);
    if (list) property.count_type = type_of(lines, words[2]);
    header.elements.back().properties.push_back(std::move(property));
  } else if (keyword != "comment" && keyword != "obj_info" && keyword != "ply") {
    bad_header(lines, "format, element, property, comment or end_header");
  }
}

Header read_header(std::string_view bytes, const std::string& file) {
  constexpr std::string_view last = "end_header";
  // A comment may contain the word; the header's end is a separate line.
  std::size_t end = bytes.find(last);
  while (end != std::string_view::npos && end > 0 && bytes[end - 1] != '\n') {
    end = bytes.find(last, end + 1);
  }
  const std::size_t line_end = end == std::string_view::npos ? end : bytes.find('\n', end);
  if (!bytes.starts_with("ply") || line_end == std::string_view::npos) {
    throw Error(Blame::Input, base::Location{file}, "not a PLY file",
                "it begins with \"ply\" and has a line \"end_header\"");
  }
  Header header;
  header.bytes = line_end + 1;
  TextLines lines(bytes.substr(0, end), file, TextLines::Style::Plain);
  bool has_format = false;
  while (lines.next()) read_header_line(lines, header, has_format);
  for (const char c : bytes.substr(0, header.bytes)) header.lines += c == '\n' ? 1 : 0;
  if (!has_format) throw Error(Blame::Input, base::Location{file}, "the PLY header has no format");
  return header;
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::filesystem::path& path, const Header& header,
            VertexNormals normals)
      : values_(bytes.substr(header.bytes), path.string(), header.encoding, header.lines),
        reads_normals_(has_normals(header)),
        shaped_by_normals_(normals == VertexNormals::Shape) {
    mesh_.path = path;
    mesh_.part_sets.emplace_back();
  }

  Mesh read(const Header& header) {
    for (const Element& element : header.elements) {
      // Each entry has at least one byte, so that an impossible count is detected before memory is
      // allocated.
      if (element.count > values_.bytes_left() && !element.properties.empty()) {
        throw Error(Blame::Input, values_.where(),
                    fmt::format("the header announces {} of {}, more than the file holds",
                                element.count, in_quotes(element.name)));
      }
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        element.name == "vertex"       ? read_vertex(element)
        : element.name == "face"       ? read_face(element)
        : element.name == strips_named ? read_strips(element)
                                       : pass_over(element);
      }
      count_unused(element);
    }
    if (values_.has_more()) {
      const Element none, &last = header.elements.empty() ? none : header.elements.back();
      throw Error(Blame::Input, values_.where(), "the file goes on behind its last number",
                  fmt::format("the header ends with {} of {}", last.count, in_quotes(last.name)),
                  "Mend the header's counts, or take away what follows");
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] static bool is_position(const Property& property) {
    return !property.count_type && property.name.size() == 1 && property.name[0] >= 'x' &&
           property.name[0] <= 'z';
  }

  [[nodiscard]] static bool has_normals(const Header& header) {
    return std::any_of(header.elements.begin(), header.elements.end(), [](const Element& element) {
      return element.name == "vertex" &&
             std::any_of(element.properties.begin(), element.properties.end(), is_normal);
    });
  }

  [[nodiscard]] static bool is_normal(const Property& property) {
    return !property.count_type && property.name.size() == 2 && property.name[0] == 'n' &&
           property.name[1] >= 'x' && property.name[1] <= 'z';
  }

  [[nodiscard]] static bool is_corners(const Property& property) {
    return property.count_type &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  // Edges, colours and other elements.
  void count_unused(const Element& element) {
    if (element.count == 0) return;
    const bool of_vertex = element.name == "vertex";
    const bool of_face = element.name == "face" || element.name == strips_named;
    if (!of_vertex && !of_face) mesh_.unused[element.name] += element.count;
    for (const Property& property : element.properties) {
      const bool shapes = shaped_by_normals_ && is_normal(property);
      const bool unused =
          of_vertex ? !is_position(property) && !shapes : of_face && !is_corners(property);
      if (unused) mesh_.unused[property.name] += element.count;
    }
  }

  void read_vertex(const Element& element) {
    Vec3 position(std::nan(""));
    glm::vec3 normal(0.0F);
    for (const Property& property : element.properties) {
      if (is_normal(property)) {
        normal[property.name[1] - 'x'] = static_cast<float>(values_.next(property.type));
        continue;
      }
      if (!is_position(property)) {
        pass_over(property);
        continue;
      }
      const double x = values_.next(property.type);
      if (!(std::abs(x) <= largest_coordinate)) {
        throw Error(Blame::Input, values_.where(),
                    fmt::format("vertex {} at {}", mesh_.vertices.size(), x),
                    fmt::format("coordinates are finite and at most {}", largest_coordinate));
      }
      position[property.name[0] - 'x'] = x;
    }
    if (std::isnan(position.x + position.y + position.z)) {
      throw Error(Blame::Input, values_.where(), "the vertices have no x, y or z",
                  "element vertex has properties x, y and z");
    }
    mesh_.vertices.push_back(position);
    if (reads_normals_) mesh_.normals.push_back(normal);
  }

  void read_face(const Element& element) {
    for (const Property& property : element.properties) {
      if (!is_corners(property)) {
        pass_over(property);
        continue;
      }
      const double count = values_.next(*property.count_type);
      if (!(count >= 3.0 && count <= static_cast<double>(max_polygon_corners))) {
        throw Error(Blame::Input, values_.where(), fmt::format("a face of {} corners", count),
                    fmt::format("a face has from 3 to {}", max_polygon_corners));
      }
      corners_.clear();
      for (int k = 0; k < static_cast<int>(count); ++k)
        corners_.push_back(vertex_index(property.type));
      add_face(corners_);
    }
  }

  template <class Corners>
  void add_face(const Corners& corners) {
    if (mesh_.indices.size() + corners.size() >= no_index) {
      throw Error(Blame::Input, values_.where(), "too many corners", "a mesh has fewer than 2^32");
    }
    add_polygon(mesh_, corners, 0, no_index, values_.line());
    if (reads_normals_) {
      mesh_.normal_indices.insert(mesh_.normal_indices.end(), corners.begin(), corners.end());
    }
  }

  void read_strips(const Element& element) {
    for (const Property& property : element.properties) {
      if (!is_corners(property)) {
        pass_over(property);
        continue;
      }
      const double count = list_length(property);
      std::array<std::uint32_t, 2> last{};
      std::size_t corners_so_far = 0;
      for (double k = 0.0; k < count; k += 1.0) {
        const double index = values_.next(property.type);
        if (begins_strip(index, property.type)) {
          corners_so_far = 0;
          continue;
        }
        const std::uint32_t corner = checked_index(index);
        const auto [a, b] = last;
        const bool flipped = corners_so_far % 2 == 1;
        if (++corners_so_far > 2 && a != b && b != corner && corner != a) {
          add_face(flipped ? std::array{b, a, corner} : std::array{a, b, corner});
        }
        last = {b, corner};
      }
    }
  }

  // Whether an index begins a strip: -1, also as stored in an unsigned type, unless it is a valid
  // vertex.
  [[nodiscard]] bool begins_strip(double index, PlyType type) const {
    const double minus_one = type == PlyType::Uint32   ? 0xFFFFFFFFU
                             : type == PlyType::Uint16 ? 0xFFFFU
                             : type == PlyType::Uint8  ? 0xFFU
                                                       : -1.0;
    return index == minus_one &&
           (index < 0.0 || index >= static_cast<double>(mesh_.vertices.size()));
  }

  std::uint32_t vertex_index(PlyType type) { return checked_index(values_.next(type)); }

  [[nodiscard]] std::uint32_t checked_index(double index) const {
    if (index >= 0.0 && index < static_cast<double>(mesh_.vertices.size()) &&
        index == std::floor(index)) {
      return static_cast<std::uint32_t>(index);
    }
    throw Error(
        Blame::Input, values_.where(), fmt::format("vertex index {} is out of range", index),
        fmt::format("allowed are 0 to the number of vertices before the faces, {}, less one",
                    mesh_.vertices.size()));
  }

  void pass_over(const Element& element) {
    for (const Property& property : element.properties) pass_over(property);
  }

  void pass_over(const Property& property) {
    const double count = property.count_type ? list_length(property) : 1.0;
    for (double k = 0.0; k < count; k += 1.0) values_.next(property.type);
  }

  [[nodiscard]] double list_length(const Property& property) {
    const double count = values_.next(*property.count_type);
    if (count >= 0.0 && count <= 1e9 && count == std::floor(count)) return count;
    throw Error(Blame::Input, values_.where(), fmt::format("a list of {} entries", count),
                "a list has a whole number of entries, up to 1e9");
  }

  PlyValues values_;
  bool reads_normals_, shaped_by_normals_;
  Mesh mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Mesh parse_ply(std::string_view bytes, const std::filesystem::path& path, VertexNormals normals) {
  const Header header = read_header(bytes, path.string());
  return PlyReader(bytes, path, header, normals).read(header);
}

}  // namespace earthshine::scenes
