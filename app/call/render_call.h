// SPDX-License-Identifier: Apache-2.0
// The request of `earthshine render`, and the picture of one camera.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/options.h"
#include "app/parts/part.h"
#include "base/files/png_file.h"
#include "radiosity/solution.h"
#include "raytrace/error_budget.h"
#include "raytrace/render.h"
#include "raytrace/solve_control/wanted_error.h"
#include "scenes/effects/culling.h"
#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::app {

struct RenderCall;

// render --over: draws the scene over a photograph, to find the position of a real camera.
enum class OverStyle { Wire, Blend, Both };

struct OverCall {
  std::string photo;  // empty: no photograph
  std::optional<OverStyle> style;
  std::optional<double> alpha;

  [[nodiscard]] bool asked() const { return !photo.empty(); }
  // The wire alone needs neither light nor a picture.
  [[nodiscard]] bool needs_picture() const {
    return style.value_or(OverStyle::Wire) != OverStyle::Wire;
  }
};

// --over, --over-style, --over-alpha.
void add_over_options(CLI::App& command, OverCall& call);

// Throws base::Error (Input) for conflicting options: --over without --png for the result, with
// --size (the photograph has a size), with part of the picture or with several cameras,
// --over-style without --over.
void check_over(const RenderCall& call);

// Reads the photograph; notes an aspect ratio different from the camera's, unless `quiet`. Throws
// base::Error (Input).
[[nodiscard]] base::Picture8 read_photo(const OverCall& call, const scenes::Camera& camera,
                                        bool quiet);

// Draws the scene over the photograph. rendered_rgb: the tone-mapped picture in the photograph's
// size, used only if needs_picture().
[[nodiscard]] base::Picture8 lay_over(const OverCall& call, base::Picture8 photo,
                                      const scenes::Scene& scene, const scenes::RayQuery& query,
                                      const scenes::Camera& camera,
                                      std::span<const std::uint8_t> rendered_rgb);

struct RenderCall {
  SceneInput scene;
  std::string output, png, cctv, range, solution, report;
  std::vector<std::string> cameras;  // empty: the scene's first
  std::optional<Size> size;
  std::optional<raytrace::Window> crop;  // one pixel for only_pixel
  bool only_pixel = false;
  bool probe = false;  // with only_pixel: origin of its light
  [[nodiscard]] const char* pixel_option() const { return probe ? "--probe" : "--only-pixel"; }
  [[nodiscard]] const char* crop_option() const { return only_pixel ? pixel_option() : "--crop"; }
  double time_limit_s = 0.0;  // of the whole command; 0: none
  bool no_error = false;      // no stated error
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  std::optional<std::uint64_t> distributed_lights;
  std::string distributed_over;  // [[area]] of the scene; empty: none
  std::vector<std::string> aovs;
  bool per_light = false, timings = false, json = false, no_caustics = false;
  bool all_effects = false;  // including those that cannot matter
  PartCall part;
  ToneChoice tone;
  OverCall over;
  std::optional<base::Picture8> photo;  // of --over, once read

  // Only the range sensor: no light is computed.
  [[nodiscard]] bool range_alone() const {
    return !range.empty() && output.empty() && png.empty() && cctv.empty() && !only_pixel &&
           !over.asked();
  }
  // Only lines over a photograph: no light either.
  [[nodiscard]] bool wire_alone() const {
    return over.asked() && !over.needs_picture() && output.empty() && cctv.empty();
  }
};

// --crop, --only-pixel, --time-limit.
void add_window_options(CLI::App& parser, RenderCall& call);
// --camera, --size, --aov, --per-light, --indirect and its options: everything that affects a
// picture's cost.
void add_picture_options(CLI::App& parser, RenderCall& call);
// Throws base::Error (Input) for an unknown layer, and for an area without lights; notes lights
// without an area.
void check_picture_options(const RenderCall& call, bool quiet);

// Cameras of --camera: names, comma-separated lists of names, or "all"; by default the scene's
// first camera.
[[nodiscard]] std::vector<const scenes::Camera*> wanted_cameras(
    const std::vector<std::string>& texts, const scenes::Scene& scene);

// Request of the call for load(). Effects that cannot matter still run if the call requests all
// effects or path tracing as a reference, or reads an existing solution.
[[nodiscard]] WantedEffects wanted_effects(const RenderCall& call,
                                           std::vector<const scenes::Camera*> cameras);

// Light of the scene for all of its cameras.
struct Solved {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;
  bool solved = false;
  bool broken_off = false;         // by a stop or the time limit: no solution
  raytrace::SurfaceError surface;  // if the solution is the result
  // With a wanted error: how it was reached.
  bool steered = false;
  std::vector<raytrace::Step> steps;
  raytrace::Limit limit = raytrace::Limit::None;
};

class RenderParts;

// Data shared by all pictures of a call.
struct RenderContext {
  const RenderCall& call;
  const Common& common;
  const LoadedScene& loaded;
  const scenes::RayQuery& query;
  const Solved& light;
  [[nodiscard]] scenes::World scene() const { return loaded.world(query); }
  double time_limit_s = 0.0;                   // for one picture; 0: none
  std::size_t number = 0;                      // index of the picture in the call
  std::optional<double> white_cd_per_m2 = {};  // of its PNGs, set by the first picture
  const RenderParts* parts = nullptr;          // parts that form pictures; nullptr: drawn here
};

// Size, layers and rays of one camera's picture.
[[nodiscard]] raytrace::RenderOptions picture_options(const RenderCall& call, const Common& common,
                                                      const LoadedScene& loaded,
                                                      const scenes::Camera& camera);

struct PictureFiles {
  std::string output, png, cctv, range;  // empty: not written
};

// Renders, writes the files, and reports on standard error unless quiet. Returns the report for
// --json and whether the picture is complete.
struct Picture {
  Json report;
  bool whole = true;
  raytrace::Limit limit = raytrace::Limit::None;  // why the wanted error was not reached
  raytrace::RenderReport rendered;
  std::optional<double> white_cd_per_m2 = {};  // of its PNG, with --exposure
  StageTimes times;                            // of the call so far, including this picture
};
[[nodiscard]] Picture take_picture(const RenderContext& context, const scenes::Camera& camera,
                                   const PictureFiles& files, StageTimes times);
// Throws base::Error (Work) with the files of the interrupted picture.
[[noreturn]] void end_interrupted(const PictureFiles& last);

}  // namespace earthshine::app
