// SPDX-License-Identifier: Apache-2.0
#include "app/parts/part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "app/build_id.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "base/error.h"
#include "base/files/output_file.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;
using base::Blame;
using base::Error;

constexpr std::uint64_t most_parts = 1000000;
constexpr const char* part_forms =
    "K/N with K from 1 to N, auto, auto/N (both in a job array) or solve";

std::optional<std::uint64_t> number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  const std::string word = text;
  std::uint64_t number = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
  if (read.ec == std::errc() && read.ptr == word.data() + word.size()) return number;
  throw Error(Blame::Input, variable, fmt::format("\"{}\" is not a whole number", word), {},
              "Write --part K/N");
}

[[noreturn]] void refuse_array(const std::string& found, const std::string& remedy) {
  throw Error(Blame::Input, "--part auto", found, {}, remedy);
}

// Slurm provides the first index and the number of tasks of an array.
void read_array(PartCall& part) {
  const auto task = number_in("SLURM_ARRAY_TASK_ID"), count = number_in("SLURM_ARRAY_TASK_COUNT");
  if (!task) {
    refuse_array("there is no SLURM_ARRAY_TASK_ID",
                 "Write --part auto/N in a PBS array of the indices 1 to N, K/N elsewhere");
  }
  const std::uint64_t first = number_in("SLURM_ARRAY_TASK_MIN").value_or(1);
  const std::uint64_t last = number_in("SLURM_ARRAY_TASK_MAX").value_or(0);
  if (!count || *task < first || last != first + *count - 1) {
    refuse_array(
        "the indices of the Slurm array are not consecutive",
        "Write --part auto/N, with all indices from 1 to N; some of them may be run alone");
  }
  part.number = *task - first + 1;
  part.count = *count;
}

// PBS provides only the index, as PBS_ARRAY_INDEX (PBS Professional, OpenPBS) or PBS_ARRAYID
// (Torque).
void read_index(PartCall& part) {
  for (const char* variable : {"SLURM_ARRAY_TASK_ID", "PBS_ARRAY_INDEX", "PBS_ARRAYID"}) {
    const auto index = number_in(variable);
    if (!index) continue;
    if (*index >= 1 && *index <= part.count) {
      part.number = *index;
      return;
    }
    throw Error(
        Blame::Input, variable, fmt::format("{} is no part of {}", *index, part.count),
        fmt::format("the indices of the array are those of the parts, 1 to {}", part.count));
  }
  refuse_array("there is no SLURM_ARRAY_TASK_ID, PBS_ARRAY_INDEX or PBS_ARRAYID",
               "Write --part K/N outside a job array");
}

PartCall::Task read_part(const std::string& text, PartCall& part) {
  using Task = PartCall::Task;
  part.begins = text == "begin";  // internal: set by main.cpp for ranks
  if (text == "solve" || part.begins) return Task::Solve;
  if (text == "merge") return Task::Merge;
  if (text == "auto") {
    read_array(part);
    return Task::Share;
  }
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    throw CLI::ValidationError("--part", fmt::format("\"{}\" is not {}", text, part_forms));
  }
  part.count = read_whole_number("--part", text.substr(slash + 1), 1, most_parts);
  if (text.substr(0, slash) == "auto") {
    read_index(part);
  } else {
    part.number = read_whole_number("--part", text.substr(0, slash), 1, part.count);
  }
  return Task::Share;
}

Json json_of(const PartsRecord& record) {
  return {{"parts", record.parts},
          {"folder", record.folder.string()},
          {"arguments", record.arguments},
          {"digests", record.digests}};
}

std::optional<PartsRecord> record_in(const fs::path& folder) {
  const fs::path path = folder / parts_file;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  const Json json = json_in(path);
  try {
    PartsRecord record;
    json.at("parts").get_to(record.parts);
    record.folder = json.at("folder").get<std::string>();
    json.at("arguments").get_to(record.arguments);
    record.digests = json.at("digests");
    if (record.parts <= most_parts && record.digests.is_object()) return record;
  } catch (const Json::exception&) {  // reported below
  }
  throw Error(Blame::Input, path.string(), "is not the record of a call in parts", {},
              "Remove it, and run the parts again: finished work is kept");
}

