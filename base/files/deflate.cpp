// SPDX-License-Identifier: Apache-2.0
#include "base/files/deflate.h"

#include <zlib.h>

#include "base/error.h"

namespace earthshine::base {

std::string deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size, bytes.data(),
                             static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  if (code != Z_OK) throw Error(Blame::Work, "compression", "zlib has no memory left");
  packed.resize(size);
  return packed;
}

}  // namespace earthshine::base
