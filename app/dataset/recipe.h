// SPDX-License-Identifier: Apache-2.0
// A data set's file, DATASET.toml: what is drawn anew for each image, and between what bounds.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/json.h"
#include "scenes/text/toml_file.h"

namespace earthshine::app {

using Bounds = std::array<double, 2>;

// A key of the scene with a value of its own in each image.
struct Varied {
  enum class Law { Uniform, LogUniform, Choice, Direction };
  std::string key;  // as --set has it
  Law law = Law::Uniform;
  std::vector<Bounds> bounds;      // one for a number, one for each component of a vector
  std::vector<std::string> words;  // TOML values of a choice
};

struct KeyPoint {
  std::string name;
  Vec3 position{0.0};  // m, in the model's axes
};

struct DrawnTarget {
  std::string name;
  bool moves = false;            // else it stays where the scene has it
  Vec3 low{0.0}, high{0.0};      // m, of translate
  bool random_attitude = false;  // to any attitude, all equally likely
  std::vector<KeyPoint> points;
};

// Where the camera is. It looks at a point with a jitter, uniform in a ball.
struct DrawnCamera {
  enum class From { Scene, Shell, Box, Path };
  std::string name;  // of the scene
  From from = From::Scene;
  Vec3 center{0.0};         // of a shell, m; its elevation is measured from the xy plane
  Bounds radius{1.0, 1.0};  // m
  Bounds azimuth_deg{0.0, 360.0}, elevation_deg{-90.0, 90.0};
  Vec3 low{0.0}, high{0.0};     // of a box
  std::vector<Vec3> points;     // of a path: evenly along its length
  std::optional<Vec3> look_at;  // m
  std::string look_at_target;   // the middle of its bounding box
  double jitter_m = 0.0;
  Bounds roll_deg{0.0, 0.0};
  double clearance_m = 0.0;  // to surfaces, along 96 rays
};

struct Recipe {
  std::filesystem::path path, scene;
  std::vector<std::string> overrides;
  std::size_t images = 0;
  std::uint64_t seed = 1;
  double error = 0.05;
  bool cctv = false;                  // pictures as the camera's CCTV chain shows them
  std::optional<Bounds> white_cd_m2;  // of the exposure, log-uniform; none: by each picture
  double unit_m = 1.0;                // of the scene
  DrawnCamera camera;
  std::vector<DrawnTarget> targets;
  std::vector<Varied> varied;
};

// Throws base::Error (Input) at the place in the file.
[[nodiscard]] Recipe read_recipe(const std::filesystem::path& path);

// All that is drawn for an image, by the data set's seed and the image's number alone.
struct Draw {
  std::vector<std::string> overrides;  // of the scene, as --set has them
  struct Pose {
    Vec3 rotate_deg{0.0}, translate_m{0.0};
  };
  std::vector<Pose> poses;  // of the targets; zero for those that stay
  std::optional<double> white_cd_m2;
  std::uint64_t seed = 0;  // of the picture's samples and noise
};
[[nodiscard]] Draw draw_values(const Recipe& recipe, std::size_t image);

// A pose of the camera; `attempt` counts those that were refused.
struct CameraPose {
  Vec3 position{0.0}, look_at{0.0}, up{0.0};
};
// scene_pose: of the camera in the scene's file. target: the middle of what it looks at.
[[nodiscard]] CameraPose draw_camera(const Recipe& recipe, std::size_t image, std::size_t attempt,
                                     const CameraPose& scene_pose,
                                     const std::optional<Vec3>& target);

}  // namespace earthshine::app
