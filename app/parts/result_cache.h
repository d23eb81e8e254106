// SPDX-License-Identifier: Apache-2.0
// The finished parts of a study, so that a run that was ended goes on from them.
//
// Each is two files in DIR/points: KEY.exr, its luminance (of a reference also the variance), and
// KEY.json, written after it: the cache_key of the scene, the view, the settings and the program,
// what it cost, and a digest of the picture. KEY is a digest of the cache_key, so that anything
// that changed has other files. Errors are not kept: they follow from the pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/command.h"
#include "base/files/exr_file.h"

namespace earthshine::app {

// Digests of everything in the scene that a picture can depend on, as a JSON object.
[[nodiscard]] Json scene_cache_key(const LoadedScene& loaded);
[[nodiscard]] Json camera_cache_key(const scenes::Camera& camera);

struct CachedResult {
  Json facts;
  base::Image image;
  base::ExrHeader header = {};  // of a picture that is part of another; not read back
};

class ResultCache {
 public:
  // Makes the folder; throws base::Error where that cannot be or nothing can be written in it.
  explicit ResultCache(const std::filesystem::path& folder);

  // None if there is no such part. One that is there but torn, foreign or not of its picture is
  // named in `said` and counts as not there.
  [[nodiscard]] std::optional<CachedResult> find(const Json& cache_key, std::string& said) const;
  // Whether its facts are there, whole; its picture is not looked at.
  [[nodiscard]] bool has(const Json& cache_key) const;
  void keep(const Json& cache_key, const CachedResult& part) const;

  // The same of parts that are facts alone, without a picture.
  [[nodiscard]] std::optional<Json> find_facts(const Json& cache_key, std::string& said) const;
  void keep_facts(const Json& cache_key, const Json& facts) const;

 private:
  [[nodiscard]] std::optional<Json> read(const Json& cache_key, std::string& said) const;

  std::filesystem::path folder_;
};

}  // namespace earthshine::app
