// SPDX-License-Identifier: Apache-2.0
// Output files are written to a temporary file, flushed to disk and renamed. Readers never see a
// partial file, and a failure, a kill or a power failure keeps the old one.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>

namespace earthshine::base {

// Remedy in messages about files that cannot be written.
inline constexpr const char* write_elsewhere =
    "Free some space or write elsewhere; an older file of that name was kept";

// A temporary file beside `target`, empty and locked. commit() renames it to the target; without
// commit() the destructor removes it. The constructor also removes temporary files of killed runs
// from the folder. With several ranks (base/ranks) only the first one writes; the others get
// /dev/null. Throws base::Error (Input) if the target's folder does not exist or the target is a
// folder, a pipe or a device, except devices that never block, such as /dev/null. Throws
// base::Error (Work) if the file cannot be written, also from commit().
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  void commit();
  // Commits only if the target does not exist; else returns false and changes nothing. Of several
  // processes with one target exactly one gets true.
  [[nodiscard]] bool commit_if_new();

 private:
  [[noreturn]] void refuse(int error_number) const;

  std::filesystem::path target_, temporary_;
  int file_ = -1;                                   // the temporary file, locked; -1: none
  std::atomic<const char*>* unfinished_ = nullptr;  // its entry in the list of temporary files
  bool committed_ = false;
};

// True on ranks whose output files are discarded, so that they can skip producing them.
[[nodiscard]] bool another_rank_writes();

// Removes all temporary files of this process. For signal handlers: it only calls unlink.
void remove_unfinished_files() noexcept;

// Removes temporary files that killed runs left in a folder: their process is gone and they are not
// locked. Keeps all files if locks of other machines are not visible.
void remove_abandoned_files(const std::filesystem::path& folder);

// Whether flock() on a file of this device works between machines, from the text of
// /proc/self/mountinfo. False for NFS mounted with local_lock=flock or all (also nolock) and for
// Lustre with localflock.
[[nodiscard]] bool others_see_locks(const std::string& mounts, unsigned major, unsigned minor);

// Writes text by a temporary file and a rename. Throws as OutputFile does, and base::Error (Work)
// if the disk is full.
void write_text(const std::filesystem::path& path, std::string_view text);
// The same, only if the file does not exist; else returns false and changes nothing.
[[nodiscard]] bool write_new_text(const std::filesystem::path& path, std::string_view text);

}  // namespace earthshine::base
