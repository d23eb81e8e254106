// SPDX-License-Identifier: Apache-2.0
// earthshine study accuracy: the cost of a smaller error, for each method.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/accuracy/report.h"
#include "app/accuracy/run.h"
#include "app/call/memory.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/parts/result_cache.h"
#include "app/study/plot.h"
#include "app/study/study.h"
#include "base/files/output_file.h"
#include "scenes/view/motion.h"
#include "studies/compare/compare.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* table_csv = "accuracy.csv";
constexpr const char* accuracy_file = "accuracy.json";
constexpr std::uint64_t most_lights = 1U << 16U, most_asked_paths = 1U << 20U;

std::vector<std::string> file_names() {
  std::vector<std::string> names = {table_csv, accuracy_file};
  for (const std::string stem : accuracy_plot_stems) {
    names.push_back(stem + ".gp");
    names.push_back(stem + ".svg");
  }
  return names;
}

// The plots' scripts, and their pictures if gnuplot is installed.
void write_plots(const fs::path& folder, const AccuracyTask& task, const AccuracyResult& result) {
  std::vector<std::string> scripts;
  for (const AccuracyPlot& plot : accuracy_plots(task, result)) {
    scripts.push_back(plot.stem + ".gp");
    base::write_text(folder / scripts.back(),
                     plot_script(plot.stem + ".svg", plot.panels, plot.across));
  }
  const std::string problem = draw_plots(folder, scripts);
  if (problem.empty()) return;
  // Removes pictures of earlier runs, which would show other data.
  for (const char* stem : accuracy_plot_stems) {
    std::error_code ignored;
    fs::remove(folder / (std::string(stem) + ".svg"), ignored);
  }
  note(fmt::format("warning: the plots are not drawn: {}; their scripts are in {}: {}", problem,
                   folder.string(), fmt::join(scripts, ", ")));
}

void check_part(const AccuracyCall& call) {
  const bool solves = call.part.task == PartCall::Task::Solve && !call.part.begins;
  if (!solves && (!call.part.in_parts() || call.time_limit_s <= 0.0)) return;
  throw base::Error(base::Blame::Input, "--part",
                    solves ? "a ladder of settings has no solution that all of it reads"
                           : "only one process can say what fits in a time limit",
                    {}, solves ? "Run the parts at once" : "Leave out --time-limit");
}

void run(const AccuracyCall& call, const Common& common) {
  check_part(call);
  LoadedScene loaded = load(call.scene, common.quiet);
  scenes::hold_still(loaded.scene);
  const scenes::Camera& camera = camera_of(call, loaded.scene, common.quiet);
  prepare_folder(call.folder, file_names(), loaded.scene.files);
  refuse_inputs_in(fs::path(call.folder) / points_folder, loaded.scene.files);
  const fs::path folder = call.folder;
  const ResultCache store(folder / points_folder);
  const std::vector<std::string> replaced = studies::replaced_keys(loaded.scene.quality);
  if (!replaced.empty() && !common.quiet) {
    note(
        fmt::format("note: the scene's quality.{} is left out: the study sets it itself; leave it "
                    "out too where you use a setting from here",
                    fmt::join(replaced, ", quality.")));
  }
  const scenes::RayQuery query = ray_query(loaded, {{&camera}}, common.quiet, true);

  std::optional<Interrupt> interrupt(std::in_place);
  studies::AccuracyView view =
      studies::accuracy_view(camera, call.size ? call.size->columns : camera.columns,
                             call.size ? call.size->rows : camera.rows, common.seed);
  view.stop = Interrupt::asked;
  view.while_solving = [](const std::function<void()>& solve) {
    const EndAtOnce nothing_to_keep;
    solve();
  };
  view.fits = [&](double patches, int rays) {
    radiosity::SolveOptions solver = solve_options(loaded.scene, common);
    solver.form_factor_rays = rays;
    return patches_fit(loaded, solver, static_cast<std::size_t>(patches), false);
  };
  const AccuracyTask task{call, common, loaded, query, view, store};
  note_unused_json(call.part, call.json, common.quiet);
  if (call.part.in_parts()) {
    PartCall part = call.part;
    share_accuracy(task, part);
    if (part.task != PartCall::Task::Merge) return;
  }
  const AccuracyResult result = measure_accuracy(task);
  interrupt.reset();  // a signal need not wait for gnuplot
  const Json json = accuracy_json(task, result);
  base::write_text(folder / table_csv, csv_of(json["points"]));
  base::write_text(folder / accuracy_file, dump(json));
  write_plots(folder, task, result);
  print(call.json ? dump(json) : accuracy_text(task, result));
}

std::vector<double> read_errors(const std::string& text) {
  std::vector<double> errors;
  for (const std::string& word : split_at_commas(text)) {
    const auto error = parsed<double>(word);
    if (!error || !(*error >= 1e-4 && *error <= 1.0)) {
      throw CLI::ValidationError("--wanted",
                                 fmt::format("\"{}\" is not an error from 0.0001 to 1", word));
    }
    errors.push_back(*error);
  }
  std::sort(errors.rbegin(), errors.rend());
  errors.erase(std::unique(errors.begin(), errors.end()), errors.end());
  return errors;
}

std::vector<int> read_counts(const std::string& option, const std::string& text,
                             std::uint64_t least, std::uint64_t most) {
  std::vector<int> counts;
  for (const std::string& word : split_at_commas(text)) {
    counts.push_back(static_cast<int>(read_whole_number(option, word, least, most)));
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

}  // namespace

Command add_study_accuracy(CLI::App& study) {
  CLI::App* parser = add_subcommand(
      study, "accuracy", "Cost of a smaller error, by radiosity, distributed lights and paths");
  const auto call = std::make_shared<AccuracyCall>();
  add_study_options(*parser, *call);
  add_part_options(*parser, call->part);
  add_camera_option(*parser, *call);
  const auto list = [parser](const char* name, const std::string& help, auto read) {
    parser->add_option_function<std::string>(name, read, help)->type_name("LIST");
  };
  list("--wanted",
       fmt::format("Errors to find settings for (default {})", fmt::join(call->wanted, ",")),
       [call](const std::string& text) { call->wanted = read_errors(text); });
  list("--lights",
       fmt::format("Numbers of distributed lights (default {})",
                   fmt::join(call->ladder.lights, ",")),
       [call](const std::string& text) {
         call->ladder.lights = read_counts("--lights", text, studies::fewest_lights, most_lights);
       });
  list("--paths",
       fmt::format("Numbers of paths per pixel (default {})", fmt::join(call->ladder.samples, ",")),
       [call](const std::string& text) {
         call->ladder.samples = read_counts("--paths", text, 2, most_asked_paths);
       });
  const auto factor = std::make_shared<std::optional<double>>();
  add_number(*parser, "--reference-factor", *factor, 1.0, 100.0,
             fmt::format("How much finer than the least wanted error the reference is (default {})",
                         call->reference_factor));
  add_time_limit(*parser, call->time_limit_s,
                 "Seconds for the whole study; what does not fit is left out and named");
  return {parser, [call, factor](const Common& common) {
            if (*factor) call->reference_factor = **factor;
            run(*call, common);
          }};
}

}  // namespace earthshine::app
