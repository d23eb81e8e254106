// SPDX-License-Identifier: Apache-2.0
// `degrade --part`: the frames of a sequence in shares. Each is written where one process would
// write it; what is kept beside the sequence, in OUT.parts, are the frames' reports.
#pragma once

#include <string>
#include <vector>

#include "app/cctv/cctv.h"
#include "app/cctv/tape.h"
#include "app/parts/part.h"
#include "app/parts/result_cache.h"

namespace earthshine::app {

class FrameParts {
 public:
  // outputs: file names with # for the frame's number; the first names the folder. Throws
  // base::Error (Input) where the folder belongs to another call.
  FrameParts(const PartCall& part, const TapeCall& pictures, const std::vector<TapeFrame>& tape,
             const std::vector<std::string>& outputs, const CctvSetup& setup, const Common& common);

  // The frames, by their place on the tape, that this process writes: none of a merge, none where
  // all of a share is there.
  [[nodiscard]] Share to_do() const;
  // Of a frame whose files are written.
  void keep(std::size_t place, const Json& report) const;
  // Of all frames; throws base::Error (Work) where one is not there, with the command that makes
  // it.
  [[nodiscard]] Json reports() const;

 private:
  [[nodiscard]] Json key_of(std::size_t place) const;
  // Of each output of a frame; empty where one is not there.
  [[nodiscard]] Json digests_of_files(std::size_t place) const;
  // Null where the frame is not there, whole.
  [[nodiscard]] Json report_of(std::size_t place) const;

  PartCall part_;
  bool quiet_;
  const std::vector<TapeFrame>& tape_;
  std::vector<std::string> outputs_;
  std::filesystem::path folder_;
  Json digests_;
  ResultCache store_;
};

}  // namespace earthshine::app
