// SPDX-License-Identifier: Apache-2.0
#include "base/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"

namespace earthshine::base {
namespace {

constexpr std::size_t chunk_px = 4096;
constexpr double middle_grey = 0.18;

void refuse_non_finite(const Image& image, const std::vector<float>& luminance) {
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    if (std::isfinite(luminance[i])) continue;
    const std::size_t width = static_cast<std::size_t>(image.width);
    throw Error(Blame::Work, "tone mapping",
                "pixel (" + std::to_string(i % width) + ", " + std::to_string(i / width) +
                    ") is not a finite number");
  }
}

// {1, 0} for a black picture.
ToneReport choose_exposure(const std::vector<float>& luminance) {
  std::vector<float> lit;
  for (float y : luminance) {
    if (y > 0.0F) lit.push_back(y);
  }
  if (lit.empty()) return {};
  const std::size_t rank =
      static_cast<std::size_t>(std::lround(0.995 * static_cast<double>(lit.size() - 1)));
  const auto bright = lit.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(lit.begin(), bright, lit.end());
  const double percentile = *bright;

  // A few nearly black pixels would dominate the logarithm. Pixels below 1e-5 of the bright end (17
  // stops) are not lit.
  struct LogSum {
    double sum = 0.0, count = 0.0;
    LogSum& operator+=(const LogSum& o) {
      sum += o.sum;
      count += o.count;
      return *this;
    }
  };
  const LogSum log_sum =
      ordered_sum(luminance.size(), chunk_px, LogSum{}, [&](std::size_t begin, std::size_t end) {
        LogSum part;
        for (std::size_t i = begin; i < end; ++i) {
          if (luminance[i] < 1e-5 * percentile) continue;
          part.sum += std::log(static_cast<double>(luminance[i]));
          part.count += 1.0;
        }
        return part;
      });
  const double exposure = middle_grey / std::exp(log_sum.sum / log_sum.count);
  // A white below 1 would stretch a flat picture to full white; at 1 the operator is the identity.
  const double white = std::max(1.0, exposure * percentile);
  return {exposure, white / exposure};
}

// scale_of(luminance): ratio of displayed colour to radiance.
template <class Scale>
ToneMapped apply_curve(const Image& image, const std::vector<float>& luminance,
                       const ToneReport& report, Scale scale_of) {
  ToneMapped result;
  result.rgb.assign(luminance.size() * 3, 0);
  result.report = report;
  const Channel* channels[3] = {image.find("R"), image.find("G"), image.find("B")};
  if (channels[0] == nullptr || channels[1] == nullptr || channels[2] == nullptr) {
    std::fill(std::begin(channels), std::end(channels), image.find("Y"));
  }
  parallel_chunks(luminance.size(), chunk_px, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double scale = scale_of(std::max(0.0, static_cast<double>(luminance[i])));
      Rgb colour{channels[0]->values[i], channels[1]->values[i], channels[2]->values[i]};
      colour = glm::max(colour * scale, Rgb(0.0));
      // Scaled instead of clipped, so that a bright lamp keeps its hue.
      colour /= std::max(1.0, max_component(colour));
      for (int c = 0; c < 3; ++c)
        result.rgb[3 * i + static_cast<std::size_t>(c)] = srgb_byte(colour[c]);
    }
  });
  return result;
}

ToneMapped apply_exposure(const Image& image, const std::vector<float>& luminance,
                          const ToneReport& report) {
  const double exposure = report.exposure;
  const double white = std::max(1.0, exposure * report.white_cd_per_m2);
  return apply_curve(image, luminance, report, [=](double y) {
    const double signal = exposure * y;
    return exposure * (1.0 + signal / (white * white)) / (1.0 + signal);
  });
}

constexpr double shoulder_from = 0.6;

double shown(double signal, ToneCurve curve) {
  if (curve == ToneCurve::Clip) return std::min(1.0, signal);
  if (signal <= shoulder_from) return signal;
  const double room = 1.0 - shoulder_from;
  return 1.0 - room * std::exp(-(signal - shoulder_from) / room);
}

double srgb_curve(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// Thresholds of the bytes: a table look-up instead of a power per pixel.
struct SrgbSteps {
  static constexpr std::size_t cells = 4096;
  std::array<double, 256> begin{};          // smallest value that rounds to this byte
  std::array<std::uint8_t, cells> first{};  // byte at the lower end of a cell

  SrgbSteps() {
    for (std::size_t byte = 1; byte < begin.size(); ++byte) {
      double below = 0.0, from = 1.0;
      while (true) {
        const double middle = 0.5 * (below + from);
        if (middle <= below || middle >= from) break;
        (255.0 * srgb_curve(middle) >= static_cast<double>(byte) - 0.5 ? from : below) = middle;
      }
      begin[byte] = from;
    }
    std::size_t byte = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      while (byte < 255 && begin[byte + 1] <= static_cast<double>(cell) / cells) ++byte;
      first[cell] = static_cast<std::uint8_t>(byte);
    }
  }
};

}  // namespace

double srgb_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb_byte(double linear) {
  static const SrgbSteps steps;
  if (!(linear > 0.0)) return 0;
  if (linear >= 1.0) return 255;
  std::size_t byte = steps.first[static_cast<std::size_t>(linear * SrgbSteps::cells)];
  while (byte < 255 && linear >= steps.begin[byte + 1]) ++byte;
  return static_cast<std::uint8_t>(byte);
}

ToneMapped tone_map(const Image& image) {
  const std::vector<float> luminance = luminance_of(image);
  refuse_non_finite(image, luminance);
  return apply_exposure(image, luminance, choose_exposure(luminance));
}

ToneMapped expose(const Image& image, double white_cd_per_m2, ToneCurve curve) {
  const std::vector<float> luminance = luminance_of(image);
  refuse_non_finite(image, luminance);
  const double exposure = 1.0 / white_cd_per_m2;
  return apply_curve(image, luminance, {exposure, white_cd_per_m2},
                     [=](double y) { return y > 0.0 ? shown(exposure * y, curve) / y : exposure; });
}

double white_at(const std::vector<const Image*>& pictures, double percent) {
  std::vector<float> lit;
  for (const Image* picture : pictures) {
    const std::vector<float> luminance = luminance_of(*picture);
    refuse_non_finite(*picture, luminance);
    for (const float y : luminance) {
      if (y > 0.0F) lit.push_back(y);
    }
  }
  if (lit.empty()) return 1.0;
  std::sort(lit.begin(), lit.end());
  const auto at = [](auto first, auto last, double share) {
    return first +
           static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(last - first - 1)));
  };
  const float bright = *at(lit.begin(), lit.end(), 0.995);
  const auto from = std::lower_bound(lit.begin(), lit.end(), 1e-5F * bright);
  return static_cast<double>(*at(from, lit.end(), percent / 100.0));
}

ToneMapped tone_map_with(const Image& image, const ToneReport& exposure) {
  const std::vector<float> luminance = luminance_of(image);
  refuse_non_finite(image, luminance);
  return apply_exposure(image, luminance, exposure);
}

}  // namespace earthshine::base
