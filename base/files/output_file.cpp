// SPDX-License-Identifier: Apache-2.0
#include "base/files/output_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"

namespace earthshine::base {
namespace {

namespace fs = std::filesystem;

// Unique among the processes and the files of this one; a leading dot keeps it out of `*.exr`.
fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> count{0};
  const std::string mark = std::to_string(::getpid()) + "-" + std::to_string(count++);
  // Long names are shortened: name and mark together must stay below the usual limit of 255 bytes.
  return target.parent_path() /
         ("." + target.filename().string().substr(0, 200) + "." + mark + ".part");
}

// The temporary files that stand, as names that live as long as their OutputFile. More at once than
// the list is long are not cleared away when a signal ends the program.
std::array<std::atomic<const char*>, 32> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free, "read in a signal handler");

std::atomic<const char*>* list_unfinished(const char* name) {
  for (std::atomic<const char*>& place : unfinished) {
    const char* none = nullptr;
    if (place.compare_exchange_strong(none, name)) return &place;
  }
  return nullptr;
}

std::string reason(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

// Follows links, so that a link is kept and the file it names is replaced.
fs::path follow_links(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  const fs::path followed = fs::weakly_canonical(path, ignored);
  return followed.empty() ? path : followed;
}

}  // namespace

OutputFile::OutputFile(const fs::path& target) : target_(follow_links(target)) {
  const std::string name = target_.string();
  if (!target_.has_filename()) {
    throw Error(Blame::Input, name, "is not the name of a file", {}, "Name a file to write");
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) {
    throw Error(Blame::Input, name, "is a folder", {}, "Name a file inside it");
  }
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error(Blame::Input, name, "cannot be written: there is no folder " + folder.string(), {},
                "Make the folder first");
  }
  if (fs::exists(status) && ::access(target_.c_str(), W_OK) != 0) {
    throw Error(Blame::Work, name, "cannot be written: " + reason(errno));
  }
  // A device or a pipe is written directly: renaming would replace it by a plain file.
  const bool plain = !fs::exists(status) || fs::is_regular_file(status);
  if (plain && ::access(folder.c_str(), W_OK) != 0) {
    throw Error(Blame::Work, name,
                "cannot be written: folder " + folder.string() + ": " + reason(errno));
  }
  temporary_ = plain ? temporary_beside(target_) : target_;
  if (plain) unfinished_ = list_unfinished(temporary_.c_str());
}

OutputFile::~OutputFile() {
  if (unfinished_ != nullptr) unfinished_->store(nullptr);
  if (committed_ || temporary_ == target_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::commit() {
  if (temporary_ != target_) {
    std::error_code problem;
    const fs::file_status old = fs::status(target_, problem);
    if (fs::exists(old)) fs::permissions(temporary_, old.permissions(), problem);
    fs::rename(temporary_, target_, problem);
    if (problem) {
      throw Error(Blame::Work, target_.string(), "cannot be written: " + problem.message());
    }
  }
  committed_ = true;
}

void remove_unfinished_files() noexcept {
  for (const std::atomic<const char*>& place : unfinished) {
    if (const char* name = place.load()) ::unlink(name);
  }
}

void remove_abandoned_files(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    // ".NAME.PID-NUMBER.part", as temporary_beside has it
    const std::string name = entry.path().filename().string();
    constexpr std::string_view suffix = ".part";
    if (name.size() <= suffix.size() || name[0] != '.' || !name.ends_with(suffix)) continue;
    const std::string stem = name.substr(0, name.size() - suffix.size());
    const std::size_t dot = stem.rfind('.');
    pid_t process = 0;
    const char* const end = stem.data() + stem.size();
    const auto read = std::from_chars(stem.data() + dot + 1, end, process);
    if (read.ec != std::errc() || read.ptr == end || *read.ptr != '-' || process <= 0) continue;
    if (::kill(process, 0) == 0 || errno != ESRCH) continue;
    fs::remove(entry.path(), ignored);
  }
}

void write_text(const fs::path& path, std::string_view text) {
  OutputFile output(path);
  const auto close = [](std::FILE* f) { std::fclose(f); };
  std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(output.temporary().c_str(), "wb"),
                                                   close);
  if (!file) throw Error(Blame::Work, path.string(), "cannot be written: " + reason(errno));
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  // A full disk may show only when buffers are flushed or the file is closed.
  const bool flushed = written && std::fflush(file.get()) == 0;
  int problem = flushed ? 0 : errno;
  if (std::fclose(file.release()) != 0 && problem == 0) problem = errno;
  if (!flushed || problem != 0) {
    throw Error(Blame::Work, path.string(), "cannot be written: " + reason(problem), {},
                "Free some space or write elsewhere; an older file of that name was kept");
  }
  output.commit();
}

}  // namespace earthshine::base
