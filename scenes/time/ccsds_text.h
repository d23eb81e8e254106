// SPDX-License-Identifier: Apache-2.0
// Reads CCSDS navigation messages (OEM: CCSDS 502.0-B, AEM: 504.0-B) as lines. Supports "KEY =
// VALUE" text (KVN), XML (505.0-B), and CIC's form with dates as a Modified Julian Date and seconds
// of the day.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scenes/time/astronomy.h"

namespace earthshine::scenes {

struct CcsdsLine {
  std::string key;    // empty: a row of data; META_START and similar keys have no value
  std::string value;  // for a row: its words separated by single blanks
  base::Location where;
};

struct CcsdsMessage {
  std::string file;
  std::string version;           // "2.0"
  bool mjd = false;              // CIC: a date has two words
  std::vector<CcsdsLine> lines;  // in file order, without comments
};

// Largest angle around the Earth between two rows between which a message is interpolated.
inline constexpr double largest_gap_rad = base::pi / 5.0;

// Error (Input) for a moment between two rows that are farther apart.
[[noreturn]] void fail_gap(const base::Location& second_row, Instant first, Instant second,
                           std::string_view remedy);

// kind: "OEM" or "AEM". An XML file gives the same lines as the message in KVN; XML is an error for
// an AEM. Throws base::Error (Input) with file and line for other text, another message or version,
// and XML with unclosed elements.
[[nodiscard]] CcsdsMessage read_ccsds(const std::filesystem::path& path, std::string_view kind,
                                      const base::Location& asked_at);

// The lines of an XML message after its header; sets the version.
[[nodiscard]] CcsdsMessage read_ccsds_xml(std::string_view text, const std::string& file,
                                          std::string_view kind);

// Metadata of a segment, by keyword.
class CcsdsMeta {
 public:
  // known: all keywords of the standard; others are collected in `unknown`.
  CcsdsMeta(base::Location where, std::vector<std::string_view> known)
      : where_(std::move(where)), known_(std::move(known)) {}
  void add(const CcsdsLine& line, std::vector<std::string>& unknown);

  [[nodiscard]] const base::Location& where() const { return where_; }
  [[nodiscard]] const CcsdsLine* find(std::string_view key) const;
  [[nodiscard]] const CcsdsLine& required(std::string_view key) const;
  [[nodiscard]] TimeSystem time_system() const;
  [[nodiscard]] Instant instant(const CcsdsLine& line, EarthClock clock) const;
  // A known reference frame, or an error with the list.
  [[nodiscard]] static Frame frame(const CcsdsLine& line);

 private:
  base::Location where_;
  std::vector<std::string_view> known_;
  std::vector<CcsdsLine> lines_;
};

// Reads the metadata whose META_START is the line before `next`, which moves behind META_STOP.
[[nodiscard]] CcsdsMeta read_meta_of(const CcsdsMessage& message, std::size_t& next,
                                     std::vector<std::string_view> known,
                                     std::vector<std::string>& unknown);

// A block of the file that has no end.
[[noreturn]] void fail_cut_off(const CcsdsLine& begin, std::string_view wanted);

// A row of data: time and numbers.
struct CcsdsRow {
  Instant at;
  std::vector<double> numbers;
};
// wanted: "X Y Z X_DOT Y_DOT Z_DOT", for messages. Throws for words that are not finite numbers,
// for another count of numbers than those allowed, and for an invalid date in this time system.
[[nodiscard]] CcsdsRow read_row(const CcsdsLine& line, bool mjd, TimeSystem system,
                                EarthClock clock, std::span<const std::size_t> allowed,
                                std::string_view wanted);

}  // namespace earthshine::scenes
