// SPDX-License-Identifier: Apache-2.0
// Files are written aside, flushed to the disk and renamed, so that a reader never sees half a file
// and a failure, a kill or a loss of power keeps the old one.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>

namespace earthshine::base {

// What to do where a file cannot be written.
inline constexpr const char* write_elsewhere =
    "Free some space or write elsewhere; an older file of that name was kept";

// A temporary file beside `target`, empty and locked; commit() renames it over the target, the
// destructor removes it if commit() was not reached. What killed runs left in its folder is
// cleared. Of several ranks (base/ranks) the first alone writes: the others have /dev/null there.
// Throws base::Error (Input) if the target's folder does not exist or the target is a
// folder, a pipe or a device other than those that never wait, such as /dev/null; and base::Error
// (Work) where nothing can be written, also from commit().
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  void commit();
  // The same only where the target is not there yet: false, and nothing is changed, if it is. Of
  // several processes that write one file exactly one gets true.
  [[nodiscard]] bool commit_if_new();

 private:
  [[noreturn]] void refuse(int error_number) const;

  std::filesystem::path target_, temporary_;
  int file_ = -1;                                   // the temporary file, locked; -1: none
  std::atomic<const char*>* unfinished_ = nullptr;  // its place in the list of what stands
  bool committed_ = false;
};

// Whether this is a rank whose files are not wanted: what is written to them need not be made.
[[nodiscard]] bool another_rank_writes();

// For a signal handler that ends the program: removes the temporary files that stand. Calls
// nothing but unlink.
void remove_unfinished_files() noexcept;

// Removes the temporary files in a folder whose process is gone and that nobody holds: runs that
// were killed had no time to. Nothing where another machine's lock would not be seen.
void remove_abandoned_files(const std::filesystem::path& folder);

// By the text of /proc/self/mountinfo: whether flock() on a file of that device holds among
// machines. Not on NFS mounted with local_lock=flock or all (as with nolock), nor on Lustre with
// localflock.
[[nodiscard]] bool others_see_locks(const std::string& mounts, unsigned major, unsigned minor);

// Writes text to a file, aside and renamed. Throws as OutputFile does, and base::Error (Work) on a
// full disk.
void write_text(const std::filesystem::path& path, std::string_view text);
// The same for a file that is not there yet; false, and nothing is changed, if it is.
[[nodiscard]] bool write_new_text(const std::filesystem::path& path, std::string_view text);

}  // namespace earthshine::base
