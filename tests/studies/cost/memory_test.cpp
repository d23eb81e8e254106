// SPDX-License-Identifier: Apache-2.0
#include "studies/cost/memory.h"

#include <gtest/gtest.h>

#include "radiosity/factors/row_pilot.h"
#include "tests/support/scene_builder.h"

namespace earthshine::studies {
namespace {

MemoryCase large_solve() {
  MemoryCase sizes;
  sizes.triangles = sizes.vertices = 1000;
  sizes.patches = 1000000;
  sizes.row_entries = 500.0;
  sizes.columns = 3;
  sizes.solves = true;
  return sizes;
}

double part(const MemoryNeed& need, const std::string& name) {
  for (const MemoryPart& p : need.parts) {
    if (p.name == name) return p.bytes;
  }
  return 0.0;
}

TEST(Memory, TheMatrixIsThereOnceAndTwiceWhileItIsCopied) {
  // 500 million entries of a number and a count, 8 bytes; a sixteenth more while bands of rows are
  // joined; some 350 bytes per patch.
  MemoryCase sizes = large_solve();
  sizes.columns = 0;
  const double joined = part(memory_needed(sizes), "form factors");
  sizes.copies_matrix = true;
  const double copied = part(memory_needed(sizes), "form factors");
  EXPECT_GT(joined, 4.25e9);
  EXPECT_LT(joined, 4.5e9);
  EXPECT_GT(copied, 8.25e9);
  EXPECT_LT(copied, 8.5e9);
}

TEST(Memory, RanksDivideEntriesAndVectors) {
  MemoryCase sizes = large_solve();
  const double whole = memory_needed(sizes).total();
  sizes.ranks = 8;
  // An eighth of 4 GB, and half as much again while rows are sent.
  EXPECT_NEAR(whole - memory_needed(sizes).total(), 4e9 * (1.0625 - 1.5 / 8.0), 0.3e9);
  // So few entries that the linear solve takes most. With 6 columns, packed to 8, each rank has an
  // eighth of 80 bytes of entries per patch, of 480 bytes of nine vectors and direct light, and of
  // 24 of reflectance.
  sizes.row_entries = 10.0;
  sizes.columns = 6;
  const double of_eight = memory_needed(sizes).total();
  sizes.ranks = 1;
  EXPECT_NEAR(memory_needed(sizes).total() - of_eight, 7.0 / 8.0 * (80e6 + 480e6 + 24e6), 1.0);
  sizes.ranks = 8;
  sizes.first_rank = false;
  EXPECT_EQ(memory_needed(sizes).total(), of_eight);
  // For the error over the surfaces the root rank has the returned values, six columns of 8 bytes,
  // 190 bytes of samples and the 80 of the rows; of the latter the others have 24.
  sizes.columns = 3;
  sizes.states_error = true;
  const double others = memory_needed(sizes).total();
  sizes.first_rank = true;
  EXPECT_NEAR(memory_needed(sizes).total() - others, 48e6 + 190e6 + 56e6, 1.0);
}

TEST(Memory, OneRankOfMpirunHasItsLibraries) {
  MemoryCase sizes = large_solve();
  const double alone = memory_needed(sizes).total();
  sizes.has_mpi = true;
  EXPECT_NEAR(memory_needed(sizes).total() - alone, 12e6, 1.0);
}

TEST(Memory, APictureOfManyLayersOutweighsItsSolution) {
  // 16384 x 16384 pixels of 27 channels: 2^28 * 27 * 4 bytes and a little.
  MemoryCase sizes = large_solve();
  sizes.patches = 1000;
  sizes.pixels = std::size_t{1} << 28;
  sizes.channels = 27;
  sizes.layers = 8;
  const MemoryNeed need = memory_needed(sizes);
  EXPECT_GE(part(need, "picture"), 27.0 * 4.0 * double(sizes.pixels));
  EXPECT_EQ(part(need, "form factors"), 0.0);  // freed before the picture begins
  EXPECT_NE(memory_remedy(need).find("--size"), std::string::npos);
  EXPECT_NE(memory_remedy(memory_needed(large_solve())).find("max_patches"), std::string::npos);
}

TEST(Memory, ASolutionThatIsReadNeedsNoMatrix) {
  MemoryCase sizes = large_solve();
  sizes.solves = false;
  EXPECT_LT(memory_needed(sizes).total(), 0.04 * memory_needed(large_solve()).total());
}

// A room whose patches all see each other.
tests::SceneBuilder lit_room() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5, 1.0));
  builder.room({m, m, m, m, m, m});
  return builder;
}

