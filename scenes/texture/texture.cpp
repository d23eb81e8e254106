// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/numbers/digest.h"

namespace earthshine::scenes {
namespace {

constexpr double full = 65535.0;

// IEC 61966-2-1.
double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::array<std::uint16_t, 256> decoding(bool is_srgb) {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double share = static_cast<double>(k) / 255.0;
    table[k] = static_cast<std::uint16_t>(std::lround(full * (is_srgb ? linear(share) : share)));
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
    : reading_(std::move(reading)) {
  const auto colour = decoding(reading_.is_srgb), plain = decoding(false);
  levels_.push_back({pixels.width, pixels.height, 0});
  const std::size_t count = pixels.rgba.size() / 4;
  texels_.resize(4 * count);
  bool has_alpha = false;
  for (std::size_t k = 0; k < count; ++k) has_alpha = has_alpha || pixels.rgba[4 * k + 3] < 255;
  base::Digest digest;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint8_t* const rgba = pixels.rgba.data() + 4 * k;
    for (std::size_t c = 0; c < 3; ++c) texels_[4 * k + c] = colour[rgba[c]];
    texels_[4 * k + 3] = plain[reading_.is_mask && !has_alpha ? rgba[1] : rgba[3]];
  }
  digest.add(
      std::string_view(reinterpret_cast<const char*>(pixels.rgba.data()), pixels.rgba.size()));
  for (const int part : {pixels.width, pixels.height, int{reading_.is_srgb}, int{reading_.is_mask},
                         int{reading_.is_crisp}, static_cast<int>(reading_.wrap_u),
                         static_cast<int>(reading_.wrap_v)}) {
    digest.add(static_cast<std::uint64_t>(part));
  }
  digest_ = digest.value();
  while (levels_.back().width > 1 || levels_.back().height > 1) add_half();
}

// Means over the texels below each new one, in proportion to how much of them it covers: the mean
// of the picture stays the same whatever its size.
void Texture::add_half() {
  const Level from = levels_.back();
  const Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), texels_.size()};
  texels_.resize(texels_.size() + 4 * std::size_t(to.width) * std::size_t(to.height));
  const double step_x = double(from.width) / to.width, step_y = double(from.height) / to.height;
  const auto cover = [](int k, double begin, double end) {
    return std::min(end, k + 1.0) - std::max(begin, double(k));
  };
  for (int y = 0; y < to.height; ++y) {
    const double y0 = y * step_y, y1 = y0 + step_y;
    for (int x = 0; x < to.width; ++x) {
      const double x0 = x * step_x, x1 = x0 + step_x;
      glm::dvec4 sum(0.0);
      for (int j = int(y0); j < std::min(from.height, int(std::ceil(y1 - 1e-9))); ++j) {
        for (int i = int(x0); i < std::min(from.width, int(std::ceil(x1 - 1e-9))); ++i) {
          sum += cover(i, x0, x1) * cover(j, y0, y1) * texel(from, i, j);
        }
      }
      sum /= step_x * step_y;
      const std::size_t at =
          to.first + 4 * (std::size_t(y) * std::size_t(to.width) + std::size_t(x));
      for (int c = 0; c < 4; ++c) {
        texels_[at + std::size_t(c)] = static_cast<std::uint16_t>(std::lround(full * sum[c]));
      }
    }
  }
  levels_.push_back(to);
}

glm::dvec4 Texture::texel(const Level& level, int x, int y) const {
  const std::uint16_t* const t = texels_.data() + level.first +
                                 4 * (std::size_t(y) * std::size_t(level.width) + std::size_t(x));
  return glm::dvec4(t[0], t[1], t[2], t[3]) / full;
}

glm::dvec4 Texture::in_level(const Level& level, const glm::dvec2& uv, bool crisp) const {
  // Far-away coordinates repeat long before they leave whole numbers.
  const double x = std::clamp(uv.x * level.width, -1e15, 1e15);
  const double y = std::clamp(uv.y * level.height, -1e15, 1e15);
  const auto column = [&](double k) {
    return wrapped(static_cast<std::int64_t>(k), level.width, reading_.wrap_u);
  };
  const auto row = [&](double k) {
    return wrapped(static_cast<std::int64_t>(k), level.height, reading_.wrap_v);
  };
  if (crisp) return texel(level, column(std::floor(x)), row(std::floor(y)));
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const double fx = x - 0.5 - left, fy = y - 0.5 - top;
  const int x0 = column(left), x1 = column(left + 1.0), y0 = row(top), y1 = row(top + 1.0);
  return (1.0 - fy) * ((1.0 - fx) * texel(level, x0, y0) + fx * texel(level, x1, y0)) +
         fy * ((1.0 - fx) * texel(level, x0, y1) + fx * texel(level, x1, y1));
}

glm::dvec4 Texture::at(const glm::dvec2& uv, double level) const {
  const bool is_number = !std::isnan(uv.x) && !std::isnan(uv.y);
  const glm::dvec2 place = is_number ? uv : glm::dvec2(0.0);
  if (!(level > 0.0)) return in_level(levels_.front(), place, reading_.is_crisp);
  const double last = static_cast<double>(levels_.size() - 1);
  const double wanted = std::min(level, last);
  const auto lower = static_cast<std::size_t>(wanted);
  const double share = wanted - std::floor(wanted);
  const glm::dvec4 fine = in_level(levels_[lower], place, lower == 0 && reading_.is_crisp);
  if (share <= 0.0) return fine;
  return (1.0 - share) * fine + share * in_level(levels_[lower + 1], place, false);
}

glm::dvec4 Texture::mean() const { return texel(levels_.back(), 0, 0); }

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
