// SPDX-License-Identifier: Apache-2.0
// CCSDS navigation messages (OEM: CCSDS 502.0-B, AEM: 504.0-B) as lines, whatever they are written
// in: "KEY = VALUE" text (KVN), XML (505.0-B), or the form of CIC, whose dates are a Modified
// Julian Date and seconds of the day.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scenes/time/astronomy.h"

namespace earthshine::scenes {

struct CcsdsLine {
  std::string key;    // empty: a row of data; META_START and its like have no value
  std::string value;  // of a row: its words with single blanks between
  base::Location where;
};

struct CcsdsMessage {
  std::string file;
  std::string version;           // "2.0"
  bool mjd = false;              // CIC: two words for a date
  std::vector<CcsdsLine> lines;  // in the order of the file, without comments
};

// kind: "OEM" or "AEM". An XML file gives the lines of the same message in KVN; of an AEM it is
// refused. Throws base::Error (Input) with file and line for text that is neither, for another
// message or version, and for XML that ends before its elements are closed.
[[nodiscard]] CcsdsMessage read_ccsds(const std::filesystem::path& path, std::string_view kind,
                                      const base::Location& asked_at);

// The lines of an XML message, after its header's; sets the version.
[[nodiscard]] CcsdsMessage read_ccsds_xml(std::string_view text, const std::string& file,
                                          std::string_view kind);

// The metadata of a segment, by keyword.
class CcsdsMeta {
 public:
  // known: all keywords that the standard has; the others are collected in `unknown`.
  CcsdsMeta(base::Location where, std::vector<std::string_view> known)
      : where_(std::move(where)), known_(std::move(known)) {}
  void add(const CcsdsLine& line, std::vector<std::string>& unknown);

  [[nodiscard]] const base::Location& where() const { return where_; }
  [[nodiscard]] const CcsdsLine* find(std::string_view key) const;
  [[nodiscard]] const CcsdsLine& required(std::string_view key) const;
  [[nodiscard]] TimeSystem time_system() const;
  [[nodiscard]] Instant instant(const CcsdsLine& line, EarthClock clock) const;
  // A reference frame that is known, or an error with the list.
  [[nodiscard]] static Frame frame(const CcsdsLine& line);

 private:
  base::Location where_;
  std::vector<std::string_view> known_;
  std::vector<CcsdsLine> lines_;
};

// A row: its moment and its numbers.
struct CcsdsRow {
  Instant at;
  std::vector<double> numbers;
};
// wanted: "X Y Z X_DOT Y_DOT Z_DOT", for messages. Throws for words that are no finite numbers, for
// fewer than `least` or more than `most` of them, and for what is no date of that time system.
[[nodiscard]] CcsdsRow read_row(const CcsdsLine& line, bool mjd, TimeSystem system,
                                EarthClock clock, std::size_t least, std::size_t most,
                                std::string_view wanted);

}  // namespace earthshine::scenes
