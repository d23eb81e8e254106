// SPDX-License-Identifier: Apache-2.0
// What the commands share: the scene as read, warnings about a solution, stage times.
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
  std::uint64_t max_memory_bytes = 0;  // 0: what is free
  std::vector<std::string> arguments;  // the whole call, from the command on
};

// The arguments of the call without those that say how it is done: --part, --wait, --threads,
// --max-memory, --quiet and --json.
[[nodiscard]] std::vector<std::string> part_free(const std::vector<std::string>& arguments);

// What --part says; empty without it.
[[nodiscard]] std::string part_in(const std::vector<std::string>& arguments);

// Throws base::Error (Input) unless each of these, by name, is the same for all ranks: those that
// differ would wait for each other for ever, or make one picture of two scenes.
void check_ranks_alike(const Json& things);

// One file per command defines it: its options, and what it does once they are read.
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
// `degrade` itself, and `degrade certify`.
[[nodiscard]] std::vector<Command> add_degrade(CLI::App& program);
[[nodiscard]] Command add_certify(CLI::App& degrade);
[[nodiscard]] Command add_fit_phong(CLI::App& program);
[[nodiscard]] Command add_report(CLI::App& program);
[[nodiscard]] Command add_manual(CLI::App& program);
[[nodiscard]] Command add_completion(CLI::App& program);
// What runs a call as if it had been typed, for `merge`. Its exit code.
using RunCall = std::function<void(const std::vector<std::string>& arguments)>;
[[nodiscard]] Command add_merge(CLI::App& program, const RunCall& run_call);
// `study` itself, which runs nothing, and one command of it per study.
[[nodiscard]] std::vector<Command> add_study(CLI::App& program);

// SCENE, --set and --error.
struct SceneInput {
  std::string path;
  std::vector<std::string> overrides;               // key=value
  std::optional<base::Location> overrides_at = {};  // in a file; none: --set

  // Whether the call itself names the error that it wants, other than a scene, whose quality.error
  // stands for whatever is made of it.
  [[nodiscard]] bool wants_error() const;
};

// All was done and written, but not to the error that the call wants: exit code 3.
struct StoppedShort : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Size {
  int columns = 0, rows = 0;
};
// A scene with the effects that were decided for the call.
struct LoadedScene {
  scenes::Scene scene;
  scenes::Asked asked;  // what the call asks of it
  scenes::LightGroups groups;
  scenes::Effects effects;
  std::vector<scenes::Culling> culled;  // switched off in the above, as they cannot matter

  [[nodiscard]] scenes::World world(const scenes::RayQuery& query) const {
    return {scene, groups, effects, query};
  }
};
// What a call wants of the scene that was read; nothing said: all of it.
struct WantedEffects {
  scenes::Asked asked;
  bool culls = false;  // those that cannot matter are switched off
};
using AskEffects = std::function<WantedEffects(const scenes::Scene&)>;
// Warnings go to standard error unless `quiet`.
[[nodiscard]] LoadedScene load(const SceneInput& input, bool quiet, const AskEffects& ask = {});

// The two steps of it. Checks the CCTV cameras and range sensors of a scene that was read.
[[nodiscard]] LoadedScene check_scene(scenes::Scene scene);
// The only place where a call's effects are decided, each time anew.
void decide_effects(LoadedScene& loaded, const WantedEffects& wanted);

// The rays of what was read, after check_input(): every command comes by its rays here.
[[nodiscard]] scenes::RayQuery ray_query(LoadedScene& loaded, const scenes::SceneUse& use,
                                         bool quiet, bool draws = false);
// Adds to its warnings what in it is surely a mistake (scenes/plausible), on standard error too
// unless `quiet`. draws: its cameras are checked first (raytrace::check_camera), which may throw.
void check_input(LoadedScene& loaded, const scenes::RayQuery& query, const scenes::SceneUse& use,
                 bool quiet, bool draws = false);

// Both throw base::Error (Input) where there is none. named_at: where a file or an option names it.
[[nodiscard]] const scenes::Camera& first_camera(const scenes::Scene& scene);
[[nodiscard]] const scenes::Camera& choose_camera(const scenes::Scene& scene,
                                                  const std::string& name,
                                                  const base::Location& named_at);
// Throws base::Error (Input) where one is named twice: its pictures would have the same name.
[[nodiscard]] std::vector<const scenes::Camera*> each_once(
    std::vector<const scenes::Camera*> cameras);

// A line on stderr where the form factors could not be balanced, with how near they came and which
// object is furthest off; and one where that took more than a thousandth of the light.
// Where the solution fell short of its laws, and what would help; empty where it did not.
[[nodiscard]] std::vector<std::string> limits_of_balance(
    const radiosity::Solution& solution, double enough = radiosity::balance_to_rounding);
// enough: the defect that was asked for.
void note_balance(const radiosity::Solution& solution,
                  double enough = radiosity::balance_to_rounding);

// A line on stderr for each object that is seen from behind more than from the front.
void note_backs(const radiosity::SolveReport& report);

// The scene's accuracy knobs as the solver wants them.
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
  // What is done more than once adds up.
  void add(const std::string& name, double seconds);
  std::vector<Stage> stages_;
};

// Largest memory the process has used so far.
[[nodiscard]] double peak_memory_mib();

}  // namespace earthshine::app
