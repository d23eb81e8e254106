// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/study.h"
#include "app/study/words.h"
#include "base/parallel.h"
#include "scenes/text/message_text.h"
#include "studies/orbit/condition_noise.h"
#include "studies/orbit/wanted_visibility.h"

namespace earthshine::app {
namespace {

// The position where Sun and Earth give the target least light for a setting.
std::size_t darkest_place(const studies::LightBasis& basis, std::size_t setting,
                          const std::vector<Rgb>& by_group) {
  const scenes::LightGroups& groups = basis.groups();
  std::size_t darkest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t place = 0; place < basis.places().size(); ++place) {
    const studies::GroupWeights weights = basis.weights(place, setting, 0.0);
    double light = 0.0;
    for (std::size_t g = 0; g < groups.count(); ++g) {
      light += base::luminance(weights.weight[g] * by_group[g]);
    }
    if (light >= least) continue;
    least = light;
    darkest = place;
  }
  return darkest;
}

bool has_lamps(const studies::LightBasis& basis, std::size_t setting) {
  const studies::GroupWeights on = basis.weights(0, setting), off = basis.weights(0, setting, 0.0);
  return on.weight != off.weight;
}

std::string at(const ViewingConfiguration& configuration, double position_deg) {
  std::vector<scenes::Instant> moments;
  for (const double tai_s : configuration.tai_s) moments.push_back({tai_s});
  return place_text(configuration.positions_deg, moments, position_deg);
}

std::string arcs_text(const ViewingConfiguration& configuration,
                      const std::vector<studies::Arc>& arcs) {
  if (configuration.tai_s.empty()) return app::arcs_text(arcs);
  std::string text;
  for (const auto& [from, to] : arcs) {
    text += fmt::format("{}{} to {}", text.empty() ? "" : ", ", at(configuration, from),
                        at(configuration, to));
  }
  return text;
}

std::string configuration_text(const ViewingConfiguration& configuration) {
  return fmt::format("camera {}{}, lamps {}{}", configuration.camera,
                     configuration.iris.empty() ? "" : " with iris " + configuration.iris,
                     configuration.lamps,
                     configuration.scene.empty() ? "" : ", in " + configuration.scene);
}

struct Rated {
  const ViewingConfiguration* configuration = nullptr;
  std::vector<studies::Arc> arcs;
  double reach = -1.0;  // share of the orbit, or 1 for a single position that suffices
  double best = 0.0;    // highest probability
};

Rated rate(const ViewingConfiguration& configuration, double wanted, bool closed) {
  Rated rated{&configuration,
              {},
              0.0,
              *std::max_element(configuration.detect.begin(), configuration.detect.end())};
  const auto seen = std::count_if(configuration.detect.begin(), configuration.detect.end(),
                                  [&](double p) { return p >= wanted; });
  rated.reach = static_cast<double>(seen) / static_cast<double>(configuration.detect.size());
  if (configuration.positions_deg.empty()) return rated;
  rated.arcs =
      studies::arcs_above(configuration.positions_deg, configuration.detect, wanted, closed);
  if (closed) rated.reach = studies::total_deg(rated.arcs) / 360.0;
  return rated;
}

// The lamp factor required where Sun and Earth give least.
std::string lamps_of(const ViewingConfiguration& configuration, double wanted) {
  const std::string where = configuration.darkest_deg
                                ? fmt::format("at {}, where it is darkest, ",
                                              at(configuration, *configuration.darkest_deg))
                                : "";
  const std::string by = fmt::format(" For {}, {}", configuration_text(configuration), where);
  if (!configuration.least_factor) {
    return fmt::format("{}no lamps up to {:g} times as bright bring it to {:g}.", by,
                       studies::most_lamp_factor, wanted);
  }
  const double factor = *configuration.least_factor;
  if (factor <= 0.0) return by + "no lamps are needed.";
  if (factor >= 1.0) return fmt::format("{}the lamps must be {:.2g} times as bright.", by, factor);
  return fmt::format("{}the lamps could be dimmed to {}{} %.", by,
                     factor <= studies::least_lamp_factor ? "less than " : "",
                     scenes::two_digits(100.0 * factor));
}

// For the answer's own configuration; also another one if it needs less.
std::string lamp_text(const std::vector<ViewingConfiguration>& configurations,
                      const ViewingConfiguration& own, double wanted) {
  const ViewingConfiguration* least = nullptr;
  const ViewingConfiguration* tried = own.tried_factors ? &own : nullptr;
  for (const ViewingConfiguration& configuration : configurations) {
    if (tried == nullptr && configuration.tried_factors) tried = &configuration;
    if (configuration.least_factor &&
        (least == nullptr || *configuration.least_factor < *least->least_factor)) {
      least = &configuration;
    }
  }
  if (tried == nullptr) return "";
  std::string text = own.tried_factors || least == nullptr ? lamps_of(*tried, wanted) : "";
  const bool less = least != nullptr && least != tried &&
                    (!tried->least_factor || *least->least_factor < 0.9 * *tried->least_factor);
  if (less || text.empty()) text += lamps_of(*least, wanted);
  return text;
}

// The camera's CCTV with this iris mode; its own mode if empty.
std::optional<degrade::Setup> cctv_with(const StudyCamera& camera, const std::string& mode) {
  if (!camera.cctv) return std::nullopt;
  degrade::Setup cctv = camera.cctv->chain;
  constexpr auto words = degrade::words_of(degrade::IrisMode{});
  const auto word = std::find(words.begin(), words.end(), mode);
  if (word != words.end()) cctv.camera.iris = static_cast<degrade::IrisMode>(word - words.begin());
  return cctv;
}

std::vector<std::string> modes_of(const studies::StudyFile& study, const StudyCamera& camera) {
  if (!camera.cctv || study.iris.empty()) return {""};
  return study.iris;
}

}  // namespace

