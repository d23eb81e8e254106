// SPDX-License-Identifier: Apache-2.0
// Stored parts of a study, from which an interrupted run continues.
//
// Each part has two files in DIR/points: KEY.exr, its luminance (for a reference also the
// variance), and then KEY.json: the cache_key of scene, view, settings and program, its cost, and a
// digest of the picture. KEY is a digest of the cache_key, so that changed input has other files.
// Errors are not stored: they follow from the pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/command.h"
#include "base/files/exr_file.h"

namespace earthshine::app {

// Digests of everything in the scene that a picture may depend on, as a JSON object.
[[nodiscard]] Json scene_cache_key(const LoadedScene& loaded);
[[nodiscard]] Json camera_cache_key(const scenes::Camera& camera);

struct CachedResult {
  Json facts;
  base::Image image;
  base::ExrHeader header = {};  // of a picture that is part of another; not read back
};

class ResultCache {
 public:
  // Makes the folder; throws base::Error if it cannot be made or written.
  explicit ResultCache(const std::filesystem::path& folder);

  // No value if the part is missing. A part that is incomplete, foreign or does not match its
  // picture is described in `said` and counts as missing.
  [[nodiscard]] std::optional<CachedResult> find(const Json& cache_key, std::string& said) const;
  // Whether its facts are complete; does not check the picture.
  [[nodiscard]] bool has(const Json& cache_key) const;
  void keep(const Json& cache_key, const CachedResult& part) const;

  // Parts that are facts only, without a picture.
  [[nodiscard]] std::optional<Json> find_facts(const Json& cache_key, std::string& said) const;
  void keep_facts(const Json& cache_key, const Json& facts) const;

 private:
  [[nodiscard]] std::optional<Json> read(const Json& cache_key, std::string& said) const;

  std::filesystem::path folder_;
};

}  // namespace earthshine::app