// Names of the digests that differ.
std::vector<std::string> differences(const PartsRecord& mine, const PartsRecord& there) {
  std::vector<std::string> differ;
  const auto without_output = [](std::vector<std::string> arguments) {
    if (std::string* output = output_in(arguments).word) output->clear();
    return arguments;
  };
  // -o refers to the record's own folder, in any spelling.
  if (without_output(mine.arguments) != without_output(there.arguments)) {
    differ.push_back(fmt::format("its arguments (there: {})", fmt::join(there.arguments, " ")));
  }
  if (mine.parts != there.parts && mine.parts > 0 && there.parts > 0) {
    differ.push_back(fmt::format("the number of parts (there: {})", there.parts));
  }
  for (const auto& [name, digest] : mine.digests.items()) {
    const auto found = there.digests.find(name);
    if (found == there.digests.end() || *found != digest) differ.push_back("the " + name);
  }
  return differ;
}

}  // namespace

void add_part_options(CLI::App& command, PartCall& part) {
  command
      .add_option_function<std::string>(
          "--part", [&part](const std::string& text) { part.task = read_part(text, part); },
          "A share of the work, kept for `merge`: K/N, or auto in a job array; solve: the solution "
          "that all parts read")
      ->type_name("K/N");
  command
      .add_option_function<std::string>(
          "--wait",
          [&part](const std::string& text) {
            part.wait_s = static_cast<double>(read_whole_number("--wait", text, 0, 10000000));
          },
          "A part waits so long for another's solution before it makes its own (default 0)")
      ->type_name("SECONDS")
      ->needs("--part");
}

void note_unused_json(const PartCall& part, bool json, bool quiet) {
  if (!json || quiet || !part.in_parts() || part.task == PartCall::Task::Merge) return;
  note("note: --json has no effect: a part reports nothing, and merge --json all of it");
}

OutputWord output_in(std::vector<std::string>& arguments) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    std::string& word = arguments[k];
    const bool apart = word == "-o" || word == "--output";
    if (apart && k + 1 < arguments.size()) return {&arguments[k + 1], 0};
    for (const std::string_view joined : {"--output=", "-o"}) {
      if (word.starts_with(joined)) return {&word, joined.size()};
    }
  }
  return {};
}

Share share_of(const PartCall& part, std::size_t items) {
  return {items * (part.number - 1) / part.count, items * part.number / part.count};
}

std::size_t part_of(std::size_t item, std::size_t items, std::size_t parts) {
  // The first part whose share ends after the item: items K / N > item.
  return ((item + 1) * parts + items - 1) / items;
}

PartsRecord read_parts_record(const fs::path& folder) {
  for (const fs::path& place : {folder, folder / points_folder}) {
    if (auto record = record_in(place)) return *record;
  }
  std::error_code why, ignored;
  static_cast<void>(fs::exists(folder / parts_file, why));
  throw Error(Blame::Input, folder.string(),
              why                           ? "cannot be looked into: " + why.message()
              : fs::exists(folder, ignored) ? fmt::format("holds no {}", parts_file)
                                            : std::string("is not there"),
              "it is the folder of a call with --part: OUTPUT.parts of render, DIR of a study");
}

void join_parts(const fs::path& folder, const Common& common, const Json& digests, PartCall& part) {
  if (base::another_rank_writes()) return;  // the first rank compares for all
  const bool merges = part.task == PartCall::Task::Merge;
  PartsRecord mine{part.count, fs::current_path(), part_free(common.arguments), digests};
  mine.digests["program"] = build_id();
  if (!merges) {
    make_folder(folder);
    base::remove_abandoned_files(folder);
    std::error_code ignored;
    if (part.begins) fs::remove(folder / parts_file, ignored);
    if (base::write_new_text(folder / parts_file, dump(json_of(mine)))) return;
  }
  PartsRecord there = read_parts_record(folder);
  const std::vector<std::string> differ = differences(mine, there);
  if (!differ.empty()) {
    throw Error(Blame::Input, (folder / parts_file).string(),
                fmt::format("belongs to another call: {} changed", fmt::join(differ, ", ")),
                "all parts of one call have the same scene, settings and program",
                "Remove that file to begin anew, or name another place to write");
  }
  if (merges && there.parts == 0) {
    throw Error(Blame::Work, folder.string(), "holds a solution alone: no part was run", {},
                "Make the same call with --part 1/N to N/N");
  }
  if (merges) {
    part.count = there.parts;
  } else if (there.parts == 0 && part.count > 0) {  // a solve was the first call
    base::write_text(folder / parts_file, dump(json_of(mine)));
  }
}

void end_part_if_interrupted() {
  if (!Interrupt::asked()) return;
  throw Error(Blame::Work, "--part", "interrupted", {},
              "Run the same part again: it goes on with what is finished");
}

}  // namespace earthshine::app
