// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/accuracy/report.h"
#include "app/call/memory.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

// Style of a series: the colour shows the method, the marker the parameter that varies.
struct SeriesStyle {
  const char* method;
  const char* series;
  const char* title;
  const char* colour;
  int mark;
};
constexpr SeriesStyle styles[] = {
    {"radiosity", "error", "radiosity, all together", "#1f4e9c", 7},
    {"radiosity", "max_patches", "patches alone", "#3b8bd6", 4},
    {"radiosity", "form_factor_rays", "form-factor rays alone", "#3b8bd6", 6},
    {"radiosity", "gather_rays", "gather rays alone", "#3b8bd6", 8},
    {"radiosity", "camera_samples", "camera samples alone", "#3b8bd6", 10},
    {"direct", "error", "direct light alone", "#777777", 5},
    {"distributed", "distributed_lights", "distributed lights", "#d9731a", 9},
    {"paths", "samples", "paths", "#2c8a3a", 13},
};

std::string style_of(const SeriesStyle& style) {
  return fmt::format("with linespoints lw 1.5 pt {} ps 0.8 lc rgb '{}'", style.mark, style.colour);
}

// In per cent; insignificant errors are drawn at the reference's resolution.
PlotPoint point_at(double x, const studies::PictureError& error, double resolution) {
  const double least = std::max(resolution, 1e-6);
  const auto drawn = [&](double value) { return 100.0 * std::max(value, least); };
  return {x, drawn(error.error), drawn(error.low), drawn(error.high)};
}

template <class Abscissa>
PlotPanel error_panel(const AccuracyResult& result, const std::string& title,
                      const std::string& x_label, Abscissa abscissa) {
  PlotPanel panel{title, x_label, "error of the picture, % of the mean luminance", {}, true};
  PlotCurve front{"Pareto front", "with steps lw 5 lc rgb '#f2c14e'", {}, false};
  for (const std::size_t k : result.findings.front) {
    front.points.push_back(
        point_at(abscissa(result.points[k]), result.points[k].error, result.resolution));
  }
  panel.curves.push_back(front);
  for (const SeriesStyle& style : styles) {
    PlotCurve curve{style.title, style_of(style), {}, true};
    for (const studies::MeasuredStep& point : result.points) {
      if (point.step.method != style.method || point.step.series != style.series) continue;
      const double x = abscissa(point);
      if (x > 0.0) curve.points.push_back(point_at(x, point.error, result.resolution));
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

PlotCurve law_curve(const studies::SeriesLaw& law) {
  constexpr int steps = 40;
  PlotCurve curve{"", "with lines lw 1.5 dt 2 lc rgb '#333333'", {}, false};
  double low = law.points.front().x, high = low;
  for (const studies::ErrorAt& point : law.points) {
    low = std::min(low, point.x);
    high = std::max(high, point.x);
  }
  for (int k = 0; k <= steps; ++k) {
    const double x = low * std::pow(high / low, double(k) / steps);
    const double y = 100.0 * law.law->error_at(x);
    curve.points.push_back({x, y, y, y});
  }
  return curve;
}

PlotPanel law_panel(const AccuracyResult& result, const studies::SeriesLaw& law,
                    const SeriesStyle& style) {
  PlotPanel panel{style.title, law.spent, "error of the setting, %", {}, false};
  if (law.law) {
    panel.title += fmt::format(": x^{:.2f}", -law.law->exponent);
    if (law.law->exponent_error) panel.title += fmt::format(" ± {:.2f}", *law.law->exponent_error);
    if (law.law->floor > 0.0) panel.title += ", floor " + scenes::percent(law.law->floor);
    panel.curves.push_back(law_curve(law));
  }
  PlotCurve curve{
      "", fmt::format("with points pt {} ps 1 lc rgb '{}'", style.mark, style.colour), {}, true};
  for (const studies::MeasuredStep& point : result.points) {
    if (point.step.method != law.method || point.step.series != law.series) continue;
    const double x = studies::spent_on(point).amount;
    if (x > 0.0) curve.points.push_back(point_at(x, point.setting_error, result.resolution));
  }
  panel.curves.push_back(std::move(curve));
  return panel;
}

}  // namespace

std::vector<AccuracyPlot> accuracy_plots(const AccuracyTask& task, const AccuracyResult& result) {
  const std::string where =
      fmt::format("{}, camera {}", task.loaded.scene.name, task.view.camera.name);
  AccuracyPlot seconds{accuracy_plot_stems[0], {}, 2};
  seconds.panels.push_back(
      error_panel(result, where, "CPU seconds, all threads together",
                  [](const studies::MeasuredStep& p) { return p.cost.cpu_seconds; }));
  seconds.panels.push_back(
      error_panel(result, "memory of the same", "MiB, solve and picture",
                  [](const studies::MeasuredStep& p) { return p.cost.memory_bytes / mib; }));
  // The Pareto front is for seconds, not memory; the legend is common.
  seconds.panels.back().legend = false;
  seconds.panels.back().curves.erase(seconds.panels.back().curves.begin());
  AccuracyPlot settings{accuracy_plot_stems[1], {}, 3};
  for (const SeriesStyle& style : styles) {
    for (const studies::SeriesLaw& law : result.findings.laws) {
      if (law.method == style.method && law.series == style.series && law.method != "direct") {
        settings.panels.push_back(law_panel(result, law, style));
      }
    }
  }
  if (settings.panels.empty()) settings.panels.push_back({where, "", "", {}, false});
  return {seconds, settings};
}

}  // namespace earthshine::app
