// SPDX-License-Identifier: Apache-2.0
#include "base/exr_attributes.h"

#include <ImathMatrix.h>
#include <ImfChromaticities.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <string_view>

namespace earthshine::base {
namespace {

bool is_own_business(std::string_view name) {
  for (std::string_view standard : {"type", "name", "view", "version", "chunkCount",
                                    "whiteLuminance", "pixelAspectRatio", "screenWindowWidth"}) {
    if (name == standard) return true;
  }
  return false;
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

}  // namespace earthshine::base
