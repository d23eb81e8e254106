// SPDX-License-Identifier: Apache-2.0
// earthshine merge: repeats the call whose parts are in a folder, with all results found there.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "app/console.h"
#include "app/options.h"
#include "app/parts/part.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

struct MergeCall {
  std::string folder;
  bool json = false;
};

namespace fs = std::filesystem;

// Whether existing input files of the call are in the other folder too. Files after an option may
// be outputs and are ignored.
bool has_inputs_of(const PartsRecord& record, const fs::path& other) {
  for (std::size_t k = 0; k < record.arguments.size(); ++k) {
    if (k > 0 && record.arguments[k - 1].starts_with('-')) continue;
    std::error_code none;
    if (!fs::exists(record.folder / record.arguments[k], none)) continue;
    if (!fs::exists(other / record.arguments[k], none)) return false;
  }
  return true;
}

// The record of a folder that may have been renamed or copied, alone or with the folder of the
// call: returns the call to be made now, for this folder.
PartsRecord record_here(const fs::path& folder) {
  PartsRecord record = read_parts_record(folder);
  const auto [word, from] = output_in(record.arguments);
  if (word == nullptr) return record;
  std::error_code ignored;
  const fs::path own = fs::canonical(folder);
  const bool in_points = own.filename() == points_folder;
  const bool study = in_points || fs::exists(own / points_folder / parts_file, ignored);
  fs::path named = word->substr(from);
  if (!study) named += ".parts";
  if (!named.has_filename()) named = named.parent_path();  // "d/"
  fs::path here = in_points ? own.parent_path() : own;
  if (fs::equivalent(record.folder / named, here, ignored)) return record;
  const std::string tail = "/" + named.lexically_normal().string();
  if (named.is_relative() && here.string().ends_with(tail)) {
    const std::string around = here.string().substr(0, here.string().size() - tail.size());
    if (has_inputs_of(record, around)) {
      record.folder = around;
      return record;
    }
  }
  if (!study && here.extension() != ".parts") {
    throw base::Error(base::Blame::Input, folder.string(),
                      "was renamed: it has the parts of " + word->substr(from),
                      "the folder of parts is called as what they make, with .parts behind",
                      "Call it so");
  }
  if (!study) here.replace_extension();
  *word = word->substr(0, from) + here.string();
  return record;
}

// In single quotes if a shell would change the word.
std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_./=:,+@%").find(c) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// File names of the call are relative to its folder.
void go_to(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::current_path(folder, problem);
  if (!problem) return;
  throw base::Error(base::Blame::Input, folder.string(),
                    "is where the call was made, and cannot be gone to: " + problem.message(), {},
                    "Merge on a machine that has that folder");
}

}  // namespace

void refuse_to_merge(const fs::path& folder, const std::vector<MissingWork>& missing) {
  const PartsRecord record = record_here(folder);
  std::map<std::size_t, std::vector<std::string>> by_part;
  for (const MissingWork& one : missing) by_part[one.part].push_back(one.what);
  std::vector<std::string> words;
  for (const std::string& word : record.arguments) words.push_back(shell_word(word));
  for (const auto& [part, what] : by_part) {
    note(fmt::format("missing: part {}: {}{}", part, what.front(),
                     what.size() > 1 ? fmt::format(" and {} more", what.size() - 1) : ""));
    note(fmt::format("  earthshine {} --part {}/{}", fmt::join(words, " "), part,
                     std::max<std::size_t>(1, record.parts)));
  }
  throw base::Error(base::Blame::Work, folder.string(), "is not complete", {},
                    fmt::format("Run the missing parts in {}, then merge again",
                                shell_word(record.folder.string())));
}

Command add_merge(CLI::App& program, const RunCall& run_call) {
  CLI::App* parser = add_subcommand(
      program, "merge",
      "What the parts of a call (--part) have left, as one process would have written it");
  const auto call = std::make_shared<MergeCall>();
  parser
      ->add_option("DIR", call->folder,
                   "Folder of the parts: OUTPUT.parts of render, the study's own of a study")
      ->required()
      ->type_name("");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call, run_call](const Common& common) {
            const PartsRecord record = record_here(call->folder);
            go_to(record.folder);
            std::vector<std::string> arguments = record.arguments;
            arguments.insert(arguments.end(), {"--part", "merge"});
            if (call->json) arguments.emplace_back("--json");
            if (common.quiet) arguments.emplace_back("--quiet");
            if (common.threads > 0) {
              arguments.insert(arguments.end(), {"--threads", std::to_string(common.threads)});
            }
            common.progress->end();  // the call has a line of its own
            run_call(arguments);
          }};
}

}  // namespace earthshine::app
