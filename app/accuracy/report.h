// SPDX-License-Identifier: Apache-2.0
// Text, tables and plots of `study accuracy`.
#pragma once

#include <string>
#include <vector>

#include "app/accuracy/run.h"
#include "app/study/plot.h"

namespace earthshine::app {

// The rows of accuracy.csv and of `points` in the JSON, one per step.
[[nodiscard]] Json accuracy_json(const AccuracyTask& task, const AccuracyResult& result);
[[nodiscard]] std::string accuracy_text(const AccuracyTask& task, const AccuracyResult& result);

// The shell command that renders a step: "earthshine render 'my scene.toml' --camera B ...".
[[nodiscard]] std::string command_of(const AccuracyTask& task, const studies::AccuracyStep& step);

struct AccuracyPlot {
  std::string stem;  // file stem of its script and its picture
  std::vector<PlotPanel> panels;
  int across = 1;
};
[[nodiscard]] std::vector<AccuracyPlot> accuracy_plots(const AccuracyTask& task,
                                                       const AccuracyResult& result);
inline constexpr const char* accuracy_plot_stems[] = {"error-seconds", "error-settings"};

}  // namespace earthshine::app
