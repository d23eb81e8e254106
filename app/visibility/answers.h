// SPDX-License-Identifier: Apache-2.0
// What a study says to the probabilities that were wanted: which camera and iris, which lamps,
// which parts of the orbit.
#pragma once

#include <vector>

#include "app/views/scene.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// One way of looking: a camera with an iris mode, by one lamp setting.
struct ViewingConfiguration {
  std::string scene;  // its path in a study of several, else empty
  std::string camera, iris, lamps;
  std::vector<double> detect;         // by place
  std::vector<double> positions_deg;  // of them; empty: a single place
  // At the place with least light of Sun and Earth: the least factor on the setting's lamps.
  std::optional<double> least_factor, darkest_deg;
  bool tried_factors = false;  // false: the setting has no lamps on
};

// Adds the viewing configurations of one camera to those of each wanted target.
void add_configurations(const StudyPart& part, const studies::StudyFile& study,
                        const StudyCamera& camera, const studies::BasisView& view,
                        std::vector<std::vector<ViewingConfiguration>>& ways);

// To keep them, and back.
[[nodiscard]] Json configurations_json(const std::vector<std::vector<ViewingConfiguration>>& ways);
[[nodiscard]] std::vector<std::vector<ViewingConfiguration>> configurations_of(const Json& kept);

// An entry of study.json's "answers".
[[nodiscard]] Json answer_json(const studies::WantedTarget& wanted, const studies::StudyFile& study,
                               const std::vector<ViewingConfiguration>& ways);

}  // namespace earthshine::app
