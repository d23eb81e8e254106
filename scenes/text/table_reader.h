// SPDX-License-Identifier: Apache-2.0
// One table of a scene file, read with checks: every value's type and range, keys that nobody
// knows. Every failure is a base::Error (Input) with the key's place, what was found, what is
// allowed.
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
  bool open_low = false;   // low itself is not allowed
  bool open_high = false;  // high itself is not allowed

  [[nodiscard]] bool holds(double x) const {
    return (open_low ? x > low : x >= low) && (open_high ? x < high : x <= high);
  }
};
inline constexpr Range any_number{};
inline constexpr Range at_least_zero{0.0};
inline constexpr Range above_zero{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range share{0.0, 1.0};
// Lumens, candelas, lux and cd/m^2. Far above any light there is (the Sun's disc: 2e9 cd/m^2), far
// below where the squares and sums of a picture leave the numbers of a float.
inline constexpr Range light_strength{0.0, 1e15};

// Larger lengths than this, in metres or in the file's unit, are slips and not spacecraft.
inline constexpr double largest_length = 1e9;

// Bytes of a name: a light group becomes channels of an EXR file, whose names end at 255.
inline constexpr std::size_t longest_name = 200;

[[nodiscard]] std::string to_string(const Range& range);

class TableReader {
 public:
  // `title` as the user writes it: "[sun]", "[[light]]"; `keys`: all that it may hold.
  TableReader(const TomlNode& node, std::string title, KeyList keys);

  // Narrows the keys, e.g. to those of one type of light.
  void allow_only(KeyList keys, std::string_view of_what) const;

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const TomlEntry* find(std::string_view key) const;

  // Reads the required key "name", and from then on messages say which entry they are about.
  [[nodiscard]] std::string read_name();
  [[nodiscard]] const std::string& label() const { return label_; }
  [[nodiscard]] const base::Location& where() const { return node_.where; }
  // The place of the key, or of the table when it has no such key.
  [[nodiscard]] const base::Location& where(std::string_view key) const;

  // Nothing when the key is absent.
  [[nodiscard]] std::optional<bool> flag(std::string_view key) const;
  [[nodiscard]] std::optional<double> number(std::string_view key, Range range = any_number) const;
  [[nodiscard]] std::optional<int> whole(std::string_view key, int low, int high) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;  // not empty
  [[nodiscard]] std::optional<std::string> name(std::string_view key) const;  // not too long either
  [[nodiscard]] std::optional<std::string> choice(std::string_view key, KeyList choices) const;
  // A number (grey) or [r, g, b].
  [[nodiscard]] std::optional<Rgb> colour(std::string_view key, Range range = light_strength) const;
  // A number, of all three axes, or [x, y, z].
  [[nodiscard]] std::optional<Vec3> scale(std::string_view key, Range range) const;
  [[nodiscard]] std::optional<Vec3> vector(std::string_view key, Range range = any_number) const;
  // Of unit length; zero is refused.
  [[nodiscard]] std::optional<Vec3> direction(std::string_view key) const;
  [[nodiscard]] std::optional<std::vector<Vec3>> points(std::string_view key) const;
  // Scalars and vectors of length, from the file's unit to metres.
  [[nodiscard]] std::optional<double> length(std::string_view key, double unit_m,
                                             Range range) const;
  [[nodiscard]] std::optional<Vec3> position(std::string_view key, double unit_m) const;

  // The value, or an error that says how to give it.
  template <class T>
  [[nodiscard]] T required(std::optional<T> value, std::string_view key,
                           std::string_view example) const {
    if (!value) missing(key, example);
    return *std::move(value);
  }

  [[noreturn]] void missing(std::string_view key, std::string_view example) const;
  // found continues `"key" in [[light]] "name" `.
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

// The tables of [[key]]: none when the key is absent.
[[nodiscard]] std::vector<const TomlNode*> named_entries(const TableReader& root,
                                                         std::string_view key);
// Throws when two of the entries have one name.
void check_unique(std::span<const std::string> names, std::span<const TomlNode* const> entries,
                  std::string_view title);

}  // namespace earthshine::scenes
