// SPDX-License-Identifier: Apache-2.0
// The scene behind `console --serve`: pictures of it while cameras, lamps, objects and joints move.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/render/warm_scene.h"
#include "scenes/text/toml_file.h"

namespace earthshine::app {

// A request of the page: {"camera", "columns", "rows", "view", "set", "level"}, all but "camera"
// optional. Lengths of `view` are in m, values of `set` as in the scene file.
struct LiveRequest {
  struct View {
    Vec3 position{0.0}, look_at{0.0}, up{0.0};
    double fov_deg = 0.0;
  };
  std::string camera;
  Size size{256, 256};
  std::optional<View> view;
  std::vector<std::pair<std::string, std::vector<double>>> set;  // "light.NAME.position": 3 numbers
  std::size_t level = 0;                                         // 0: at once
};
// Throws base::Error (Input) for text that is not JSON, unknown keys, and values of another type,
// number or range.
[[nodiscard]] LiveRequest read_live_request(std::string_view text);

// The wanted error of each level above 0.
inline constexpr double level_errors[] = {0.3, 0.2, 0.1, 0.05, 0.03, 0.02};

enum class MovableKind { Lamp, Object, Joint };

class LiveScene {
 public:
  LiveScene(const SceneInput& input, const Common& common);

  // Cameras, and what can be moved, as the scene was at the start: for the page.
  [[nodiscard]] const Json& description() const { return description_; }
  // A head as JSON, its length in four bytes (little-endian) before it, and planes of 32-bit
  // floats: R, G and B; with level 0 also the object and the depth, m along the camera's axis, of
  // each pixel of the size in the request. No value if a newer request came meanwhile. Throws
  // base::Error.
  [[nodiscard]] std::optional<std::string> draw(const LiveRequest& request);

 private:
  struct Movable {
    std::string key;
    std::vector<double> value;
    MovableKind kind;
    std::optional<std::size_t> index;  // in the scene's list
    bool moves_warm;                   // another value needs no file
    std::optional<Vec3> aim_m;         // of a spot: the point that it keeps aiming at
  };
  using Set = decltype(LiveRequest::set);
  // Those of the scene's own file.
  [[nodiscard]] std::vector<Movable> movables() const;
  [[nodiscard]] Json describe() const;
  // Where the movables of this pose are, m; of objects the middle of their bounds.
  [[nodiscard]] Json marks() const;
  void apply(const LiveRequest& request);
  void find_in_scene(Movable& one, const std::string& name, const scenes::TomlTable& keys) const;
  // From the scene as it was read; no value if it must be read again.
  [[nodiscard]] std::optional<scenes::PoseChange> change_to(const Set& set) const;
  [[nodiscard]] base::Image at_once(const RenderCall& call, const scenes::Camera& camera,
                                    const Size& size, Json& head);
  [[nodiscard]] base::Image sampled(RenderCall& call, const scenes::Camera& camera, Json& head);

  Common common_;
  std::vector<std::string> own_set_;
  WarmScene scene_;
  Set read_set_, pose_set_;              // of the scene's files, and its present pose
  std::vector<scenes::Camera> cameras_;  // of this pose
  std::vector<Movable> movables_;
  Json description_;
  std::optional<Solved> light_;  // the latest, of `light_set_` and the files as they are read
  Set light_set_;
  std::mutex drawing_;
  std::atomic<std::uint64_t> newest_ = 0;
};

}  // namespace earthshine::app
