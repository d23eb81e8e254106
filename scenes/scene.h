// SPDX-License-Identifier: Apache-2.0
// The scene: a plain value that all stages read. Lengths in metres, photometric units, linear RGB.
// scene_file.h reads one from a TOML file and checks it completely.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::scenes {

struct FaceParts;  // scenes/health/coincident.h

class Texture;            // scenes/texture/texture.h
struct TextureTransform;  // of texture coordinates

// A texture that varies a colour of a material over the surface, relative to the mean colour.
struct TextureMap {
  std::shared_ptr<const Texture> texture;  // null: none
  std::shared_ptr<const TextureTransform> transform;
  bool by_second = false;  // uses Scene::second_uv
  // 1 / (mean of the texture, times vertex colours if used, over all surfaces of the material); 0
  // where the mean is 0.
  Rgb over_mean{1.0};
};
struct MaterialMaps {
  TextureMap diffuse, emit;
  TextureMap opacity;  // alpha: no surface where it is below the cutoff
  double cutoff = 0.5;
  bool by_vertex = false;  // Scene::vertex_colour multiplies the diffuse colour

  [[nodiscard]] bool vary_diffuse() const { return diffuse.texture || by_vertex; }
};

// Reflectance model of the 1990 report: pi f = diffuse + specular cos^n(alpha), n = shininess.
// diffuse + 2 specular / (n + 2) + mirror + transmit <= 1 in every channel.
struct Material {
  std::string name;
  Rgb diffuse{0.0};
  Rgb specular{0.0};
  double shininess = 1.0;
  Rgb mirror{0.0};
  Rgb transmit{0.0};
  double ior = 1.0;
  Rgb emit{0.0};            // exitance, lm/m^2
  std::string light_group;  // of the emitted light; default: the material's name
  bool two_sided = false;   // false: the back is black
  // Divides the lobe by the larger cosine of the two directions to the normal, which compensates
  // the loss toward the horizon (Neumann, Neumann and Szirmay-Kalos, "Compact metallic reflectance
  // models", Computer Graphics Forum 18(3), 1999). Used for metals of glTF files.
  bool even_lobe = false;
  std::shared_ptr<const MaterialMaps> maps;  // null: no textures. diffuse and emit are the means

  [[nodiscard]] bool emits() const { return base::max_component(emit) > 0.0; }
  [[nodiscard]] bool has_black_back() const {
    return !two_sided && !(base::max_component(transmit) > 0.0);
  }
  [[nodiscard]] bool has_holes() const { return maps && maps->opacity.texture; }
  [[nodiscard]] bool lets_light_through() const {
    return base::max_component(transmit) > 0.0 || has_holes();
  }
  [[nodiscard]] bool reflects() const {  // has a diffuse or glossy lobe
    return base::max_component(diffuse) > 0.0 || base::max_component(specular) > 0.0;
  }
  [[nodiscard]] bool passes_light_on() const {  // mirror or glass: rays continue
    return base::max_component(mirror) > 0.0 || base::max_component(transmit) > 0.0;
  }
};

// Three vertices, counter-clockwise seen from the front. Two consecutive triangles of one polygon
// that form a parallelogram are stored as (0,1,2), (0,2,3) of its corners.
struct Triangle {
  std::uint32_t vertex[3];
  std::uint32_t object;
  std::uint32_t material;
  std::uint32_t polygon;  // index over the scene, shared by the triangles of one file polygon
};

// Two triangles that partly coincide within ray accuracy, and which one is in front
// (scenes/health/coincident.h). Each hides the other's front, or back, from light on that side. An
// opaque face hides both sides of glass.
struct FacePair {
  std::uint32_t a, b;
  bool b_before_a;  // b is on the front side of a
  bool a_before_b;
};

// Orientation of the faces of a mesh (scenes/health).
enum class Orient { Mended, Outward, Inward, AsIs, TwoSided };

