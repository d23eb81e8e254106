// SPDX-License-Identifier: Apache-2.0
// Bytes compressed without loss (zlib; deflate.cpp is its only user).
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace earthshine::base {

// The zlib stream (RFC 1950) of the bytes, at the highest compression.
[[nodiscard]] std::string deflated(std::span<const std::uint8_t> bytes);

}  // namespace earthshine::base
