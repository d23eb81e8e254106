// SPDX-License-Identifier: Apache-2.0
// The conditions of a study, put into tables.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "app/report/sections.h"
#include "app/report/text.h"

namespace earthshine::app {

std::vector<Block> blocks_of(const StudyResults& study) {
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < study.conditions.size(); ++k) {
    const ConditionEntry& condition = study.conditions[k];
    const std::string lamps = condition.position_deg ? "\n" + condition.lamps : "";
    const auto same = [&](const Block& block) {
      return block.scene == condition.scene && block.lamps == lamps;
    };
    const auto found = std::find_if(blocks.begin(), blocks.end(), same);
    if (found == blocks.end()) {
      blocks.push_back({condition.scene, lamps, {k}});
    } else {
      found->conditions.push_back(k);
    }
  }
  for (Block& block : blocks) {
    if (block.lamps.empty()) continue;
    block.lamps.erase(0, 1);  // the mark that it is an orbit's
    std::stable_sort(block.conditions.begin(), block.conditions.end(),
                     [&](std::size_t a, std::size_t b) {
                       return *study.conditions[a].position_deg < *study.conditions[b].position_deg;
                     });
  }
  return blocks;
}

std::vector<std::size_t> results_of(const StudyResults& study, const Block& block) {
  std::map<std::size_t, std::size_t> places;
  for (std::size_t k = 0; k < block.conditions.size(); ++k) places[block.conditions[k]] = k;
  std::vector<std::size_t> results;
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    if (places.count(study.results[k].condition) != 0) results.push_back(k);
  }
  std::sort(results.begin(), results.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t k) {
      const ResultEntry& result = study.results[k];
      return std::tuple(result.camera, result.target, places[result.condition]);
    };
    return key(a) < key(b);
  });
  return results;
}

std::string block_title(const StudyResults& study, const Block& block) {
  const std::string& name = study.scenes[block.scene].name;
  std::string title = escaped(name.empty() ? study.scenes[block.scene].id : name);
  if (!block.lamps.empty()) title += ", lamps: " + escaped(block.lamps);
  return title;
}

std::string places_text(const StudyResults& study, const Block& block,
                        const std::vector<std::size_t>& places) {
  if (places.size() == block.conditions.size() && places.size() > 1) return "everywhere";
  std::string text;
  for (std::size_t k = 0; k < places.size();) {
    std::size_t last = k;
    const auto condition = [&](std::size_t place) -> const ConditionEntry& {
      return study.conditions[block.conditions[places[place]]];
    };
    if (condition(k).position_deg) {
      while (last + 1 < places.size() && places[last + 1] == places[last] + 1) ++last;
    }
    if (!text.empty()) text += ", ";
    text += escaped(place_of(condition(k)));
    if (last > k) text += " to " + escaped(place_of(condition(last)));
    k = last + 1;
  }
  return text;
}

}  // namespace earthshine::app
