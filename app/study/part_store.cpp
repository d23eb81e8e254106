// SPDX-License-Identifier: Apache-2.0
#include "app/study/part_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>
#include <map>

#include "app/build_id.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/output_file.h"
#include "base/numbers/digest.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

std::string stem_of(const Json& marks) {
  base::Digest digest;
  digest.add(std::string_view(dump(marks)));
  return digest.text();
}

// Files keep channels by name, whatever their order in memory.
std::string digest_of(const base::Image& image) {
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

// The facts have a digest of their own: a changed digit is found when they are read.
std::string text_of_part(const Json& marks, const Json& facts, const Json& picture) {
  return dump({{"marks", marks},
               {"facts", facts},
               {"digest", stem_of(Json::parse(dump(facts)))},
               {"picture", picture}});
}

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

}  // namespace

Json scene_marks(const LoadedScene& loaded) {
  Json marks = Json::object();
  for (const radiosity::ScenePart& part : radiosity::scene_parts(loaded.scene, loaded.groups)) {
    marks[part.key] = hex(part.digest);
  }
  // What a picture reads besides; taken apart whole, so that another member does not compile until
  // it is decided about.
  base::Digest lobes;
  for (const scenes::Triangle& triangle : loaded.scene.triangles) {
    const auto& [name, diffuse, specular, shininess, mirror, transmit, ior, emit, group, sheet] =
        loaded.scene.materials[triangle.material];
    lobes.add(specular);
    lobes.add(shininess);
  }
  lobes.add(loaded.scene.ambient_radiance);
  marks["lobes"] = lobes.text();
  marks["build"] = build_id();
  return marks;
}

Json camera_marks(const scenes::Camera& camera) {
  base::Digest digest;
  for (const Vec3& v : {camera.position, camera.look_at, camera.up}) digest.add(v);
  for (const double x : {camera.fov_deg, camera.focus_m, camera.aperture_m}) digest.add(x);
  return digest.text();
}

PartStore::PartStore(const fs::path& folder) : folder_(folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!fs::is_directory(folder)) {
    throw base::Error(base::Blame::Input, folder.string(),
                      "cannot be made a folder" + (problem ? ": " + problem.message() : ""), {},
                      "Name another folder");
  }
  const base::OutputFile writable(folder / "points.json");
}

std::optional<Json> PartStore::read(const Json& marks, std::string& said) const {
  const fs::path path = folder_ / (stem_of(marks) + ".json");
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Json json = Json::parse(text, nullptr, false);
  const bool whole = json.is_object() && json.contains("marks") && json.contains("facts") &&
                     json["facts"].is_object() && json.contains("picture") &&
                     json.contains("digest") && json["digest"] == stem_of(json["facts"]);
  if (!whole || json["marks"] != marks) {
    said = fmt::format("{} {}; it is done again", path.string(),
                       whole ? "belongs to something else" : "is broken");
    return std::nullopt;
  }
  return json;
}

std::optional<StoredPart> PartStore::find(const Json& marks, std::string& said) const {
  const std::optional<Json> json = read(marks, said);
  if (!json) return std::nullopt;
  const auto again = [&](const std::string& why) {
    said = fmt::format("{} {}; it is done again", (folder_ / (stem_of(marks) + ".json")).string(),
                       why);
    return std::nullopt;
  };
  StoredPart part{(*json)["facts"], {}};
  try {
    part.image = base::read_exr(folder_ / (stem_of(marks) + ".exr")).image;
  } catch (const base::Error& error) {
    return again(fmt::format("has lost its picture ({})", error.what()));
  }
  if ((*json)["picture"] != digest_of(part.image)) return again("has another picture beside it");
  return part;
}

std::optional<Json> PartStore::find_facts(const Json& marks, std::string& said) const {
  const std::optional<Json> json = read(marks, said);
  return json ? std::optional<Json>((*json)["facts"]) : std::nullopt;
}

void PartStore::keep_facts(const Json& marks, const Json& facts) const {
  base::write_text(folder_ / (stem_of(marks) + ".json"), text_of_part(marks, facts, Json()));
}

bool PartStore::has(const Json& marks) const {
  std::error_code ignored;
  return fs::exists(folder_ / (stem_of(marks) + ".json"), ignored);
}

void PartStore::keep(const Json& marks, const StoredPart& part) const {
  base::write_exr(folder_ / (stem_of(marks) + ".exr"), part.image);
  base::write_text(folder_ / (stem_of(marks) + ".json"),
                   text_of_part(marks, part.facts, digest_of(part.image)));
}

}  // namespace earthshine::app
