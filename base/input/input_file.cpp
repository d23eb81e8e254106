// SPDX-License-Identifier: Apache-2.0
#include "base/input/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

#include "base/free_memory.h"

namespace earthshine::base {
namespace {

// Builds messages that name the file once: "is a folder", or "x.obj" is a folder if the place is in
// another file.
struct Named {
  const std::filesystem::path& path;
  const Location& asked_at;

  [[nodiscard]] Error wrong(const std::string& is, const std::string& allowed = {},
                            const std::string& remedy = {}) const {
    const bool named = asked_at.file == path.string();
    return {Blame::Input, asked_at, named ? is : "\"" + path.string() + "\" " + is, allowed,
            remedy};
  }
};

class Descriptor {
 public:
  // Without O_NONBLOCK opening a pipe without a writer would block.
  explicit Descriptor(const Named& file)
      : number_(::open(file.path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (number_ < 0) {
      const std::string why = system_reason(errno);
      throw Error(Blame::Input, file.asked_at, "cannot open \"" + file.path.string() + "\": " + why,
                  file.asked_at.line > 0 ? "paths are relative to the file that names them" : "");
    }
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// Size in bytes. Sockets fail earlier, when they are opened.
std::uint64_t size_on_disk(const Descriptor& file, const Named& named) {
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) {
    throw named.wrong("cannot be read: " + system_reason(errno));
  }
  if (S_ISDIR(status.st_mode)) throw named.wrong("is a folder", "a file is wanted here");
  if (!S_ISREG(status.st_mode)) {
    throw named.wrong("is a pipe or a device", "a file on disk is wanted here",
                      "Write it to a file first");
  }
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

void check_input_file(const std::filesystem::path& path, const Location& asked_at) {
  const Named named{path, asked_at};
  const Descriptor file(named);
  static_cast<void>(size_on_disk(file, named));
}

std::string read_input_file(const std::filesystem::path& path, std::size_t max_bytes,
                            const Location& asked_at) {
  const Named named{path, asked_at};
  const auto too_large = [&] {
    throw named.wrong(fmt::format("is larger than {} bytes", max_bytes),
                      "that is the largest file of this kind that is read", "Split it");
  };
  const Descriptor file(named);
  const std::uint64_t size = size_on_disk(file, named);
  if (size > max_bytes) too_large();
  check_room(size, path.string());
  // Files in /proc report size 0, and a file may grow while it is read: read to the end.
  std::string bytes;
  constexpr std::size_t step = std::size_t{1} << 16;
  std::size_t filled = 0;
  while (true) {
    if (filled == bytes.size()) bytes.resize(filled == 0 ? size + 1 : filled + step);
    const ssize_t got = ::read(file.number(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      throw named.wrong("cannot be read: " + system_reason(errno));
    }
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled > max_bytes) too_large();
  }
  bytes.resize(filled);
  return bytes;
}

void refuse_file(const std::filesystem::path& path, const std::string& found,
                 std::string_view allowed, std::string_view remedy) {
  throw Error(Blame::Input, path.string(), found, allowed, remedy);
}

}  // namespace earthshine::base
