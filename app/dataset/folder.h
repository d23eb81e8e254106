// SPDX-License-Identifier: Apache-2.0
// Where a data set's files are in its folder; BOP's are below train/000000.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "app/output.h"

namespace earthshine::app {

// The files of a data set.
class Folder {
 public:
  explicit Folder(std::filesystem::path path) : path_(std::move(path)) {
    for (const char* room : {"models", "images", "train/000000/rgb", "train/000000/depth",
                             "train/000000/mask", "train/000000/mask_visib"}) {
      std::filesystem::path folder = path_;
      make_folder(folder);
      for (const std::filesystem::path& part : std::filesystem::path(room))
        make_folder(folder /= part);
    }
  }
  [[nodiscard]] std::filesystem::path labels(std::size_t image) const {
    return path_ / "images" / fmt::format("{:06}.json", image);
  }
  [[nodiscard]] std::filesystem::path layers(std::size_t image) const {
    return path_ / "images" / fmt::format("{:06}.exr", image);
  }
  [[nodiscard]] std::filesystem::path bop(const char* room, std::size_t image) const {
    return path_ / "train/000000" / room / fmt::format("{:06}.png", image);
  }
  [[nodiscard]] std::filesystem::path mask(const char* room, std::size_t image,
                                           std::size_t target) const {
    return path_ / "train/000000" / room / fmt::format("{:06}_{:06}.png", image, target);
  }
  // scene_camera, scene_gt, scene_gt_info, annotations.
  [[nodiscard]] std::vector<std::filesystem::path> lists() const {
    const std::filesystem::path bop = path_ / "train/000000";
    return {bop / "scene_camera.json", bop / "scene_gt.json", bop / "scene_gt_info.json",
            path_ / "annotations.json"};
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace earthshine::app
