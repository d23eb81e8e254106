// SPDX-License-Identifier: Apache-2.0
// `degrade --part`: processes share the frames of a sequence. Frames are written as by one process;
// OUT.parts, beside the sequence, stores their reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/cctv/cctv.h"
#include "app/parts/part.h"
#include "app/parts/result_cache.h"

namespace earthshine::app {

// Maps pictures to television frames: one still for several frames, or a sequence of pictures, one
// per frame or, for an interlaced camera, one per field.

struct TapeCall {
  std::vector<std::string> inputs;
  std::uint64_t frames = 0;  // number of frames of a single input; 0: unset
  bool fields = false;       // inputs are fields, two per frame
  std::uint64_t first = 0;   // number of the first frame
};

struct TapeFrame {
  std::uint64_t number = 0;
  std::vector<std::string> inputs;  // one, or one per field
};

// Throws base::Error (Input) for --frames with several pictures, and for an odd number of fields.
[[nodiscard]] std::vector<TapeFrame> lay_out(const TapeCall& call);

// The path with the # characters in its file name replaced by the number, zero-padded to their
// count. Without # the path itself.
[[nodiscard]] std::string numbered(const std::string& path, std::uint64_t number);

// Throws base::Error (Input), naming `option`, if several frames would share a file.
void check_numbered(const std::string& option, const std::string& path, std::size_t frames);

class FrameParts {
 public:
  // outputs: file names with # for the frame's number; the first one determines the folder. Throws
  // base::Error (Input) if the folder belongs to another call.
  FrameParts(const PartCall& part, const TapeCall& pictures, const std::vector<TapeFrame>& tape,
             const std::vector<std::string>& outputs, const CctvSetup& setup, const Common& common);

  // The frames, by index on the tape, that this process writes: none for a merge, none if the part
  // is complete.
  [[nodiscard]] Share to_do() const;
  // Stores the report of a frame whose files are written.
  void keep(std::size_t place, const Json& report) const;
  // Reports of all frames; throws base::Error (Work) if one is missing, with the command that makes
  // it.
  [[nodiscard]] Json reports() const;

 private:
  [[nodiscard]] Json key_of(std::size_t place) const;
  // Digests of a frame's outputs; empty if one is missing.
  [[nodiscard]] Json digests_of_files(std::size_t place) const;
  // Null unless the frame is complete.
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
