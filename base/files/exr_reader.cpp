// SPDX-License-Identifier: Apache-2.0
#include "base/files/exr_reader.h"

#include <Iex.h>
#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/files/exr_attributes.h"
#include "base/files/exr_window.h"
#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

constexpr std::int64_t longest_edge_px = 65536;
constexpr std::int64_t largest_pixel_count = std::int64_t{1} << 30;

std::vector<std::string> channel_names(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    names.emplace_back(c.name());
  }
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), most); ++i) {
    text += (i == 0 ? "\"" : ", \"") + words[i] + "\"";
  }
  if (words.size() > most) text += " and " + std::to_string(words.size() - most) + " more";
  return text;
}

int picture_part(const Imf::MultiPartInputFile& file) {
  for (int part = 0; part < file.parts(); ++part) {
    if (is_deep(file.header(part))) continue;
    const auto kind = find_picture(channel_names(file.header(part))).kind;
    if (kind != ExrPicture::Kind::None) return part;
  }
  return 0;
}

std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

void check_size(const std::filesystem::path& path, const Imath::Box2i& window) {
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width >= 1 && height >= 1 && width <= longest_edge_px && height <= longest_edge_px &&
      width * height <= largest_pixel_count) {
    return;
  }
  refuse_file(path, "has " + size_text(width, height) + " pixels",
              "the largest picture read has 65536 on an edge and 1073741824 in all",
              "Crop or shrink it");
}

void check_shape(const std::filesystem::path& path, const Imf::Header& header) {
  refuse_deep(path, header);
  check_size(path, header.dataWindow());
  if (!(std::abs(header.pixelAspectRatio() - 1.0F) < 0.001F)) {
    refuse_file(
        path, "has pixels " + std::to_string(header.pixelAspectRatio()) + " times as wide as high",
        "pixels must be square", "Resample it");
  }
}

ExrPicture checked_picture(const std::filesystem::path& path, const Imf::Header& header) {
  const std::vector<std::string> names = channel_names(header);
  for (const char* chroma : {"RY", "BY"}) {
    if (header.channels().findChannel(chroma) == nullptr) continue;
    refuse_file(path,
                "stores colour as luminance and chroma (channel \"" + std::string(chroma) + "\")",
                "a picture has R, G, B or Y at full resolution", "Convert it to R, G, B");
  }
  ExrPicture picture = find_picture(names);
  if (picture.kind == ExrPicture::Kind::None) {
    if (!picture.layers.empty()) {
      refuse_file(path, "has a picture in each of the layers " + joined(picture.layers),
                  "one layer, or one called Combined, is the picture", "Write one of them alone");
    }
    refuse_file(path, names.empty() ? "has no channels" : "has the channels " + joined(names),
                "a picture is R, G and B, or Y, or X, Y and Z",
                names.empty() ? "" : "Rename those that are radiance in cd/m^2");
  }
  for (const std::string& name : picture.channels) {
    const Imf::Channel& channel = header.channels()[name.c_str()];
    if (channel.xSampling == 1 && channel.ySampling == 1) continue;
    refuse_file(path, "stores channel \"" + name + "\" at reduced resolution",
                "every channel must have the full resolution", "Resample it");
  }
  return picture;
}

// Matrix for row vectors from the file's primaries to Rec. 709; none if they are equal.
std::optional<Imath::M44f> colour_matrix(const std::filesystem::path& path,
                                         const Imf::Header& header, ExrPicture::Kind kind) {
  const Imf::Chromaticities rec709;  // the default
  if (kind == ExrPicture::Kind::Luminance) return std::nullopt;
  const Imath::M44f from_xyz = Imf::XYZtoRGB(rec709, 1.0F);
  if (kind == ExrPicture::Kind::Xyz) return from_xyz;
  if (!Imf::hasChromaticities(header)) return std::nullopt;
  const Imf::Chromaticities& own = Imf::chromaticities(header);
  const auto near = [](const Imath::V2f& a, const Imath::V2f& b) {
    return (a - b).length() < 2e-4F;
  };
  if (near(own.red, rec709.red) && near(own.green, rec709.green) && near(own.blue, rec709.blue) &&
      near(own.white, rec709.white)) {
    return std::nullopt;
  }
  const Imath::M44f matrix = Imf::RGBtoXYZ(own, 1.0F) * from_xyz;
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(matrix.getValue()[i])) {
      refuse_file(path, "has chromaticities that span no colours", {}, "Correct the attribute");
    }
  }
  return matrix;
}

}  // namespace

struct ExrReader::Open {
  std::filesystem::path path;
  Imf::MultiPartInputFile file;
  int part = 0;
  ExrPicture picture;
  float white = 1.0F;
  std::optional<Imath::M44f> to_rec709;
  Imath::Box2i window;
  ExrHeader header;

  explicit Open(const std::filesystem::path& name)
      : path(name), file(name.c_str(), 0), part(picture_part(file)) {
    const Imf::Header& own = file.header(part);
    check_shape(path, own);
    picture = checked_picture(path, own);
    if (!file.partComplete(part)) {
      refuse_file(path, "is incomplete: some of its pixels are missing", {}, "Copy it again");
    }
    white = white_luminance(path, own);
    to_rec709 = colour_matrix(path, own, picture.kind);
    window = picture_window(path, own);
    header = exr_attributes(own);
    header.whole = whole_of(own, window);
  }

  [[nodiscard]] int width() const { return window.max.x - window.min.x + 1; }
  [[nodiscard]] int height() const { return window.max.y - window.min.y + 1; }

  void check_finite(const Image& rows, int first) const {
    for (const Channel& channel : rows.channels) {
      for (std::size_t i = 0; i < channel.values.size(); ++i) {
        if (std::isfinite(channel.values[i] * white)) continue;
        refuse_pixel(path, channel.name, i, rows.width, first, channel.values[i]);
      }
    }
  }

  void scale(Image& rows) const {
    if (to_rec709) {
      std::vector<float>& r = rows.channels[0].values;
      std::vector<float>& g = rows.channels[1].values;
      std::vector<float>& b = rows.channels[2].values;
      for (std::size_t i = 0; i < r.size(); ++i) {
        const Imath::V3f colour = Imath::V3f(r[i], g[i], b[i]) * *to_rec709;
        r[i] = colour.x;
        g[i] = colour.y;
        b[i] = colour.z;
      }
    }
    const char* const rgb[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < rows.channels.size(); ++c) {
      rows.channels[c].name = rows.channels.size() == 1 ? "Y" : rgb[c];
      if (white == 1.0F) continue;
      for (float& value : rows.channels[c].values) value *= white;
    }
  }
};

ExrReader::ExrReader(const std::filesystem::path& path) {
  check_exr_file(path);
  try {
    open_ = std::make_unique<Open>(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    refuse_file(path, std::string("cannot be read as OpenEXR: ") + e.what());
  }
}

ExrReader::~ExrReader() = default;

int ExrReader::width() const { return open_->width(); }
int ExrReader::height() const { return open_->height(); }
int ExrReader::channel_count() const { return static_cast<int>(open_->picture.channels.size()); }
const ExrHeader& ExrReader::header() const { return open_->header; }

Image ExrReader::read_rows(int first, int count) {
  try {
    Image rows =
        read_window(open_->file, open_->part, open_->picture.channels, open_->window, first, count);
    open_->check_finite(rows, first);
    open_->scale(rows);
    return rows;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    refuse_file(open_->path, std::string("cannot be read as OpenEXR: ") + e.what());
  }
}

}  // namespace earthshine::base
