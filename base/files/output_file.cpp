// SPDX-License-Identifier: Apache-2.0
#include "base/files/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/ranks/ranks.h"

namespace earthshine::base {
namespace {

namespace fs = std::filesystem;

// ".NAME.PROCESS-NUMBER.part": unique among processes and the files of this process. The leading
// dot hides it from `*.exr`.
constexpr std::string_view suffix = ".part";

// Shortens long names: name and mark must fit into the usual limit of 255 bytes.
fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> count{0};
  const std::string mark = std::to_string(::getpid()) + "-" + std::to_string(count++);
  return target.parent_path() /
         ("." + target.filename().string().substr(0, 200) + "." + mark + std::string(suffix));
}

// Process number in the name of a temporary file; 0 for other files.
pid_t writer_of(const std::string& name) {
  if (name.size() <= suffix.size() || name[0] != '.' || !name.ends_with(suffix)) return 0;
  const std::string stem = name.substr(0, name.size() - suffix.size());
  pid_t process = 0;
  const char* const end = stem.data() + stem.size();
  const auto read = std::from_chars(stem.data() + stem.rfind('.') + 1, end, process);
  const bool sound = read.ec == std::errc() && read.ptr != end && *read.ptr == '-';
  return sound ? std::max(process, 0) : 0;
}

// The writer of a temporary file holds a lock on it. The lock ends with the process, however it
// ends.
bool lock(int file) { return ::flock(file, LOCK_EX | LOCK_NB) == 0; }

bool others_see_locks_on(int file) {
  struct stat status {};
  std::ifstream mounts("/proc/self/mountinfo");
  const std::string text{std::istreambuf_iterator<char>(mounts), {}};
  return ::fstat(file, &status) == 0 &&
         others_see_locks(text, major(status.st_dev), minor(status.st_dev));
}

// Removes a temporary file of a killed run: its process is gone and the file is not locked. A lock
// may belong to a process with the same number on another machine or in another container.
void remove_if_abandoned(const fs::path& path) {
  const pid_t process = writer_of(path.filename().string());
  if (process == 0 || ::kill(process, 0) == 0 || errno != ESRCH) return;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return;
  if (others_see_locks_on(file) && lock(file)) ::unlink(path.c_str());
  ::close(file);
}

// Names of the existing temporary files; each lives as long as its OutputFile. A signal handler
// removes them. Files beyond the list's capacity are not removed then.
std::array<std::atomic<const char*>, 32> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free, "read in a signal handler");

std::atomic<const char*>* list_unfinished(const char* name) {
  for (std::atomic<const char*>& place : unfinished) {
    const char* none = nullptr;
    if (place.compare_exchange_strong(none, name)) return &place;
  }
  return nullptr;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

void flush_folder(const fs::path& folder) {
  const int open = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (open < 0) return;
  ::fsync(open);
  ::close(open);
}

// /dev/stdout is a link to "pipe:[1234]", which is not a path.
bool has_no_name(const fs::path& path) {
  std::error_code problem;
  static_cast<void>(fs::canonical(path, problem));
  return static_cast<bool>(problem);
}

// Once per folder: a run may write thousands of files into it.
void clear_once(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> cleared;
  {
    const std::lock_guard guard(mutex);
    if (!cleared.insert(folder).second) return;
  }
  remove_abandoned_files(folder);
}

// Resolves links: the link stays and its target is replaced.
fs::path follow_links(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  const fs::path followed = fs::weakly_canonical(path, ignored);
  return followed.empty() ? path : followed;
}

}  // namespace

bool another_rank_writes() { return ranks() != nullptr && ranks()->number() > 0; }

OutputFile::OutputFile(const fs::path& target) : target_(follow_links(target)) {
  if (another_rank_writes()) {  // the folder may not exist on this machine
    temporary_ = "/dev/null";
    return;
  }
  const std::string name = target_.string();
  if (!target_.has_filename()) {
    throw Error(Blame::Input, name, "is not the name of a file", {}, "Name a file to write");
  }
  std::error_code problem, ignored;
  const fs::file_status status = fs::status(target_, problem);
  if (!fs::status_known(status)) {
    throw Error(blame_of_target(problem.value()), name, "cannot be written: " + problem.message(),
                {}, "Name another file to write");
  }
  if (fs::is_directory(status)) {
    throw Error(Blame::Input, name, "is a folder", {}, "Name a file inside it");
  }
  const fs::path folder = folder_of(target_);
  if (!fs::is_directory(folder, ignored)) {
    throw Error(Blame::Input, name,
                "cannot be written: there is no folder \"" + folder.string() + "\"", {},
                "Make the folder first");
  }
  if (fs::exists(status) && ::access(target_.c_str(), W_OK) != 0) {
    throw Error(Blame::Work, name, "cannot be written: " + system_reason(errno));
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    // Written directly: renaming would replace /dev/null by a plain file. Opening a named pipe
    // blocks until it has a reader; a pipe without a name is /dev/stdout, which is already open.
    if (!fs::is_character_file(status) && !(fs::is_fifo(status) && has_no_name(target_))) {
      throw Error(Blame::Input, name, "is a pipe or a device", "a file on disk is wanted here",
                  "Name a file to write");
    }
    temporary_ = target_;
  }
  if (!temporary_.empty()) return;
  clear_once(folder);
  do {
    temporary_ = temporary_beside(target_);
    // Listed before it exists, because a signal may arrive at any time.
    unfinished_ = list_unfinished(temporary_.c_str());
    file_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0 && unfinished_ != nullptr) unfinished_->store(nullptr);
  } while (file_ < 0 && errno == EEXIST);
  if (file_ < 0) {
    throw Error(Blame::Work, name,
                "cannot be written: folder " + folder.string() + ": " + system_reason(errno));
  }
  static_cast<void>(lock(file_));  // some file systems have no locks
}

