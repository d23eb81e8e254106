// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/frame_parts.h"

#include <fmt/format.h>

#include "app/build_id.h"
#include "app/console.h"
#include "app/parts/shared_solution.h"
#include "base/error.h"

namespace earthshine::app {
namespace {

Json digests_of_call(const TapeCall& pictures, const CctvSetup& setup) {
  Json files = Json::array();
  for (const std::string& file : pictures.inputs) files.push_back(digest_of_file(file));
  const degrade::Options& options = setup.chain.options;
  const Json settings = {{"camera", settings_json(setup.chain.camera)},
                         {"monitor", monitor_json(setup.chain.monitor)},
                         {"view", options.view},
                         {"fov_deg", options.fov_deg}};
  return {{"pictures", digest_of(files)}, {"settings", digest_of(settings)}};
}

// Position of the # in the file name, ignoring folders.
std::pair<std::size_t, std::size_t> run_of_hashes(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t begin = path.find('#', slash == std::string::npos ? 0 : slash + 1);
  if (begin == std::string::npos) return {path.size(), 0};
  const std::size_t end = path.find_first_not_of('#', begin);
  return {begin, (end == std::string::npos ? path.size() : end) - begin};
}

}  // namespace

FrameParts::FrameParts(const PartCall& part, const TapeCall& pictures,
                       const std::vector<TapeFrame>& tape, const std::vector<std::string>& outputs,
                       const CctvSetup& setup, const Common& common)
    : part_(part),
      quiet_(common.quiet),
      tape_(tape),
      folder_(outputs.front() + ".parts"),
      digests_(digests_of_call(pictures, setup)),
      store_(folder_) {
  for (const std::string& output : outputs) {
    if (!output.empty()) outputs_.push_back(output);
  }
  join_parts(folder_, common, digests_, part_);
}

Json FrameParts::key_of(std::size_t place) const {
  return {
      {"what", "frame"}, {"call", digests_}, {"build", build_id()}, {"frame", tape_[place].number}};
}

Json FrameParts::digests_of_files(std::size_t place) const {
  Json digests = Json::array();
  for (const std::string& output : outputs_) {
    const std::string file = numbered(output, tape_[place].number);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return Json::array();
    digests.push_back(digest_of_file(file));
  }
  return digests;
}

Json FrameParts::report_of(std::size_t place) const {
  std::string ignored;
  const auto facts = store_.find_facts(key_of(place), ignored);
  return facts && (*facts)["files"] == digests_of_files(place) ? (*facts)["report"] : Json();
}

Share FrameParts::to_do() const {
  if (part_.task != PartCall::Task::Share) return {};
  const Share mine = share_of(part_, tape_.size());
  for (std::size_t place = mine.first; place < mine.last; ++place) {
    if (report_of(place).is_null()) return {place, mine.last};
  }
  if (!quiet_) note(fmt::format("part {} of {}: nothing to do", part_.number, part_.count));
  return {};
}

void FrameParts::keep(std::size_t place, const Json& report) const {
  store_.keep_facts(key_of(place), {{"files", digests_of_files(place)}, {"report", report}});
}

Json FrameParts::reports() const {
  Json reports = Json::array();
  std::vector<MissingWork> missing;
  for (std::size_t place = 0; place < tape_.size(); ++place) {
    reports.push_back(report_of(place));
    if (!reports.back().is_null()) continue;
    missing.push_back(
        {fmt::format("frame {}", tape_[place].number), part_of(place, tape_.size(), part_.count)});
  }
  if (!missing.empty()) refuse_to_merge(folder_, missing);
  return reports;
}

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
