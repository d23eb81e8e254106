// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/radiance_file.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/free_memory.h"
#include "degrade/stage/axis_map.h"

namespace earthshine::degrade {
namespace {

constexpr std::size_t strip_pixels = std::size_t{1} << 22;
// A multiple of the lines in a compression block of OpenEXR (DWAB has the largest).
constexpr int strip_lines = 256;
// The picture and the chain's planes, also on the screen if their number does not depend on the
// sensor's grid.
constexpr double copies = 3.0;

void check_memory(std::size_t pixels, int channels, double screen_pixels_per_pixel) {
  const auto free_bytes = base::free_memory_bytes();
  const double needed = copies * (1.0 + screen_pixels_per_pixel) * 4.0 *
                        static_cast<double>(channels) * static_cast<double>(pixels);
  if (!free_bytes || needed <= static_cast<double>(*free_bytes)) return;
  const auto mib = [](double bytes) {
    return std::to_string(static_cast<long long>(bytes / 1048576.0)) + " MiB";
  };
  throw base::Error(base::Blame::Work, "picture", "needs " + mib(needed),
                    mib(static_cast<double>(*free_bytes)) + " are free",
                    "Crop or shrink it, or leave the stage sensor-grid on");
}

// One plane of luminance, or three of colour. Negative values are counted and become 0, as in the
// chain.
Picture planes_of(base::Image strip, bool colour, std::size_t& negative_pixels) {
  Picture picture{strip.width, strip.height, {}};
  if (colour && strip.channels.size() == 3) {
    for (base::Channel& channel : strip.channels) {
      picture.planes.push_back(std::move(channel.values));
    }
  } else {
    picture.planes.push_back(base::luminance_of(strip));
  }
  for (Plane& plane : picture.planes) {
    for (float& value : plane) {
      if (value >= 0.0F) continue;
      ++negative_pixels;
      value = 0.0F;
    }
  }
  return picture;
}

// Adds input rows, in order, to the rows of the grid that they overlap.
class RowSums {
 public:
  RowSums(int in_rows, Grid grid, std::size_t planes)
      : grid_(grid), across_(area_average(in_rows, grid.rows)) {
    sums_.assign(planes, std::vector<double>(static_cast<std::size_t>(grid.columns) *
                                             static_cast<std::size_t>(grid.rows)));
  }

  void add(const Picture& lines, int first) {
    const std::size_t columns = static_cast<std::size_t>(grid_.columns);
    for (std::size_t y = 0; y < static_cast<std::size_t>(lines.rows); ++y) {
      const std::size_t row = y + static_cast<std::size_t>(first);
      for (std::size_t out = first_out_; out < static_cast<std::size_t>(grid_.rows); ++out) {
        const std::size_t begin = across_.start[out], end = across_.start[out + 1];
        if (across_.source[end - 1] < row) {
          first_out_ = out + 1;
          continue;
        }
        if (across_.source[begin] > row) break;
        const double weight = across_.weight[begin + row - across_.source[begin]];
        for (std::size_t p = 0; p < sums_.size(); ++p) {
          const float* const from = lines.planes[p].data() + y * columns;
          double* const to = sums_[p].data() + out * columns;
          for (std::size_t x = 0; x < columns; ++x) to[x] += weight * static_cast<double>(from[x]);
        }
      }
    }
  }

  [[nodiscard]] base::Image image() const {
    Picture picture{grid_.columns, grid_.rows, {}};
    for (const std::vector<double>& sum : sums_)
      picture.planes.emplace_back(sum.begin(), sum.end());
    return to_image(picture);
  }

 private:
  Grid grid_;
  AxisMap across_;
  std::size_t first_out_ = 0;
  std::vector<std::vector<double>> sums_;
};

}  // namespace

RadianceFile read_radiance(base::ExrReader& reader, const Setup& setup, std::size_t most_pixels) {
  RadianceFile file;
  file.columns = reader.width();
  file.rows = reader.height();
  const std::size_t pixels =
      static_cast<std::size_t>(file.columns) * static_cast<std::size_t>(file.rows);
  const std::vector<std::string>& off = setup.options.off;
  const bool keeps_size = std::find(off.begin(), off.end(), "sensor-grid") != off.end();
  if (pixels <= most_pixels || keeps_size) {
    const double per_resel = keeps_size ? setup.monitor.pixels_per_resel : 0.0;
    check_memory(pixels, std::max(reader.channel_count(), setup.camera.colour ? 3 : 1),
                 per_resel * per_resel);
    file.image = reader.read_rows(0, file.rows);
    return file;
  }
  file.averaged = true;
  const bool colour = setup.camera.colour && reader.channel_count() == 3;
  const Grid grid = picture_grid(file.columns, file.rows, setup.monitor);
  const AxisMap along = area_average(file.columns, grid.columns);
  RowSums sums(file.rows, grid, colour ? 3 : 1);
  const std::size_t fit = strip_pixels / static_cast<std::size_t>(file.columns) / strip_lines;
  const int lines = strip_lines * static_cast<int>(std::max(fit, std::size_t{1}));
  for (int first = 0; first < file.rows; first += lines) {
    const int count = std::min(lines, file.rows - first);
    const Picture strip = planes_of(reader.read_rows(first, count), colour, file.negative_pixels);
    sums.add(apply(strip, along, area_average(count, count)), first);
  }
  file.image = sums.image();
  return file;
}

}  // namespace earthshine::degrade
