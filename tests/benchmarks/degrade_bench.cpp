// SPDX-License-Identifier: Apache-2.0
// The CCTV chain: input pixels per second for each shipped camera, for a camera with every stage
// on, and for each of its stages alone (input pixels of the stage).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "base/numbers/random.h"
#include "degrade/chain.h"
#include "degrade/settings/presets.h"

namespace earthshine {
namespace {

using degrade::CctvCamera;
using degrade::Monitor;
using degrade::Picture;

base::Image noise_picture(int edge_px) {
  base::Image image = base::make_rgb_image(edge_px, edge_px);
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  for (base::Channel& channel : image.channels) {
    for (float& value : channel.values) value = static_cast<float>(1000.0 * rng.next());
  }
  return image;
}

// A monochrome camera with every effect on.
CctvCamera everything() {
  CctvCamera camera = degrade::find_preset("sit-monochrome")->camera;
  camera.f_number_min = 250.0;  // so that gain is needed
  camera.fall_off = 4.0;
  camera.glare = 0.02;
  camera.lens_blur = 0.3;
  camera.shading_percent = 20.0;
  camera.lag = 0.42;
  camera.smear_db = 90.0;
  camera.saturation = 0.2;
  camera.bloom = 0.5;
  camera.dark_electrons = 5.0;
  camera.dsnu_percent = 0.1;
  camera.bandwidth_mhz = 4.2;
  camera.aperture_correction = 0.3;
  camera.bits = 8;
  camera.interlace = true;
  return camera;
}

// A monitor with `rows` lines, wide enough for a square picture.
Monitor monitor_of(int rows) {
  Monitor monitor;
  monitor.rows = rows;
  monitor.columns = rows * 4 / 3;
  return monitor;
}

degrade::Options options() {
  degrade::Options wanted;
  wanted.fov_deg = 40.0;
  return wanted;
}

void set_rate(benchmark::State& state, std::size_t pixels) {
  state.counters["px"] =
      benchmark::Counter(static_cast<double>(pixels),
                         benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

void chain(benchmark::State& state, const CctvCamera& camera, const Monitor& monitor) {
  const base::Image image = noise_picture(static_cast<int>(state.range(0)));
  for (auto round : state) {
    benchmark::DoNotOptimize(degrade::degrade(image, camera, monitor, options()).pixels.data());
  }
  set_rate(state, image.pixel_count());
}

// One stage with its usual input, on a monitor with as many lines as the picture.
void one_stage(benchmark::State& state, const degrade::Stage& stage) {
  const int lines = static_cast<int>(state.range(0));
  const base::Image image = noise_picture(lines);
  Picture before{image.width, image.height, {base::luminance_of(image)}};
  degrade::Options watched = options();
  bool reached = false;
  watched.watch = [&](const degrade::Stage& ran, const Picture& picture) {
    reached = reached || &ran == &stage;
    if (!reached) before = picture;
  };
  const degrade::Setup setup{everything(), monitor_of(lines), options()};
  const degrade::Result whole = degrade::degrade(image, setup.camera, setup.monitor, watched, {});
  degrade::Report report = whole.report;
  degrade::Memory memory = whole.memory;
  for (auto round : state) {
    const Picture after = stage.merge != nullptr
                              ? stage.merge(before, before)
                              : stage.law(Picture(before), {setup, report, memory, 1, 2});
    benchmark::DoNotOptimize(after.planes.front().data());
  }
  set_rate(state, before.pixel_count());
}

template <class Body>
benchmark::internal::Benchmark* add(const std::string& name, Body body) {
  return benchmark::RegisterBenchmark(name.c_str(), body)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

}  // namespace
}  // namespace earthshine

int main(int argc, char** argv) {
  using namespace earthshine;
  benchmark::Initialize(&argc, argv);
  for (const degrade::Preset& preset : degrade::presets()) {
    add("degrade/" + std::string(preset.name),
        [&preset](benchmark::State& state) { chain(state, preset.camera, {}); })
        ->ArgName("px")
        ->Arg(512)
        ->Arg(2048);
  }
  add("everything/300-lines", [](benchmark::State& state) { chain(state, everything(), {}); })
      ->ArgName("px")
      ->Arg(512)
      ->Arg(1024)
      ->Arg(2048);
  // As many lines as the picture, so that the cost grows with the picture.
  add("everything/own-lines",
      [](benchmark::State& state) {
        chain(state, everything(), monitor_of(static_cast<int>(state.range(0))));
      })
      ->ArgName("px")
      ->Arg(256)
      ->Arg(512)
      ->Arg(1024)
      ->Arg(2000);
  for (const degrade::Stage& stage : degrade::stages()) {
    add("stage/" + std::string(stage.name),
        [&stage](benchmark::State& state) { one_stage(state, stage); })
        ->ArgName("lines")
        ->Arg(1024)
        ->Arg(2000);
  }
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
