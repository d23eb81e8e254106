// SPDX-License-Identifier: Apache-2.0
// One solution and one picture per camera for all lamp settings and all orbit positions: each lamp
// with its own setting, each Sun and each cell of the Earth's disc is a light group, and every
// condition is a weighted sum of the groups.
//
// The sums are exact for lamps and the Sun (a partly hidden Sun counts as a dimmed whole one). The
// Earth's radiance is approximated by its mean in each cell. The light of a pixel or a target from
// cell k is an integral of radiance times a response >= 0, so that the error of the sum is at most
// sum_k max|L - w_k| T_k, with T_k the light of the cell at radiance 1: `bound`. For independent
// errors of the cells it is about sqrt(sum_k var_k T_k^2): `rms`, a likely size.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "scenes/effects/light_groups.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// Sun and Earth at one orbit position.
struct SkyPlace {
  std::optional<scenes::Sun> sun;
  std::optional<scenes::Earth> earth;
};
[[nodiscard]] SkyPlace sky_of(const scenes::Scene& scene);

// Factors on the scene's light by name: of a lamp, of a light group of lamps or of an emitting
// material's group, and "sun" and "earth". A lamp's name has priority over its group's.
struct LampSetting {
  std::string name;
  bool others_off = false;  // switches off lamps and emitters without a factor; otherwise they keep
                            // the scene's light
  std::map<std::string, Rgb> factors;
  base::Location where = {};  // in a study's file
};

struct BasisOptions {
  std::size_t disc_cells = 48;     // of the Earth's disc, if it is fixed
  std::size_t sphere_cells = 192;  // of all directions, if it moves
};

// Weights of the light groups in one condition.
struct GroupWeights {
  std::vector<Rgb> weight;
  // For cells of the Earth, in luminance and in units of the group's light: the largest and the
  // root mean square deviation from the weight within the cell. 0 for other groups.
  std::vector<double> largest, scatter;
};

class LightBasis {
 public:
  // places: at least one. Throws base::Error (Input) if a setting has an unknown name or a factor
  // below 0.
  LightBasis(const scenes::Scene& scene, std::vector<SkyPlace> places,
             std::vector<LampSetting> settings, const BasisOptions& options = {});

  // With one place, the scene's own sky; otherwise a sky in parts (scenes/sky/sky_cells.h). Sources
  // are scaled so that Suns, Earth and lamps have similar weight in the error of a picture.
  [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
  // A lamp with its own setting has a group of its name, followed by " (lamp)" or " (lamps)" if
  // others have that name.
  [[nodiscard]] const scenes::LightGroups& groups() const { return groups_; }
  [[nodiscard]] const std::vector<SkyPlace>& places() const { return places_; }
  [[nodiscard]] const std::vector<LampSetting>& settings() const { return settings_; }
  [[nodiscard]] bool in_parts() const { return scene_.sky_parts != nullptr; }
  // Numbers of light groups for the Sun at its places, and for the Earth; 0 for none.
  [[nodiscard]] std::size_t sun_parts() const;
  [[nodiscard]] std::size_t earth_parts() const;
  // The scene at one place with one setting, which the weighted sum approximates.
  [[nodiscard]] scenes::Scene scene_at(std::size_t place, std::size_t setting) const;

  // lamps: factor on all factors of the setting.
  [[nodiscard]] GroupWeights weights(std::size_t place, std::size_t setting,
                                     double lamps = 1.0) const;
  // The same with one light as in the scene: a light group by its name, or the parts of the "sun"
  // or the "earth".
  [[nodiscard]] GroupWeights weights_with(std::size_t place, std::size_t setting,
                                          const std::string& light) const;

 private:
  [[nodiscard]] GroupWeights weigh(std::size_t place, const LampSetting& setting,
                                   double lamps) const;
  [[nodiscard]] Rgb factor(const LampSetting& setting, const std::string& name,
                           const std::string& group) const;
  [[nodiscard]] static Rgb sky_factor(const LampSetting& setting, const std::string& name);
  void check_settings() const;
  void split_lamps();
  void split_sky(const BasisOptions& options);
  void weigh_earth(const SkyPlace& place, const Rgb& factor, GroupWeights& weights) const;

  scenes::Scene original_, scene_;
  std::vector<SkyPlace> places_;
  std::vector<LampSetting> settings_;
  std::vector<std::size_t> sun_of_place_;   // number among the suns; no_group: none
  std::vector<std::string> group_of_lamp_;  // in the original scene
  double sun_scale_ = 1.0, earth_unit_ = 1.0;
  scenes::LightGroups groups_;
};

// R, G, B of a picture with a layer for each group.
[[nodiscard]] base::Image weighted_sum(const base::Image& layers,
                                       const std::vector<std::string>& groups,
                                       const GroupWeights& weights);

// Mean light of each group over some pixels.
[[nodiscard]] std::vector<Rgb> mean_by_group(const base::Image& layers,
                                             const std::vector<std::string>& groups,
                                             const std::vector<std::uint32_t>& pixels);

// Error of a sum of light by group (`mean_by_group`) due to the cells, relative to the sum; empty
// if the sum is 0.
struct BasisError {
  double bound = 0.0, rms = 0.0;
};
[[nodiscard]] std::optional<BasisError> basis_error(const GroupWeights& weights,
                                                    const std::vector<Rgb>& by_group);

}  // namespace earthshine::studies
