// SPDX-License-Identifier: Apache-2.0
// earthshine report: makes report.html again from a study's folder.
#include <memory>
#include <system_error>

#include "app/options.h"
#include "app/output.h"
#include "app/report/page.h"
#include "app/study/results.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

struct ReportCall {
  std::string folder;
  bool plain = false;
};

}  // namespace

StudyResults read_study(const fs::path& folder) {
  const std::string name = (folder / study_file).string();
  std::error_code why, other;
  if (!fs::is_regular_file(name, why)) {
    const bool there = fs::exists(folder, other) || other;
    throw Error(Blame::Input, name,
                "cannot be read" + (!there ? ": there is no folder \"" + folder.string() + "\""
                                    : why  ? ": " + why.message()
                                           : ""),
                "a study's folder has this file",
                "Name the folder given as -o to study visibility, orbit or run");
  }
  return read_results(name, read_json(name, "Run the study again, which writes the file anew"));
}

Command add_report(CLI::App& program) {
  CLI::App* parser = add_subcommand(
      program, "report", "Draw a study's report.html anew, from the study.json in its folder");
  const auto call = std::make_shared<ReportCall>();
  parser->add_option("DIR", call->folder, "The study's folder")->type_name("")->required();
  parser->add_flag("--plain", call->plain, "Without the script: no plots, no sliders");
  return {parser, [call](const Common& common) {
            const fs::path folder = call->folder;
            const std::string results = (folder / study_file).string();
            std::error_code ignored;
            if (fs::exists(results, ignored)) {
              check_outputs({(folder / report_file).string()}, {results});
            }
            write_report(folder, read_study(folder), {call->plain, common.quiet});
          }};
}

}  // namespace earthshine::app
