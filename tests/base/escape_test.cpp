// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"

namespace earthshine::base {
namespace {

TEST(Escape, WhatATerminalObeysBecomesVisible) {
  EXPECT_EQ(escaped("\x1b]0;title\x07"), R"(\x1b]0;title\x07)");
  EXPECT_EQ(escaped("a\nb\tc"), R"(a\x0ab\x09c)");
  EXPECT_EQ(escaped("a\nb\tc\r", "\n\t"), "a\nb\tc\\x0d");
  EXPECT_EQ(escaped("\x7f\xc2\x9b"
                    "31m"),
            R"(\u007f\u009b31m)");
  EXPECT_EQ(escaped(std::string_view("\0", 1)), R"(\x00)");
}

TEST(Escape, MarksOfDirectionAndWhatHasNoWidthBecomeVisible) {
  EXPECT_EQ(escaped("a\u202egnp.exe\u2066\u200f\u061c"), R"(a\u202egnp.exe\u2066\u200f\u061c)");
  EXPECT_EQ(escaped("\u200b\ufeff\u2028\u00ad"), R"(\u200b\ufeff\u2028\u00ad)");
}

TEST(Escape, BytesThatAreNotUtf8BecomeVisible) {
  EXPECT_EQ(escaped("caf\xe9 \xff"), R"(caf\xe9 \xff)");
  EXPECT_EQ(escaped("\xc0\xaf"), R"(\xc0\xaf)");          // an overlong form
  EXPECT_EQ(escaped("\xed\xa0\x80"), R"(\xed\xa0\x80)");  // half of a surrogate pair
  EXPECT_EQ(escaped("\xe2\x80"), R"(\xe2\x80)");          // truncated
}

TEST(Escape, OtherTextStaysAsItIs) {
  for (const std::string_view text : {"", "plain \\x1b", "Größe", "灯", "مصباح", "🛰"}) {
    EXPECT_EQ(escaped(text), text);
  }
}

}  // namespace
}  // namespace earthshine::base
