// SPDX-License-Identifier: Apache-2.0
// Scenes from inline text, for tests of the reader.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/read/scene_file.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::test {

// A folder with scene.toml and the meshes of a test.
class SceneFolder {
 public:
  void put(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    write_bytes(folder_ / name, bytes);
  }

  [[nodiscard]] scenes::Scene read(const std::string& toml,
                                   const std::vector<std::string>& overrides = {}) const {
    put("scene.toml", toml);
    return scenes::read_scene(folder_ / "scene.toml", overrides);
  }

  // The error message, without the folder's path.
  [[nodiscard]] std::string refusal(const std::string& toml,
                                    const std::vector<std::string>& overrides = {}) const {
    try {
      static_cast<void>(read(toml, overrides));
    } catch (const base::Error& error) {
      EXPECT_EQ(error.blame(), base::Blame::Input);
      std::string message = error.what();
      const std::string prefix = folder_.path().string() + "/";
      for (std::size_t at = message.find(prefix); at != std::string::npos;
           at = message.find(prefix)) {
        message.erase(at, prefix.size());
      }
      return message;
    }
    return "was not refused";
  }

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

// Whether all pieces occur in the text.
inline ::testing::AssertionResult holds(const std::string& text,
                                        const std::vector<std::string>& pieces) {
  for (const std::string& piece : pieces) {
    if (text.find(piece) == std::string::npos) {
      return ::testing::AssertionFailure() << "no \"" << piece << "\" in: " << text;
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace earthshine::test
