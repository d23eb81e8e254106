// SPDX-License-Identifier: Apache-2.0
// Cryptomatte: the objects, or materials, that cover a pixel, and their coverages, so that
// compositing programs select anti-aliased mattes by name. Specification 1.2.0 of Psyop:
//   id        MurmurHash3_x86_32 of the name's bytes (UTF-8), seed 0, as the bits of a float;
//             bit 23 is inverted if the float would be denormal, infinite or not a number
//   layers    <type>00.R id of rank 0, .G its coverage, .B id of rank 1, .A its coverage; <type>01
//             ranks 2 and 3, <type>02 ranks 4 and 5; larger coverage first
//   preview   <type>.R/G/B: colours from the ids, mixed by coverage; some readers require it
// Coverage is the share of the pixel's camera samples. A sample without a hit has no id: the
// coverages of a pixel sum to 1 minus the share of the sky, unless more than six ids meet in it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "raytrace/camera/camera.h"
#include "raytrace/camera/pixel_filter.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {

// Appleby's MurmurHash3_x86_32.
[[nodiscard]] std::uint32_t murmur3_32(std::string_view bytes, std::uint32_t seed = 0);

// The bits of a name's id. Names with the same hash share their matte.
[[nodiscard]] std::uint32_t cryptomatte_id(std::string_view name);
[[nodiscard]] std::string eight_hex_digits(std::uint32_t bits);

inline constexpr std::size_t cryptomatte_ranks = 6;
inline constexpr std::size_t cryptomatte_channel_count = 3 + 2 * cryptomatte_ranks;
using CryptomattePixel = std::array<float, cryptomatte_channel_count>;
// "CryptoObject.R" ... "CryptoObject02.A", in the order of CryptomattePixel.
[[nodiscard]] std::vector<std::string> cryptomatte_channels(std::string_view type);

// Coverage of one pixel.
class CoverageRanks {
 public:
  void add(std::uint32_t id, double weight);
  // Coverages as shares of `whole`, the weight of all samples of the pixel, with or without hits;
  // then resets. Equal coverages: the smaller id first, so that the order of samples does not
  // matter.
  [[nodiscard]] CryptomattePixel take(double whole);

 private:
  struct Cover {
    std::uint32_t id;
    double weight;
  };
  std::vector<Cover> covers_;
};

// The source of a type's ids.
enum class CryptomatteOf { Object, Material };
struct CryptomatteType {
  const char* aov;
  const char* name;
  CryptomatteOf of;
};
inline constexpr std::array<CryptomatteType, 2> cryptomatte_types{
    {{"crypto_object", "CryptoObject", CryptomatteOf::Object},
     {"crypto_material", "CryptoMaterial", CryptomatteOf::Material}}};

// Names in the order of the scene's objects or materials.
[[nodiscard]] std::vector<std::string> cryptomatte_names(const scenes::Scene& scene,
                                                         CryptomatteOf of);

// The Cryptomatte channels of a picture during rendering: the cryptomatte_types() in `image`. One
// for all threads; the image's channels must stay at their addresses.
class CryptomatteLayers {
 public:
  CryptomatteLayers(const scenes::Scene& scene, base::Image& image);
  [[nodiscard]] bool empty() const { return types_.empty(); }

 private:
  friend class CryptomatteWriter;
  struct Type {
    CryptomatteOf of;
    std::vector<std::uint32_t> ids;  // per object or material
    std::array<std::vector<float>*, cryptomatte_channel_count> channels;
  };
  const scenes::Scene& scene_;
  std::vector<Type> types_;
};

// Fills the channels pixel by pixel; one object per thread.
class CryptomatteWriter {
 public:
  explicit CryptomatteWriter(const CryptomatteLayers& layers);
  // A camera sample that hit `triangle`, or scenes::no_triangle.
  void add(std::uint32_t triangle, double weight = 1.0);
  // Writes the pixel and begins the next one.
  void store(std::size_t pixel);

 private:
  const CryptomatteLayers& layers_;
  std::vector<CoverageRanks> ranks_;  // per type
  double whole_ = 0.0;
};

// The camera samples of a window of a picture.
struct CoverageSamples {
  std::uint64_t seed = 1;
  Window window;
  const std::vector<std::uint32_t>& counts;  // per pixel of the window; 0: not finished
  const PixelFilter& filter;
};

// Fills the Cryptomatte channels of `image`, the window. Casts the picture's camera samples again,
// at least sixteen per finished pixel, because the number of samples of a pixel is known only at
// the end. Rays without light are cheap. Returns the number of rays.
std::uint64_t fill_cryptomatte(const scenes::Scene& scene, const scenes::RayQuery& query,
                               const CameraModel& camera, const CoverageSamples& samples,
                               base::Image& image);

}  // namespace earthshine::raytrace
