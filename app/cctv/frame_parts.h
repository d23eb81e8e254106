// SPDX-License-Identifier: Apache-2.0
// `degrade --part`: the frames of a sequence in shares. Each is written where one process would
// write it; what is kept beside the sequence, in OUT.parts, are the frames' reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/cctv/cctv.h"
#include "app/parts/part.h"
#include "app/parts/result_cache.h"

namespace earthshine::app {

// Which pictures become which television frames: one still shown for some frames, or a row of
// pictures, one for each frame or, of an interlaced camera, for each field.

struct TapeCall {
  std::vector<std::string> inputs;
  std::uint64_t frames = 0;  // how long a single input is shown; 0: not said
  bool fields = false;       // inputs are fields: two to a frame
  std::uint64_t first = 0;   // number of the first frame
};

struct TapeFrame {
  std::uint64_t number = 0;
  std::vector<std::string> inputs;  // one, or one for each field
};

// Throws base::Error (Input) when --frames stands beside several pictures, or fields are odd in
// number.
[[nodiscard]] std::vector<TapeFrame> lay_out(const TapeCall& call);

// The path with its run of # in the file's name replaced by the number, as wide as the run at
// least. Without # the path itself.
[[nodiscard]] std::string numbered(const std::string& path, std::uint64_t number);

// Throws base::Error (Input), naming `option`, when several frames would be written into one file.
void check_numbered(const std::string& option, const std::string& path, std::size_t frames);

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