// An object that repeats the faces of another one: p -> linear p + offset_m. Its own triangles, in
// the same order, follow those of all objects that are not instances; likewise its vertices.
struct Instance {
  std::uint32_t object = 0;  // the original, not itself an instance
  glm::dmat3 linear{1.0};    // of positive determinant
  Vec3 offset_m{0.0};
  std::uint32_t first_vertex = 0;
};

// Topology of an object's faces by shared edges (scenes/health).
struct SurfaceHealth {
  std::size_t parts = 0;
  std::size_t closed_parts = 0;  // parts without open and non-manifold edges
  std::size_t inward_parts = 0;  // closed parts with their backs outside
  std::size_t open_edges = 0;
  std::size_t non_manifold_edges = 0;
  std::size_t mixed_edges = 0;  // between faces of opposite winding
};

// Of a rigid body at the scene's moment, the middle of an exposure (scenes/view/motion.h).
struct Motion {
  Vec3 velocity_m_s{0.0};
  Vec3 spin_deg_s{0.0};  // axis times rate, by the right-hand rule

  [[nodiscard]] bool moves() const { return velocity_m_s != Vec3(0.0) || spin_deg_s != Vec3(0.0); }
};

struct Object {
  std::string name;
  bool target = false;  // visibility studies measure it
  std::string joint;    // that it hangs on; empty: none
  Motion motion;
  std::optional<Vec3> spin_about;  // point that turns in place; empty: the middle of its bounds
  Orient orient = Orient::Mended;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t polygon_count = 0;
  double area_m2 = 0.0;                // one side, of the file's polygons
  std::uint32_t degenerate_count = 0;  // polygons without area, omitted
  std::string source;                  // "meshes/bay.obj#Liner" or "sphere"
  std::string unused;                  // contents of its file that are not read: "24 vn, 96 vt"
  SurfaceHealth surface;               // after repair
  std::optional<Instance> instance;
};

class Photometry;

enum class LampKind { Point, Spot, Rectangle, Disk, Measured, Distant };

struct Lamp {
  std::string name;
  std::string group;
  LampKind kind = LampKind::Point;
  Vec3 position{0.0};  // m; the centre of a rectangle or disk; distant: none
  // Unit: toward the aim; normal of a rectangle or disk; distant: direction of the light.
  Vec3 axis{0.0, 0.0, 1.0};
  Rgb intensity_cd{0.0};          // point; spot: on the axis; measured: maximum
  double beam_deg = 0.0;          // spot: full angle of the cone of full intensity
  double field_deg = 0.0;         // spot: full angle beyond which the intensity is 0
  Vec3 edge_u{0.0}, edge_v{0.0};  // rectangle: full edges, m; it shines along edge_u x edge_v
  double radius_m = 0.0;          // disk
  Rgb exitance{0.0};              // rectangle and disk, lm/m^2
  Vec3 c0{1.0, 0.0, 0.0};  // measured: unit, across the axis, in the plane C0; C90: c0 x axis
  std::shared_ptr<const Photometry> photometry;  // measured
  std::string source;                            // measured: the file, as the scene names it
  Motion motion;                                 // turns about its position
  Rgb illuminance_lx{0.0};                       // distant: on an unoccluded plane that faces it
  std::string joint;                             // that it hangs on; empty: none
  std::string object;                            // that has it in its mesh file; empty: none

  [[nodiscard]] bool is_distant() const { return kind == LampKind::Distant; }
  // 0 without light; in the unit of the lamp's kind.
  [[nodiscard]] Rgb strength() const { return intensity_cd + exitance + illuminance_lx; }
  void dim(const Rgb& times) {
    intensity_cd *= times;
    exitance *= times;
    illuminance_lx *= times;
  }
};

// A virtual rectangle over which lights may be distributed (LightPaths::Distributed); rays do not
// hit it. Its lights shine along edge_u x edge_v.
struct Area {
  std::string name;
  Vec3 center{0.0};               // m
  Vec3 edge_u{0.0}, edge_v{0.0};  // full edges, m
  Vec3 normal{0.0, 0.0, 1.0};     // unit
};

struct Sun {
  Vec3 direction{0.0, 0.0, 1.0};  // unit, toward the Sun
  Rgb illuminance_lx{133100.0};   // at normal incidence, unoccluded
  double angular_radius_deg = 0.2666;
};

