// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <algorithm>
#include <numeric>
#include <system_error>
#include <vector>

namespace earthshine::base {
namespace {

std::string compose(std::string_view where, std::string_view found, std::string_view allowed,
                    std::string_view remedy) {
  std::string text(where);
  if (!text.empty()) text += ": ";
  text += found;
  if (!allowed.empty()) text.append("; ").append(allowed);
  if (!remedy.empty()) text.append(". ").append(remedy);
  return text;
}

}  // namespace

std::string to_string(const Location& location) {
  std::string text = location.file;
  if (location.line > 0) text += ":" + std::to_string(location.line);
  if (location.line > 0 && location.column > 0) text += ":" + std::to_string(location.column);
  return text;
}

Error::Error(Blame blame, std::string_view where, std::string_view found, std::string_view allowed,
             std::string_view remedy)
    : std::runtime_error(compose(where, found, allowed, remedy)), blame_(blame) {}

Error::Error(Blame blame, const Location& where, std::string_view found, std::string_view allowed,
             std::string_view remedy)
    : Error(blame, std::string_view(to_string(where)), found, allowed, remedy) {}

std::string system_reason(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace earthshine::base
