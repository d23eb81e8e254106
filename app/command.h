// SPDX-License-Identifier: Apache-2.0
// What the commands share: options, reading the scene, checking what will be written, stage times.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "radiosity/solution.h"
#include "scenes/effects.h"
#include "scenes/light_groups.h"
#include "scenes/scene.h"

namespace earthshine::app {

using Json = nlohmann::ordered_json;

// Options of every command.
struct Common {
  int threads = 0;  // 0: all
  std::uint64_t seed = 1;
  bool quiet = false;
  std::uint64_t max_memory_bytes = 0;  // 0: what is free
};

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
[[nodiscard]] Command add_relight(CLI::App& program);
// `degrade` itself, and `degrade certify`.
[[nodiscard]] std::vector<Command> add_degrade(CLI::App& program);
[[nodiscard]] Command add_certify(CLI::App& degrade);
[[nodiscard]] Command add_fit_phong(CLI::App& program);
[[nodiscard]] Command add_report(CLI::App& program);
// `study` itself, which runs nothing, and one command of it per study.
[[nodiscard]] std::vector<Command> add_study(CLI::App& program);

// SCENE, --set and --error.
struct SceneInput {
  std::string path;
  std::vector<std::string> overrides;  // key=value
};
void add_scene_options(CLI::App& command, SceneInput& input);

struct Size {
  int columns = 0, rows = 0;
};
// --size CxR; stays empty where the camera's own size is meant.
void add_size_option(CLI::App& command, std::optional<Size>& size);

// The words between the commas, also empty ones.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

// A whole number within [least, most], read strictly: no sign for unsigned, no octal, no rounding.
// Throws CLI::ValidationError with the option's name.
[[nodiscard]] std::uint64_t read_whole_number(const std::string& option, const std::string& text,
                                              std::uint64_t least, std::uint64_t most);

// An option that takes such a number.
void add_whole_number(CLI::App& command, const std::string& flags, std::uint64_t& value,
                      std::uint64_t least, std::uint64_t most, const std::string& help);

// An option that takes a finite number within [least, most].
void add_number(CLI::App& command, const std::string& flags, std::optional<double>& value,
                double least, double most, const std::string& help);

// --max-memory SIZE, with a unit: 500MiB, 2GiB.
void add_memory_option(CLI::App& command, std::uint64_t& bytes);

// --time-limit SECONDS above 0.
void add_time_limit(CLI::App& command, double& seconds, const std::string& help);

// Refuses an empty word, such as that of a variable that the shell does not know.
[[nodiscard]] CLI::Validator not_empty();

// A scene with what follows from it alone. Warnings go to standard error unless `quiet`.
struct LoadedScene {
  scenes::Scene scene;
  scenes::LightGroups groups;
  scenes::Effects effects;
};
[[nodiscard]] LoadedScene load(const SceneInput& input, bool quiet);

// The camera of that name, or the first one when the name is empty. Throws base::Error (Input).
[[nodiscard]] const scenes::Camera& choose_camera(const scenes::Scene& scene,
                                                  const std::string& name);

// A line on stderr where the form factors could not be balanced, with how near they came and which
// object is furthest off; and one where that took more than a thousandth of the light.
void note_balance(const radiosity::Solution& solution);

// A line on stderr for each object that is seen from behind more than from the front.
void note_backs(const radiosity::SolveReport& report);

// The scene's accuracy knobs as the solver wants them.
[[nodiscard]] radiosity::SolveOptions solve_options(const scenes::Scene& scene,
                                                    const Common& common);

// Throws base::Error before any work is done if one of the files (empty names are left out) cannot
// be written or two are the same.
void check_outputs(const std::vector<std::string>& paths, const std::vector<std::string>& inputs);

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

[[nodiscard]] inline Json to_json(const Rgb& value) {
  return Json::array({value.r, value.g, value.b});
}
// Indented text with a final newline. Numbers that are not finite become null.
[[nodiscard]] std::string dump(const Json& json);

}  // namespace earthshine::app
