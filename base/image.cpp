// SPDX-License-Identifier: Apache-2.0
#include "base/image.h"

#include "base/error.h"

namespace earthshine::base {

const Channel* Image::find(std::string_view name) const {
  for (const Channel& channel : channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

std::vector<float>& Image::add(std::string name) {
  channels.push_back({std::move(name), std::vector<float>(pixel_count(), 0.0F)});
  return channels.back().values;
}

Image make_rgb_image(int width, int height) {
  Image image{width, height, {}};
  image.channels.reserve(3);
  for (const char* name : {"R", "G", "B"}) image.add(name);
  return image;
}

std::vector<float> luminance_of(const Image& image) {
  const Channel* r = image.find("R");
  const Channel* g = image.find("G");
  const Channel* b = image.find("B");
  if (r != nullptr && g != nullptr && b != nullptr) {
    std::vector<float> y(image.pixel_count());
    for (std::size_t i = 0; i < y.size(); ++i) {
      y[i] = static_cast<float>(luminance({r->values[i], g->values[i], b->values[i]}));
    }
    return y;
  }
  if (const Channel* y = image.find("Y")) return y->values;
  throw Error(Blame::Input, "image", "has neither the channels R, G, B nor Y",
              "the first layer of the file must be linear RGB or luminance",
              "Rename the channels or write the file with earthshine render");
}

}  // namespace earthshine::base