OutputFile::~OutputFile() {
  if (file_ < 0) return;
  if (!committed_) ::unlink(temporary_.c_str());
  if (unfinished_ != nullptr) unfinished_->store(nullptr);
  ::close(file_);  // this releases the lock
}

void OutputFile::commit() {
  if (file_ >= 0) {
    struct stat old {};
    if (::stat(target_.c_str(), &old) == 0) static_cast<void>(::fchmod(file_, old.st_mode & 07777));
    // Flush the file, rename it, then flush the folder: after a power failure the old or the new
    // file is complete. If the folder cannot be flushed, the file system does so later.
    if (::fsync(file_) != 0 && errno != EINVAL) refuse(errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) refuse(errno);
    flush_folder(folder_of(target_));
  }
  committed_ = true;
}

// link() is atomic also on NFS, where a lock or a test for existence is not. If NFS loses a reply,
// it repeats the request and reports EEXIST although the link was made; the file then has two
// names. File systems without links use rename.
bool OutputFile::commit_if_new() {
  if (file_ < 0) return true;  // a device
  if (::fsync(file_) != 0 && errno != EINVAL) refuse(errno);
  if (::link(temporary_.c_str(), target_.c_str()) != 0) {
    const int problem = errno;
    struct stat own {};
    const bool made = ::stat(temporary_.c_str(), &own) == 0 && own.st_nlink > 1;
    std::error_code ignored;
    if (problem == EEXIST && !made) return false;
    if (problem == EPERM || problem == ENOTSUP || problem == ENOSYS) {
      if (fs::exists(target_, ignored)) return false;
      commit();
      return true;
    }
    if (problem != EEXIST) refuse(problem);
  }
  ::unlink(temporary_.c_str());
  flush_folder(folder_of(target_));
  committed_ = true;
  return true;
}

void OutputFile::refuse(int error_number) const {
  throw Error(Blame::Work, target_.string(), "cannot be written: " + system_reason(error_number),
              {}, write_elsewhere);
}

bool others_see_locks(const std::string& mounts, unsigned major, unsigned minor) {
  const std::string device = std::to_string(major) + ":" + std::to_string(minor);
  std::istringstream lines(mounts);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string mount, parent, of;
    if (!(words >> mount >> parent >> of) || of != device) continue;
    const bool local = line.find("local_lock=") != std::string::npos &&
                       line.find("local_lock=none") == std::string::npos &&
                       line.find("local_lock=posix") == std::string::npos;
    if (local || line.find("localflock") != std::string::npos) return false;
  }
  return true;
}

void remove_unfinished_files() noexcept {
  for (const std::atomic<const char*>& place : unfinished) {
    if (const char* name = place.load()) ::unlink(name);
  }
}

void remove_abandoned_files(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    remove_if_abandoned(entry.path());
  }
}

namespace {

// Writes to the temporary file.
void write_aside(const OutputFile& output, const fs::path& path, std::string_view text) {
  const auto close = [](std::FILE* f) { std::fclose(f); };
  std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(output.temporary().c_str(), "wb"),
                                                   close);
  if (!file) throw Error(Blame::Work, path.string(), "cannot be written: " + system_reason(errno));
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  // A full disk may cause an error only at the flush or the close.
  const bool flushed = written && std::fflush(file.get()) == 0;
  int problem = flushed ? 0 : errno;
  if (std::fclose(file.release()) != 0 && problem == 0) problem = errno;
  if (!flushed || problem != 0) {
    throw Error(Blame::Work, path.string(), "cannot be written: " + system_reason(problem), {},
                write_elsewhere);
  }
}

}  // namespace

void write_text(const fs::path& path, std::string_view text) {
  OutputFile output(path);
  if (another_rank_writes()) return;
  write_aside(output, path, text);
  output.commit();
}

bool write_new_text(const fs::path& path, std::string_view text) {
  OutputFile output(path);
  write_aside(output, path, text);
  return output.commit_if_new();
}

}  // namespace earthshine::base
