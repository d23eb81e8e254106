// SPDX-License-Identifier: Apache-2.0
// console.html: layers, masks and settings of all cameras in one page that needs no network.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/console/layers.h"

namespace earthshine::app {

// What the page may take in bytes; beyond, browsers open it slowly.
inline constexpr std::size_t most_page_bytes = 30'000'000;

// A page without its data. The hash is of the script, the only one that may run.
struct PageParts {
  std::string title, style;
  std::string_view body, script, script_hash;
};
// blobs: base64, in elements "b0", "b1" ... of the page.
[[nodiscard]] std::string page_of(const PageParts& parts, const Json& data,
                                  const std::vector<std::string>& blobs);

class ConsolePage {
 public:
  // layers_folder: where the layers are as EXR files, for the commands that the page shows; empty:
  // nowhere.
  ConsolePage(const StudyPart& part, const StudyCall& call, std::string layers_folder,
              const Common& common);

  void add(const ConsoleView& view);
  [[nodiscard]] std::string html() const;

 private:
  // The name of the element that has the bytes; empty where there are none.
  [[nodiscard]] std::string stored(const std::string& bytes);

  const StudyPart& part_;
  const Common& common_;
  Json data_;
  std::vector<std::string> blobs_;  // base64
};

}  // namespace earthshine::app
