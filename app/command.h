// SPDX-License-Identifier: Apache-2.0
// Common code of the commands: loading scenes, warnings about a solution, stage times.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/json.h"
#include "app/progress.h"
#include "radiosity/solution.h"
#include "scenes/effects/culling.h"
#include "scenes/effects/world.h"
#include "scenes/plausible/plausible.h"
#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace earthshine::app {

// Keywords and values in the header of a picture.
using HeaderTexts = std::vector<std::pair<std::string, std::string>>;

// Options of every command.
struct Common {
  int threads = 0;  // 0: all
  std::uint64_t seed = 1;
  bool quiet = false;
  std::uint64_t max_memory_bytes = 0;  // 0: the free memory
  std::vector<std::string> arguments;  // the whole call, from the command on
  // Of the whole call; shows nothing by default.
  std::shared_ptr<Progress> progress = std::make_shared<Progress>(true);
};

// The arguments without options that only affect execution: --part, --wait, --threads,
// --max-memory, --quiet and --json.
[[nodiscard]] std::vector<std::string> part_free(const std::vector<std::string>& arguments);

// The value of --part; empty if absent.
[[nodiscard]] std::string part_in(const std::vector<std::string>& arguments);

// Throws base::Error (Input) unless each value is equal on all ranks: otherwise ranks would wait
// for each other forever, or render one picture of two scenes.
void check_ranks_alike(const Json& things);

// A command: its options, and its action after they are read. Each file defines one.
struct Command {
  CLI::App* parser = nullptr;
  std::function<void(const Common&)> run;
};

[[nodiscard]] Command add_render(CLI::App& program);
[[nodiscard]] Command add_solve(CLI::App& program);
[[nodiscard]] Command add_form_factors(CLI::App& program);
[[nodiscard]] Command add_plan(CLI::App& program);
[[nodiscard]] Command add_inspect(CLI::App& program);
[[nodiscard]] Command add_new(CLI::App& program);
[[nodiscard]] Command add_relight(CLI::App& program);
[[nodiscard]] Command add_console(CLI::App& program);
[[nodiscard]] Command add_dataset(CLI::App& program);
[[nodiscard]] Command add_view(CLI::App& program);
// `degrade` and `degrade certify`.
[[nodiscard]] std::vector<Command> add_degrade(CLI::App& program);
[[nodiscard]] Command add_certify(CLI::App& degrade);
[[nodiscard]] Command add_fit_phong(CLI::App& program);
[[nodiscard]] Command add_report(CLI::App& program);
[[nodiscard]] Command add_manual(CLI::App& program);
[[nodiscard]] Command add_completion(CLI::App& program);
// Runs a call as if entered on the command line, for `merge`. Returns its exit code.
using RunCall = std::function<void(const std::vector<std::string>& arguments)>;
[[nodiscard]] Command add_merge(CLI::App& program, const RunCall& run_call);
// `study`, which only groups, and one command per study.
[[nodiscard]] std::vector<Command> add_study(CLI::App& program);

// SCENE, --set and --error.
struct SceneInput {
  std::string path;
  std::vector<std::string> overrides;               // key=value
  std::optional<base::Location> overrides_at = {};  // in a file; none: --set

  // Whether the call itself sets a wanted error, by an option or an override, not the scene's
  // quality.error.
  [[nodiscard]] bool wants_error() const;
};

// The results are written, but not to the wanted error or not for all cameras: exit code 3.
struct StoppedShort : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Size {
  int columns = 0, rows = 0;
};
// A scene with the effects of the call.
struct LoadedScene {
  scenes::Scene scene;
  scenes::Asked asked;  // request of the call
  scenes::LightGroups groups;
  scenes::Effects effects;
  std::vector<scenes::Culling> culled;  // switched off above, because they cannot matter

