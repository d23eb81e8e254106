// SPDX-License-Identifier: Apache-2.0
// Gather points that serve all samples of their pixel, against all light paths.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/render.h"
#include "raytrace/tuning.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// A grey room with a bright wall and a block on its floor, seen from a corner; a lamp and its
// shadows.
struct Room {
  scenes::Scene scene;
  scenes::Camera camera;
  Room() {
    tests::SceneBuilder builder;
    const std::uint32_t grey = builder.material(tests::grey(0.5));
    const std::uint32_t bright = builder.material(tests::grey(0.5, 100.0));
    builder.room({bright, grey, grey, grey, grey, grey});
    builder.plate(grey, 0.3, 0.2, true);
    for (std::size_t v = builder.scene.vertices.size() - 4; v < builder.scene.vertices.size();
         ++v) {
      builder.scene.vertices[v] += Vec3(0.5, 0.5, 0.0);
    }
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp";
    lamp.kind = scenes::LampKind::Disk;
    lamp.position = Vec3(0.5, 0.5, 0.9);
    lamp.axis = Vec3(0, 0, -1);
    lamp.radius_m = 0.1;
    lamp.exitance = Rgb(3000.0);
    builder.scene.lamps.push_back(lamp);
    scene = builder.scene;
    camera.name = "corner";
    camera.position = Vec3(0.95, 0.9, 0.6);
    camera.look_at = Vec3(0.4, 0.45, 0.2);
    camera.fov_deg = 60.0;
  }
};

struct Studio {
  Room room;
  tests::Prepared prepared{room.scene};
  radiosity::Solution solution = [this] {
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 0.1;
    solve.form_factor_rays = 256;
    return prepared.solve(solve);
  }();
  [[nodiscard]] Frame picture(const RenderOptions& options) const {
    return render(prepared, solution, room.camera, options);
  }
};

const Studio& studio() {
  static const Studio made;
  return made;
}

RenderOptions shared_options(int columns = 48, int rows = 40) {
  RenderOptions options;
  options.columns = columns;
  options.rows = rows;
  options.gather_rays = 32;
  options.aovs = {"variance"};
  return options;
}

double mean(const Frame& frame) {
  double sum = 0.0;
  for (const float v : frame.image.find("G")->values) sum += double(v);
  return sum / static_cast<double>(frame.image.pixel_count());
}

TEST(SharedGather, PictureIsThatOfAllPathsWithinTheStatedErrors) {
  // z = difference / sqrt(sum of both variances). Stated variances are those of independent
  // samples, and low-discrepancy samples have less: the mean of z^2 is at most 1 plus the bias of
  // denoising.
  PathOptions paths;
  paths.columns = shared_options().columns;
  paths.rows = shared_options().rows;
  paths.paths_per_pixel = 1024;
  const Frame oracle = trace_paths(studio().prepared, studio().room.camera, paths);
  const Frame quick = studio().picture(shared_options());
  const auto& a = oracle.image.find("G")->values;
  const auto& b = quick.image.find("G")->values;
  const auto& va = oracle.image.find("variance")->values;
  const auto& vb = quick.image.find("variance")->values;
  double squares = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    const double off = double(a[p]) - double(b[p]);
    squares += off * off / std::max(1e-12, double(va[p]) + double(vb[p]));
  }
  const auto n = static_cast<double>(a.size());
  EXPECT_LT(squares / n, 1.0 + 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(mean(quick) / mean(oracle), 1.0,
              4.0 * quick.report.relative_noise / std::sqrt(n) + 0.005);
}

// Every pixel has the fixed number of samples, and every point its rays.
TEST(SharedGather, FixedNumbersAreTheSameEverywhere) {
  RenderOptions options = shared_options();
  options.camera_samples = 4;
  const RenderReport report = studio().picture(options).report;
  EXPECT_EQ(report.camera_samples, 4.0);
  EXPECT_EQ(report.most_camera_samples, 4);
  EXPECT_EQ(report.gather_rays, options.gather_rays);
}

