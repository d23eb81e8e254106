// SPDX-License-Identifier: Apache-2.0
// Reader of one table of a scene file. Checks every value's type and range and rejects unknown
// keys. Every failure is a base::Error (Input) with the key's place, the value found and the
// allowed values.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "scenes/text/toml_file.h"

namespace earthshine::scenes {

using KeyList = std::span<const std::string_view>;

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;   // excludes low itself
  bool open_high = false;  // excludes high itself

  [[nodiscard]] bool holds(double x) const {
    return (open_low ? x > low : x >= low) && (open_high ? x < high : x <= high);
  }
};
inline constexpr Range any_number{};
inline constexpr Range at_least_zero{0.0};
inline constexpr Range above_zero{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range share{0.0, 1.0};
// Lumens, candelas, lux and cd/m^2. Far above any real light (the Sun's disc: 2e9 cd/m^2), far
// below the overflow of a picture's squares and sums in float.
inline constexpr Range light_strength{0.0, 1e15};

// Larger lengths, in metres or in the file's unit, are errors.
inline constexpr double largest_length = 1e9;

// Bytes of a name. A light group becomes channels of an EXR file, whose names have at most 255
// bytes.
inline constexpr std::size_t longest_name = 200;

[[nodiscard]] std::string to_string(const Range& range);

class TableReader {
 public:
  // `title` as the user writes it: "[sun]", "[[light]]"; `keys`: all permitted keys.
  TableReader(const TomlNode& node, std::string title, KeyList keys);

  // Restricts the permitted keys, e.g. to the keys of one type of light.
  void allow_only(KeyList keys, std::string_view of_what) const;

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const TomlEntry* find(std::string_view key) const;

  // Reads the required key "name"; later messages contain the name.
  [[nodiscard]] std::string read_name();
  [[nodiscard]] const std::string& label() const { return label_; }
  [[nodiscard]] const base::Location& where() const { return node_.where; }
  // Place of the key, or of the table if the key is absent.
  [[nodiscard]] const base::Location& where(std::string_view key) const;

  // No value if the key is absent.
  [[nodiscard]] std::optional<bool> flag(std::string_view key) const;
  [[nodiscard]] std::optional<double> number(std::string_view key, Range range = any_number) const;
  [[nodiscard]] std::optional<int> whole(std::string_view key, int low, int high) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;  // not empty
  [[nodiscard]] std::optional<std::string> name(std::string_view key) const;  // limited length
  [[nodiscard]] std::optional<std::string> choice(std::string_view key, KeyList choices) const;
  // A number (grey) or [r, g, b].
  [[nodiscard]] std::optional<Rgb> colour(std::string_view key, Range range = light_strength) const;
  // A number for all three axes, or [x, y, z].
  [[nodiscard]] std::optional<Vec3> scale(std::string_view key, Range range) const;
  [[nodiscard]] std::optional<Vec3> vector(std::string_view key, Range range = any_number) const;
  // Normalised; zero is an error.
  [[nodiscard]] std::optional<Vec3> direction(std::string_view key) const;
  [[nodiscard]] std::optional<std::vector<Vec3>> points(std::string_view key) const;
  // Scalar lengths, converted from the file's unit to metres.
  [[nodiscard]] std::optional<double> length(std::string_view key, double unit_m,
                                             Range range) const;
  [[nodiscard]] std::optional<Vec3> position(std::string_view key, double unit_m) const;

  // The value, or an error with an example.
  template <class T>
  [[nodiscard]] T required(std::optional<T> value, std::string_view key,
                           std::string_view example) const {
    if (!value) missing(key, example);
    return *std::move(value);
  }

  [[noreturn]] void missing(std::string_view key, std::string_view example) const;
  // found continues the text `"key" in [[light]] "name" `.
  [[noreturn]] void fail(std::string_view key, std::string_view found,
                         std::string_view allowed = {}, std::string_view remedy = {}) const;

 private:
  [[nodiscard]] std::optional<Vec3> one_or_three(std::string_view key, Range range,
                                                 std::string_view wanted) const;
  [[nodiscard]] Vec3 three(const TomlEntry& entry, const TomlNode& node, Range range,
                           std::string_view wanted) const;
  [[nodiscard]] double checked(const TomlEntry& entry, const TomlNode& node, Range range,
                               std::string_view wanted) const;

  const TomlNode& node_;
  const TomlTable* table_ = nullptr;
  std::string label_;
};

// The tables of [[key]]; empty if the key is absent.
[[nodiscard]] std::vector<const TomlNode*> named_entries(const TableReader& root,
                                                         std::string_view key);
// Throws if two entries have the same name.
void check_unique(std::span<const std::string> names, std::span<const TomlNode* const> entries,
                  std::string_view title);

}  // namespace earthshine::scenes