void add_configurations(const StudyPart& part, const studies::StudyFile& study,
                        const StudyCamera& camera, const studies::BasisView& view,
                        std::vector<std::vector<ViewingConfiguration>>& configurations) {
  if (study.wanted.empty()) return;
  const studies::LightBasis& basis = *part.basis;
  const std::size_t places = basis.places().size();
  for (const std::string& mode : modes_of(study, camera)) {
    const std::optional<degrade::Setup> cctv = cctv_with(camera, mode);
    const std::string iris = cctv ? std::string(degrade::word_of(cctv->camera.iris)) : "";
    for (std::size_t setting = 0; setting < basis.settings().size(); ++setting) {
      std::vector<std::vector<double>> detect(places);  // by position and target
      base::parallel_chunks(places, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place) {
          detect[place] = studies::detections(basis, view, place, setting, 1.0, cctv);
        }
      });
      const bool lamps = has_lamps(basis, setting);
      for (std::size_t w = 0; w < study.wanted.size(); ++w) {
        const auto named =
            std::find(part.targets.begin(), part.targets.end(), study.wanted[w].target);
        const auto target = static_cast<std::size_t>(named - part.targets.begin());
        const std::size_t darkest = darkest_place(basis, setting, view.targets[target].by_group);
        const bool tries = lamps && view.plan.targets[target].view.in_view();
        ViewingConfiguration configuration{study.scenes.size() > 1 ? part.path : "",
                                           camera.camera->name,
                                           iris,
                                           basis.settings()[setting].name,
                                           {},
                                           part.positions_deg,
                                           {},
                                           {},
                                           {},
                                           tries};
        for (const std::vector<double>& at_place : detect)
          configuration.detect.push_back(at_place[target]);
        for (const scenes::Instant& moment : part.moments)
          configuration.tai_s.push_back(moment.tai_s);
        if (!part.positions_deg.empty()) configuration.darkest_deg = part.positions_deg[darkest];
        if (tries) {
          configuration.least_factor = studies::least_factor(
              [&](double factor) {
                return studies::detections(basis, view, darkest, setting, factor, cctv)[target];
              },
              study.wanted[w].probability);
        }
        configurations[w].push_back(std::move(configuration));
      }
    }
  }
}

