// SPDX-License-Identifier: Apache-2.0
// --part: distributes work over processes that share only a folder. Each computes its share of the
// call and stores the results there (result_cache.h); `merge` repeats the call, reads all results
// and writes the output of a single process. docs/cluster.md defines the shares.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

// Task of this process.
struct PartCall {
  enum class Task {
    All,    // one process, no parts
    Share,  // share `number` of `count`
    Solve,  // only the solution, for later parts
    Merge   // only combines the results of parts
  };
  Task task = Task::All;
  std::size_t number = 0, count = 0;  // of a share, from 1
  double wait_s = 0.0;                // of a share: time to wait for another process's solution
  bool begins = false;                // of a solve: replaces an earlier call in the same folder

  [[nodiscard]] bool in_parts() const { return task != Task::All; }
};

// Folder of stored results in a study's folder.
inline constexpr const char* points_folder = "points";
// File in the folder of parts, and in points.
inline constexpr const char* parts_file = "parts.json";

// --part K/N, auto, auto/N, solve or merge; --wait SECONDS.
void add_part_options(CLI::App& command, PartCall& part);

// Notes that a part has no report.
void note_unused_json(const PartCall& part, bool json, bool quiet);

// The items [first, last) of a part.
struct Share {
  std::size_t first = 0, last = 0;
};
// Divides `items` in order into contiguous shares that differ by at most one item.
[[nodiscard]] Share share_of(const PartCall& part, std::size_t items);
// The part, from 1, that has the item.
[[nodiscard]] std::size_t part_of(std::size_t item, std::size_t items, std::size_t parts);

// DIR/parts.json: the call of all parts and digests of everything that its results depend on. The
// first process writes it; later ones compare. NOLINTNEXTLINE(bugprone-exception-escape):
// destructor and move of Json throw nothing.
struct PartsRecord {
  std::size_t parts = 0;               // 0: unknown, after a solve only
  std::filesystem::path folder;        // working directory of the call
  std::vector<std::string> arguments;  // by part_free()
  Json digests;                        // flat: name to digest
};

// Makes the folder if necessary, and writes or compares the record. Throws base::Error (Input) with
// the differences. A merge makes nothing and reads the number of parts from the record.
void join_parts(const std::filesystem::path& folder, const Common& common, const Json& digests,
                PartCall& part);

// The value of -o in a call: `word` from character `from` on; nullptr: absent.
struct OutputWord {
  std::string* word = nullptr;
  std::size_t from = 0;
};
[[nodiscard]] OutputWord output_in(std::vector<std::string>& arguments);

// For a folder made by join_parts(), or a study's folder. Throws base::Error (Input).
[[nodiscard]] PartsRecord read_parts_record(const std::filesystem::path& folder);

// Throws base::Error (Work) after a signal requested a stop (app/console.h).
void end_part_if_interrupted();

// A result that a merge did not find.
struct MissingWork {
  std::string what;
  std::size_t part = 0;  // the part that makes it
};
// Notes the command of each missing part, and throws base::Error (Work).
[[noreturn]] void refuse_to_merge(const std::filesystem::path& folder,
                                  const std::vector<MissingWork>& missing);

}  // namespace earthshine::app
