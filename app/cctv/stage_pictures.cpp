// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/stage_pictures.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "base/files/exr_file.h"

namespace earthshine::app {

StagePictures::StagePictures(std::string folder, const Files& inputs, degrade::Options& options)
    : folder_(std::move(folder)), options_(options) {
  if (folder_.empty()) return;
  prepare_folder(folder_, {}, {});
  refuse_inputs_in(folder_, inputs);
  options_.watch = [this, count = 0](const degrade::Stage& stage,
                                     const degrade::Picture& picture) mutable {
    base::write_exr(fmt::format("{}/{:02}-{}.exr", folder_, ++count, stage.name),
                    degrade::to_image(picture),
                    {{{"earthshine:cctv.stage", std::string(stage.name)}}, {}});
  };
}

StagePictures::~StagePictures() { options_.watch = {}; }

}  // namespace earthshine::app
