// SPDX-License-Identifier: Apache-2.0
// The orbit as text and as a drawing: the Earth, the Sun and the bay's axis at four positions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/sections.h"
#include "app/report/text.h"
#include "app/study/words.h"
#include "base/units.h"

namespace earthshine::app {
namespace {

// Seen from the orbit's north, so that motion is counterclockwise; the Sun is at the left. SVG
// units, not to scale.
constexpr double centre_x = 180.0, centre_y = 108.0, earth_radius = 40.0, orbit_radius = 62.0;
constexpr double arrow = 26.0;

struct Point {
  double x, y;
};

Point on_orbit(double position_deg, double radius) {
  const double phi = base::radians(position_deg);
  return {centre_x - radius * std::cos(phi), centre_y + radius * std::sin(phi)};
}

// An arc of the orbit from `from` to `to` along the motion.
std::string arc(double from_deg, double to_deg) {
  const Point from = on_orbit(from_deg, orbit_radius), to = on_orbit(to_deg, orbit_radius);
  return fmt::format("M{:.1f} {:.1f}A{} {} 0 {} 0 {:.1f} {:.1f}", from.x, from.y, orbit_radius,
                     orbit_radius, to_deg - from_deg > 180.0 ? 1 : 0, to.x, to.y);
}

// Direction of the bay's axis. Components out of the orbital plane: a dot toward the reader, a
// cross away.
std::string axis(const BayAxis& bay) {
  const double phi = base::radians(bay.position_deg);
  const Point at = on_orbit(bay.position_deg, orbit_radius);
  const double dx = arrow * (-bay.zenith * std::cos(phi) + bay.forward * std::sin(phi));
  const double dy = arrow * (bay.zenith * std::sin(phi) + bay.forward * std::cos(phi));
  std::string svg =
      fmt::format("<circle class=\"craft\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>", at.x, at.y);
  if (std::hypot(dx, dy) > 0.3 * arrow) {
    return svg + fmt::format(
                     "<path class=\"bay\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}\" "
                     "marker-end=\"url(#bay-tip)\"/>",
                     at.x, at.y, dx, dy);
  }
  if (bay.normal > 0.0) {
    return svg +
           fmt::format("<circle class=\"bay\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", at.x, at.y);
  }
  return svg + fmt::format("<path class=\"bay\" d=\"M{:.1f} {:.1f}m-7 -7l14 14m0 -14l-14 14\"/>",
                           at.x, at.y);
}

std::string drawing(const OrbitEntry& orbit) {
  const auto label = [](double x, double y, const char* anchor, const char* text) {
    return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>", x, y, anchor, text);
  };
  std::string svg =
      "<svg role=\"img\" viewBox=\"0 14 360 188\" aria-label=\"The Earth with the Sun at the left, "
      "the orbit, and the direction out of the bay at four positions\">"
      "<defs>";
  for (const char* id : {"tip", "bay-tip"}) {
    svg += fmt::format(
        "<marker id=\"{}\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" "
        "markerHeight=\"8\" markerUnits=\"userSpaceOnUse\" orient=\"auto\">"
        "<path d=\"M0 0L8 4L0 8z\"/></marker>",
        id);
  }
  svg += "</defs>";
  svg += "<circle class=\"sun\" cx=\"14\" cy=\"108\" r=\"11\"/>" + label(14, 136, "middle", "Sun");
  for (const int y : {98, 108, 118}) {
    svg += fmt::format("<path class=\"ray\" d=\"M30 {}h34\" marker-end=\"url(#tip)\"/>", y);
  }
  svg += fmt::format(
      "<circle class=\"earth\" cx=\"{0}\" cy=\"{1}\" r=\"{2}\"/>"
      "<path class=\"night\" d=\"M{0} {3}a{2} {2} 0 0 1 0 {4}z\"/>"
      "<circle class=\"way\" cx=\"{0}\" cy=\"{1}\" r=\"{5}\"/>",
      centre_x, centre_y, earth_radius, centre_y - earth_radius, 2.0 * earth_radius, orbit_radius);
  for (const auto& [from, to] : orbit.umbra_deg) {
    svg += fmt::format("<path class=\"shadow\" d=\"{}\"/>", arc(from, std::min(to, from + 359.9)));
  }
  svg += fmt::format("<path class=\"way\" d=\"{}\" marker-end=\"url(#tip)\"/>", arc(25.0, 52.0));
  for (const BayAxis& bay : orbit.bay) svg += axis(bay);
  return svg + label(110, 134, "end", "0° noon") +
         label(180, 196, "middle", "90° evening terminator") +
         label(250, 134, "start", "180° midnight") +
         label(180, 28, "middle", "270° morning terminator") + "</svg>";
}

std::string attitude_words(const std::string& attitude) {
  if (attitude == "bay-to-earth") return "the bay faces the Earth, nose forward";
  if (attitude == "bay-to-space") return "the bay faces away from the Earth, nose forward";
  if (attitude == "tail-down") return "the tail points to the Earth, the bay faces forward";
  if (attitude == "bay-to-sun")
    return "the bay faces the Sun, the nose points to the orbit’s north";
  return attitude == "table" ? "from a table of attitudes" : escaped(attitude);
}

std::string in_words(const OrbitEntry& orbit) {
  std::string text =
      "<p>A <strong>position</strong> is the angle along the orbit from orbit noon, in the "
      "direction of flight: 0° noon, 90° the evening terminator below, 180° midnight, 270° the "
      "morning terminator.</p>\n";
  text += "<p><strong>Orbit</strong>: circular, altitude " + figure(orbit.altitude_km) + " km";
  if (orbit.period_s) text += ", one turn in " + figure(*orbit.period_s / 60.0) + " min";
  text +=
      "; beta angle (the Sun’s height over the orbit’s plane) " + figure(orbit.beta_deg) + "°. ";
  text += orbit.umbra_deg.empty()
              ? "The Earth never hides all of the Sun."
              : "The Earth hides the Sun at " + degrees(arcs_text(orbit.umbra_deg)) + ".";
  text += "</p>\n<p><strong>Attitude</strong>: ";
  if (orbit.inertial_as.empty()) {
    text += attitude_words(orbit.attitude);
  } else {
    text += "fixed among the stars, as at " + figure(orbit.inertial_at_deg) + "°, where " +
            attitude_words(orbit.inertial_as);
  }
  return text + ". Arrows: out of the bay.</p>\n";
}

}  // namespace

std::string orbits_html(const StudyResults& study) {
  std::vector<std::pair<std::string, std::string>> drawn;  // each orbit once, with its scenes
  for (std::size_t k = 0; k < study.scenes.size(); ++k) {
    const std::optional<OrbitEntry>& orbit = study.scenes[k].orbit;
    if (!orbit) continue;
    const std::string html = "<div>" + in_words(*orbit) + "</div>\n" + drawing(*orbit);
    const auto same = std::find_if(drawn.begin(), drawn.end(),
                                   [&](const auto& one) { return one.first == html; });
    const std::string title = escaped(scene_title(study, k));
    if (same == drawn.end()) {
      drawn.emplace_back(html, title);
    } else {
      same->second += ", " + title;
    }
  }
  std::string text;
  for (const auto& [html, scenes] : drawn) {
    text += "<div class=\"orbit\">\n";
    if (drawn.size() > 1) text += "<p class=\"of\">" + scenes + "</p>\n";
    text += html + "\n</div>\n";
  }
  return text;
}

}  // namespace earthshine::app
