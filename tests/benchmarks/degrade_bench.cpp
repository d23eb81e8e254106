// SPDX-License-Identifier: Apache-2.0
// Pixels of the input per second through the whole CCTV chain, for each camera that ships.
#include <benchmark/benchmark.h>

#include <string>

#include "base/random.h"
#include "degrade/chain.h"
#include "degrade/presets.h"

namespace earthshine {
namespace {

base::Image noise_picture(int edge_px) {
  base::Image image = base::make_rgb_image(edge_px, edge_px);
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  for (base::Channel& channel : image.channels) {
    for (float& value : channel.values) value = static_cast<float>(1000.0 * rng.next());
  }
  return image;
}

void chain(benchmark::State& state, const degrade::Preset& preset) {
  const base::Image image = noise_picture(static_cast<int>(state.range(0)));
  for (auto round : state) {
    benchmark::DoNotOptimize(degrade::degrade(image, preset.camera, {}).pixels.data());
  }
  state.counters["px"] =
      benchmark::Counter(static_cast<double>(image.pixel_count()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kIsIterationInvariant);
}

}  // namespace
}  // namespace earthshine

int main(int argc, char** argv) {
  using namespace earthshine;
  benchmark::Initialize(&argc, argv);
  for (const degrade::Preset& preset : degrade::presets()) {
    const std::string name = "degrade/" + std::string(preset.name);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&preset](benchmark::State& state) { chain(state, preset); })
        ->ArgName("px")
        ->Arg(512)
        ->Arg(2048)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
