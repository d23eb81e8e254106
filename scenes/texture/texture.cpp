// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/numbers/digest.h"
#include "base/parallel.h"
#include "base/tone.h"

namespace earthshine::scenes {
namespace {

constexpr double full = 65535.0;
constexpr std::size_t texels_together = 65536;  // by one thread

std::array<std::uint16_t, 256> decoding(bool is_srgb) {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double share = static_cast<double>(k) / 255.0;
    table[k] = static_cast<std::uint16_t>(
        std::lround(full * (is_srgb ? base::srgb_linear(share) : share)));
  }
  return table;
}

int wrapped(std::int64_t x, int size, Wrap wrap) {
  if (wrap == Wrap::Clamp) return static_cast<int>(std::clamp<std::int64_t>(x, 0, size - 1));
  const std::int64_t period = wrap == Wrap::Mirror ? 2 * std::int64_t{size} : size;
  std::int64_t in = x % period;
  if (in < 0) in += period;
  return static_cast<int>(in < size ? in : period - 1 - in);
}

}  // namespace

Texture::Texture(const base::Pixels& pixels, TextureReading reading)
    : reading_(std::move(reading)), width_(pixels.width), height_(pixels.height) {
  const auto colour = decoding(reading_.is_srgb), plain = decoding(false);
  const std::size_t count = pixels.rgba.size() / 4;
  texels_.resize(4 * count);
  bool has_alpha = false;
  for (std::size_t k = 0; reading_.is_mask && k < count && !has_alpha; ++k) {
    has_alpha = pixels.rgba[4 * k + 3] < 255;
  }
  const std::size_t opacity = reading_.is_mask && !has_alpha ? 1 : 3;
  base::Digest digest;
  base::parallel_chunks(count, texels_together, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint8_t* const rgba = pixels.rgba.data() + 4 * k;
      std::uint16_t* const texel = texels_.data() + 4 * k;
      for (std::size_t c = 0; c < 3; ++c) texel[c] = colour[rgba[c]];
      texel[3] = plain[rgba[opacity]];
    }
  });
  digest.add(
      std::string_view(reinterpret_cast<const char*>(pixels.rgba.data()), pixels.rgba.size()));
  for (const int part : {pixels.width, pixels.height, int{reading_.is_srgb}, int{reading_.is_mask},
                         int{reading_.is_crisp}, static_cast<int>(reading_.wrap_u),
                         static_cast<int>(reading_.wrap_v)}) {
    digest.add(static_cast<std::uint64_t>(part));
  }
  digest_ = digest.value();
  std::array<std::uint64_t, 4> sum{};
  for (std::size_t k = 0; k < texels_.size(); ++k) sum[k % 4] += texels_[k];
  for (int c = 0; c < 4; ++c) {
    mean_[c] = static_cast<double>(sum[static_cast<std::size_t>(c)]) / full / double(count);
  }
}

glm::dvec4 Texture::texel(int x, int y) const {
  const std::uint16_t* const t =
      texels_.data() + 4 * (std::size_t(y) * std::size_t(width_) + std::size_t(x));
  return glm::dvec4(t[0], t[1], t[2], t[3]) / full;
}

glm::dvec4 Texture::at(const glm::dvec2& uv) const {
  const bool is_number = !std::isnan(uv.x) && !std::isnan(uv.y);
  // Clamped so that the conversion to integers cannot overflow.
  const double x = is_number ? std::clamp(uv.x * width_, -1e15, 1e15) : 0.0;
  const double y = is_number ? std::clamp(uv.y * height_, -1e15, 1e15) : 0.0;
  const auto column = [&](double k) {
    return wrapped(static_cast<std::int64_t>(k), width_, reading_.wrap_u);
  };
  const auto row = [&](double k) {
    return wrapped(static_cast<std::int64_t>(k), height_, reading_.wrap_v);
  };
  if (reading_.is_crisp) return texel(column(std::floor(x)), row(std::floor(y)));
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const double fx = x - 0.5 - left, fy = y - 0.5 - top;
  const int x0 = column(left), x1 = column(left + 1.0), y0 = row(top), y1 = row(top + 1.0);
  return (1.0 - fy) * ((1.0 - fx) * texel(x0, y0) + fx * texel(x1, y0)) +
         fy * ((1.0 - fx) * texel(x0, y1) + fx * texel(x1, y1));
}

void PictureShelf::prepare(const std::vector<Picture>& pictures) {
  std::vector<const Picture*> fresh;
  for (const Picture& picture : pictures) {
    const auto is_same = [&](const auto& other) { return other.reading == picture.reading; };
    if (std::any_of(shelved_.begin(), shelved_.end(), is_same) ||
        std::any_of(fresh.begin(), fresh.end(),
                    [&](const Picture* other) { return is_same(*other); })) {
      continue;
    }
    fresh.push_back(&picture);
  }
  std::vector<std::shared_ptr<const Texture>> made(fresh.size());
  base::parallel_chunks(fresh.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      try {
        made[k] = std::make_shared<const Texture>(
            base::read_pixels(fresh[k]->bytes, fresh[k]->reading.name), fresh[k]->reading);
      } catch (const base::Error& error) {  // reported by take()
        if (error.blame() != base::Blame::Input) throw;
      }
    }
  });
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    if (made[k]) shelved_.push_back({fresh[k]->reading, made[k]});
  }
}

std::shared_ptr<const Texture> PictureShelf::take(const TextureReading& reading,
                                                  const std::function<std::string()>& read) {
  for (const Shelved& known : shelved_) {
    if (known.reading == reading) return known.texture;
  }
  std::shared_ptr<const Texture> made;
  try {
    made = std::make_shared<const Texture>(base::read_pixels(read(), reading.name), reading);
  } catch (const base::Error& error) {
    if (error.blame() != base::Blame::Input) throw;
    warnings_.push_back(
        fmt::format("a texture is left out, the plain colour stays: {}", error.what()));
  }
  shelved_.push_back({reading, made});
  return made;
}

}  // namespace earthshine::scenes
