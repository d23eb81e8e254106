// SPDX-License-Identifier: Apache-2.0
#include "base/files/exr_attributes.h"

#include <ImathMatrix.h>
#include <ImfChromaticities.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/input/exr_guard.h"
#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

bool is_own_business(std::string_view name) {
  for (std::string_view standard :
       {"type", "name", "view", "version", "chunkCount", "whiteLuminance", "pixelAspectRatio"}) {
    if (name == standard) return true;
  }
  return false;
}

using Names = std::vector<std::string>;

const Names colour_words[] = {{"R", "G", "B"}, {"r", "g", "b"}, {"red", "green", "blue"}};
const Names luminance_words[] = {{"Y"}, {"luminance"}, {"Luminance"}, {"L"}};

bool has_all(const Names& channels, const Names& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
    return std::find(channels.begin(), channels.end(), name) != channels.end();
  });
}

Names within(const std::string& layer, const Names& words) {
  Names names;
  names.reserve(words.size());
  const std::string prefix = layer.empty() ? layer : layer + ".";
  for (const std::string& word : words) names.push_back(prefix + word);
  return names;
}

// The picture of one layer; "" is the root of the file. X, Y and Z are colours in the root only: in
// a layer they are a position, and its Y is not luminance.
ExrPicture in_layer(const Names& channels, const std::string& layer) {
  for (const Names& words : colour_words) {
    const Names names = within(layer, words);
    if (has_all(channels, names)) return {ExrPicture::Kind::Rgb, names, {}};
  }
  const Names xyz = {"X", "Y", "Z"};
  if (layer.empty() && has_all(channels, xyz)) return {ExrPicture::Kind::Xyz, xyz, {}};
  if (!layer.empty() && has_all(channels, within(layer, {"X"}))) return {};
  for (const Names& words : luminance_words) {
    const Names names = within(layer, words);
    if (has_all(channels, names)) return {ExrPicture::Kind::Luminance, names, {}};
  }
  return {};
}

Names layers_of(const Names& channels) {
  Names layers;
  for (const std::string& name : channels) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string layer = name.substr(0, dot);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

bool is_combined(const std::string& layer) {
  return layer == "Combined" || layer.ends_with(".Combined");
}

}  // namespace

void set_exr_attributes(Imf::Header& header, const ExrHeader& attributes) {
  if (const ExrHeader::Whole& whole = attributes.whole; whole.columns > 0) {
    const Imath::V2i size = header.dataWindow().size();
    header.displayWindow() = {{0, 0}, {whole.columns - 1, whole.rows - 1}};
    header.dataWindow() = {{whole.x, whole.y}, {whole.x + size.x, whole.y + size.y}};
  }
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
  Imf::addWhiteLuminance(header, 1.0F);
  for (const auto& [name, value] : attributes.text) {
    header.insert(name, Imf::StringAttribute(value));
  }
  for (const auto& [name, value] : attributes.numbers) {
    header.insert(name, Imf::FloatAttribute(value));
  }
  for (const auto& [name, value] : attributes.matrices) {
    Imath::M44f matrix;
    std::copy(value.begin(), value.end(), matrix.getValue());
    header.insert(name, Imf::M44fAttribute(matrix));
  }
}

ExrHeader exr_attributes(const Imf::Header& header) {
  ExrHeader result;
  for (auto a = header.begin(); a != header.end(); ++a) {
    if (is_own_business(a.name())) continue;
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) {
      result.text.emplace_back(a.name(), text->value());
    } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&a.attribute())) {
      result.numbers.emplace_back(a.name(), real->value());
    } else if (const auto* wide = dynamic_cast<const Imf::DoubleAttribute*>(&a.attribute())) {
      result.numbers.emplace_back(a.name(), static_cast<float>(wide->value()));
    } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&a.attribute())) {
      result.numbers.emplace_back(a.name(), static_cast<float>(whole->value()));
    } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&a.attribute())) {
      ExrMatrix values{};
      std::copy_n(matrix->value().getValue(), values.size(), values.begin());
      result.matrices.emplace_back(a.name(), values);
    }
  }
  return result;
}

float white_luminance(const std::filesystem::path& path, const Imf::Header& header) {
  if (!Imf::hasWhiteLuminance(header)) return 1.0F;
  const float white = Imf::whiteLuminance(header);
  if (std::isfinite(white) && white > 0.0F) return white;
  throw Error(Blame::Input, path.string(), "has whiteLuminance = " + std::to_string(white),
              "it is the luminance of (1, 1, 1) in cd/m^2 and must be positive");
}

ExrPicture find_picture(const Names& channels) {
  if (ExrPicture whole = in_layer(channels, ""); whole.kind != ExrPicture::Kind::None) {
    return whole;
  }
  Names with_picture, combined;
  for (const std::string& layer : layers_of(channels)) {
    if (in_layer(channels, layer).kind == ExrPicture::Kind::None) continue;
    with_picture.push_back(layer);
    if (is_combined(layer)) combined.push_back(layer);
  }
  if (combined.size() == 1) return in_layer(channels, combined.front());
  if (with_picture.size() == 1) return in_layer(channels, with_picture.front());
  return {ExrPicture::Kind::None, {}, with_picture};
}

void check_exr_file(const std::filesystem::path& path) {
  std::error_code other;  // such as missing permission; reported below
  if (!std::filesystem::exists(path, other) && !other) refuse_file(path, "there is no such file");
  check_input_file(path, {path.string()});
  std::string begin(4, '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), 4);
  if (begin == "\x89PNG") refuse_file(path, "is a PNG", "OpenEXR is read", "Name a .exr file");
  guard_exr(path);
}

bool is_deep(const Imf::Header& header) {
  return header.hasType() && Imf::isDeepData(header.type());
}

void refuse_deep(const std::filesystem::path& path, const Imf::Header& header) {
  if (!is_deep(header)) return;
  refuse_file(path, "holds deep data", "only flat pictures can be read",
              "Flatten it, for example with oiiotool --flatten");
}

void refuse_pixel(const std::filesystem::path& path, const std::string& channel, std::size_t i,
                  int columns, int first, float value) {
  const std::size_t width = static_cast<std::size_t>(columns);
  refuse_file(path,
              "pixel (" + std::to_string(i % width) + ", " +
                  std::to_string(i / width + static_cast<std::size_t>(first)) + ") of channel \"" +
                  channel + "\" is " + (std::isnan(value) ? "not a number" : "infinite"),
              "radiance must be finite", "Render it again or repair the picture");
}

}  // namespace earthshine::base
