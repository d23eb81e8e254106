// SPDX-License-Identifier: Apache-2.0
#include "app/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "base/error.h"

namespace earthshine::app {
namespace {

// Notes are padded to four bytes.
std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

// The build id in the notes of one segment; empty if absent.
std::string id_among(std::span<const std::byte> notes) {
  constexpr std::string_view owner("GNU\0", 4);
  while (notes.size() >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes.data(), sizeof head);
    const std::size_t name = sizeof head, content = name + padded(head.n_namesz);
    const std::size_t next = content + padded(head.n_descsz);
    if (next > notes.size()) break;
    const std::string_view said(reinterpret_cast<const char*>(&notes[name]), head.n_namesz);
    if (head.n_type == NT_GNU_BUILD_ID && said == owner) {
      std::string text;
      for (const std::byte b : notes.subspan(content, head.n_descsz)) {
        text += fmt::format("{:02x}", static_cast<unsigned>(b));
      }
      return text;
    }
    notes = notes.subspan(next);
  }
  return {};
}

bool holds(const dl_phdr_info& object, const void* address) {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (int k = 0; k < object.dlpi_phnum; ++k) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[k];
    const std::uintptr_t start = object.dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_LOAD && at >= start && at - start < segment.p_memsz) return true;
  }
  return false;
}

// Finds the program, or the Python module, that contains this code; skips other libraries.
int look_at(dl_phdr_info* object, std::size_t, void* found) {
  static const char here = 0;
  if (!holds(*object, &here)) return 0;
  for (int k = 0; k < object->dlpi_phnum; ++k) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[k];
    if (segment.p_type != PT_NOTE) continue;
    // The loader gives addresses as integers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* start = reinterpret_cast<const std::byte*>(object->dlpi_addr + segment.p_vaddr);
    std::string id = id_among({start, segment.p_memsz});
    if (!id.empty()) *static_cast<std::string*>(found) = std::move(id);
  }
  return 1;
}

}  // namespace

const std::string& build_id() {
  static const std::string id = [] {
    std::string found;
    ::dl_iterate_phdr(look_at, &found);
    if (found.empty()) {
      throw base::Error(base::Blame::Work, "earthshine", "was linked without a build id", {},
                        "Link it with --build-id");
    }
    return found;
  }();
  return id;
}

}  // namespace earthshine::app
