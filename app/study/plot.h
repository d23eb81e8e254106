// SPDX-License-Identifier: Apache-2.0
// Plots by gnuplot: a script with its data, run in a separate process. The only user of gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::app {

// Name of its package, for messages.
inline constexpr const char* plot_package = "gnuplot-nox";

// Any text as a literal gnuplot string: in single quotes, inside which gnuplot processes neither
// escapes nor commands, without control characters or invalid UTF-8.
[[nodiscard]] std::string plot_text(std::string_view text);

// A point of a plot; no error bar if low = high.
struct PlotPoint {
  double x = 0.0, y = 0.0, low = 0.0, high = 0.0;
};
struct PlotCurve {
  std::string title;
  std::string style;              // gnuplot syntax: "with lines lw 2 lc rgb '#888888'"
  std::vector<PlotPoint> points;  // positive, for logarithmic axes
  bool bars = false;              // error bars below the points
};
struct PlotPanel {
  std::string title, x_label, y_label;
  std::vector<PlotCurve> curves;
  bool legend = true;
};

// A script that writes the SVG file `picture` (a plain file name) beside itself: `across` panels
// per row, both axes logarithmic. Panels without points are labelled.
[[nodiscard]] std::string plot_script(const std::string& picture,
                                      const std::vector<PlotPanel>& panels, int across);

// Runs gnuplot in `folder` on its files `scripts`. Returns "" or the reason of a failure, as a
// sentence; does not throw, because the results do not need the plots.
[[nodiscard]] std::string draw_plots(const std::filesystem::path& folder,
                                     const std::vector<std::string>& scripts);

}  // namespace earthshine::app
