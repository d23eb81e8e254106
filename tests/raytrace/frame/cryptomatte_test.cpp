// SPDX-License-Identifier: Apache-2.0
#include "raytrace/frame/cryptomatte.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numbers/random.h"
#include "scenes/ray_query.h"

namespace earthshine::raytrace {
namespace {

float id_value(std::string_view name) { return std::bit_cast<float>(cryptomatte_id(name)); }

// Appleby's algorithm for seeds and lengths with every remainder; values of the reference C++ code
// from public test suites.
TEST(Cryptomatte, HashIsMurmur3ForEveryLengthAndSeed) {
  EXPECT_EQ(murmur3_32(""), 0U);
  EXPECT_EQ(murmur3_32("", 1), 0x514E28B7U);
  EXPECT_EQ(murmur3_32("", 0xffffffffU), 0x81F16F39U);
  EXPECT_EQ(murmur3_32("\xff\xff\xff\xff"), 0x76293B50U);
  EXPECT_EQ(murmur3_32("\x21\x43\x65\x87"), 0xF55B516BU);
  EXPECT_EQ(murmur3_32("\x21\x43\x65\x87", 0x5082EDEE), 0x2362F9DEU);
  EXPECT_EQ(murmur3_32("a"), 0x3C2569B2U);
  EXPECT_EQ(murmur3_32("ab"), 0x9BBFD75FU);
  EXPECT_EQ(murmur3_32("hello"), 613153351U);
}

// Names and floats of the unit tests that Psyop publishes with Cryptomatte for Nuke.
TEST(Cryptomatte, IdsAreThoseOfThePublishedTests) {
  EXPECT_FLOAT_EQ(id_value("hello"), 6.0705627102400005616e-17F);
  EXPECT_FLOAT_EQ(id_value("cube"), -4.08461912519e+15F);
  EXPECT_FLOAT_EQ(id_value("sphere"), 2.79018604383e+15F);
  EXPECT_FLOAT_EQ(id_value("plane"), 3.66557617593e-11F);
  EXPECT_FLOAT_EQ(id_value("\xd1\x80\xd0\xb0\xd0\xb2\xd0\xbd\xd0\xb8\xd0\xbd\xd0\xb0"),
                  -1.3192631212399999468e-25F);
  EXPECT_FLOAT_EQ(id_value("m\xc3\xa4"
                           "dchen"),
                  6.2361298211599995797e+25F);
}

// The manifests in the specification, and keys of layers as Arnold and Nuke write them.
TEST(Cryptomatte, HexIsThatOfPublishedManifestsAndKeys) {
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("bunny")), "13851a76");
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("default")), "42c9679f");
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("bunny_porcelain_mat")), "b24b26d4");
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("crypto_object")).substr(0, 7), "f834d0a");
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("crypto_material")).substr(0, 7), "bda530a");
  EXPECT_EQ(eight_hex_digits(cryptomatte_id("uCryptoAsset")).substr(0, 7), "d593dd7");
}

// Two of 2^8 exponents are invalid: about 32 of 4096 names need the fix, and all ids are normal.
TEST(Cryptomatte, EveryIdIsAFiniteNormalNumber) {
  int turned = 0;
  for (int i = 0; i < 4096; ++i) {
    const std::string name = "object " + std::to_string(i);
    EXPECT_TRUE(std::isnormal(id_value(name))) << name;
    turned += cryptomatte_id(name) != murmur3_32(name) ? 1 : 0;
    EXPECT_EQ((cryptomatte_id(name) ^ murmur3_32(name)) & ~(1U << 23U), 0U);
  }
  EXPECT_NEAR(turned, 32, 4 * std::sqrt(32.0));
}