TEST(SharedGather, CropAndReplayHaveThePixelsOfTheWholePicture) {
  RenderOptions options = shared_options();
  options.aovs = {"direct", "indirect", "variance", "depth"};
  const Frame whole = studio().picture(options);
  for (const Window& crop : {Window{13, 9, 11, 17}, Window{30, 22, 1, 1}, Window{0, 0, 5, 3}}) {
    options.crop = crop;
    const Frame part = studio().picture(options);
    ASSERT_EQ(part.image.width, crop.columns);
    for (const base::Channel& channel : part.image.channels) {
      const auto& from = whole.image.find(channel.name)->values;
      for (int y = 0; y < crop.rows; ++y) {
        for (int x = 0; x < crop.columns; ++x) {
          EXPECT_EQ(channel.values[static_cast<std::size_t>(y * crop.columns + x)],
                    from[static_cast<std::size_t>((crop.y + y) * 48 + crop.x + x)])
              << channel.name << " " << x << ", " << y;
        }
      }
    }
  }
  options.crop = {40, 0, 9, 4};
  EXPECT_THROW(static_cast<void>(studio().picture(options)), base::Error);
}

TEST(SharedGather, SameBytesOnOneAndTwoThreads) {
  const base::ThreadLimit one(1);
  const Frame a = studio().picture(shared_options());
  const base::ThreadLimit two(2);
  const Frame b = studio().picture(shared_options());
  for (std::size_t c = 0; c < a.image.channels.size(); ++c) {
    EXPECT_EQ(a.image.channels[c].values, b.image.channels[c].values);
  }
}

TEST(SharedGather, DirectIndirectAndSpecularAddUpToThePicture) {
  for (const double error : {0.0, 0.1}) {
    RenderOptions options = shared_options(24, 20);
    options.error = error;
    options.aovs = {"direct", "indirect", "specular"};
    const Frame frame = studio().picture(options);
    const Frame direct = [&] {
      RenderOptions none = options;
      none.indirect = Indirect::None;
      none.aovs.clear();
      return studio().picture(none);
    }();
    double indirect = 0.0;
    for (std::size_t p = 0; p < frame.image.pixel_count(); ++p) {
      const auto at = [&](const char* name) { return double(frame.image.find(name)->values[p]); };
      EXPECT_NEAR(at("direct.G") + at("indirect.G") + at("specular.G"), at("G"),
                  1e-5 * at("G") + 1e-6);
      EXPECT_GE(at("indirect.G"), 0.0);
      indirect += at("indirect.G");
    }
    EXPECT_GT(indirect, 0.0);
    EXPECT_GT(mean(frame), mean(direct));
  }
}

TEST(SharedGather, LightStraightFromTheEarthIsDirect) {
  // Only a plate under a wide Earth: nothing else reflects, hence direct is the whole picture.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 2.0, 0.0, true);
  scenes::Earth earth;
  earth.half_angle_deg = 70.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(1000.0);
  builder.scene.earth = earth;
  const tests::Prepared prepared(builder.scene);
  scenes::Camera camera;
  camera.position = Vec3(0, 0, 1);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  RenderOptions options = shared_options(12, 12);
  options.aovs = {"direct", "indirect"};
  const Frame frame = render(prepared, prepared.solve({}), camera, options);
  for (std::size_t p = 0; p < frame.image.pixel_count(); ++p) {
    const double all = double(frame.image.find("G")->values[p]);
    EXPECT_GT(all, 0.0);
    EXPECT_NEAR(double(frame.image.find("direct.G")->values[p]), all, 1e-5 * all);
    EXPECT_NEAR(double(frame.image.find("indirect.G")->values[p]), 0.0, 1e-5 * all);
  }
}

