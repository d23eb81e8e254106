// SPDX-License-Identifier: Apache-2.0
// The program's work as a Python process calls it: a scene that stays loaded, pictures in memory.
// Requests and reports are JSON texts, whose keys the package's stubs (earthshine/__init__.pyi)
// name. One call at a time: callers take turns. All throw base::Error.
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

// Before anything else: the program's notes are not printed, and signals stay Python's.
void be_a_guest();
// Asks the call in progress to end; it throws Stopped. False: none is asked to.
void ask_to_stop(bool stop);
struct Stopped {};

[[nodiscard]] std::string version();

// A CCTV camera with its monitor, ready for a picture.
struct CctvView {
  std::string name;
  degrade::Setup setup;
};

// A picture with the header that its file has.
struct Frame {
  base::ExrFile file;
  std::string report = "{}";
  std::string error;             // why there is no `cctv`; "": it was not looked for
  std::optional<CctvView> cctv;  // of the camera that it was taken with
  double fov_deg = 0.0;          // vertical; 0: not known
};

// The radiosity of a scene's patches. Arrays have a row a patch.
struct Light {
  std::string report = "{}";
  std::vector<std::string> groups;
  std::size_t count = 0;
  std::vector<float> radiosity, direct_lx, indirect_lx;  // patch x group x RGB
  std::vector<double> area_m2, centre_m, normal;         // patch; x 3
  std::vector<std::uint32_t> object;
  struct Kept;  // the solution itself, and with what settings it was found
  std::shared_ptr<const Kept> kept;
};

class Session {
 public:
  // text: of a scene that stands in no file; its meshes are looked for beside `path`.
  Session(std::string path, std::optional<std::string> text);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Changes to the scene, as --set has them, in place of those before. The next call reads the
  // scene anew and keeps the ray structure and the solutions that still hold.
  void set(std::vector<std::string> overrides);

  [[nodiscard]] std::string describe();
  // How often the scene was read, its rays structured, its light solved and a picture drawn.
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

// What the monitor of a CCTV camera shows.
struct Monitor {
  degrade::Result result;
  base::Image twin;  // no channels unless it was asked for
  degrade::Memory twin_memory;
  std::string report = "{}";
  CctvView view;
};
[[nodiscard]] std::shared_ptr<Monitor> degrade_frame(const Frame& frame, const std::string& request,
                                                     const Monitor* before);
void write_monitor(const Monitor& monitor, const std::string& path);

// A study into its folder. Returns {"study": study.json, "table": results.csv}.
[[nodiscard]] std::string run_study(const std::string& request);

}  // namespace earthshine::python
