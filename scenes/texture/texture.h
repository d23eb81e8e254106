// SPDX-License-Identifier: Apache-2.0
// A picture on a surface: its colours by place, linear. There are no smaller copies for places seen
// from afar: their texels mix colours of neighbouring parts of an atlas, which the samples of a
// pixel do not know of. Samples of the picture itself are right on average, and their scatter says
// how far they are off.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/pixels/pixels.h"

namespace earthshine::scenes {

// Beyond the picture's edges.
enum class Wrap : std::uint8_t { Repeat, Clamp, Mirror };

struct TextureReading {
  std::string name;       // of the file, for reports
  bool is_srgb = true;    // colours are decoded to linear ones (IEC 61966-2-1)
  bool is_mask = false;   // opacity: the picture's alpha, or its grey where it has none
  bool is_crisp = false;  // nearest texel, not between four
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
  bool operator==(const TextureReading&) const = default;
};

class Texture {
 public:
  Texture(const base::Pixels& pixels, TextureReading reading);

  // Linear colour and opacity, in [0, 1]. u to the right, v down from the upper left corner, 1 at
  // the far edges.
  [[nodiscard]] glm::dvec4 at(const glm::dvec2& uv) const;
  [[nodiscard]] const glm::dvec4& mean() const { return mean_; }  // of the whole picture
  [[nodiscard]] const std::string& name() const { return reading_.name; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] std::size_t bytes() const { return texels_.size() * sizeof(std::uint16_t); }
  [[nodiscard]] std::uint64_t digest() const { return digest_; }  // of all that at() depends on

 private:
  [[nodiscard]] glm::dvec4 texel(int x, int y) const;

  TextureReading reading_;
  int width_, height_;
  std::vector<std::uint16_t> texels_;  // 4 a texel, 65535 is 1: fine enough for sRGB's darkest step
  glm::dvec4 mean_{0.0};
  std::uint64_t digest_ = 0;
};

// (u, v) of the vertices to (u, v) of the texture.
struct TextureTransform {
  glm::dmat2 turn{1.0};
  glm::dvec2 shift{0.0};
  [[nodiscard]] glm::dvec2 apply(const glm::dvec2& uv) const { return turn * uv + shift; }
};

// Textures of mesh files. What cannot be read leaves the plain colour and a warning: models are
// handed round without their pictures more often than not.

// One picture of a file in memory for each way of reading it.
class PictureShelf {
 public:
  // `warnings` is the mesh's, and must outlive the shelf.
  explicit PictureShelf(std::vector<std::string>& warnings) : warnings_(warnings) {}

  // A picture that will be taken, and its bytes.
  struct Picture {
    TextureReading reading;
    std::string bytes;
  };
  // Makes many of them at once, on all threads. What fails is left to take().
  void prepare(const std::vector<Picture>& pictures);

  // The texture of the bytes that `read` gives, which is called for each new key. Null, and a
  // warning, where that or the picture fails with base::Error (Input).
  [[nodiscard]] std::shared_ptr<const Texture> take(const TextureReading& reading,
                                                    const std::function<std::string()>& read);

 private:
  struct Shelved {
    TextureReading reading;
    std::shared_ptr<const Texture> texture;
  };
  std::vector<Shelved> shelved_;
  std::vector<std::string>& warnings_;
};

}  // namespace earthshine::scenes
