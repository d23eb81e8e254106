// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/confined_path.h"

#include <fmt/format.h>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {

using base::Blame;
using base::Error;

std::filesystem::path confined_path(const std::filesystem::path& base_folder,
                                    std::string_view named,
                                    std::span<const std::filesystem::path> folders,
                                    const base::Location& asked_at) {
  // A backslash separates folders only on Windows; here it could hide ".." from the check below.
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
  // Made absolute first: a relative path without any existing component would not be resolved.
  const auto resolved = [&](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, problem), problem);
  };
  const std::filesystem::path wanted = resolved(base_folder / relative);
  for (const std::filesystem::path& folder : folders) {
    const auto root = resolved(folder.empty() ? "." : folder);
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