TEST(Memory, PicturesWithoutASolutionNeedNoPatches) {
  const auto builder = lit_room();
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions options;
  options.patch_edge_m = 0.01;
  MemoryCase sizes = memory_case(prepared.scene, prepared.groups, prepared.effects, options);
  EXPECT_EQ(sizes.patches, 60000U);
  EXPECT_EQ(sizes.columns, 3U);
  const double solved = memory_needed(sizes).total();
  raytrace::RenderOptions picture;
  picture.indirect = raytrace::Indirect::None;
  add_picture(sizes, prepared.groups, prepared.effects, picture);
  EXPECT_LT(memory_needed(sizes).total(), 0.2 * solved);
}

TEST(Memory, EveryLayerOfThePictureCounts) {
  const auto builder = lit_room();
  const tests::Prepared prepared(builder.scene);
  raytrace::RenderOptions picture;
  picture.columns = picture.rows = 1000;
  const auto bytes = [&](const std::vector<std::string>& aovs) {
    picture.aovs = aovs;
    MemoryCase sizes;
    add_picture(sizes, prepared.groups, prepared.effects, picture);
    return part(memory_needed(sizes), "picture");
  };
  EXPECT_NEAR(bytes({"albedo"}) - bytes({}), 12e6, 1.0);
  // Three ranks of two objects and the preview: 15 channels.
  EXPECT_NEAR(bytes({"crypto_object"}) - bytes({}), 60e6, 1.0);
  // A part has its own sum, 12 bytes, and requires the two others.
  EXPECT_NEAR(bytes({"direct"}) - bytes({}), 12e6 + 36e6, 1.0);
  // With a wanted error rays are cast in rounds: sums of 12 bytes of three kinds, one of them also
  // denoised, and a tenth more for off-grid points, remain until the end.
  const double at_once = bytes({});
  picture.error = 0.05;
  EXPECT_NEAR(bytes({}) - at_once, 55e6, 3e6);
  picture.crop = {0, 0, 10, 10};
  EXPECT_LT(bytes({}), 1e5);
}

TEST(Memory, RowsExpectedAreTheRowsThatAreCast) {
  const auto builder = lit_room();
  const tests::Prepared prepared(builder.scene);
  const radiosity::Patches patches = radiosity::subdivide(builder.scene, 0.05);
  const radiosity::FormFactors factors =
      radiosity::cast_form_factors(builder.scene, prepared.query, patches, {256});
  const double cast = double(factors.hits.size()) / double(patches.count());
  const double expected =
      radiosity::expected_rows(builder.scene, prepared.query, patches.count(), 256).entries;
  EXPECT_NEAR(expected / cast, 1.0, 0.1);
  // At most the number of rays.
  EXPECT_LE(radiosity::expected_rows(builder.scene, prepared.query, 1U << 26U, 256).entries, 256.0);
}

TEST(Memory, PatchesOfAMilliontheOfTheRoomAreNotReached) {
  auto builder = lit_room();
  EXPECT_LT(radiosity::expected_unreached(builder.scene, 600, 256), 1e-6);
  builder.plate(0, 1e-3, 0.5, true);
  EXPECT_GT(radiosity::expected_unreached(builder.scene, 600, 256), 0.5);
}

}  // namespace
}  // namespace earthshine::studies
