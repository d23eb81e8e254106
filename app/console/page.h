// SPDX-License-Identifier: Apache-2.0
// console.html: layers, masks and settings of all cameras in one page without network access.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/console/layers.h"

namespace earthshine::app {

// Maximum size in bytes; browsers open larger pages slowly.
inline constexpr std::size_t most_page_bytes = 30'000'000;

// A page without its data. The hash is of the script, the only one that may run.
struct PageParts {
  std::string title, style;
  std::string_view body, script, script_hash;
  bool connects = false;  // to the server that gave the page; otherwise to nothing
};
// blobs: base64, in elements "b0", "b1" ... of the page.
[[nodiscard]] std::string page_of(const PageParts& parts, const Json& data,
                                  const std::vector<std::string>& blobs);

class ConsolePage {
 public:
  // set: changes of the scene's keys. layers_folder: folder of the layers' EXR files, for the
  // commands that the page shows; empty: none.
  ConsolePage(const StudyPart& part, const std::vector<std::string>& set, std::string layers_folder,
              const Common& common);

  void add(const ConsoleView& view);
  // Lamp settings and verdicts of a finished study (app/console/study_folder.h).
  void add_study(Json study) { data_["study"] = std::move(study); }
  [[nodiscard]] std::string html() const;

 private:
  // Returns the name of the element that stores the bytes; empty for no bytes.
  [[nodiscard]] std::string stored(const std::string& bytes);
  [[nodiscard]] Json json_of(const studies::SightTarget& target);

  const StudyPart& part_;
  const Common& common_;
  Json data_;
  std::vector<std::string> blobs_;  // base64
};

}  // namespace earthshine::app
