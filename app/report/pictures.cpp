// SPDX-License-Identifier: Apache-2.0
// Pairs and single pictures, read from the study's folder into the page.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "base/error.h"
#include "base/input/input_file.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1A\n";
constexpr std::uintmax_t largest_bytes = std::uintmax_t{64} << 20U;

// A study's folder may come from someone else: its pictures are in it, and nothing else is read.
void check_inside(const std::string& file) {
  const fs::path path(file);
  const bool climbs = std::find(path.begin(), path.end(), fs::path("..")) != path.end();
  if (file.empty() || path.is_absolute() || climbs) {
    throw Error(Blame::Input, "picture \"" + file + "\"", "is not inside the study's folder",
                "pictures are named from there, without \"..\"");
  }
}

std::string png_bytes(const fs::path& folder, const std::string& file) {
  check_inside(file);
  const fs::path path = folder / file;
  std::string bytes = base::read_input_file(path, largest_bytes, {path.string()});
  if (bytes.compare(0, png_signature.size(), png_signature) != 0) {
    throw Error(Blame::Input, path.string(), "is not a PNG file", "pictures of a report are PNG");
  }
  return bytes;
}

class Album {
 public:
  explicit Album(const fs::path& folder) : folder_(folder) {}
  [[nodiscard]] bool has(const PictureEntry& picture) const { return read_.contains(picture.file); }
  std::string image(const PictureEntry& picture, const std::string& alternative) {
    const auto [entry, added] = read_.try_emplace(picture.file);
    if (added) entry->second = base64(png_bytes(folder_, picture.file));
    return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escaped(alternative),
                       entry->second);
  }

 private:
  const fs::path& folder_;
  std::map<std::string, std::string> read_;
};

// The summary's cells show them beside their reasons; paper has none of them.
std::string thumbnails_html(const StudyResults& study, Album& album) {
  if (study.thumbnails.empty()) return "";
  std::string html = fmt::format(
      "<details class=\"unprinted\">\n<summary>{}: noon, midnight and where a verdict changes, "
      "each "
      "exposed for itself</summary>\n<div class=\"thumbs\">\n",
      counted(study.thumbnails.size(), "condition in small", "conditions in small"));
  for (std::size_t k = 0; k < study.thumbnails.size(); ++k) {
    const ThumbnailEntry& small = study.thumbnails[k];
    const ConditionEntry& condition = study.conditions[small.condition];
    const std::string title = "Camera " + study.cameras[small.camera].name + ", " + condition.name;
    html += fmt::format("<figure id=\"p{}\">", k) + album.image({small.file, {}}, title);
    if (!small.monitor.empty()) {
      html += album.image({small.monitor, {}}, title + ", on the monitor");
    }
    html += "<figcaption>" + escaped(title) + "</figcaption></figure>\n";
  }
  return html + "</div>\n</details>\n";
}

}  // namespace

std::string pictures_html(const StudyResults& study, const fs::path& folder) {
  if (study.pairs.empty() && study.figures.empty() && study.thumbnails.empty()) return "";
  Album album(folder);
  std::string html;
  if (!study.pairs.empty()) html += "<div class=\"pairs\">\n";
  for (const PairEntry& pair : study.pairs) {
    // On paper each picture is there once.
    const bool again = album.has(pair.left) && album.has(pair.right);
    html += std::string(again ? "<figure class=\"pair unprinted\">" : "<figure class=\"pair\">") +
            "\n<figcaption>" + escaped(pair.title) + "</figcaption>\n<div class=\"sides\">\n";
    for (const PictureEntry* side : {&pair.left, &pair.right}) {
      html += "<figure>" + album.image(*side, pair.title + ": " + side->caption) + "<figcaption>" +
              escaped(side->caption) + "</figcaption></figure>\n";
    }
    html += "</div>\n</figure>\n";
  }
  if (!study.pairs.empty()) html += "</div>\n";
  if (!study.figures.empty()) html += "<div class=\"singles\">\n";
  for (const PictureEntry& single : study.figures) {
    html += std::string(album.has(single) ? "<figure class=\"unprinted\">" : "<figure>") +
            album.image(single, single.caption) + "<figcaption>" + escaped(single.caption) +
            "</figcaption></figure>\n";
  }
  if (!study.figures.empty()) html += "</div>\n";
  return html + thumbnails_html(study, album);
}

}  // namespace earthshine::app
