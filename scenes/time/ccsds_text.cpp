// SPDX-License-Identifier: Apache-2.0
#include "scenes/time/ccsds_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input/input_file.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t max_ccsds_bytes = std::size_t{256} << 20;
constexpr std::string_view blank = " \t\r\n";
constexpr const char* dates =
    "allowed is 2026-03-01T12:00:00.0 or 2026-060T12:00:00.0, of the years 1972 to 2199";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(blank);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    words.push_back(line.substr(0, line.find_first_of(blank)));
    line.remove_prefix(words.back().size());
  }
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

void check_version(const CcsdsMessage& message, std::string_view kind,
                   const base::Location& where) {
  const bool oem = kind == "OEM";
  for (const std::string_view known : {"1.0", "2.0", "3.0"}) {
    if (message.version == known && (oem || known != "3.0")) return;
  }
  throw Error(Blame::Input, where, fmt::format("{} version {}", kind, in_quotes(message.version)),
              oem ? "allowed are 1.0, 2.0 and 3.0" : "allowed are 1.0 and 2.0");
}

// The first line names the message and its version.
void read_first(CcsdsMessage& message, const CcsdsLine& line, std::string_view kind) {
  const std::string ccsds = fmt::format("CCSDS_{}_VERS", kind);
  const std::string cic = fmt::format("CIC_{}_VERS", kind);
  if (line.key != ccsds && line.key != cic) {
    const std::string found = line.key.empty() ? line.value : line.key;
    throw Error(Blame::Input, line.where, fmt::format("begins with {}", in_quotes(found)),
                fmt::format("an {} begins with {} = 2.0 or, in XML, with <{}>", kind, ccsds,
                            kind == "OEM" ? "oem" : "aem"));
  }
  message.version = line.value;
  message.mjd = line.key == cic;
  check_version(message, kind, line.where);
}

CcsdsMessage read_kvn(std::string_view text, const std::string& file, std::string_view kind) {
  CcsdsMessage message;
  message.file = file;
  bool begun = false;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.starts_with("COMMENT")) continue;
    if (line.find('\0') != std::string_view::npos) {
      throw Error(Blame::Input, base::Location{file, number, 0}, "is no text: it has a NUL byte");
    }
    CcsdsLine read;
    read.where = {file, number, 0};
    const std::size_t equals = line.find('=');
    const auto words = words_of(line);
    if (equals != std::string_view::npos) {
      read.key = trimmed(line.substr(0, equals));
      read.value = trimmed(line.substr(equals + 1));
    } else if (words.size() == 1 && words[0].find_first_of("0123456789") == std::string::npos) {
      read.key = words[0];
    } else {
      read.value = joined(words);
    }
    if (begun) {
      message.lines.push_back(std::move(read));
    } else {
      read_first(message, read, kind);
      begun = true;
    }
  }
  if (!begun) throw Error(Blame::Input, base::Location{file, 0, 0}, "has no lines");
  return message;
}

}  // namespace

CcsdsMessage read_ccsds(const std::filesystem::path& path, std::string_view kind,
                        const base::Location& asked_at) {
  const std::string whole = base::read_input_file(path, max_ccsds_bytes, asked_at);
  std::string_view text = whole;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos || text[first] != '<') {
    return read_kvn(text, path.string(), kind);
  }
  if (kind == "AEM") {
    throw Error(Blame::Input, path.string(), "is an AEM in XML", "an AEM is read as KVN alone",
                "Write it as \"KEY = VALUE\" lines");
  }
  CcsdsMessage message = read_ccsds_xml(text, path.string(), kind);
  check_version(message, kind, {path.string(), 1, 0});
  return message;
}

void CcsdsMeta::add(const CcsdsLine& line, std::vector<std::string>& unknown) {
  if (const CcsdsLine* before = find(line.key)) {
    throw Error(Blame::Input, line.where, fmt::format("{} is there twice", line.key),
                fmt::format("the first is in line {}", before->where.line));
  }
  if (std::find(known_.begin(), known_.end(), line.key) == known_.end() &&
      std::find(unknown.begin(), unknown.end(), line.key) == unknown.end()) {
    unknown.push_back(line.key);
  }
  lines_.push_back(line);
}

