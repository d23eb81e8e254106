// SPDX-License-Identifier: Apache-2.0
// earthshine merge: the call whose parts a folder holds, once more, with all work found there.
#include <filesystem>
#include <memory>

#include "app/options.h"
#include "app/parts/part.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

struct MergeCall {
  std::string folder;
  bool json = false;
};

// File names of the call are read where it was made.
void go_to(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::current_path(folder, problem);
  if (!problem) return;
  throw base::Error(base::Blame::Input, folder.string(),
                    "is where the call was made, and cannot be gone to: " + problem.message(), {},
                    "Merge on a machine that has that folder");
}

}  // namespace

Command add_merge(CLI::App& program, const RunCall& run_call) {
  CLI::App* parser = program.add_subcommand(
      "merge", "What the parts of a call (--part) have left, as one process would have written it");
  const auto call = std::make_shared<MergeCall>();
  parser
      ->add_option(
          "DIR", call->folder,
          "Folder of the parts: OUTPUT.parts of render and degrade, the study's own of a study")
      ->required()
      ->type_name("");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call, run_call](const Common& common) {
            const PartsRecord record = read_parts_record(call->folder);
            go_to(record.folder);
            std::vector<std::string> arguments = record.arguments;
            arguments.insert(arguments.end(), {"--part", "merge"});
            if (call->json) arguments.emplace_back("--json");
            if (common.quiet) arguments.emplace_back("--quiet");
            if (common.threads > 0) {
              arguments.insert(arguments.end(), {"--threads", std::to_string(common.threads)});
            }
            run_call(arguments);
          }};
}

}  // namespace earthshine::app
