// SPDX-License-Identifier: Apache-2.0
#include "base/files/exr_window.h"

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>

#include <algorithm>

#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

std::string corners(const Imath::Box2i& box) {
  const auto corner = [](const Imath::V2i& at) {
    return "(" + std::to_string(at.x) + ", " + std::to_string(at.y) + ")";
  };
  return corner(box.min) + " to " + corner(box.max);
}

// Columns [left, left + width) of every row.
Image columns_of(const Image& lines, std::ptrdiff_t left, int width) {
  Image cut{width, lines.height, {}};
  cut.channels.reserve(lines.channels.size());
  for (const Channel& channel : lines.channels) {
    std::vector<float>& values = cut.add(channel.name);
    for (std::ptrdiff_t y = 0; y < lines.height; ++y) {
      const auto from = channel.values.begin() + y * lines.width + left;
      std::copy(from, from + width, values.begin() + y * width);
    }
  }
  return cut;
}

}  // namespace

Imath::Box2i picture_window(const std::filesystem::path& path, const Imf::Header& header) {
  const Imath::Box2i& data = header.dataWindow();
  const Imath::Box2i& display = header.displayWindow();
  const Imath::Box2i window(
      {std::max(data.min.x, display.min.x), std::max(data.min.y, display.min.y)},
      {std::min(data.max.x, display.max.x), std::min(data.max.y, display.max.y)});
  if (!window.isEmpty()) return window;
  refuse_file(path,
              "has its pixels outside of the picture: data window " + corners(data) +
                  ", display window " + corners(display),
              "a picture has pixels in both windows",
              "Correct the display window, for example with oiiotool --fullpixels");
}

ExrHeader::Whole whole_of(const Imf::Header& header, const Imath::Box2i& window) {
  const Imath::Box2i& display = header.displayWindow();
  if (window == display) return {};
  return {display.max.x - display.min.x + 1, display.max.y - display.min.y + 1,
          window.min.x - display.min.x, window.min.y - display.min.y};
}

Image read_window(Imf::MultiPartInputFile& file, int part, const std::vector<std::string>& channels,
                  const Imath::Box2i& window, int first, int count) {
  const Imath::Box2i& data = file.header(part).dataWindow();
  const int y = window.min.y + first;
  // The library needs room for every column of the data window.
  Image lines{data.max.x - data.min.x + 1, count, {}};
  lines.channels.reserve(channels.size());
  Imf::FrameBuffer buffer;
  for (const std::string& name : channels) {
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, lines.add(name).data(),
                                         Imath::V2i(data.min.x, y), lines.width, count));
  }
  Imf::InputPart input(file, part);
  input.setFrameBuffer(buffer);
  input.readPixels(y, y + count - 1);
  const int width = window.max.x - window.min.x + 1;
  return lines.width == width ? lines : columns_of(lines, window.min.x - data.min.x, width);
}

}  // namespace earthshine::base