const CcsdsLine* CcsdsMeta::find(std::string_view key) const {
  const auto found = std::find_if(lines_.begin(), lines_.end(),
                                  [&](const CcsdsLine& line) { return line.key == key; });
  return found == lines_.end() ? nullptr : &*found;
}

const CcsdsLine& CcsdsMeta::required(std::string_view key) const {
  if (const CcsdsLine* line = find(key)) return *line;
  throw Error(Blame::Input, where_, fmt::format("the metadata that begin here have no {}", key));
}

TimeSystem CcsdsMeta::time_system() const {
  const CcsdsLine& line = required("TIME_SYSTEM");
  if (const auto system = time_system_named(line.value)) return *system;
  throw Error(Blame::Input, line.where, fmt::format("TIME_SYSTEM is {}", in_quotes(line.value)),
              "allowed are " + time_system_names());
}

Instant CcsdsMeta::instant(const CcsdsLine& line, EarthClock clock) const {
  if (const auto read = read_instant(line.value, time_system(), clock)) return *read;
  throw Error(Blame::Input, line.where, fmt::format("{} is {}", line.key, in_quotes(line.value)),
              dates);
}

Frame CcsdsMeta::frame(const CcsdsLine& line) {
  if (const auto frame = frame_named(line.value)) return *frame;
  throw Error(Blame::Input, line.where, fmt::format("{} is {}", line.key, in_quotes(line.value)),
              "allowed are " + frame_names());
}

CcsdsMeta read_meta_of(const CcsdsMessage& message, std::size_t& next,
                       std::vector<std::string_view> known, std::vector<std::string>& unknown) {
  const CcsdsLine& begin = message.lines[next - 1];
  CcsdsMeta meta(begin.where, std::move(known));
  for (; next < message.lines.size(); ++next) {
    const CcsdsLine& line = message.lines[next];
    if (line.key.empty() || line.key == "META_START") break;
    if (line.key == "META_STOP") {
      ++next;
      return meta;
    }
    meta.add(line, unknown);
  }
  fail_cut_off(begin, "META_STOP");
}

void fail_gap(const base::Location& second_row, Instant first, Instant second,
              std::string_view remedy) {
  throw Error(Blame::Input, second_row,
              fmt::format("the row here ends a gap of {:.6g} s from {} to {}", second - first,
                          utc_text(first), utc_text(second)),
              "between two rows the spacecraft may go 36 deg around the Earth",
              std::string(remedy));
}

void fail_cut_off(const CcsdsLine& begin, std::string_view wanted) {
  throw Error(Blame::Input, begin.where,
              fmt::format("{} that begins here has no {}", begin.key, wanted),
              "the file is cut off, or the line is missing");
}

CcsdsRow read_row(const CcsdsLine& line, bool mjd, TimeSystem system, EarthClock clock,
                  std::span<const std::size_t> allowed, std::string_view wanted) {
  const auto words = words_of(line.value);
  const std::size_t date_words = mjd ? 2 : 1;
  std::vector<double> numbers;
  for (std::size_t k = mjd ? 0 : 1; k < words.size(); ++k) {
    const auto number = number_in(words[k]);
    if (!number || !std::isfinite(*number)) {
      throw Error(Blame::Input, line.where, fmt::format("{} is no number", in_quotes(words[k])),
                  fmt::format("a row is a date and {}", wanted));
    }
    numbers.push_back(*number);
  }
  const std::size_t count = words.size() < date_words ? 0 : words.size() - date_words;
  if (std::ranges::find(allowed, count) == allowed.end()) {
    throw Error(Blame::Input, line.where,
                fmt::format("a row with {} numbers behind its date", count),
                fmt::format("a row is a date and {}", wanted));
  }
  const auto at = mjd ? instant_of_mjd(numbers[0], numbers[1], system, clock)
                      : read_instant(words[0], system, clock);
  if (!at) {
    const std::string_view date = mjd ? std::string_view(line.value) : words[0];
    throw Error(Blame::Input, line.where, fmt::format("{} is no date", in_quotes(date)),
                mjd ? "CIC files have a whole Modified Julian Date and seconds of the day" : dates);
  }
  if (mjd) numbers.erase(numbers.begin(), numbers.begin() + 2);
  return {*at, std::move(numbers)};
}

}  // namespace earthshine::scenes
