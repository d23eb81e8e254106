// SPDX-License-Identifier: Apache-2.0
#include "app/parts/result_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "app/build_id.h"
#include "app/output.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/output_file.h"
#include "base/numbers/digest.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

// Files store channels by name, independent of their order in memory.
std::string digest_of_image(const base::Image& image) {
  std::vector<const base::Channel*> channels;
  for (const base::Channel& channel : image.channels) channels.push_back(&channel);
  std::sort(channels.begin(), channels.end(),
            [](const auto* a, const auto* b) { return a->name < b->name; });
  base::Digest digest;
  digest.add(std::uint64_t{image.pixel_count()});
  for (const base::Channel* channel : channels) {
    digest.add(std::string_view(channel->name));
    for (const float value : channel->values) {
      digest.add(std::uint64_t{std::bit_cast<std::uint32_t>(value)});
    }
  }
  return digest.text();
}

// The facts have their own digest, which detects any change.
std::string text_of_part(const Json& cache_key, const Json& facts, const Json& picture) {
  return dump({{"cache_key", cache_key},
               {"facts", facts},
               {"digest", digest_of(Json::parse(dump(facts)))},
               {"picture", picture}});
}

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

}  // namespace

Json scene_cache_key(const LoadedScene& loaded) {
  Json cache_key = Json::object();
  for (const radiosity::ScenePart& part : radiosity::scene_parts(loaded.scene, loaded.groups)) {
    cache_key[part.key] = hex(part.digest);
  }
  // Further inputs of a picture. The structured binding makes a new member a compile error until it
  // is decided whether it belongs here.
  base::Digest lobes;
  for (const scenes::Triangle& triangle : loaded.scene.triangles) {
    const auto& [name, diffuse, specular, shininess, mirror, transmit, ior, emit, group, sheet,
                 even_lobe, maps] = loaded.scene.materials[triangle.material];
    lobes.add(specular);
    lobes.add(shininess);
  }
  lobes.add(loaded.scene.ambient_radiance);
  cache_key["lobes"] = lobes.text();
  cache_key["build"] = build_id();
  return cache_key;
}

Json camera_cache_key(const scenes::Camera& camera) {
  base::Digest digest;
  for (const Vec3& v : {camera.position, camera.look_at, camera.up}) digest.add(v);
  if (camera.exposure_s > 0.0 || camera.line_s > 0.0) {
    digest.add(camera.motion.velocity_m_s);
    digest.add(camera.motion.spin_deg_s);
    for (const double x : {camera.exposure_s, camera.line_s}) digest.add(x);
    digest.add(std::uint64_t{camera.from_below});
  }
  for (const double x : {camera.fov_deg, camera.focus_m, camera.aperture_m}) digest.add(x);
  if (camera.intrinsics) {
    for (const double x : *camera.intrinsics) digest.add(x);
    digest.add(static_cast<double>(camera.columns));
    digest.add(static_cast<double>(camera.rows));
  }
  digest.add(static_cast<double>(static_cast<int>(camera.distortion)));
  for (const double x : camera.distortion_k) digest.add(x);
  return digest.text();
}

ResultCache::ResultCache(const fs::path& folder) : folder_(folder) {
  make_folder(folder);
  const base::OutputFile writable(folder / "points.json");
}

std::optional<Json> ResultCache::read(const Json& cache_key, std::string& said) const {
  const fs::path path = folder_ / (digest_of(cache_key) + ".json");
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  Json json = json_in(path);
  const bool whole = json.is_object() && json.contains("cache_key") && json.contains("facts") &&
                     json["facts"].is_object() && json.contains("picture") &&
                     json.contains("digest") && json["digest"] == digest_of(json["facts"]);
  if (!whole || json["cache_key"] != cache_key) {
    said = fmt::format("{} {}; it is recomputed", path.string(),
                       whole ? "belongs to something else" : "is broken");
    return std::nullopt;
  }
  return json;
}

std::optional<CachedResult> ResultCache::find(const Json& cache_key, std::string& said) const {
  const std::optional<Json> json = read(cache_key, said);
  if (!json) return std::nullopt;
  const auto again = [&](const std::string& why) {
    said = fmt::format("{} {}; it is recomputed",
                       (folder_ / (digest_of(cache_key) + ".json")).string(), why);
    return std::nullopt;
  };
  CachedResult part{(*json)["facts"], {}};
  try {
    part.image = base::read_exr(folder_ / (digest_of(cache_key) + ".exr")).image;
  } catch (const base::Error& error) {
    return again(fmt::format("has lost its picture ({})", error.what()));
  }
  if ((*json)["picture"] != digest_of_image(part.image))
    return again("has another picture beside it");
  return part;
}

std::optional<Json> ResultCache::find_facts(const Json& cache_key, std::string& said) const {
  const std::optional<Json> json = read(cache_key, said);
  return json ? std::optional<Json>((*json)["facts"]) : std::nullopt;
}

void ResultCache::keep_facts(const Json& cache_key, const Json& facts) const {
  base::write_text(folder_ / (digest_of(cache_key) + ".json"),
                   text_of_part(cache_key, facts, Json()));
}

bool ResultCache::has(const Json& cache_key) const {
  std::string ignored;
  return read(cache_key, ignored).has_value();
}

void ResultCache::keep(const Json& cache_key, const CachedResult& part) const {
  base::write_exr(folder_ / (digest_of(cache_key) + ".exr"), part.image, part.header);
  base::write_text(folder_ / (digest_of(cache_key) + ".json"),
                   text_of_part(cache_key, part.facts, digest_of_image(part.image)));
}

}  // namespace earthshine::app
