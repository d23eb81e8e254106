// SPDX-License-Identifier: Apache-2.0
// What `earthshine render` was asked for, and one camera's picture of it.
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

// render --over: the scene laid over a photograph, for studies of where a camera stood and looked.
enum class OverStyle { Wire, Blend, Both };

struct OverCall {
  std::string photo;  // empty: no photograph
  std::optional<OverStyle> style;
  std::optional<double> alpha;

  [[nodiscard]] bool asked() const { return !photo.empty(); }
  // The wire alone needs neither the light nor the picture.
  [[nodiscard]] bool needs_picture() const {
    return style.value_or(OverStyle::Wire) != OverStyle::Wire;
  }
};

// --over, --over-style, --over-alpha.
void add_over_options(CLI::App& command, OverCall& call);

// Throws base::Error (Input) if the options do not go together: --over without --png to receive the
// picture, with --size (the photograph has one), with a part of the picture or with several
// cameras, --over-style without --over.
void check_over(const RenderCall& call);

// Reads the photograph; a note on stderr where its aspect is not the camera's, unless `quiet`.
// Throws base::Error (Input).
[[nodiscard]] base::Picture8 read_photo(const OverCall& call, const scenes::Camera& camera,
                                        bool quiet);

// The photograph with the scene over it. rendered_rgb: the tone-mapped picture of the photograph's
// size, which only styles with needs_picture() look at.
[[nodiscard]] base::Picture8 lay_over(const OverCall& call, base::Picture8 photo,
                                      const scenes::Scene& scene, const scenes::RayQuery& query,
                                      const scenes::Camera& camera,
                                      std::span<const std::uint8_t> rendered_rgb);

struct RenderCall {
  SceneInput scene;
  std::string output, png, cctv, range, solution, report;
  std::vector<std::string> cameras;  // empty: the scene's first
  std::optional<Size> size;
  std::optional<raytrace::Window> crop;  // one pixel with only_pixel
  bool only_pixel = false;
  bool probe = false;  // with only_pixel: where its light comes from
  [[nodiscard]] const char* pixel_option() const { return probe ? "--probe" : "--only-pixel"; }
  [[nodiscard]] const char* crop_option() const { return only_pixel ? pixel_option() : "--crop"; }
  double time_limit_s = 0.0;  // of the whole command; 0: none
  bool no_error = false;      // none is stated
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  std::optional<std::uint64_t> distributed_lights;
  std::string distributed_over;  // [[area]] of the scene; empty: none
  std::vector<std::string> aovs;
  bool per_light = false, timings = false, json = false, no_caustics = false;
  bool all_effects = false;  // also those that cannot matter
  PartCall part;
  ToneChoice tone;
  OverCall over;
  std::optional<base::Picture8> photo;  // of --over, once it is read

  // What the range sensor sees: no light is computed.
  [[nodiscard]] bool range_alone() const {
    return !range.empty() && output.empty() && png.empty() && cctv.empty() && !only_pixel &&
           !over.asked();
  }
  // Lines over a photograph: nor is it here.
  [[nodiscard]] bool wire_alone() const {
    return over.asked() && !over.needs_picture() && output.empty() && cctv.empty();
  }
};

// --crop, --only-pixel, --time-limit.
void add_window_options(CLI::App& parser, RenderCall& call);
// --camera, --size, --aov, --per-light, --indirect and what belongs to its ways: what a picture's
// cost depends on.
void add_picture_options(CLI::App& parser, RenderCall& call);
// Throws base::Error (Input) for a layer that is not known, and for an area without its lights;
// notes lights that are spread nowhere.
void check_picture_options(const RenderCall& call, bool quiet);

// Of --camera: names, lists of names with commas between, or "all"; the first of the scene if there
// are none.
[[nodiscard]] std::vector<const scenes::Camera*> wanted_cameras(
    const std::vector<std::string>& texts, const scenes::Scene& scene);

// What the call asks of the scene, for load(). Effects that cannot matter run if the call wants all
// of them, paths as a reference, or a solution that is there already.
[[nodiscard]] WantedEffects wanted_effects(const RenderCall& call,
                                           std::vector<const scenes::Camera*> cameras);

// The light of the scene, for all of its cameras.
struct Solved {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;
  bool solved = false;
  bool broken_off = false;         // by a stop or the time limit: there is no solution
  raytrace::SurfaceError surface;  // where the solution is what is asked for
  // Where an error was asked for: how it was reached.
  bool steered = false;
  std::vector<raytrace::Step> steps;
  raytrace::Limit limit = raytrace::Limit::None;
};

class RenderParts;

// What all pictures of a call share.
struct Studio {
  const RenderCall& call;
  const Common& common;
  const LoadedScene& loaded;
  const scenes::RayQuery& query;
  const Solved& light;
  [[nodiscard]] scenes::World scene() const { return loaded.world(query); }
  double time_limit_s = 0.0;                   // for one picture; 0: none
  std::size_t number = 0;                      // of the picture among the call's
  std::optional<double> white_cd_per_m2 = {};  // of its PNGs, once the first picture has said it
  const RenderParts* parts = nullptr;  // what pictures are put together from; nullptr: drawn here
};

// The size, the layers and the rays of one camera's picture.
[[nodiscard]] raytrace::RenderOptions picture_options(const RenderCall& call, const Common& common,
                                                      const LoadedScene& loaded,
                                                      const scenes::Camera& camera);

struct PictureFiles {
  std::string output, png, cctv, range;  // empty: not wanted
};

// Renders, writes the files, tells on standard error unless quiet. Returns the report for --json
// and whether the picture is whole.
struct Picture {
  Json report;
  bool whole = true;
  raytrace::Limit limit = raytrace::Limit::None;  // what kept it from the wanted error
  raytrace::RenderReport rendered;
  std::optional<double> white_cd_per_m2 = {};  // of its PNG, with --exposure
  StageTimes times;                            // of the whole call so far and of this picture
};
[[nodiscard]] Picture take_picture(const Studio& studio, const scenes::Camera& camera,
                                   const PictureFiles& files, StageTimes times);
// Throws base::Error (Work), which names the files of the picture that was stopped.
[[noreturn]] void end_interrupted(const PictureFiles& last);

}  // namespace earthshine::app
