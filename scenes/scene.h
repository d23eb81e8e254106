// SPDX-License-Identifier: Apache-2.0
// What is there: a plain value that the stages read. Lengths in metres, photometric units, linear
// RGB. scene_file.h makes one from a TOML file; every Scene that leaves it has passed all checks.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::scenes {

class Texture;            // scenes/texture/texture.h
struct TextureTransform;  // of the vertices' coordinates

// A texture that varies a colour of a material over the surface, about its mean there.
struct TextureMap {
  std::shared_ptr<const Texture> texture;  // null: none
  std::shared_ptr<const TextureTransform> transform;
  bool by_second = false;  // by Scene::second_uv
  // 1 / the mean over what wears the material of the texture, times the vertices' colours if they
  // vary it; 0 where that is 0.
  Rgb over_mean{1.0};
};
struct MaterialMaps {
  TextureMap diffuse, emit;
  TextureMap opacity;  // by its alpha: nothing is there where that is below the cutoff
  double cutoff = 0.5;
  bool by_vertex = false;  // Scene::vertex_colour multiplies the diffuse colour

  [[nodiscard]] bool vary_diffuse() const { return diffuse.texture || by_vertex; }
};

// Surface reflectance as the 1990 report has it: pi f = diffuse + specular cos^n(alpha), n =
// shininess. diffuse + 2 specular / (n + 2) + mirror + transmit <= 1 in every channel.
struct Material {
  std::string name;
  Rgb diffuse{0.0};
  Rgb specular{0.0};
  double shininess = 1.0;
  Rgb mirror{0.0};
  Rgb transmit{0.0};
  double ior = 1.0;
  Rgb emit{0.0};            // exitance, lm/m^2
  std::string light_group;  // of what it emits; the material's name unless the scene says otherwise
  bool two_sided = false;   // false: the back is black
  // The lobe over the larger of the cosines of both directions to the normal, which makes up for
  // what it loses toward the horizon (Neumann, Neumann and Szirmay-Kalos, "Compact metallic
  // reflectance models", Computer Graphics Forum 18(3), 1999). Of metals of glTF files.
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
  [[nodiscard]] bool reflects() const {  // by a diffuse or glossy lobe
    return base::max_component(diffuse) > 0.0 || base::max_component(specular) > 0.0;
  }
  [[nodiscard]] bool passes_light_on() const {  // mirror or glass: rays go on from it
    return base::max_component(mirror) > 0.0 || base::max_component(transmit) > 0.0;
  }
};

// Three vertices, counter-clockwise seen from the front. Two consecutive triangles of one polygon
// that form a parallelogram are laid down as (0,1,2), (0,2,3) of its corners.
struct Triangle {
  std::uint32_t vertex[3];
  std::uint32_t object;
  std::uint32_t material;
  std::uint32_t
      polygon;  // running number over the scene; the triangles of one file polygon share it
};

// Two triangles of which parts lie on each other, nearer than rays tell apart, and which is over
// which there (scenes/health/coincident.h). Each hides the other's front, or back, from light on
// that side; what is opaque hides both sides of glass, whatever is said.
struct FacePair {
  std::uint32_t a, b;
  bool b_before_a;  // b is on the side of a's front
  bool a_before_b;
};

// Which way the faces of a mesh are turned (scenes/health).
enum class Orient { Mended, Outward, Inward, AsIs, TwoSided };

// Of an object that repeats the faces of another, p -> linear p + offset_m of the other's: its own
// triangles, in the same order, stand after those of all objects that are no instances, its
// vertices likewise.
struct Instance {
  std::uint32_t object = 0;  // the other: no instance itself
  glm::dmat3 linear{1.0};    // of positive determinant
  Vec3 offset_m{0.0};
  std::uint32_t first_vertex = 0;
};

// How an object's faces hang together, by edges (scenes/health).
struct SurfaceHealth {
  std::size_t parts = 0;
  std::size_t closed_parts = 0;  // of them without open and non-manifold edges
  std::size_t inward_parts = 0;  // of these those that show their backs to the outside
  std::size_t open_edges = 0;
  std::size_t non_manifold_edges = 0;
  std::size_t mixed_edges = 0;  // between faces that are wound against each other
};

struct Object {
  std::string name;
  bool target = false;  // visibility studies measure it
  // Against the cameras; pictures show it where it stands, studies add what a tube's lag makes of
  // it.
  Vec3 velocity_m_s{0.0};
  Orient orient = Orient::Mended;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t polygon_count = 0;
  double area_m2 = 0.0;                // one side, of the polygons as the file has them
  std::uint32_t degenerate_count = 0;  // polygons without area, left out
  std::string source;                  // "meshes/bay.obj#Liner" or "sphere"
  std::string unused;                  // what its file holds and nothing reads: "24 vn, 96 vt"
  SurfaceHealth surface;               // as it was mended
  std::optional<Instance> instance;
};

class Photometry;

enum class LampKind { Point, Spot, Rectangle, Disk, Measured, Distant };

struct Lamp {
  std::string name;
  std::string group;
  LampKind kind = LampKind::Point;
  Vec3 position{0.0};  // m; the centre of a rectangle or disk; distant: none
  // Unit: toward the aim; the normal of a rectangle or disk; distant: the way that light goes.
  Vec3 axis{0.0, 0.0, 1.0};
  Rgb intensity_cd{0.0};          // point; spot: on the axis; measured: where it is greatest
  double beam_deg = 0.0;          // spot: full angle of the cone of full intensity
  double field_deg = 0.0;         // spot: full angle beyond which there is none
  Vec3 edge_u{0.0}, edge_v{0.0};  // rectangle: full edges, m; it shines along edge_u x edge_v
  double radius_m = 0.0;          // disk
  Rgb exitance{0.0};              // rectangle and disk, lm/m^2
  Vec3 c0{1.0, 0.0, 0.0};  // measured: unit, across the axis, in the plane C0; C90: c0 x axis
  std::shared_ptr<const Photometry> photometry;  // measured
  std::string source;                            // measured: the file, as the scene names it
  Rgb illuminance_lx{0.0};  // distant: on a plane that faces it, nothing in front of it

