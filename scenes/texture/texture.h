// SPDX-License-Identifier: Apache-2.0
// A picture on a surface: linear colour by position. There are no mipmaps: their texels would mix
// colours of adjacent parts of an atlas, of which the samples of a pixel know nothing. Samples of
// the original picture are unbiased, and their variance measures the error.
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

// Mode outside [0, 1].
enum class Wrap : std::uint8_t { Repeat, Clamp, Mirror };

struct TextureReading {
  std::string name;       // of the file, for reports
  bool is_srgb = true;    // colours are decoded to linear ones (IEC 61966-2-1)
  bool is_mask = false;   // opacity: the picture's alpha, or its grey value without alpha
  bool is_crisp = false;  // nearest texel, no interpolation
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
  bool operator==(const TextureReading&) const = default;
};

class Texture {
 public:
  Texture(const base::Pixels& pixels, TextureReading reading);

  // Linear colour and opacity, in [0, 1]. u points right, v down from the upper left corner; 1 is
  // the far edge.
  [[nodiscard]] glm::dvec4 at(const glm::dvec2& uv) const;
  [[nodiscard]] const glm::dvec4& mean() const { return mean_; }  // over the whole picture
  [[nodiscard]] const std::string& name() const { return reading_.name; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] std::size_t bytes() const { return texels_.size() * sizeof(std::uint16_t); }
  [[nodiscard]] std::uint64_t digest() const { return digest_; }  // of everything that affects at()

 private:
  [[nodiscard]] glm::dvec4 texel(int x, int y) const;

  TextureReading reading_;
  int width_, height_;
  std::vector<std::uint16_t> texels_;  // 4 per texel, 65535 is 1: resolves sRGB's darkest step
  glm::dvec4 mean_{0.0};
  std::uint64_t digest_ = 0;
};

// Maps (u, v) of the vertices to (u, v) of the texture.
struct TextureTransform {
  glm::dmat2 matrix{1.0};
  glm::dvec2 shift{0.0};
  [[nodiscard]] glm::dvec2 apply(const glm::dvec2& uv) const { return matrix * uv + shift; }
};

// Textures of mesh files. A picture that cannot be read leaves the plain colour and gives a
// warning: models are often passed on without their pictures.

// Shared cache of pictures in memory, one entry for each file and way of reading it.
class PictureShelf {
 public:
  // `warnings` belongs to the mesh and must outlive the shelf.
  explicit PictureShelf(std::vector<std::string>& warnings) : warnings_(warnings) {}

  // A picture that will be requested, and its bytes.
  struct Picture {
    TextureReading reading;
    std::string bytes;
  };
  // Decodes many pictures on all threads. take() reports failures.
  void prepare(const std::vector<Picture>& pictures);

  // The texture decoded from the bytes that `read` returns; `read` is called for each new key.
  // Null, with a warning, if it or the decoder fails with base::Error (Input).
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
