// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/numbers/digest.h"
#include "base/parallel.h"

namespace earthshine::scenes {
namespace {

constexpr double full = 65535.0;
constexpr std::size_t texels_together = 65536;  // by one thread

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
  texels_.reserve(4 * (count + count / 3 + 64));  // with the smaller pictures
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
  while (levels_.back().width > 1 || levels_.back().height > 1) add_half();
}

namespace {

// How much of the texels of a row, from `first` on, lies in one of the next picture's: shares that
// add up to 1.
struct Cover {
  std::size_t first = 0, count = 0;
  std::array<float, 4> share{};
};

// A texel of half the picture covers two, of an odd size three or parts of four.
std::vector<Cover> covers(int from, int to) {
  const double step = double(from) / to;
  std::vector<Cover> all(static_cast<std::size_t>(to));
  for (int k = 0; k < to; ++k) {
    const double begin = k * step, end = begin + step;
    Cover& cover = all[static_cast<std::size_t>(k)];
    const int first = int(begin), last = std::min({from, int(std::ceil(end - 1e-9)), first + 4});
    cover.first = static_cast<std::size_t>(first);
    cover.count = static_cast<std::size_t>(last - first);
    for (int i = first; i < last; ++i) {
      cover.share[static_cast<std::size_t>(i - first)] =
          float((std::min(end, i + 1.0) - std::max(begin, double(i))) / step);
    }
  }
  return all;
}

}  // namespace

// Means over the texels below each new one, in proportion to how much of them it covers: the mean
// of the picture stays the same whatever its size.
void Texture::add_half() {
  const Level from = levels_.back();
  const Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), texels_.size()};
  texels_.resize(texels_.size() + 4 * std::size_t(to.width) * std::size_t(to.height));
  const std::vector<Cover> columns = covers(from.width, to.width),
                           rows = covers(from.height, to.height);
  const std::size_t rows_together = std::max<std::size_t>(1, texels_together / columns.size());
  base::parallel_chunks(rows.size(), rows_together, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      std::uint16_t* made = texels_.data() + to.first + 4 * y * columns.size();
      for (const Cover& column : columns) {
        std::array<float, 4> sum{0.5F, 0.5F, 0.5F, 0.5F};  // rounds
        for (std::size_t j = 0; j < rows[y].count; ++j) {
          const std::uint16_t* t =
              texels_.data() + from.first +
              4 * ((rows[y].first + j) * std::size_t(from.width) + column.first);
          for (std::size_t i = 0; i < column.count; ++i, t += 4) {
            const float share = rows[y].share[j] * column.share[i];
            for (std::size_t c = 0; c < 4; ++c) sum[c] += share * float(t[c]);
          }
        }
        for (const float x : sum) *made++ = static_cast<std::uint16_t>(x);
      }
    }
  });
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
      } catch (const base::Error& error) {  // said by take()
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
