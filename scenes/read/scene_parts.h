// SPDX-License-Identifier: Apache-2.0
// The parts of a scene file, one function per table. All throw base::Error (Input) for invalid
// input.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/light/ies_file.h"
#include "scenes/mesh.h"
#include "scenes/read/place_mesh.h"
#include "scenes/scene.h"
#include "scenes/text/table_reader.h"

namespace earthshine::scenes {

// root: of a file whose kind its label names, "the scene".
void check_format(const TableReader& root);

[[nodiscard]] Material read_material(const TomlNode& node);

// Reads each measured luminaire once for all its lamps.
class LuminaireShelf {
 public:
  explicit LuminaireShelf(std::filesystem::path scene_folder)
      : scene_folder_(std::move(scene_folder)) {}
  [[nodiscard]] const Luminaire& take(const std::filesystem::path& named,
                                      const base::Location& asked_at);
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> files;
    for (const auto& [file, luminaire] : luminaires_) files.push_back(file);
    return files;
  }
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> warnings;
    for (const auto& [file, luminaire] : luminaires_) {
      if (!luminaire.warning.empty()) warnings.push_back(luminaire.warning);
    }
    return warnings;
  }

 private:
  std::filesystem::path scene_folder_;
  std::map<std::filesystem::path, Luminaire> luminaires_;
};

// Where joints and tracks have what hangs on them.
class JointPoses {
 public:
  JointPoses() = default;
  // At the scene's moment, after its sky was read.
  explicit JointPoses(const Scene& scene);
  // Of the joint that the table's key "joint" names; no motion without the key. Throws base::Error
  // (Input) for an unknown one.
  [[nodiscard]] Pose of(const TableReader& table) const;

 private:
  std::vector<std::string> names_;
  std::vector<Pose> poses_;
};

// [[joint]] and [[track]] to scene.linkage, after the sky was read. Throws base::Error (Input) for
// unknown parents, a joint that is its own ancestor, and bad tables, at their file and line.
void read_linkage(Scene& scene, const TableReader& root, double unit_m);

[[nodiscard]] Lamp read_lamp(const TomlNode& node, double unit_m, const JointPoses& joints,
                             LuminaireShelf& shelf);

[[nodiscard]] Area read_area(const TomlNode& node, double unit_m);

inline constexpr Range altitudes_km{0.0, 1e6, true};

// [orbit]; a table of attitudes is relative to scene.path, warnings go to the scene.
[[nodiscard]] Orbit read_orbit(Scene& scene, const TomlNode& node);

// [sun], [earth], [orbit], [time] and [moon], each null when absent, to scene.sun, scene.earth,
// scene.orbit and scene.moon.
struct SkyTables {
  const TomlNode *sun, *earth, *orbit, *time, *moon;
};
void read_sky(Scene& scene, const SkyTables& tables);

[[nodiscard]] Camera read_camera(const TomlNode& node, double unit_m, const JointPoses& joints);
[[nodiscard]] SettingTable read_settings(const TomlNode& node, const std::string& title,
                                         bool named);
[[nodiscard]] Quality read_quality(const TomlNode& node, std::vector<std::string>& warnings);

// A mesh and the scene's materials made from it.
struct ShelvedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> scene_material;  // per mesh.materials; no_index: not yet used
};

// Reads each mesh once for all its objects.
class MeshShelf {
 public:
  // own_material_count: number of the scene file's materials; materials of meshes follow them.
  MeshShelf(std::filesystem::path scene_folder, std::size_t own_material_count)
      : scene_folder_(std::move(scene_folder)), own_material_count_(own_material_count) {}

  [[nodiscard]] ShelvedMesh& take(const std::filesystem::path& named,
                                  const base::Location& asked_at, VertexNormals normals);
  [[nodiscard]] std::size_t own_material_count() const { return own_material_count_; }

 private:
  std::filesystem::path scene_folder_;
  std::size_t own_material_count_;
  std::map<std::pair<std::filesystem::path, VertexNormals>, std::unique_ptr<ShelvedMesh>> meshes_;
};

// translate, rotate, scale, inward and joint of an object.
[[nodiscard]] Placement read_placement(const TableReader& table, double unit_m,
                                       const JointPoses& joints);

// velocity, m/s, and spin, deg/s, in the scene's axes.
[[nodiscard]] Motion read_motion(const TableReader& table);
// spin_about of an object.
[[nodiscard]] std::optional<Vec3> read_spin_about(const TableReader& table, double unit_m);

// Adds the object's triangles, and the materials that only its mesh defines, to the scene, and to
// `fronts` the sides that the mesh's normals say are fronts. Says how it is placed.
Placement read_object(Scene& scene, const TomlNode& node, double unit_m, const JointPoses& joints,
                      MeshShelf& shelf, FileFronts& fronts);

// Adds lamps and cameras of a mesh file to the scene: those of the part (no_index: all), placed
// like the object's faces; strengths do not change with scale. Their names are "OBJECT.NAME" and
// unique; each lamp is a separate light group. Throws base::Error (Input) at `where` for
// coordinates that are too large.
void add_file_lamps(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                    const Placement& placement, const base::Location& where);
void add_file_cameras(Scene& scene, const std::string& object, const Mesh& mesh, std::uint32_t part,
                      const Placement& placement, const base::Location& where);

// [[object]] tables with instance_of: read when all other objects are in the scene and repaired.
class InstanceReader {
 public:
  // The table's name if it is an instance, which finish() reads; `node` must live until then.
  [[nodiscard]] std::optional<std::string> take(const TomlNode& node);
  // Registers an object that is not an instance.
  void know(const std::string& name, const Placement& placement) { placed_[name] = placement; }
  void finish(Scene& scene, double unit_m, const JointPoses& joints,
              std::size_t own_material_count) const;

 private:
  std::map<std::string, Placement> placed_;
  std::vector<const TomlNode*> waiting_;
};

}  // namespace earthshine::scenes
