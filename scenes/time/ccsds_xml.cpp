// SPDX-License-Identifier: Apache-2.0
// The subset of XML in CCSDS messages: elements, attributes, text, comments. No document types and
// no custom entities.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"
#include "scenes/time/ccsds_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::string_view xml_blank = " \t\r\n";
constexpr std::size_t most_nested = 32;
constexpr std::array<std::string_view, 10> state_columns = {
    "EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT", "X_DDOT", "Y_DDOT", "Z_DDOT"};
// By order of the derivative (number of dots).
constexpr std::array<std::string_view, 3> state_units = {"km", "km/s", "km/s**2"};

class XmlReader {
 public:
  XmlReader(std::string_view text, const std::string& file, std::string_view kind)
      : text_(text), kind_(kind) {
    message_.file = file;
  }

  CcsdsMessage read() {
    while (at_ < text_.size()) {
      if (text_[at_] != '<') {
        take_text();
      } else if (text_.substr(at_).starts_with("<!--")) {
        skip_to("-->");
      } else if (text_.substr(at_).starts_with("<?")) {
        skip_to("?>");
      } else if (text_.substr(at_).starts_with("<!")) {
        fail("has a document type or CDATA", "plain elements are read");
      } else {
        read_tag();
      }
    }
    if (!open_.empty()) {
      fail(fmt::format("ends inside <{}>: it is cut off", open_.back()), "every element is closed");
    }
    if (message_.version.empty()) {
      fail("has no version", fmt::format("an {} in XML has <{} id=\"CCSDS_{}_VERS\" version="
                                         "\"2.0\">",
                                         kind_, tag(), kind_));
    }
    return std::move(message_);
  }

 private:
  [[nodiscard]] std::string tag() const { return lower_case(std::string(kind_)); }
  [[nodiscard]] base::Location here() const { return {message_.file, line_, 0}; }
  [[noreturn]] void fail(const std::string& found, const std::string& allowed = {}) const {
    throw Error(Blame::Input, here(), found, allowed);
  }

  void advance(std::size_t to) {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
    at_ = to;
  }

  void skip_to(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail("ends inside a comment: it is cut off");
    advance(found + end.size());
  }

  void take_text() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    inside_ += trimmed(text_.substr(at_, end - at_));
    advance(end);
  }

  void read_tag() {
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos) fail("ends inside a tag: it is cut off");
    std::string_view tag = text_.substr(at_ + 1, end - at_ - 1);
    const bool closing = tag.starts_with('/');
    const bool empty = tag.ends_with('/');
    if (closing) tag.remove_prefix(1);
    if (empty) tag.remove_suffix(1);
    const std::string_view name = tag.substr(0, tag.find_first_of(xml_blank));
    if (!closing) open(name, tag.substr(name.size()));
    if (closing || empty) close(name);
    inside_.clear();
    advance(end + 1);
  }

  // The value of an attribute; empty if absent.
  [[nodiscard]] static std::string_view attribute(std::string_view attributes,
                                                  std::string_view name) {
    const std::size_t found = attributes.find(fmt::format("{}=", name));
    if (found == std::string_view::npos) return {};
    attributes.remove_prefix(found + name.size() + 1);
    if (attributes.empty()) return {};
    const std::size_t end = attributes.find(attributes[0], 1);
    return end == std::string_view::npos ? std::string_view() : attributes.substr(1, end - 1);
  }

  void open(std::string_view name, std::string_view attributes) {
    if (open_.size() == most_nested) fail("has too many elements inside each other");
    open_.emplace_back(name);
    if (name == tag()) {
      message_.version = attribute(attributes, "version");
    } else if (name == "metadata") {
      message_.lines.push_back({"META_START", {}, here()});
    } else if (name == "covarianceMatrix") {
      skipped_ = open_.size();
    } else if (name == "stateVector") {
      state_ = {};
    } else if (inside("stateVector")) {
      check_unit(name, attribute(attributes, "units"));
    }
  }

  void check_unit(std::string_view name, std::string_view unit) const {
    if (unit.empty() || name == "EPOCH") return;
    const std::size_t dots = name.ends_with("_DDOT") ? 2 : name.ends_with("_DOT") ? 1 : 0;
    if (unit == state_units[dots]) return;
    fail(fmt::format("{} is in {}", name, in_quotes(unit)),
         fmt::format("an OEM has {}", state_units[dots]));
  }

  [[nodiscard]] bool inside(std::string_view name) const {
    return std::find(open_.begin(), open_.end(), name) != open_.end();
  }

  void close(std::string_view name) {
    if (open_.empty() || open_.back() != name) {
      fail(fmt::format("</{}> closes <{}>", name, open_.empty() ? "nothing" : open_.back()));
    }
    if (skipped_ == 0) end_element(name);
    if (skipped_ == open_.size()) skipped_ = 0;
    open_.pop_back();
  }

  void end_element(std::string_view name) {
    if (name == "metadata") {
      message_.lines.push_back({"META_STOP", {}, here()});
    } else if (name == "stateVector") {
      end_state();
    } else if (inside("stateVector")) {
      const auto column = std::find(state_columns.begin(), state_columns.end(), name);
      if (column == state_columns.end()) fail(fmt::format("<{}> in a state vector", name));
      state_[static_cast<std::size_t>(column - state_columns.begin())] = inside_;
    } else if (inside("metadata") && !inside_.empty() && name != "COMMENT") {
      message_.lines.push_back({std::string(name), inside_, here()});
    }
  }

  // An empty column before the last one leaves too few words, which read_row reports.
  void end_state() {
    std::string row;
    for (const std::string& word : state_) {
      if (!word.empty()) row += (row.empty() ? "" : " ") + word;
    }
    message_.lines.push_back({{}, row, here()});
  }

  std::string_view text_, kind_;
  CcsdsMessage message_;
  std::size_t at_ = 0, skipped_ = 0;  // depth of the skipped element; 0: none
  int line_ = 1;
  std::vector<std::string> open_;
  std::string inside_;
  std::array<std::string, state_columns.size()> state_;
};

}  // namespace

CcsdsMessage read_ccsds_xml(std::string_view text, const std::string& file, std::string_view kind) {
  return XmlReader(text, file, kind).read();
}

}  // namespace earthshine::scenes
