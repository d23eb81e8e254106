// SPDX-License-Identifier: Apache-2.0
// Pictures in memory: reading and writing files, relighting, the CCTV chain; studies.
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "app/cctv/cctv.h"
#include "app/cctv/degrade_list.h"
#include "app/console.h"
#include "app/options.h"
#include "app/provenance.h"
#include "app/study/study.h"
#include "app/tools/relight.h"
#include "app/visibility/run.h"
#include "base/error.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "python/request.h"
#include "python/session.h"
#include "studies/orbit/study_file.h"

namespace earthshine::python {

using app::Json;

std::shared_ptr<Frame> read_frame(const std::string& path) {
  const CallLock call_lock;
  auto frame = std::make_shared<Frame>();
  frame->file = base::read_exr(path);
  for (const auto& [name, value] : frame->file.header.numbers) {
    if (name == "earthshine:camera.fov_deg") frame->fov_deg = static_cast<double>(value);
  }
  return frame;
}

std::shared_ptr<Frame> relight(const Frame& frame, const std::vector<std::string>& settings) {
  const CallLock call_lock;
  auto changed = std::make_shared<Frame>(frame);
  app::relight(changed->file, settings, "the frame");
  return changed;
}

void write_frame(const Frame& frame, const std::string& path) {
  const CallLock call_lock;
  if (path.ends_with(".exr")) return base::write_exr(path, frame.file.image, frame.file.header);
  if (!path.ends_with(".png")) {
    throw base::Error(base::Blame::Input, path, "is neither a .exr nor a .png file", {},
                      "Name a file that ends in one of the two");
  }
  const base::Image& image = frame.file.image;
  base::write_png(path, image.width, image.height, 3, base::tone_map(image).rgb,
                  app::partial_mark(frame.file.header));
}

namespace {

app::CctvSetup setup_of(const CctvView& view) { return {view.name, view.setup}; }

// The camera of the request, or the frame's own.
app::CctvSetup camera_of(const Frame& frame, const Request& request, const app::Common& common) {
  if (request.has("camera")) {
    return app::cctv_of(app::camera_of_argument("camera", request.word("camera", "")), common);
  }
  if (frame.cctv) return setup_of(*frame.cctv);
  if (!frame.error.empty()) throw base::Error(base::Blame::Input, "camera", frame.error);
  return app::cctv_of_preset(std::string(app::default_preset), common);
}

}  // namespace

std::shared_ptr<Monitor> degrade_frame(const Frame& frame, const std::string& request_text,
                                       const Monitor* before) {
  const Request request(request_text);
  const CallLock call_lock(request);
  const app::Common common = request.common();
  app::CctvSetup setup = camera_of(frame, request, common);
  degrade::Options& options = setup.chain.options;
  options.seed = common.seed;
  options.frame = static_cast<std::uint64_t>(request.number("frame").value_or(0.0));
  options.off = request.words("off");
  options.fov_deg = request.number("fov_deg").value_or(frame.fov_deg);
  const base::Image& image = frame.file.image;
  auto monitor = std::make_shared<Monitor>();
  degrade::Memory memory, twin_memory;
  if (before != nullptr) {
    memory = before->result.memory;
    twin_memory = before->twin_memory;
  }
  const degrade::CctvCamera& camera = setup.chain.camera;
  monitor->result = degrade::degrade(image, camera, setup.chain.monitor, options, memory);
  Json report = app::cctv_json(setup, monitor->result);
  if (request.flag("twin")) {
    const int resels = static_cast<int>(request.number("target_resels").value_or(5.0));
    const degrade::Twin twin =
        degrade::twin(image, camera, setup.chain.monitor, options, {resels}, twin_memory);
    monitor->twin = degrade::to_image(twin, monitor->result);
    monitor->twin_memory = twin.memory;
    report["twin"] = app::twin_json(twin);
  }
  leave_if_asked();
  monitor->report = app::dump(report);
  monitor->view = {std::move(setup.name), std::move(setup.chain)};
  return monitor;
}

void write_monitor(const Monitor& monitor, const std::string& path) {
  const CallLock call_lock;
  app::write_cctv(path, setup_of(monitor.view), monitor.result);
}

std::string run_study(const std::string& request_text) {
  const Request request(request_text);
  const CallLock call_lock(request);
  const app::Common common = request.common();
  const std::string path = request.word("path", ""), kind = request.word("kind", "run");
  app::StudyTask task;
  if (kind == "run") {
    task.study = studies::read_study_file(path);
    task.command = "study run " + path;
  } else {
    app::StudyCall call;
    call.scene = {path, request.words("set")};
    if (const auto error = request.number("error")) {
      call.scene.overrides.push_back(fmt::format("quality.error={}", *error));
    }
    call.cameras = request.words("cameras");
    if (const auto size = request.whole_numbers("size", 2, 1)) {
      call.size = app::Size{(*size)[0], (*size)[1]};
    }
    task.study = app::study_of(call, request.words("wanted"), {});
    task.command = "study " + kind;
    if (kind == "orbit") {
      const auto positions = static_cast<int>(request.number("positions").value_or(36.0));
      task.study.positions_deg = studies::even_positions(positions);
      task.study.timeline = positions > 1;
    }
  }
  task.folder = request.word("folder", "");
  const auto found = app::run_study(std::move(task), common);
  leave_if_asked();
  return app::dump({{"study", app::to_json(*found)}, {"table", app::results_csv(*found)}});
}

}  // namespace earthshine::python
