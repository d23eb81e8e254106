// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/readers.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "app/json.h"
#include "app/report/page.h"
#include "app/study/results.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/exr_reader.h"
#include "base/files/png_file.h"
#include "base/free_memory.h"
#include "degrade/settings/camera_file.h"
#include "radiosity/store/solution_file.h"
#include "scenes/effects/light_groups.h"
#include "scenes/light/ies_file.h"
#include "scenes/mesh/mesh_file.h"
#include "scenes/mesh/obj_file.h"
#include "scenes/read/scene_file.h"
#include "scenes/reflect/phong_fit.h"
#include "scenes/sky/attitude_file.h"
#include "studies/orbit/study_file.h"

namespace earthshine::fuzz {
namespace {

namespace fs = std::filesystem;

void mesh(const fs::path& file) {
  static_cast<void>(scenes::read_mesh(file, file.parent_path(), {"scene.toml", 1, 1}));
}

void library(const fs::path& file) {
  scenes::Mesh mesh;
  mesh.path = file.parent_path() / "a.obj";
  mesh.libraries.push_back({file.filename().string(), {"a.obj", 1, 1}});
  const fs::path folders[] = {file.parent_path()};
  scenes::read_material_libraries(mesh, folders);
}

void picture(const fs::path& file) {
  try {
    static_cast<void>(base::read_exr(file));
  } catch (const base::Error&) {  // `degrade` reads other files than `relight`
  }
  base::ExrReader reader(file);
  for (int row = 0; row < reader.height(); row += 16) {
    static_cast<void>(reader.read_rows(row, std::min(16, reader.height() - row)));
  }
}

// Of the scene that ships as furnace/, as its seed is.
void solution(const fs::path& file) {
  static const scenes::Scene scene =
      scenes::read_scene(EARTHSHINE_SOURCE_DIR "/scenes/library/furnace/scene.toml");
  static const scenes::LightGroups groups = scenes::find_light_groups(scene);
  static const radiosity::SolveOptions options =
      radiosity::solve_options(scenes::resolve_quality(scene), 1);
  static_cast<void>(
      radiosity::read_solution(file, {scene, groups, options, EARTHSHINE_PROGRAM_VERSION}));
}

// Also draws the page, where errors of reading show. A page that names missing pictures is refused.
void study_results(const fs::path& file) {
  const auto study = app::read_results(file.filename(), app::read_json(file, ""));
  app::write_report(file.parent_path(), study, {.plain = true, .quiet = true});
}

constexpr Reader all_readers[] = {
    {"scene", ".toml", [](const fs::path& f) { degrade::check_settings(scenes::read_scene(f)); }},
    {"study", ".toml", [](const fs::path& f) { static_cast<void>(studies::read_study_file(f)); }},
    {"camera", ".toml",
     [](const fs::path& f) { degrade::check_settings(scenes::read_camera_file(f)); }},
    {"obj", ".obj", mesh},
    {"mtl", ".mtl", library},
    {"gltf", ".gltf", mesh},
    {"glb", ".glb", mesh},
    {"ply", ".ply", mesh},
    {"stl", ".stl", mesh},
    {"ies", ".ies",
     [](const fs::path& f) {
       static_cast<void>(scenes::read_ies(f, {"scene.toml", 1, 1}));
     }},
    {"attitudes", ".csv",
     [](const fs::path& f) {
       std::vector<std::string> warnings;
       static_cast<void>(scenes::read_attitudes(f, {"scene.toml", 1, 1}, warnings));
     }},
    {"reflectance", ".csv",
     [](const fs::path& f) { static_cast<void>(scenes::read_reflectance(f)); }},
    {"exr", ".exr", picture},
    {"png", ".png", [](const fs::path& f) { static_cast<void>(base::read_png(f)); }},
    {"solution", ".h5", solution},
    {"report", ".json", study_results}};

// Gone when the process ends.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("earthshine-fuzz-" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

}  // namespace

std::span<const Reader> readers() { return all_readers; }

void read_bytes(const Reader& reader, std::string_view bytes) {
  static const Folder folder;
  const fs::path file = folder.path / ("in" + std::string(reader.ending));
  std::ofstream(file, std::ios::binary).write(bytes.data(), std::ssize(bytes));
  const base::MemoryLimit limit(std::uint64_t{1} << 30U);
  try {
    reader.read(file);
  } catch (const base::Error&) {  // it said what is wrong with them
  }
}

}  // namespace earthshine::fuzz
