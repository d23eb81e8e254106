// SPDX-License-Identifier: Apache-2.0
// Embeds pictures of the study's folder in the page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/options.h"
#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/words.h"
#include "base/error.h"
#include "base/input/input_file.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1A\n";
constexpr std::uintmax_t largest_bytes = std::uintmax_t{64} << 20U;

// A study's folder may come from someone else: only pictures inside it are read.
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

// "EV 7.3, white at 190 cd/m²" for ISO 100, as for --exposure.
std::string exposure_text(const Number& white_cd_m2) {
  if (!white_cd_m2 || !(*white_cd_m2 > 0.0)) return "";
  return fmt::format("EV {:.1f}, white at {} cd/m²", std::log2(*white_cd_m2 / white_of_ev0),
                     figure(white_cd_m2));
}

// Embeds each picture of the study once, with the common white if there is one.
class Album {
 public:
  Album(const StudyResults& study, const fs::path& folder) : folder_(folder) {
    for (const FigureEntry& picture : study.figures) add(picture);
    for (const PairEntry& pair : study.pairs) {
      for (const PictureEntry* side : {&pair.left, &pair.right})
        add({*side, {}, {}, false, {}, {}, {}});
    }
    for (const PairEntry& pair : study.pairs) {
      for (const PictureEntry* side : {&pair.left, &pair.right}) pictures_[of(*side)].paired = true;
    }
  }

  // Index of a picture.
  [[nodiscard]] std::size_t of(const PictureEntry& picture) const {
    return places_.at(picture.file);
  }

  [[nodiscard]] std::string html() const {
    std::string html;
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      const FigureEntry& picture = pictures_[k].entry;
      const bool twice = !picture.same_file.empty();
      html += fmt::format("<figure id=\"i{}\" class=\"{}{}\">", k,
                          pictures_[k].paired ? "paired" : "", twice ? " twice" : "") +
              image(folder_, picture.file, picture.caption, "own");
      if (twice) {
        html += image(folder_, picture.same_file, picture.caption + ", same exposure", "same");
      }
      html += "<figcaption>" + escaped(picture.caption) + exposure(picture.white_cd_m2, "own") +
              exposure(picture.same_white_cd_m2, "same") + "</figcaption></figure>\n";
    }
    return html;
  }

  static std::string image(const fs::path& folder, const std::string& file,
                           const std::string& alternative, const char* kind) {
    return fmt::format("<img class=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", kind,
                       escaped(alternative), base64(png_bytes(folder, file)));
  }

  static std::string exposure(const Number& white_cd_m2, const char* kind) {
    const std::string text = exposure_text(white_cd_m2);
    return text.empty() ? "" : fmt::format(" <span class=\"ev {}\">{}</span>", kind, text);
  }

 private:
  struct Picture {
    FigureEntry entry;
    bool paired = false;
  };

  void add(const FigureEntry& picture) {
    if (places_.try_emplace(picture.file, pictures_.size()).second) pictures_.push_back({picture});
  }

  const fs::path& folder_;
  std::vector<Picture> pictures_;
  std::map<std::string, std::size_t> places_;
};

// The script shows the two pictures with a slider.
std::string pairs_html(const StudyResults& study, const Album& album) {
  if (study.pairs.empty()) return "";
  std::string html = "<ul class=\"pairs\">\n";
  for (const PairEntry& pair : study.pairs) {
    html += fmt::format(
        "<li data-left=\"i{}\" data-right=\"i{}\"><strong>{}</strong>: <span>{}</span>, "
        "<span>{}</span></li>\n",
        album.of(pair.left), album.of(pair.right), escaped(pair.title), escaped(pair.left.caption),
        escaped(pair.right.caption));
  }
  return html + "</ul>\n";
}

// More thumbnails than this are not printed.
constexpr std::size_t most_printed = 100;

// The cells of the summary show them with their reasons.
std::string thumbnails_html(const StudyResults& study, const fs::path& folder) {
  if (study.thumbnails.empty()) return "";
  std::string html = fmt::format(
      "<details{}>\n<summary>{}: noon, midnight, where a verdict changes and where a target is "
      "missed, each at its own exposure</summary>\n<div class=\"thumbs\">\n",
      study.results.size() > most_printed ? " class=\"unprinted\"" : "",
      counted(study.thumbnails.size(), "condition in small", "conditions in small"));
  for (std::size_t k = 0; k < study.thumbnails.size(); ++k) {
    const ThumbnailEntry& small = study.thumbnails[k];
    const ConditionEntry& condition = study.conditions[small.condition];
    std::string title = "Camera " + study.cameras[small.camera].name + ", " + condition.name;
    if (study.scenes.size() > 1) title += ", " + scene_title(study, condition.scene);
    html += fmt::format("<figure id=\"p{}\">", k) + Album::image(folder, small.file, title, "own");
    if (!small.monitor.empty()) {
      html += Album::image(folder, small.monitor, title + ", on the monitor", "monitor");
    }
    html += "<figcaption>" + escaped(title) + Album::exposure(small.white_cd_m2, "own") +
            "</figcaption></figure>\n";
  }
  return html + "</div>\n</details>\n";
}

}  // namespace

std::string pictures_html(const StudyResults& study, const fs::path& folder) {
  if (study.pairs.empty() && study.figures.empty() && study.thumbnails.empty()) return "";
  const Album album(study, folder);
  const std::string pictures = album.html();
  return pairs_html(study, album) +
         (pictures.empty() ? "" : "<div class=\"singles\">\n" + pictures + "</div>\n") +
         thumbnails_html(study, folder);
}

}  // namespace earthshine::app
