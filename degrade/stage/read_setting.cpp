// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/read_setting.h"

#include <cmath>
#include <locale>
#include <sstream>

namespace earthshine::degrade {

using base::Blame;
using base::Error;
using scenes::Setting;
using scenes::SettingTable;

std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

std::string as_written(const Setting& setting) {
  if (const bool* const yes = std::get_if<bool>(&setting.value)) return *yes ? "true" : "false";
  if (const double* const value = std::get_if<double>(&setting.value)) return number(*value);
  if (const auto* const word = std::get_if<std::string>(&setting.value)) return in_quotes(*word);
  return "a list";
}

const base::Location& place_of(const SettingTable& table, std::string_view key) {
  for (const Setting& setting : table.settings) {
    if (setting.key == key) return setting.where;
  }
  return table.where;
}

void read_value(const Setting& setting, bool& field, Limits) { field = value_of<bool>(setting); }

void read_value(const Setting& setting, double& field, Limits limits) {
  const double value = value_of<double>(setting);
  if (!(value >= limits.least && value <= limits.most)) {
    throw Error(Blame::Input, setting.where, in_quotes(setting.key) + " is " + number(value),
                "it must lie between " + number(limits.least) + " and " + number(limits.most));
  }
  field = value;
}

void read_value(const Setting& setting, int& field, Limits limits) {
  double value = 0.0;
  read_value(setting, value, limits);
  if (value != std::floor(value)) {
    throw Error(Blame::Input, setting.where, in_quotes(setting.key) + " is " + number(value),
                "it must be a whole number");
  }
  field = static_cast<int>(value);
}

}  // namespace earthshine::degrade
