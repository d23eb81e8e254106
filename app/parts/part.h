// SPDX-License-Identifier: Apache-2.0
// --part: work spread over processes that share nothing but a folder. Each does its share of the
// call and leaves the results there (result_cache.h); `merge` runs the call once more, finds all of
// them and writes what one process would have written. docs/cluster.md says what a share is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

// What a call is to do of its work.
struct PartCall {
  enum class Task {
    All,    // one process, no parts
    Share,  // the `number`-th of `count`
    Solve,  // the solution alone, for the parts to come
    Merge   // nothing but to put together what parts have left
  };
  Task task = Task::All;
  std::size_t number = 0, count = 0;  // from 1; of a share
  double wait_s = 0.0;                // of a share: for another process's solution
  bool begins = false;                // of a solve: a call of before in the same place is forgotten

  [[nodiscard]] bool in_parts() const { return task != Task::All; }
};

// In a study's folder: what is kept.
inline constexpr const char* points_folder = "points";
// In the folder of parts, and in points.
inline constexpr const char* parts_file = "parts.json";

// --part K/N, auto, auto/N, solve or merge; --wait SECONDS.
void add_part_options(CLI::App& command, PartCall& part);

// A note where a report is asked for of a part that has none.
void note_unused_json(const PartCall& part, bool json, bool quiet);

// The items from `first` to before `last` of a part.
struct Share {
  std::size_t first = 0, last = 0;
};
// Of `items` in order: shares that touch, cover all and differ by one at most.
[[nodiscard]] Share share_of(const PartCall& part, std::size_t items);
// Which part, from 1, has the item.
[[nodiscard]] std::size_t part_of(std::size_t item, std::size_t items, std::size_t parts);

// DIR/parts.json: the call that all parts share and digests of all that its results depend on.
// The first process writes it, and those that come later compare.
// NOLINTNEXTLINE(bugprone-exception-escape): destructor and move of Json throw nothing.
struct PartsRecord {
  std::size_t parts = 0;               // 0: not known yet, of a solve alone
  std::filesystem::path folder;        // where the call was made
  std::vector<std::string> arguments;  // without those that say how it is done: part_free()
  Json digests;                        // flat: name of what it is of -> digest
};

// Makes the folder where it is not there, writes the record or compares it with the one there.
// Throws base::Error (Input) that names what differs. A merge makes nothing, and takes the number
// of parts from the record.
void join_parts(const std::filesystem::path& folder, const Common& common, const Json& digests,
                PartCall& part);

// What -o says in a call: `word` from the letter `from` on; nullptr: nothing.
struct OutputWord {
  std::string* word = nullptr;
  std::size_t from = 0;
};
[[nodiscard]] OutputWord output_in(std::vector<std::string>& arguments);

// Of a folder that join_parts() made, or of the folder of a study. Throws base::Error (Input).
[[nodiscard]] PartsRecord read_parts_record(const std::filesystem::path& folder);

// Throws base::Error (Work) once a signal has asked for an end (app/console.h).
void end_part_if_interrupted();

// What a merge did not find.
struct MissingWork {
  std::string what;
  std::size_t part = 0;  // that makes it
};
// Notes it with the command that makes each part, and throws base::Error (Work).
[[noreturn]] void refuse_to_merge(const std::filesystem::path& folder,
                                  const std::vector<MissingWork>& missing);

}  // namespace earthshine::app