TEST(Cryptomatte, RanksGoByCoverageAndTiesByIdInWhateverOrderSamplesCome) {
  const std::vector<std::uint32_t> samples = {7, 5, 9, 5, 7, 5, 3};
  CoverageRanks forwards, backwards;
  for (const std::uint32_t id : samples) forwards.add(id, 1.0);
  for (auto id = samples.rbegin(); id != samples.rend(); ++id) backwards.add(*id, 1.0);
  const CryptomattePixel pixel = forwards.take(8.0);  // one sample of eight hit the sky
  EXPECT_EQ(pixel, backwards.take(8.0));
  const std::uint32_t order[] = {5, 7, 3, 9};
  const float coverage[] = {3.0F / 8, 2.0F / 8, 1.0F / 8, 1.0F / 8};
  for (std::size_t rank = 0; rank < 4; ++rank) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(pixel[3 + 2 * rank]), order[rank]);
    EXPECT_EQ(pixel[4 + 2 * rank], coverage[rank]);
  }
  for (std::size_t c = 3 + 8; c < pixel.size(); ++c) EXPECT_EQ(pixel[c], 0.0F);
  EXPECT_EQ(forwards.take(1.0), CryptomattePixel{});  // take() has reset it
}

// Coverages sum to 1 minus the share of samples without a hit; beyond six ids the smallest are
// dropped.
TEST(Cryptomatte, CoveragesSumToOneLessTheSky) {
  scenes::Scene scene;
  for (std::uint32_t k = 0; k < 8; ++k) {
    scene.objects.emplace_back().name = "object " + std::to_string(k);
    scene.triangles.push_back({{0, 0, 0}, k, k % 2, k});
  }
  scene.materials.resize(2);
  scene.materials[0].name = "even";
  scene.materials[1].name = "odd";
  constexpr int pixels = 64, samples = 32;
  base::Image image{pixels, 1, {}};
  for (const CryptomatteType& type : cryptomatte_types) {
    for (const std::string& channel : cryptomatte_channels(type.name)) image.add(channel);
  }
  const CryptomatteLayers layers(scene, image);
  CryptomatteWriter writer(layers);
  base::Rng rng(base::Key(1, base::Stream::Test, 0));
  for (std::size_t p = 0; p < pixels; ++p) {
    int sky = 0;
    const double kinds = 1.0 + 9.0 * rng.next();
    std::array<int, 8> met{};
    for (int s = 0; s < samples; ++s) {
      const auto what = static_cast<std::uint32_t>(kinds * rng.next());
      if (what >= 8) {
        ++sky;
        writer.add(scenes::no_triangle);
      } else {
        ++met[what];
        writer.add(what);
      }
    }
    writer.store(p);
    const auto sum = [&](const std::string& type) {
      float total = 0.0F;
      for (const char* c : {"00.G", "00.A", "01.G", "01.A", "02.G", "02.A"}) {
        total += image.find(type + c)->values[p];
      }
      return total;
    };
    std::sort(met.begin(), met.end());
    const int dropped = met[0] + met[1];
    EXPECT_EQ(sum("CryptoObject"), 1.0F - static_cast<float>(sky + dropped) / samples);
    EXPECT_EQ(sum("CryptoMaterial"), 1.0F - static_cast<float>(sky) / samples);
  }
}

TEST(Cryptomatte, PreviewMixesColoursByCoverage) {
  CoverageRanks ranks;
  ranks.add(cryptomatte_id("bunny"), 1.0);    // 13851a76: green 851a7600 / ffffffff
  ranks.add(cryptomatte_id("default"), 3.0);  // 42c9679f: green c9679f00 / ffffffff
  const CryptomattePixel pixel = ranks.take(4.0);
  EXPECT_FLOAT_EQ(pixel[1], 0.25F * (0x851a7600 / 4294967295.0F) +
                                0.75F * (static_cast<float>(0xc9679f00U) / 4294967295.0F));
  EXPECT_FLOAT_EQ(pixel[2],
                  0.25F * (0x1a760000 / 4294967295.0F) + 0.75F * (0x679f0000 / 4294967295.0F));
}

}  // namespace
}  // namespace earthshine::raytrace
