// SPDX-License-Identifier: Apache-2.0
// Files are written aside and renamed, so that a reader never sees half a file and a failure keeps
// the old one.
#pragma once

#include <atomic>
#include <filesystem>
#include <string_view>

namespace earthshine::base {

// A temporary name beside `target`; commit() renames it over the target, the destructor removes it
// if commit() was not reached. Throws base::Error (Input) if the target's folder does not exist or
// the target is a folder, and base::Error (Work) if renaming fails.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  std::atomic<const char*>* unfinished_ = nullptr;  // its place in the list of what stands
  bool committed_ = false;
};

// For a signal handler that ends the program: removes the temporary files that stand. Calls
// nothing but unlink.
void remove_unfinished_files() noexcept;

// Removes the temporary files in a folder of processes of this machine that are gone: runs that
// were killed had no time to.
void remove_abandoned_files(const std::filesystem::path& folder);

// Writes text to a file, aside and renamed. Throws as OutputFile does, and base::Error (Work) on a
// full disk.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace earthshine::base
