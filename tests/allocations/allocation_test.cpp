// SPDX-License-Identifier: Apache-2.0
// An effect that has nothing to do allocates nothing: a picture of the scene with it asks for as
// many bytes as one without it. Counted at operator new, on one thread, so that both runs are the
// same but for the effect.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <string>

#include "base/parallel.h"
#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace {
std::atomic<std::uint64_t> given_bytes{0};

void* counted(std::size_t bytes) {
  given_bytes += bytes;
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}

// Out of line, or GCC takes the free() of what new gave for a fault.
[[gnu::noinline]] void give_back(void* memory) { std::free(memory); }
}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes); }
void* operator new[](std::size_t bytes) { return counted(bytes); }
void operator delete(void* memory) noexcept { give_back(memory); }
void operator delete[](void* memory) noexcept { give_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { give_back(memory); }
void operator delete[](void* memory, std::size_t) noexcept { give_back(memory); }

namespace earthshine {
namespace {

struct View {
  scenes::Scene scene;
  scenes::Camera camera;
  raytrace::RenderOptions options;
};
using Change = std::function<void(View&)>;

// A room with a lamp: what is solved, gathered and written.
View plain() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.5, 0.5, 0.8);
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  View view{builder.scene, {}, {}};
  view.camera.name = "A";
  view.camera.position = Vec3(0.1, 0.1, 0.5);
  view.camera.look_at = Vec3(0.9, 0.9, 0.4);
  view.options.columns = view.options.rows = 24;
  return view;
}

std::uint64_t bytes_of(const Change& change) {
  View view = plain();
  if (change) change(view);
  view.scene.cameras = {view.camera};
  const scenes::LightGroups groups = scenes::find_light_groups(view.scene);
  scenes::Asked asked;
  asked.cameras = {&view.scene.cameras.front()};
  const scenes::Effects effects = scenes::find_effects(view.scene, groups, asked);
  const scenes::RayQuery query(view.scene);
  radiosity::SolveOptions solver;
  solver.patch_edge_m = 0.25;
  solver.form_factor_rays = 64;
  const std::uint64_t before = given_bytes;
  const radiosity::Solution solution =
      radiosity::solve({view.scene, groups, effects, query}, solver);
  const raytrace::Frame frame =
      raytrace::render({view.scene, groups, effects, query}, solution, view.camera, view.options);
  EXPECT_GT(frame.report.rays.total(), 0U);
  return given_bytes - before;
}

class Allocations : public testing::Test {
 protected:
  base::ThreadLimit one_{1};
  std::uint64_t first_ = bytes_of({});  // with what is set up once
  std::uint64_t usual_ = bytes_of({});
};

TEST_F(Allocations, AreTheSameTwice) { EXPECT_EQ(bytes_of({}), usual_); }

TEST_F(Allocations, EffectsWithNothingToDoTakeNone) {
  const std::map<std::string, Change> culled = {
      {"specular 0",
       [](View& view) {
         for (scenes::Material& m : view.scene.materials) m.shininess = 30.0;
       }},
      {"aperture 0", [](View& view) { view.camera.focus_m = 2.0; }},
      {"mirror 0, glass 0",
       [](View& view) {
         for (scenes::Material& m : view.scene.materials) m.ior = 1.5;
       }},
      {"an Earth without light",
       [](View& view) {
         view.scene.earth.emplace();
         view.scene.earth->model = scenes::EarthModel::Uniform;
         view.scene.earth->half_angle_deg = 40.0;
       }},
      {"a Sun without light",
       [](View& view) {
         view.scene.sun.emplace();
         view.scene.sun->illuminance_lx = Rgb(0.0);
       }},
      {"ambient 0", [](View& view) { view.scene.ambient_radiance = Rgb(0.0); }},
  };
  for (const auto& [name, change] : culled) EXPECT_EQ(bytes_of(change), usual_) << name;
}

// The count includes the memory of effects that run.
TEST_F(Allocations, EffectsThatRunTakeSome) {
  EXPECT_GT(bytes_of([](View& view) {
              view.scene.sun.emplace();
              view.scene.sun->direction = Vec3(0, 0, 1);
              view.scene.sun->illuminance_lx = Rgb(1000.0);
              view.options.per_light = true;
            }),
            usual_);
}

}  // namespace
}  // namespace earthshine