// A point far away; its light as it arrives at the spacecraft at the scene's moment.
struct Moon {
  Vec3 direction{0.0, 0.0, 1.0};  // unit, toward the Moon
  Rgb illuminance_lx{0.0};        // at normal incidence, nothing in front of it
  double phase_deg = 0.0;         // Sun, Moon, Earth: 0 full, 180 new
  bool hidden = false;            // behind the Earth: it lights the Earth alone
};

enum class EarthModel { Lambert, Uniform };

class AlbedoGrid;  // scenes/sky/albedo_grid.h

// Albedo by latitude, a0 + a1 P1(sin latitude) + a2 P2(sin latitude), P1 and P2 Legendre's
// polynomials, between 0 and 1: Knocke, Ries and Tapley, "Earth radiation pressure effects on
// satellites", AIAA/AAS 1988, with a1 = 0.10 cos(day's angle from 22 December).
struct LatitudeAlbedo {
  double a0 = 0.34;
  double a1 = 0.0;
  double a2 = 0.29;
  Vec3 north{0.0, 0.0, 1.0};  // unit, toward the Earth's north pole
};

struct Earth {
  Vec3 direction{0.0, 0.0, 1.0};  // unit, toward the centre
  double half_angle_deg = 0.0;    // asin(R / (R + h))
  double altitude_m = 0.0;        // 0 when only the half angle is known (uniform model)
  EarthModel model = EarthModel::Lambert;
  Rgb albedo{0.3};
  Rgb radiance{0.0};                          // uniform model, cd/m^2
  std::optional<LatitudeAlbedo> by_latitude;  // lambert model: `albedo` times this
  std::shared_ptr<const AlbedoGrid> grid;     // lambert model: `albedo` times this; null: none
  glm::dmat3 to_ground{1.0};                  // of a grid: the scene's axes to ITRF's
};

// Attitudes as a function of time; scenes/sky/attitude_file.h defines the rotations.
struct AttitudeTable {
  std::string file;
  bool by_time = true;     // `at` is the time since orbit noon, s; otherwise the position, deg
  std::vector<double> at;  // ascending, at least one
  std::vector<glm::dquat> rotations;  // unit quaternions, one for each
};

struct Mission;  // scenes/time/mission.h: trajectory and attitude against time

// Orbit data from files: attitudes along a circular orbit, or a mission that replaces the circle.
struct OrbitFiles {
  std::optional<AttitudeTable> attitudes;
  std::shared_ptr<const Mission> mission;
};

// A circular orbit about the Earth and the spacecraft's attitude along it; orbit.h defines the
// frames. For a mission: the circle through the spacecraft's position at the scene's time.
struct Orbit {
  double altitude_m = 0.0;
  double beta_deg = 0.0;                  // height of the Sun over the orbit's plane
  double position_deg = 0.0;              // where the scene's Sun and Earth are taken; 0 orbit noon
  std::string attitude = "bay-to-earth";  // empty: by the files
  std::string inertial_as = "bay-to-earth";  // } of attitude "inertial": the pose that is kept
  double inertial_at_deg = 0.0;              // } and where the spacecraft takes it
  std::shared_ptr<const OrbitFiles> files;   // null: none
  double inclination_deg = 0.0;
  double noon_argument_deg = 0.0;  // argument of latitude at orbit noon
};

// Pixel reconstruction filter; raytrace/camera/pixel_filter.h has the formulas.
enum class FilterShape { Box, Triangle, Gaussian, BlackmanHarris };
[[nodiscard]] std::string_view filter_name(FilterShape shape);  // name in scene files

// Distortion of the lens, with OpenCV's coefficients (scenes/view/projection.h).
enum class Distortion { None, BrownConrady, Fisheye };

