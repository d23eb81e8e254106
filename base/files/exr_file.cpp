// SPDX-License-Identifier: Apache-2.0
#include "base/files/exr_file.h"

#include <Iex.h>
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <half.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "base/error.h"
#include "base/files/exr_attributes.h"
#include "base/files/exr_window.h"
#include "base/files/output_file.h"
#include "base/free_memory.h"
#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

constexpr std::int64_t largest_edge_px = 16384;
constexpr std::int64_t largest_sample_count = std::int64_t{1} << 30;  // 4 GiB as float

// The library's own stream ignores write errors in its destructor, where the offset table is
// written. This one stores them.
class CheckedStream : public Imf::OStream {
 public:
  explicit CheckedStream(const std::filesystem::path& path)
      : Imf::OStream(path.c_str()), file_(std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) problem_ = errno;
  }
  ~CheckedStream() override {
    if (file_ != nullptr) std::fclose(file_);
  }
  CheckedStream(const CheckedStream&) = delete;
  CheckedStream& operator=(const CheckedStream&) = delete;

  void write(const char bytes[], int count) override {
    const std::size_t size = static_cast<std::size_t>(count);
    if (problem_ == 0 && std::fwrite(bytes, 1, size, file_) != size) problem_ = errno;
    if (problem_ != 0) throw Iex::IoExc(reason());
    position_ += static_cast<std::uint64_t>(count);
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override {
    // A device cannot seek. That is harmless unless the library rewrites bytes; write() would then
    // report the error.
    if (problem_ == 0 && ::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) {
      problem_ = errno;
      throw Iex::IoExc(reason());
    }
    position_ = position;
  }

  void close() {
    if (file_ == nullptr) return;
    if (std::fflush(file_) != 0 && problem_ == 0) problem_ = errno;
    if (std::fclose(file_) != 0 && problem_ == 0) problem_ = errno;
    file_ = nullptr;
  }
  [[nodiscard]] int problem() const { return problem_; }
  [[nodiscard]] std::string reason() const { return system_reason(problem_); }

 private:
  std::FILE* file_;
  std::uint64_t position_ = 0;
  int problem_ = 0;
};

[[noreturn]] void refuse_writing(const std::filesystem::path& path, const std::string& why) {
  throw Error(Blame::Work, path.string(), "cannot be written: " + why, {}, write_elsewhere);
}

// If memory runs out while rows are compressed, the library omits them without an error.
bool has_all_rows(const std::filesystem::path& path) {
  try {
    return Imf::InputFile(path.c_str(), 0).isComplete();
  } catch (const std::exception&) {
    return false;
  }
}

