// SPDX-License-Identifier: Apache-2.0
// The program as a library for Python: a scene that stays loaded, and pictures in memory. Requests
// and reports are JSON texts with the keys of the package's stubs (earthshine/__init__.pyi). Calls
// are serialised. All throw base::Error.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files/exr_file.h"
#include "degrade/chain.h"

namespace earthshine::python {

// Call first: suppresses the program's notes and leaves signals to Python.
void be_a_guest();
// Asks the present call to stop; it throws Stopped. False: cancels the request.
void ask_to_stop(bool stop);
struct Stopped {};

[[nodiscard]] std::string version();

// A CCTV camera with its monitor, ready for use.
struct CctvView {
  std::string name;
  degrade::Setup setup;
};

// A picture with the header of its file.
struct Frame {
  base::ExrFile file;
  std::string report = "{}";
  std::string error;             // why there is no `cctv`; "": not requested
  std::optional<CctvView> cctv;  // of the picture's camera
  double fov_deg = 0.0;          // vertical; 0: unknown
};

// The radiosity of a scene's patches. Arrays have one row per patch.
struct Light {
  std::string report = "{}";
  std::vector<std::string> groups;
  std::size_t count = 0;
  std::vector<float> radiosity, direct_lx, indirect_lx;  // patch x group x RGB
  std::vector<double> area_m2, centre_m, normal;         // patch; x 3
  std::vector<std::uint32_t> object;
  struct Kept;  // the solution and its settings
  std::shared_ptr<const Kept> kept;
};

class Session {
 public:
  // text: of a scene without a file; its meshes are relative to `path`.
  Session(std::string path, std::optional<std::string> text);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Replaces the changes to the scene, in --set syntax. The next call reads the scene again and
  // keeps the ray structure and the solutions that are still valid.
  void set(std::vector<std::string> overrides);

  [[nodiscard]] std::string describe();
  // Counts of scene reads, ray structures, solves and pictures.
  [[nodiscard]] std::string work() const;
  [[nodiscard]] std::shared_ptr<Frame> render(const std::string& request,
                                              const std::shared_ptr<const Light>& light);
  [[nodiscard]] std::shared_ptr<Light> solve(const std::string& request);
  void write_light(const Light& light, const std::string& path);
  [[nodiscard]] std::string plan(const std::string& request);
  [[nodiscard]] std::string form_factors(const std::string& request);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

[[nodiscard]] std::shared_ptr<Frame> read_frame(const std::string& path);
[[nodiscard]] std::shared_ptr<Frame> relight(const Frame& frame,
                                             const std::vector<std::string>& settings);
// An EXR file with all layers, or a tone-mapped PNG.
void write_frame(const Frame& frame, const std::string& path);

// The displayed picture of a CCTV camera's monitor.
struct Monitor {
  degrade::Result result;
  base::Image twin;  // no channels unless requested
  degrade::Memory twin_memory;
  std::string report = "{}";
  CctvView view;
};
[[nodiscard]] std::shared_ptr<Monitor> degrade_frame(const Frame& frame, const std::string& request,
                                                     const Monitor* before);
void write_monitor(const Monitor& monitor, const std::string& path);

// Runs a study into its folder. Returns {"study": study.json, "table": results.csv}.
[[nodiscard]] std::string run_study(const std::string& request);

}  // namespace earthshine::python
