// SPDX-License-Identifier: Apache-2.0
#include "app/compare/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/compare/tables.h"
#include "app/report/assets.h"
#include "app/report/text.h"
#include "studies/compare/target_differences.h"

namespace earthshine::app {
namespace {

using studies::MethodResult;

constexpr int magnified_to = 512;  // px: small pictures are enlarged by an integer factor

std::string percent(double share) { return figure(share, Form::Percent) + " %"; }

std::string findings_html(const studies::Comparison& comparison,
                          const std::vector<std::string>& warnings) {
  std::string html = "<ul>\n";
  for (const std::string& warning : warnings) {
    html += "<li>Found on loading: " + escaped(warning) + "</li>\n";
  }
  for (const std::string& finding : findings(comparison)) {
    html += "<li>" + escaped(finding) + "</li>\n";
  }
  return html + "</ul>\n";
}

std::string methods_html(const studies::Comparison& comparison) {
  std::string html = fmt::format(
      "<div class=\"scroll\"><table>\n<thead><tr><th>method</th><th>RMSE</th><th>bias</th>"
      "<th>off by more than ×{}</th><th>CPU s</th></tr></thead>\n<tbody>\n",
      studies::misleading_factor);
  for (const MethodResult& result : comparison.methods) {
    html += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:+.2f} %</td><td>{}</td><td>{}</td></tr>\n",
        escaped(result.method.name), percent(result.error.error), 100.0 * result.error.bias,
        percent(result.off_share), figure(result.cpu_seconds()));
  }
  return html + "</tbody>\n</table></div>\n<p>The reference itself is uncertain by " +
         percent(comparison.reference_noise) + ".</p>\n";
}

std::string legend_html() {
  std::string html = "<ul class=\"legend\">\n";
  const auto add = [&](const studies::Colour& colour, std::string_view label) {
    html += fmt::format(
        "<li><svg width=\"16\" height=\"16\" aria-hidden=\"true\"><rect width=\"16\" height=\"16\" "
        "fill=\"#{:02x}{:02x}{:02x}\" stroke=\"currentColor\"/></svg> {}</li>\n",
        colour[0], colour[1], colour[2], escaped(label));
  };
  for (const studies::DifferenceBand& band : studies::difference_bands)
    add(band.colour, band.label);
  add(studies::difference_sky, "sky, not compared");
  return html + "</ul>\n";
}

std::string pair_html(const MethodResult& result) {
  const base::Image& image = result.frame.image;
  const int times = std::max(1, magnified_to / std::max(image.width, image.height));
  const std::string name = escaped(result.method.name);
  std::string caption = name, pictures;
  for (const std::string& file : picture_files(result.method)) {
    const bool is_difference = !pictures.empty();
    pictures += fmt::format("<img src=\"{}\" alt=\"{}{}\" width=\"{}\" height=\"{}\">\n",
                            escaped(file), name, is_difference ? " over the reference" : "",
                            times * image.width, times * image.height);
    if (!is_difference) continue;
    caption += fmt::format(": RMSE {}, bias {:+.2f} %", percent(result.error.error),
                           100.0 * result.error.bias);
  }
  return "<figure>\n<figcaption>" + caption + "</figcaption>\n<div class=\"beside\">\n" + pictures +
         "</div>\n</figure>\n";
}

}  // namespace

std::vector<std::string> picture_files(const studies::Method& method) {
  std::vector<std::string> files = {method.name + ".png"};
  if (method.name != studies::reference_name) files.push_back("difference-" + files.front());
  return files;
}

std::string page_of(const std::string& scene, const std::string& camera,
                    const std::vector<std::string>& warnings,
                    const studies::Comparison& comparison) {
  const std::string title = escaped(scene) + ", camera " + escaped(camera);
  // Only the pictures beside the page may be loaded; scripts may not run.
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "img-src 'self' file:; style-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}: comparison</title>\n<style>\n{1}\n"
      "figure {{ margin: 1rem 0; }}\n.beside {{ display: flex; flex-wrap: wrap; gap: .5rem; }}\n"
      "img {{ height: auto; image-rendering: pixelated; }}\n"
      "</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>Study compare, by earthshine {2}.</p>\n",
      title, report_style(), EARTHSHINE_VERSION);
  html += findings_html(comparison, warnings) + "<h2>Methods</h2>\n" + methods_html(comparison) +
          "<h2>Pictures</h2>\n<p>Left the picture, all with the reference’s exposure; right its "
          "luminance over the reference’s:</p>\n" +
          legend_html();
  for (const MethodResult& result : comparison.methods) html += pair_html(result);
  return html + "</body>\n</html>\n";
}

}  // namespace earthshine::app