  [[nodiscard]] bool is_distant() const { return kind == LampKind::Distant; }
  // 0 where it gives no light; in the unit of its kind.
  [[nodiscard]] Rgb strength() const { return intensity_cd + exitance + illuminance_lx; }
  void dim(const Rgb& times) {
    intensity_cd *= times;
    exitance *= times;
    illuminance_lx *= times;
  }
};

// A rectangle that lights may be spread over (Indirect::Distributed). It is not there: no ray meets
// it. Its lights shine along edge_u x edge_v.
struct Area {
  std::string name;
  Vec3 center{0.0};               // m
  Vec3 edge_u{0.0}, edge_v{0.0};  // full edges, m
  Vec3 normal{0.0, 0.0, 1.0};     // unit
};

struct Sun {
  Vec3 direction{0.0, 0.0, 1.0};  // unit, toward the Sun
  Rgb illuminance_lx{133100.0};   // at normal incidence, nothing in front of it
  double angular_radius_deg = 0.2666;
};

enum class EarthModel { Lambert, Uniform };

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
};

// Attitudes against time; scenes/sky/attitude_file.h says how a turn is to be read.
struct AttitudeTable {
  std::string file;
  bool by_time = true;     // `at` is the time since orbit noon, s; otherwise the position, deg
  std::vector<double> at;  // rising, one or more
  std::vector<glm::dquat> turns;  // unit, one for each
};

struct Mission;  // scenes/time/mission.h: trajectory and attitude against time

// What files say of an orbit: attitudes along the circle, or a mission in place of the circle.
struct OrbitFiles {
  std::optional<AttitudeTable> attitudes;
  std::shared_ptr<const Mission> mission;
};

// A circular orbit about the Earth and which way the spacecraft points along it; orbit.h has the
// frames. Of a mission: the circle through the spacecraft at the scene's moment.
struct Orbit {
  double altitude_m = 0.0;
  double beta_deg = 0.0;                  // height of the Sun over the orbit's plane
  double position_deg = 0.0;              // where the scene's Sun and Earth are taken; 0 orbit noon
  std::string attitude = "bay-to-earth";  // empty: by the files
  std::string inertial_as = "bay-to-earth";  // } of attitude "inertial": the pose that is kept
  double inertial_at_deg = 0.0;              // } and where the spacecraft takes it
  std::shared_ptr<const OrbitFiles> files;  // null: none
  double inclination_deg = 0.0;
  double noon_argument_deg = 0.0;  // argument of latitude at orbit noon
};

// How the light around a pixel's centre is weighed; raytrace/camera/pixel_filter.h has the
// formulas.
enum class FilterShape { Box, Triangle, Gaussian, BlackmanHarris };
[[nodiscard]] std::string_view filter_name(FilterShape shape);  // as scene files have it

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
  double focus_m = 0.0;      // } thin lens when both are positive
  double aperture_m = 0.0;   // } diameter
  std::string cctv;          // a [[cctv]] of the scene or one that ships; empty: none
  std::string range_sensor;  // a [[range_sensor]] of the scene; empty: none
  FilterShape filter = FilterShape::Box;
  double filter_width_px = 1.0;  // full width of the filter's support
  base::Location where;          // of its position in the scene file
  std::optional<base::Location> cctv_at, range_sensor_at;
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

// Accuracy knobs as the scene gives them. resolve_quality (quality.h) fills the gaps.
struct Quality {
  std::optional<double> error;  // wanted relative error
  std::optional<double> patch_edge_m;
  std::optional<int> max_patches;
  std::optional<bool> refine;           // patches where they matter; unset: see resolve_quality
  std::optional<int> form_factor_rays;  // per patch
  std::optional<int> gather_rays;       // per pixel
  std::optional<int> camera_samples;    // per pixel
  std::optional<bool> denoise;          // gather points with their neighbours
  std::optional<double> solver_tolerance;
};

struct SkyParts;  // sky_cells.h

struct Scene {
  std::filesystem::path path;
  std::vector<std::filesystem::path> files;  // that it was read from: itself, meshes, tables, ...
  std::string name;
  std::vector<Vec3> vertices;
  std::vector<glm::vec2> vertex_uv;      // u, v down, of each; empty: no surface has a texture
  std::vector<glm::vec2> second_uv;      // the same of emission's own set; empty: none
  std::vector<glm::vec3> vertex_colour;  // linear; empty: none
  std::vector<Triangle> triangles;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<FacePair> coincident;  // ascending, a < b
  std::vector<Lamp> lamps;
  std::vector<Area> areas;
  std::optional<Sun> sun;
  std::optional<Earth> earth;
  std::optional<Orbit> orbit;                 // Sun and Earth are where it has them
  std::shared_ptr<const SkyParts> sky_parts;  // of studies alone
  Rgb ambient_radiance{0.0};                  // k_a I_a with k_a = diffuse; 0: off
  std::vector<Camera> cameras;
  std::vector<SettingTable> cctv;
  std::optional<SettingTable> monitor;
  std::vector<SettingTable> range_sensors;
  Quality quality;
  std::vector<std::string> warnings;  // one line each, e.g. counted degenerate triangles
};

}  // namespace earthshine::scenes
