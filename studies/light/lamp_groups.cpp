// SPDX-License-Identifier: Apache-2.0
// LightBasis' checks of settings, and its lamp groups: lamps that a setting names get their own
// group; lamps that are off in all settings are removed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "studies/light/light_basis.h"

namespace earthshine::studies {
namespace {

using scenes::no_group;

// Whether the name belongs to the sky or one of its parts: "sun", "earth-12".
bool is_sky_name(const std::string& name) {
  for (const std::string sky : {"sun", "earth", "ambient"}) {
    if (name == sky) return true;
    if (name.rfind(sky + "-", 0) == 0 &&
        name.find_first_not_of("0123456789", sky.size() + 1) == std::string::npos) {
      return true;
    }
  }
  return false;
}

// Renames groups that lights with different factors would share: a split lamp may have the name of
// another group, or either the name of a part of the sky.
void set_apart(scenes::Scene& scene, const std::vector<scenes::Lamp*>& split) {
  std::set<std::string> taken;
  const auto free_name = [&taken](const std::string& name, const char* suffix) {
    std::string free = name;
    while (taken.contains(free) || is_sky_name(free)) free += suffix;
    return free;
  };
  const auto is_split = [&split](const scenes::Lamp& lamp) {
    return std::find(split.begin(), split.end(), &lamp) != split.end();
  };
  std::vector<std::string*> groups;
  for (scenes::Lamp& lamp : scene.lamps) {
    if (!is_split(lamp)) groups.push_back(&lamp.group);
  }
  for (scenes::Material& material : scene.materials) {
    if (material.emits()) groups.push_back(&material.light_group);
  }
  for (const std::string* group : groups) {
    if (!is_sky_name(*group)) taken.insert(*group);
  }
  std::map<std::string, std::string> renamed;
  for (std::string* group : groups) {
    if (!is_sky_name(*group)) continue;
    std::string& name = renamed[*group];
    if (name.empty()) taken.insert(name = free_name(*group, " (lamps)"));
    *group = name;
  }
  for (scenes::Lamp* lamp : split) {
    lamp->group = free_name(lamp->group, " (lamp)");
    taken.insert(lamp->group);
  }
}

base::Location place_of(const LampSetting& setting) {
  if (!setting.where.file.empty()) return setting.where;
  return base::Location{"lamps \"" + setting.name + "\""};
}

}  // namespace

void LightBasis::check_settings() const {
  std::set<std::string> known;
  if (std::any_of(places_.begin(), places_.end(), [](const SkyPlace& p) { return p.sun; })) {
    known.insert("sun");
  }
  if (std::any_of(places_.begin(), places_.end(), [](const SkyPlace& p) { return p.earth; })) {
    known.insert("earth");
  }
  for (const scenes::Lamp& lamp : scene_.lamps) known.insert({lamp.name, lamp.group});
  const scenes::LightGroups groups = scenes::find_light_groups(original_);
  for (std::size_t m = 0; m < original_.materials.size(); ++m) {
    if (groups.material[m] != no_group) known.insert(original_.materials[m].light_group);
  }
  for (const LampSetting& setting : settings_) {
    for (const auto& [name, factor] : setting.factors) {
      if (!known.contains(name)) {
        throw base::Error(
            base::Blame::Input, place_of(setting),
            fmt::format("lamps \"{}\": the scene has no lamp or light group \"{}\"", setting.name,
                        name),
            known.empty() ? "it has none at all" : fmt::format("it has {}", fmt::join(known, ", ")),
            "Name one of them");
      }
      if (!(factor.r >= 0.0 && factor.g >= 0.0 && factor.b >= 0.0)) {
        throw base::Error(base::Blame::Input, place_of(setting),
                          fmt::format("\"{}\" has a factor below 0", name), "0 or more",
                          "Write 0 for a lamp that is off");
      }
    }
  }
}

void LightBasis::split_lamps() {
  std::set<std::string> named;
  for (const LampSetting& setting : settings_) {
    for (const auto& [name, factor] : setting.factors) named.insert(name);
  }
  const auto ever_on = [&](const std::string& name, const std::string& group) {
    return std::any_of(settings_.begin(), settings_.end(), [&](const LampSetting& setting) {
      return base::max_component(factor(setting, name, group)) > 0.0;
    });
  };
  std::vector<scenes::Lamp*> split;
  for (scenes::Lamp& lamp : scene_.lamps) {
    if (!ever_on(lamp.name, lamp.group)) {
      lamp.dim(Rgb(0.0));
    } else if (named.contains(lamp.name)) {
      lamp.group = lamp.name;
      split.push_back(&lamp);
    }
  }
  for (scenes::Material& material : scene_.materials) {
    if (material.emits() && !ever_on(material.light_group, material.light_group)) {
      material.emit = Rgb(0.0);
    }
  }
  set_apart(scene_, split);
}

Rgb LightBasis::factor(const LampSetting& setting, const std::string& name,
                       const std::string& group) const {
  for (const std::string& key : {name, group}) {
    const auto found = setting.factors.find(key);
    if (found != setting.factors.end()) return found->second;
  }
  return Rgb(setting.others_off ? 0.0 : 1.0);
}

Rgb LightBasis::sky_factor(const LampSetting& setting, const std::string& name) {
  const auto found = setting.factors.find(name);
  return found == setting.factors.end() ? Rgb(1.0) : found->second;
}

}  // namespace earthshine::studies
