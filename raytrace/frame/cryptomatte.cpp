// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/cryptomatte.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "base/numbers/random.h"
#include "base/parallel.h"

namespace earthshine::raytrace {
namespace {

// Little-endian on every machine.
std::uint32_t block_at(std::string_view bytes, std::size_t at, std::size_t count = 4) {
  std::uint32_t block = 0;
  for (std::size_t i = 0; i < count; ++i) {
    block |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return block;
}

std::uint32_t scrambled(std::uint32_t block) {
  return std::rotl(block * 0xcc9e2d51U, 15) * 0x1b873593U;
}

// Preview colours of the specification: the id's lower bits as shares of all bits.
std::array<float, 2> preview(std::uint32_t id) {
  constexpr double all = 4294967295.0;
  return {static_cast<float>(static_cast<double>(id << 8U) / all),
          static_cast<float>(static_cast<double>(id << 16U) / all)};
}

std::vector<float>* values_of(base::Image& image, std::string_view name) {
  for (base::Channel& channel : image.channels) {
    if (channel.name == name) return &channel.values;
  }
  return nullptr;
}

}  // namespace

std::uint32_t murmur3_32(std::string_view bytes, std::uint32_t seed) {
  std::uint32_t hash = seed;
  const std::size_t whole = bytes.size() / 4 * 4;
  for (std::size_t at = 0; at < whole; at += 4) {
    hash = std::rotl(hash ^ scrambled(block_at(bytes, at)), 13) * 5 + 0xe6546b64U;
  }
  hash ^= scrambled(block_at(bytes, whole, bytes.size() - whole));
  hash ^= static_cast<std::uint32_t>(bytes.size());
  hash = (hash ^ (hash >> 16U)) * 0x85ebca6bU;
  hash = (hash ^ (hash >> 13U)) * 0xc2b2ae35U;
  return hash ^ (hash >> 16U);
}

std::uint32_t cryptomatte_id(std::string_view name) {
  const std::uint32_t hash = murmur3_32(name);
  const std::uint32_t exponent = hash >> 23U & 255U;
  return exponent == 0 || exponent == 255 ? hash ^ (1U << 23U) : hash;
}

std::string eight_hex_digits(std::uint32_t bits) {
  std::string text(8, '0');
  for (std::size_t i = 0; i < 8; ++i) text[7 - i] = "0123456789abcdef"[bits >> (4 * i) & 15U];
  return text;
}

std::vector<std::string> cryptomatte_channels(std::string_view type) {
  const std::string name(type);
  std::vector<std::string> channels = {name + ".R", name + ".G", name + ".B"};
  for (std::size_t rank = 0; rank < cryptomatte_ranks; ++rank) {
    const std::string layer = name + "0" + std::to_string(rank / 2);
    channels.push_back(layer + (rank % 2 == 0 ? ".R" : ".B"));
    channels.push_back(layer + (rank % 2 == 0 ? ".G" : ".A"));
  }
  return channels;
}

void CoverageRanks::add(std::uint32_t id, double weight) {
  for (Cover& cover : covers_) {
    if (cover.id != id) continue;
    cover.weight += weight;
    return;
  }
  covers_.push_back({id, weight});
}

CryptomattePixel CoverageRanks::take(double whole) {
  CryptomattePixel result{};
  std::sort(covers_.begin(), covers_.end(), [](const Cover& a, const Cover& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.id < b.id;
  });
  for (std::size_t rank = 0; rank < covers_.size(); ++rank) {
    const auto coverage = static_cast<float>(covers_[rank].weight / whole);
    const auto [green, blue] = preview(covers_[rank].id);
    result[1] += coverage * green;
    result[2] += coverage * blue;
    if (rank >= cryptomatte_ranks) continue;
    result[3 + 2 * rank] = std::bit_cast<float>(covers_[rank].id);
    result[4 + 2 * rank] = coverage;
  }
  covers_.clear();
  return result;
}

std::vector<std::string> cryptomatte_names(const scenes::Scene& scene, CryptomatteOf of) {
  std::vector<std::string> names;
  if (of == CryptomatteOf::Object) {
    for (const scenes::Object& object : scene.objects) names.push_back(object.name);
  } else {
    for (const scenes::Material& material : scene.materials) names.push_back(material.name);
  }
  return names;
}

CryptomatteLayers::CryptomatteLayers(const scenes::Scene& scene, base::Image& image)
    : scene_(scene) {
  for (const CryptomatteType& known : cryptomatte_types) {
    const std::vector<std::string> channels = cryptomatte_channels(known.name);
    if (image.find(channels.front()) == nullptr) continue;
    Type& type = types_.emplace_back();
    type.of = known.of;
    for (const std::string& name : cryptomatte_names(scene, known.of)) {
      type.ids.push_back(cryptomatte_id(name));
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      type.channels[c] = values_of(image, channels[c]);
    }
  }
}

CryptomatteWriter::CryptomatteWriter(const CryptomatteLayers& layers)
    : layers_(layers), ranks_(layers.types_.size()) {}

void CryptomatteWriter::add(std::uint32_t triangle, double weight) {
  whole_ += weight;
  if (triangle == scenes::no_triangle) return;
  const scenes::Triangle& met = layers_.scene_.triangles[triangle];
  for (std::size_t t = 0; t < ranks_.size(); ++t) {
    const CryptomatteLayers::Type& type = layers_.types_[t];
    const std::uint32_t index = type.of == CryptomatteOf::Object ? met.object : met.material;
    ranks_[t].add(type.ids[index], weight);
  }
}

void CryptomatteWriter::store(std::size_t pixel) {
  for (std::size_t t = 0; t < ranks_.size(); ++t) {
    const CryptomattePixel values = ranks_[t].take(whole_);
    for (std::size_t c = 0; c < values.size(); ++c) {
      (*layers_.types_[t].channels[c])[pixel] = values[c];
    }
  }
  whole_ = 0.0;
}

namespace {

constexpr std::uint32_t least_samples = 16;

// Uses the sample positions of shade_samples().
void cover(const scenes::RayQuery& query, const CameraModel& camera, const PixelFilter& filter,
           const PixelPoints& points, int x, int y, std::uint32_t count,
           CryptomatteWriter& writer) {
  scenes::RayPacket packet;
  scenes::HitPacket hits;
  for (std::uint32_t first = 0; first < count; first += scenes::RayPacket::width) {
    const std::size_t lanes = std::min<std::size_t>(scenes::RayPacket::width, count - first);
    for (std::size_t k = 0; k < lanes; ++k) {
      const auto p = points.point(first + k);
      const auto offset = filter.offset(p[0], p[1]);
      CameraModel moved;
      const CameraModel& then = camera_of_sample(
          camera, y, [&] { return points.time(first + k, camera.lens_radius_m > 0.0); }, moved);
      const Ray ray = then.ray(x + 0.5 + offset[0], y + 0.5 + offset[1], p[2], p[3]);
      query.set(packet, k, ray.origin, ray.direction);
    }
    query.closest(packet, lanes, hits);
    for (std::size_t k = 0; k < lanes; ++k) writer.add(hits.triangle[k]);
  }
}

}  // namespace

std::uint64_t fill_cryptomatte(const scenes::Scene& scene, const scenes::RayQuery& query,
                               const CameraModel& camera, const CoverageSamples& samples,
                               base::Image& image) {
  const CryptomatteLayers layers(scene, image);
  if (layers.empty()) return 0;
  std::atomic<std::uint64_t> rays = 0;
  const Window& window = samples.window;
  base::parallel_chunks(
      static_cast<std::size_t>(window.rows), 8, [&](std::size_t begin, std::size_t end) {
        CryptomatteWriter writer(layers);
        for (int y = window.y + static_cast<int>(begin); y < window.y + static_cast<int>(end);
             ++y) {
          for (int x = window.x; x < window.x + window.columns; ++x) {
            const std::uint32_t count = samples.counts[window.index(x, y)];
            if (count == 0) continue;
            const auto number =
                static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.columns) +
                static_cast<std::uint64_t>(x);
            const PixelPoints points(samples.seed, number);
            rays += std::max(count, least_samples);
            cover(query, camera, samples.filter, points, x, y, std::max(count, least_samples),
                  writer);
            writer.store(window.index(x, y));
          }
        }
      });
  return rays;
}

}  // namespace earthshine::raytrace
