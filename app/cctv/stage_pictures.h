// SPDX-License-Identifier: Apache-2.0
// The picture after each stage of the CCTV chain, as files.
#pragma once

#include <string>

#include "app/output.h"
#include "degrade/chain.h"

namespace earthshine::app {

// While it lives, the chain run with `options` writes DIR/NN-stage.exr after each stage, in the
// stage's unit. An empty folder name: nothing. Throws base::Error (Input) when an input
// lies in the folder, and (Work) when a file cannot be written.
class StagePictures {
 public:
  StagePictures(std::string folder, const Files& inputs, degrade::Options& options);
  ~StagePictures();
  StagePictures(const StagePictures&) = delete;
  StagePictures& operator=(const StagePictures&) = delete;

 private:
  std::string folder_;
  degrade::Options& options_;
};

}  // namespace earthshine::app
