// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/tape.h"

#include <fmt/format.h>

#include "base/error.h"

namespace earthshine::app {
namespace {

// Position of the # in the file name, ignoring folders.
std::pair<std::size_t, std::size_t> run_of_hashes(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t begin = path.find('#', slash == std::string::npos ? 0 : slash + 1);
  if (begin == std::string::npos) return {path.size(), 0};
  const std::size_t end = path.find_first_not_of('#', begin);
  return {begin, (end == std::string::npos ? path.size() : end) - begin};
}

}  // namespace

std::vector<TapeFrame> lay_out(const TapeCall& call) {
  using base::Blame;
  if (call.frames > 0 && call.inputs.size() > 1) {
    throw base::Error(Blame::Input, "--frames", "accepts a single input picture",
                      "it says how long one picture is shown",
                      "Leave it out: each picture is a frame");
  }
  const std::size_t per_frame = call.fields ? 2 : 1;
  if (call.inputs.size() % per_frame != 0) {
    throw base::Error(Blame::Input, "--fields",
                      fmt::format("{} pictures are no whole number of frames", call.inputs.size()),
                      "a frame has two fields", "Give an even number of pictures");
  }
  std::vector<TapeFrame> tape;
  for (std::size_t i = 0; i < call.inputs.size(); i += per_frame) {
    const auto begin = call.inputs.begin() + static_cast<std::ptrdiff_t>(i);
    tape.push_back(
        {call.first + tape.size(), {begin, begin + static_cast<std::ptrdiff_t>(per_frame)}});
  }
  while (!tape.empty() && tape.size() < call.frames) {
    tape.push_back({tape.back().number + 1, tape.back().inputs});
  }
  return tape;
}

std::string numbered(const std::string& path, std::uint64_t number) {
  const auto [begin, width] = run_of_hashes(path);
  if (width == 0) return path;
  return path.substr(0, begin) + fmt::format("{:0{}}", number, width) + path.substr(begin + width);
}

void check_numbered(const std::string& option, const std::string& path, std::size_t frames) {
  const auto [begin, width] = run_of_hashes(path);
  if (frames > 1 && path.find('#', begin + width) != std::string::npos) {
    throw base::Error(base::Blame::Input, option, fmt::format("\"{}\" has # in two places", path),
                      "one run of # is the frame's number, as wide as the run",
                      "Name it for example frame-####.png");
  }
  if (path.empty() || frames < 2 || width > 0) return;
  throw base::Error(base::Blame::Input, option,
                    fmt::format("{} frames would be written into \"{}\"", frames, path),
                    "the name of a sequence holds # where the frame's number goes",
                    "Name it for example frame-####.png");
}

}  // namespace earthshine::app