TEST(SharedGather, PathsBetweenMirrorsHaveNoEnd) {
  // A closed room whose walls reflect 0.8 and emit M: L = M / pi + 0.8 L, five times the emission;
  // a tenth of it arrives by paths of more than ten mirrors.
  tests::SceneBuilder builder;
  scenes::Material wall = tests::grey(0.0, 1.0);
  wall.mirror = Rgb(0.8);
  const std::uint32_t m = builder.material(wall);
  builder.room({m, m, m, m, m, m});
  const tests::Prepared prepared(builder.scene);
  scenes::Camera camera;
  camera.position = Vec3(0.3, 0.4, 0.5);
  camera.look_at = Vec3(1, 0.6, 0.3);
  RenderOptions options = shared_options(32, 32);
  const Frame frame = render(prepared, prepared.solve({}), camera, options);
  double variance = 0.0;
  for (const float v : frame.image.find("variance")->values) variance += double(v);
  const double standard_error = std::sqrt(variance) / 1024.0;
  EXPECT_GT(standard_error, 0.0);
  EXPECT_LT(standard_error, 0.02);
  EXPECT_NEAR(mean(frame), 5.0 / base::pi, 4.0 * standard_error);
}

TEST(SharedGather, AStoppedPictureKeepsWhatIsFinished) {
  // After a stop at any query every pixel has a value; from some query on, some pixels are finished
  // and others are not.
  RenderOptions options = shared_options(64, 48);
  const Frame whole = studio().picture(options);
  EXPECT_FALSE(whole.report.stopped);
  EXPECT_EQ(whole.report.finished_share, 1.0);
  const base::ThreadLimit one(1);
  std::atomic<int> asked{0};
  options.stop = [&asked] {
    ++asked;
    return false;
  };
  static_cast<void>(studio().picture(options));
  const int all = asked;
  int cut_short = 0;
  for (int last = 1; last < all; last += all / 16) {
    asked = 0;
    options.stop = [&asked, last] { return ++asked > last; };
    const Frame part = studio().picture(options);
    EXPECT_TRUE(part.report.stopped);
    for (const float v : part.image.find("G")->values) EXPECT_GT(v, 0.0F);
    EXPECT_NEAR(mean(part) / mean(whole), 1.0, 0.3);
    if (part.report.finished_share > 0.0 && part.report.finished_share < 1.0) ++cut_short;
  }
  EXPECT_GT(cut_short, 0);
}

TEST(SharedGather, TwoSamplesAreEnoughToBeginWithWhereNoEdgeIsNear) {
  // A wall alone has no edge, and its pixels get half of the least samples; where two walls meet,
  // some get all of them. An error of 1 is reached at once, so that only samples for the eye
  // follow, and the wall needs none.
  RenderOptions options = shared_options(96, 80);
  options.error = 1.0;
  const auto samples = [&](const Window& crop) {
    options.crop = crop;
    return studio().picture(options).report.camera_samples;
  };
  const double least = tuning::initial_camera_samples;
  EXPECT_EQ(samples({60, 0, 8, 8}), least / 2.0);
  EXPECT_GT(samples({36, 0, 8, 8}), least / 2.0);
}

TEST(SharedGather, AStopAtTheFirstQuestionCostsLittle) {
  // Samples one of 25 pixels of a surface, and all off-grid points that no pixel serves: less than
  // half of the rays of the whole initial sampling, as after a stop at its end. At edges two camera
  // samples give an error.
  RenderOptions options = shared_options(96, 80);
  options.error = 1.0;
  const auto gathered = [&](bool at_once) {
    options.stop = [at_once] { return at_once; };
    const Frame frame = studio().picture(options);
    for (const float v : frame.image.find("G")->values) EXPECT_GT(v, 0.0F);
    EXPECT_GT(add_up(frame.error).squared[static_cast<std::size_t>(ErrorPart::Camera)], 0.0);
    return static_cast<double>(frame.report.rays.gather);
  };
  EXPECT_LT(gathered(true), 0.5 * gathered(false));
}

TEST(SharedGather, ATimeLimitIsKeptAndStillGivesEveryPixelASample) {
  RenderOptions options = shared_options(64, 64);
  options.time_limit_s = 1e-3;
  const Frame frame = studio().picture(options);
  for (const float v : frame.image.find("G")->values) EXPECT_GT(v, 0.0F);
}

}  // namespace
}  // namespace earthshine::raytrace