  [[nodiscard]] scenes::World world(const scenes::RayQuery& query) const {
    return {scene, groups, effects, query};
  }
};
// Request of a call for a loaded scene; default: everything.
struct WantedEffects {
  scenes::Asked asked;
  bool culls = false;  // switches off effects that cannot matter
};
using AskEffects = std::function<WantedEffects(const scenes::Scene&)>;
// Warnings go to standard error unless `quiet`.
[[nodiscard]] LoadedScene load(const SceneInput& input, bool quiet, const AskEffects& ask = {});

// The two steps of load(). Checks the CCTV cameras and range sensors of the scene.
[[nodiscard]] LoadedScene check_scene(scenes::Scene scene);
// Decides the effects of a call; no other code does. May be repeated.
void decide_effects(LoadedScene& loaded, const WantedEffects& wanted);

// Ray queries for the scene, after check_input(); the only source of ray queries in commands.
[[nodiscard]] scenes::RayQuery ray_query(LoadedScene& loaded, const scenes::SceneUse& use,
                                         bool quiet, bool draws = false);
// Adds warnings about likely mistakes (scenes/plausible), also on standard error unless `quiet`.
// draws: first checks the cameras (raytrace::check_camera), which may throw.
void check_input(LoadedScene& loaded, const scenes::RayQuery& query, const scenes::SceneUse& use,
                 bool quiet, bool draws = false);

// Removes the cameras that are inside a body, and returns them; a note names each unless `quiet`,
// after " at `moment`" if there is one. Throws base::Error (Input) if none would be left; with a
// moment, of several of a study, none may be left.
[[nodiscard]] std::vector<const scenes::Camera*> skip_hidden_cameras(
    const scenes::Scene& scene, const scenes::RayQuery& query,
    std::vector<const scenes::Camera*>& cameras, bool quiet, const std::string& moment = {});
// Throws StoppedShort unless `skipped`, names, is empty.
void check_skipped(const std::vector<std::string>& skipped);

// Both throw base::Error (Input) without such a camera. named_at: place in a file or option.
[[nodiscard]] const scenes::Camera& first_camera(const scenes::Scene& scene);
[[nodiscard]] const scenes::Camera& choose_camera(const scenes::Scene& scene,
                                                  const std::string& name,
                                                  const base::Location& named_at);
// Throws base::Error (Input) for a repeated camera: its pictures would have the same name.
[[nodiscard]] std::vector<const scenes::Camera*> each_once(
    std::vector<const scenes::Camera*> cameras);

// Messages with a remedy if the form factors are not balanced (with the remaining defect and the
// object with the largest one), or if patches send more than a thousandth of their light to
// themselves. Empty otherwise.
[[nodiscard]] std::vector<std::string> limits_of_balance(
    const radiosity::Solution& solution, double enough = radiosity::balance_to_rounding);
// Notes them on stderr. enough: the required defect.
void note_balance(const radiosity::Solution& solution,
                  double enough = radiosity::balance_to_rounding);

// Notes each object that is seen more from behind than from the front.
void note_backs(const radiosity::SolveReport& report);

// The scene's accuracy settings for the solver.
[[nodiscard]] radiosity::SolveOptions solve_options(const scenes::Scene& scene,
                                                    const Common& common);

// Wall seconds per stage, in order.
class StageTimes {
 public:
  using Stage = std::pair<std::string, double>;
  template <class Work>
  auto measure(const std::string& stage, Work work) {
    struct Stop {
      StageTimes& times;
      const std::string& stage;
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      ~Stop() {
        const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
        times.add(stage, gone.count());
      }
    } stop{*this, stage};
    return work();
  }
  void add(const std::vector<Stage>& stages) {
    for (const auto& [name, seconds] : stages) add(name, seconds);
  }
  [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }
  [[nodiscard]] double total() const;
  [[nodiscard]] Json json() const;

 private:
  // Repeated stages add up.
  void add(const std::string& name, double seconds);
  std::vector<Stage> stages_;
};

// Peak memory of the process so far.
[[nodiscard]] double peak_memory_mib();

}  // namespace earthshine::app
