// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace earthshine::base {
namespace {

TEST(Error, LocationIsWrittenAsFarAsKnown) {
  EXPECT_EQ(to_string(Location{"scene.toml", 14, 3}), "scene.toml:14:3");
  EXPECT_EQ(to_string(Location{"scene.toml", 14, 0}), "scene.toml:14");
  EXPECT_EQ(to_string(Location{"scene.toml", 0, 3}), "scene.toml");
}

TEST(Error, MessageSaysWhereWhatAllowedAndRemedy) {
  const Error full(Blame::Input, Location{"a.toml", 2, 0}, "gain is 0", "it must be at least 1",
                   "Leave it out");
  EXPECT_STREQ(full.what(), "a.toml:2: gain is 0; it must be at least 1. Leave it out");
  EXPECT_EQ(full.blame(), Blame::Input);
  EXPECT_STREQ(Error(Blame::Work, "", "disk full").what(), "disk full");
  // The message continues after the first NUL of a binary file.
  EXPECT_STREQ(Error(Blame::Input, "a", std::string_view("\"v\0\" is no row", 14)).what(),
               "a: \"v\\x00\" is no row");
}

TEST(Error, PartsAreThoseItWasMadeOf) {
  const Error error(Blame::Input, Location{"scene.toml", 14, 3}, "found", "allowed", "remedy");
  EXPECT_EQ(error.parts().where.file, "scene.toml");
  EXPECT_EQ(error.parts().where.line, 14);
  EXPECT_EQ(error.parts().where.column, 3);
  EXPECT_EQ(error.parts().found, "found");
  EXPECT_EQ(error.parts().allowed, "allowed");
  EXPECT_EQ(error.parts().remedy, "remedy");
  EXPECT_EQ(Error(Blame::Work, "--part", "found").parts().where.file, "--part");
}

}  // namespace
}  // namespace earthshine::base