struct Camera {
  std::string name;
  Vec3 position{0.0};
  Vec3 look_at{0.0, 0.0, 1.0};
  Vec3 up{0.0, 0.0, 1.0};
  double fov_deg = 40.0;  // vertical, full; with intrinsics 2 atan(rows / (2 fy))
  int columns = 512;
  int rows = 512;
  // fx, fy, cx, cy in pixels of columns x rows; the upper left corner is (0, 0). Unset: by fov_deg.
  std::optional<std::array<double, 4>> intrinsics;
  Distortion distortion = Distortion::None;
  std::array<double, 5> distortion_k{};  // k1, k2, p1, p2, k3; of a fisheye k1 to k4
  double focus_m = 0.0;                  // } thin lens when both are positive
  double aperture_m = 0.0;               // } diameter
  std::string cctv;                      // a [[cctv]] of the scene or a built-in one; empty: none
  std::string range_sensor;              // a [[range_sensor]] of the scene; empty: none
  FilterShape filter = FilterShape::Box;
  double filter_width_px = 1.0;  // full width of the filter's support
  Motion motion;                 // turns about its position
  double exposure_s = 0.0;       // during which each row takes light
  double line_s = 0.0;           // from the beginning of a row's exposure to the next row's
  bool from_below = false;       // the last row begins
  // Only light in this time is taken: an instant of a picture in which objects move.
  double open_from_s = -std::numeric_limits<double>::infinity();
  double open_until_s = std::numeric_limits<double>::infinity();
  base::Location where;  // of its position in the scene file
  std::optional<base::Location> cctv_at, range_sensor_at;
  std::string joint;   // that it hangs on; empty: none
  std::string object;  // whose mesh file has it; empty: the scene file
};

// A [[cctv]], [monitor] or [[range_sensor]] table as written; degrade/ knows its keys and checks
// them.
struct Setting {
  std::string key;
  std::variant<bool, double, std::string, std::vector<double>> value;
  base::Location where;
};
struct SettingTable {
  std::string name;
  base::Location where;
  std::vector<Setting> settings;
};

// Accuracy settings of the scene. resolve_quality (quality.h) supplies defaults.
struct Quality {
  std::optional<double> error;  // wanted relative error
  std::optional<double> patch_edge_m;
  std::optional<int> max_patches;
  std::optional<bool> refine;           // adaptive patches; unset: see resolve_quality
  std::optional<int> form_factor_rays;  // per patch
  std::optional<int> gather_rays;       // per pixel
  std::optional<int> camera_samples;    // per pixel
  std::optional<bool> denoise;          // of gather points
  std::optional<double> solver_tolerance;
};

struct SkyParts;  // sky_cells.h
struct Linkage;   // scenes/time/linkage.h: joints and tracks

struct Scene {
  std::filesystem::path path;
  std::vector<std::filesystem::path> files;  // all files read: the scene, meshes, tables, ...
  std::string name;
  double unit_m = 1.0;  // of lengths in the file
  std::vector<Vec3> vertices;
  std::vector<glm::vec2> vertex_uv;      // u, v (down) per vertex; empty: no textures
  std::vector<glm::vec2> second_uv;      // second set, for emission; empty: none
  std::vector<glm::vec3> vertex_colour;  // linear; empty: none
  std::vector<Triangle> triangles;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<FacePair> coincident;  // ascending, a < b
  // Of the triangles, for objects that move, which changes `coincident`.
  std::shared_ptr<const FaceParts> face_parts;
  std::vector<Lamp> lamps;
  std::vector<Area> areas;
  std::optional<Sun> sun;
  std::optional<Earth> earth;
  std::optional<Moon> moon;
  std::optional<Orbit> orbit;                 // Sun and Earth are where it has them
  std::shared_ptr<const SkyParts> sky_parts;  // of studies alone
  std::shared_ptr<const Linkage> linkage;     // null: nothing moves
  Rgb ambient_radiance{0.0};                  // k_a I_a with k_a = diffuse; 0: off
  std::vector<Camera> cameras;
  std::vector<SettingTable> cctv;
  std::optional<SettingTable> monitor;
  std::vector<SettingTable> range_sensors;
  Quality quality;
  std::vector<std::string> warnings;  // one line each, e.g. the number of degenerate triangles
};

}  // namespace earthshine::scenes
