// SPDX-License-Identifier: Apache-2.0
#include "base/files/hdf5_file.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "base/error.h"
#include "base/numbers/digest.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

// One data set large enough for compression, and small ones.
std::string sample_file() {
  std::vector<float> ramp(6000);
  std::iota(ramp.begin(), ramp.end(), 0.5F);
  Hdf5Writer file;
  file.array<float>("ramp", ramp, {2000, 3}, {"lx", "a ramp"});
  file.array<std::uint32_t>("deep/er/three", std::vector<std::uint32_t>{1, 2, 0xFFFFFFFFU}, {3},
                            {});
  file.array<double>("empty", {}, {0, 3}, {});
  file.texts("names", {"Earth", "", "Sonne \u00fc"}, {});
  file.texts("no names", {}, {});
  file.attribute("text", "STS-46");
  file.attribute("no text", "");
  file.attribute("number", 0.1);
  file.attribute("count", ~std::uint64_t{0});
  return file.finish();
}

std::string sealed(const std::string& file) {
  Digest digest;
  digest.add(std::string_view(file).substr(512));
  std::string text = file;
  text.replace(text.find("seal ") + 5, 16, digest.text());
  return text;
}

TEST(Hdf5File, WhatIsWrittenIsRead) {
  const Hdf5Reader file(sample_file(), "a.h5");
  const std::vector<float> ramp = file.array<float>("ramp", {2000, 3});
  for (std::size_t k = 0; k < ramp.size(); ++k) EXPECT_EQ(ramp[k], 0.5F + static_cast<float>(k));
  EXPECT_EQ(file.array<std::uint32_t>("deep/er/three", {3}),
            (std::vector<std::uint32_t>{1, 2, 0xFFFFFFFFU}));
  EXPECT_EQ(file.shape("empty"), (Hdf5Shape{0, 3}));
  EXPECT_TRUE(file.array<double>("empty", {0, 3}).empty());
  EXPECT_EQ(file.texts("names"), (std::vector<std::string>{"Earth", "", "Sonne \u00fc"}));
  EXPECT_TRUE(file.texts("no names").empty());
  EXPECT_EQ(file.text_attribute("text"), "STS-46");
  EXPECT_EQ(file.text_attribute("no text"), "");
  EXPECT_EQ(file.number_attribute("number"), 0.1);
  EXPECT_EQ(file.count_attribute("count"), ~std::uint64_t{0});
}

TEST(Hdf5File, TheSameCallsGiveTheSameBytes) {
  const std::string once = sample_file();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 stores times in seconds
  EXPECT_EQ(sample_file(), once);
}

TEST(Hdf5File, WhatIsMissingOrOfAnotherShapeOrTypeIsNamed) {
  const Hdf5Reader file(sample_file(), "a.h5");
  const auto array = [&](const char* name, const Hdf5Shape& shape) {
    return test::error_of(Blame::Input, [&] { (void)file.array<float>(name, shape); });
  };
  expect_in("a.h5: ", array("sun", {3}));
  expect_in("there is no \"sun\"", array("sun", {3}));
  expect_in("there is no \"deep/sun\"", array("deep/sun", {3}));
  expect_in("there is no \"deep\"", array("deep", {3}));  // a group
  expect_in("\"ramp\" is 2000 x 3, expected 2000 x 4", array("ramp", {2000, 4}));
  expect_in("\"ramp\" is 2000 x 3, expected 6000", array("ramp", {6000}));
  expect_in("another kind of number", array("deep/er/three", {3}));
  expect_in("no list of texts", test::error_of(Blame::Input, [&] { (void)file.texts("ramp"); }));
  expect_in("no number \"text\"",
            test::error_of(Blame::Input, [&] { (void)file.number_attribute("text"); }));
  expect_in("no number \"number\"",
            test::error_of(Blame::Input, [&] { (void)file.count_attribute("number"); }));
  expect_in("no text \"number\"",
            test::error_of(Blame::Input, [&] { (void)file.text_attribute("number"); }));
  expect_in("no text \"nix\"",
            test::error_of(Blame::Input, [&] { (void)file.text_attribute("nix"); }));
}

TEST(Hdf5File, AnyChangedByteBreaksTheSeal) {
  const std::string file = sample_file();
  for (std::size_t at = 0; at < file.size(); at += 1 + at / 100) {
    std::string changed = file;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_THROW(Hdf5Reader(changed, "a.h5"), Error) << at;
  }
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{20}, std::size_t{512}, file.size() / 2, file.size() - 1}) {
    EXPECT_THROW(Hdf5Reader(file.substr(0, length), "a.h5"), Error) << length;
  }
  EXPECT_THROW(Hdf5Reader(file + '\0', "a.h5"), Error);
}

TEST(Hdf5File, ASealOverSomethingElseIsAnErrorToo) {
  const std::string block = sample_file().substr(0, 512);
  for (const std::string& content :
       {std::string("x"), std::string(4096, '\0'), sample_file().substr(512, 3000),
        std::string("\x89HDF\r\n\x1a\n")}) {
    EXPECT_THROW(Hdf5Reader(sealed(block + content), "a.h5"), Error);
  }
}

// A file that no Hdf5Writer makes: `make` adds to it before it gets a seal.
template <class Make>
std::string foreign_file(const test::TemporaryFolder& folder, Make make) {
  const std::string path = folder / "foreign.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  make(file);
  H5Fclose(file);
  return sealed(sample_file().substr(0, 512) + test::read_bytes(path));
}

void make_set(hid_t file, hsize_t count, hid_t properties) {
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  H5Dclose(H5Dcreate2(file, "set", H5T_IEEE_F32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Sclose(space);
}

TEST(Hdf5File, AnExtentThatWasNeverStoredIsNotAllocated) {
  const test::TemporaryFolder folder;
  constexpr std::size_t count = std::size_t{1} << 45;
  const std::string bytes = foreign_file(folder, [&](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1000;
    H5Pset_chunk(properties, 1, &chunk);
    make_set(file, count, properties);
    H5Pclose(properties);
  });
  const Hdf5Reader file(bytes, "a.h5");
  EXPECT_EQ(file.shape("set"), Hdf5Shape{count});
  expect_in("not stored in full",
            test::error_of(Blame::Input, [&] { (void)file.array<float>("set", {count}); }));
}

TEST(Hdf5File, DataOutsideTheFileAreNotRead) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "secret", std::string(40, 'x'));
  const std::string secret = folder / "secret", other = folder / "other.h5";
  const hid_t linked = H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t contiguous = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_alloc_time(contiguous, H5D_ALLOC_TIME_EARLY);
  make_set(linked, 10, contiguous);
  H5Pclose(contiguous);
  H5Fclose(linked);
  const std::string bytes = foreign_file(folder, [&](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(properties, secret.c_str(), 0, 40);
    make_set(file, 10, properties);
    H5Pclose(properties);
    H5Lcreate_external(other.c_str(), "/set", file, "link", H5P_DEFAULT, H5P_DEFAULT);
  });
  const Hdf5Reader file(bytes, "a.h5");
  for (const char* name : {"set", "link"}) {
    expect_in("there is no",
              test::error_of(Blame::Input, [&] { (void)file.array<float>(name, {10}); }));
  }
}

}  // namespace
}  // namespace earthshine::base