// One row of a channel in 16 bits: converting all rows at once would take half of the picture's
// memory again.
struct HalfRow {
  const Channel& channel;
  std::vector<Imath::half> values;
  void fill(int y) {
    const auto from = channel.values.begin() +
                      static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * values.size());
    std::copy_n(from, values.size(), values.begin());
  }
};

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& attributes) {
  if (image.width < 1 || image.height < 1 || image.channels.empty()) {
    refuse_writing(path, "the picture has no pixels");
  }
  OutputFile output(path);
  if (another_rank_writes()) return;
  CheckedStream stream(output.temporary());
  if (stream.problem() != 0) refuse_writing(path, stream.reason());
  try {
    Imf::Header header(image.width, image.height);
    set_exr_attributes(header, attributes);
    Imf::FrameBuffer buffer;
    std::vector<HalfRow> half_rows;
    half_rows.reserve(attributes.half_channels.size());
    for (const Channel& channel : image.channels) {
      if (channel.values.size() != image.pixel_count()) {
        refuse_writing(path, "channel \"" + channel.name + "\" has a wrong number of values");
      }
      if (header.channels().findChannel(channel.name) != nullptr) {
        refuse_writing(path, "there are two channels \"" + channel.name + "\"");
      }
      const auto& half = attributes.half_channels;
      if (std::find(half.begin(), half.end(), channel.name) != half.end()) {
        header.channels().insert(channel.name, Imf::Channel(Imf::HALF));
        half_rows.push_back(
            {channel, std::vector<Imath::half>(static_cast<std::size_t>(image.width))});
        Imath::half* row = half_rows.back().values.data() - header.dataWindow().min.x;
        buffer.insert(channel.name,
                      Imf::Slice(Imf::HALF, reinterpret_cast<char*>(row), sizeof(Imath::half), 0));
        continue;
      }
      header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
      char* values = reinterpret_cast<char*>(const_cast<float*>(channel.values.data()));
      buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, values, header.dataWindow()));
    }
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    for (int y = 0; !half_rows.empty() && y < image.height; ++y) {
      for (HalfRow& row : half_rows) row.fill(y);
      file.writePixels(1);
    }
    if (half_rows.empty()) file.writePixels(image.height);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    refuse_writing(path, stream.problem() != 0 ? stream.reason() : e.what());
  }
  stream.close();
  if (stream.problem() != 0) refuse_writing(path, stream.reason());
  std::error_code ignored;
  const bool is_device = !std::filesystem::is_regular_file(output.temporary(), ignored);
  if (!is_device && !has_all_rows(output.temporary())) {
    refuse_writing(path, "rows are missing; there may be too little memory");
  }
  output.commit();
}

namespace {

// Called before pixels are allocated.
void check_header(const std::filesystem::path& path, const Imf::Header& header) {
  refuse_deep(path, header);
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || width > largest_edge_px || height > largest_edge_px) {
    refuse_file(path, "has " + size + " pixels", "the largest picture read is 16384 x 16384",
                "Crop or shrink it");
  }
  std::int64_t channels = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    ++channels;
    if (c.channel().xSampling == 1 && c.channel().ySampling == 1) continue;
    refuse_file(path, "stores channel \"" + std::string(c.name()) + "\" at reduced resolution",
                "every channel must have the full resolution",
                "Convert luminance/chroma files to R, G, B");
  }
  if (channels == 0) refuse_file(path, "has no channels");
  if (width * height * channels > largest_sample_count) {
    refuse_file(path, "has " + size + " pixels in " + std::to_string(channels) + " channels",
                "at most 1073741824 values are read", "Leave out some channels");
  }
}

// Colour must be finite. Depth and similar channels may be infinite where rays escape.
void check_and_scale_colour(const std::filesystem::path& path, Image& image, float white) {
  for (Channel& channel : image.channels) {
    const std::string& name = channel.name;
    if (name != "R" && name != "G" && name != "B" && name != "Y") continue;
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
      float& value = channel.values[i];
      if (white != 1.0F) value *= white;
      if (std::isfinite(value)) continue;
      refuse_pixel(path, name, i, image.width, 0, value);
    }
  }
}

}  // namespace

ExrFile read_exr(const std::filesystem::path& path) {
  check_exr_file(path);
  ExrFile result;
  float white = 1.0F;
  try {
    Imf::MultiPartInputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header(0);
    check_header(path, header);
    if (!file.partComplete(0)) {
      refuse_file(path, "is incomplete: some of its pixels are missing", {}, "Copy it again");
    }
    white = white_luminance(path, header);
    result.header = exr_attributes(header);
    const Imath::Box2i window = picture_window(path, header);
    result.header.whole = whole_of(header, window);
    std::vector<std::string> channels;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      channels.emplace_back(c.name());
    }
    const Imath::V2i size = header.dataWindow().size() + Imath::V2i(1, 1);
    check_room(static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
                   channels.size() * sizeof(float),
               path.string());
    result.image = read_window(file, 0, channels, window, 0, window.max.y - window.min.y + 1);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    refuse_file(path, std::string("cannot be read as OpenEXR: ") + e.what());
  }
  check_and_scale_colour(path, result.image, white);
  return result;
}

}  // namespace earthshine::base