void add_configuration(std::vector<ViewingConfiguration>& configurations,
                       const ViewingConfiguration& configuration) {
  const auto same = std::find_if(
      configurations.begin(), configurations.end(), [&](const ViewingConfiguration& w) {
        return !w.positions_deg.empty() && w.scene == configuration.scene &&
               w.camera == configuration.camera && w.iris == configuration.iris &&
               w.lamps == configuration.lamps;
      });
  if (same == configurations.end()) {
    configurations.push_back(configuration);
    return;
  }
  const auto append = [](auto& list, const auto& more) {
    list.insert(list.end(), more.begin(), more.end());
  };
  append(same->detect, configuration.detect);
  append(same->positions_deg, configuration.positions_deg);
  append(same->tai_s, configuration.tai_s);
  if (!configuration.tried_factors) return;
  // The pose that needs most decides; without a factor no lamps are enough.
  const bool needs_more =
      !same->tried_factors ||
      (same->least_factor &&
       (!configuration.least_factor || *configuration.least_factor > *same->least_factor));
  if (needs_more) {
    same->least_factor = configuration.least_factor;
    same->darkest_deg = configuration.darkest_deg;
  }
  same->tried_factors = true;
}

AnswerEntry answer_of(const studies::WantedTarget& wanted, const studies::StudyFile& study,
                      const std::vector<ViewingConfiguration>& configurations) {
  Rated best;
  for (const ViewingConfiguration& configuration : configurations) {
    Rated rated = rate(configuration, wanted.probability, study.timeline);
    if (rated.reach > best.reach || (rated.reach == best.reach && rated.best > best.best)) {
      best = std::move(rated);
    }
  }
  AnswerEntry answer;
  answer.wanted = wanted.text;
  answer.target = wanted.target;
  answer.least = wanted.probability;
  if (best.configuration == nullptr) {
    answer.text = fmt::format("Nothing was looked at for {}.", wanted.target);
    return answer;
  }
  const ViewingConfiguration& configuration = *best.configuration;
  answer.camera = configuration.camera;
  answer.iris = configuration.iris;
  answer.lamps = configuration.lamps;
  answer.scene = configuration.scene;
  answer.best_probability = best.best;
  answer.least_factor = configuration.least_factor;
  if (configuration.least_factor) answer.darkest_deg = configuration.darkest_deg;
  for (const auto& [from, to] : best.arcs) {
    const double revolutions_deg = 360.0 * std::floor(from / 360.0);
    answer.arcs_deg.emplace_back(from - revolutions_deg, to - revolutions_deg);
  }
  answer.found = best.best >= wanted.probability;
  std::string text;
  if (best.best < wanted.probability) {
    text = fmt::format(
        "None of the cameras, iris modes and lamp settings detects {} with {:g} or more{}: at best "
        "{:.2g}, by {}.",
        wanted.target, wanted.probability,
        configuration.positions_deg.empty() ? "" : " at any of the positions", best.best,
        configuration_text(configuration));
  } else if (configuration.positions_deg.empty()) {
    text = fmt::format("{} is detected with {:.2g}, by {}.", wanted.target, best.best,
                       configuration_text(configuration));
  } else {
    text = fmt::format(
        "{} is detected with {:g} or more best by {}: {}{}.", wanted.target, wanted.probability,
        configuration_text(configuration), arcs_text(configuration, best.arcs),
        study.timeline ? fmt::format(" ({:.0f} % of the orbit)", 100.0 * best.reach) : "");
  }
  answer.text = text + lamp_text(configurations, configuration, wanted.probability);
  return answer;
}

}  // namespace earthshine::app
