// SPDX-License-Identifier: Apache-2.0
// STL: binary (84 + 50 n bytes, exactly) and ascii. Its parts are the named solids of an ascii
// file.
#pragma once

#include <filesystem>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

[[nodiscard]] Mesh parse_stl(std::string_view bytes, const std::filesystem::path& path);

}  // namespace earthshine::scenes
