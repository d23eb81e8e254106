// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {

using base::Blame;
using base::Error;

std::string read_input_file(const std::filesystem::path& path, std::size_t max_bytes,
                            const base::Location& asked_at) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(Blame::Input, asked_at, fmt::format("{} is a folder", in_quotes(path.string())),
                "a file is wanted here");
  }
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    throw Error(Blame::Input, asked_at,
                fmt::format("cannot open {}: {}", in_quotes(path.string()), std::strerror(errno)),
                "paths are relative to the file that names them");
  }
  // Read in steps instead of asking for the size, which pipes and devices do not know.
  std::string bytes;
  constexpr std::size_t step = std::size_t{1} << 20;
  while (true) {
    const std::size_t before = bytes.size();
    const std::size_t wanted = std::min(std::max(step, before), max_bytes + 1 - before);
    bytes.resize(before + wanted);
    const std::size_t got = std::fread(bytes.data() + before, 1, wanted, file.get());
    bytes.resize(before + got);
    if (bytes.size() > max_bytes) {
      throw Error(Blame::Input, asked_at,
                  fmt::format("{} is larger than {} bytes", in_quotes(path.string()), max_bytes),
                  "that is the largest file of this kind that is read", "Split it");
    }
    if (got < wanted) break;
  }
  if (std::ferror(file.get()) != 0) {
    throw Error(Blame::Input, asked_at,
                fmt::format("cannot read {}: {}", in_quotes(path.string()), std::strerror(errno)));
  }
  return bytes;
}

std::string read_regular_file(const std::filesystem::path& path, std::size_t max_bytes,
                              const base::Location& asked_at) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(path, ignored).type();
  if (kind == std::filesystem::file_type::fifo || kind == std::filesystem::file_type::character ||
      kind == std::filesystem::file_type::block || kind == std::filesystem::file_type::socket) {
    throw Error(Blame::Input, asked_at,
                fmt::format("{} is a pipe or a device", in_quotes(path.string())),
                "a file on disk is wanted here");
  }
  return read_input_file(path, max_bytes, asked_at);
}

std::filesystem::path confined_path(const std::filesystem::path& base_folder,
                                    std::string_view named,
                                    std::span<const std::filesystem::path> folders,
                                    const base::Location& asked_at) {
  // A backslash separates folders only on Windows; here it would hide a climb from the check below.
  const std::filesystem::path relative{std::string(named)};
  const bool has_drive = named.size() > 1 && named[1] == ':';
  const bool strange = named.find('\\') != std::string_view::npos ||
                       named.find('\0') != std::string_view::npos || named.empty();
  if (relative.is_absolute() || has_drive || strange || named.front() == '~') {
    throw Error(Blame::Input, asked_at,
                fmt::format("the path {} is not relative", in_quotes(named)),
                "a file that a mesh names is given relative to the mesh, with / between folders",
                "Put it beside the mesh and correct the path");
  }
  std::error_code problem;
  const std::filesystem::path wanted =
      std::filesystem::weakly_canonical(base_folder / relative, problem);
  for (const std::filesystem::path& folder : folders) {
    const auto root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, problem);
    if (problem) continue;
    const auto inside = wanted.lexically_relative(root);
    if (!inside.empty() && *inside.begin() != "..") return base_folder / relative;
  }
  throw Error(Blame::Input, asked_at,
              fmt::format("the path {} leads out of the scene's folder", in_quotes(named)),
              "a file that a mesh names lies in the folder of the scene or of the mesh, or below",
              "Move it there and correct the path");
}

}  // namespace earthshine::scenes
