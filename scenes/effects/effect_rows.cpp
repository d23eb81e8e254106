// SPDX-License-Identifier: Apache-2.0
// The rows of `earthshine plan`: the fact that decided each effect.
#include <fmt/format.h>

#include "scenes/effects/effects.h"
#include "scenes/sky/airglow.h"
#include "scenes/sky/sky.h"

namespace earthshine::scenes {
namespace {

std::string pick(bool runs, const char* yes, const char* no) { return runs ? yes : no; }

class Rows {
 public:
  Rows(const Scene& scene, const LightGroups& groups, const Asked& asked)
      : scene_(scene),
        groups_(groups),
        asked_(asked),
        e_(find_effects(scene, groups, asked)),
        worn_(scene.materials.size(), false) {
    for (const Triangle& triangle : scene.triangles) worn_[triangle.material] = true;
    if (asked_.cameras.empty()) {
      for (const Camera& camera : scene.cameras) asked_.cameras.push_back(&camera);
    }
  }

  std::vector<EffectRow> all() {
    row("interreflection", e_.interreflection, interreflection());
    row("sun", e_.sun, sun());
    row("penumbra", e_.penumbra, penumbra());
    row("earth", e_.earth, earth());
    row("lamps", e_.lamps, lamps());
    for (std::size_t kind = 0; kind < lamp_kinds; ++kind) lamps_of(kind);
    row("emitting surfaces", e_.emitters,
        material("emit", [](const Material& m) { return m.emit; }));
    row("ambient", e_.ambient,
        pick(e_.ambient, "ambient.radiance is above 0", "no [ambient] radiance"));
    row("phong lobe", e_.phong, phong());
    row("glossy reflection", e_.glossy, glossy());
    row("mirror", e_.mirror, material("mirror", [](const Material& m) { return m.mirror; }));
    row("refraction", e_.refraction,
        material("transmit", [](const Material& m) { return m.transmit; }));
    row("depth of field", e_.depth_of_field, depth_of_field());
    row("light groups", groups_.count() > 1,
        fmt::format("{} group(s) give light", groups_.count()));
    row("layers", asked_.per_light || !asked_.layers.empty(), layers());
    row("cctv", e_.cctv, camera([](const Camera& c) { return !c.cctv.empty(); }, "cctv model"));
    row("range sensor", e_.range_sensor,
        camera([](const Camera& c) { return !c.range_sensor.empty(); }, "range_sensor") +
            (e_.range_sensor ? "; render --range shows it" : ""));
    return std::move(rows_);
  }

 private:
  void row(std::string effect, bool runs, std::string reason) {
    rows_.push_back({std::move(effect), runs, std::move(reason)});
  }

  // "material "foil" has specular > 0", or why no material has it.
  template <class Value>
  std::string material(const char* key, Value value) {
    std::string unused;
    for (std::size_t m = 0; m < worn_.size(); ++m) {
      if (base::max_component(value(scene_.materials[m])) <= 0.0) continue;
      std::string has = fmt::format("material \"{}\" has {} > 0", scene_.materials[m].name, key);
      if (worn_[m]) return has;
      if (unused.empty()) unused = has + ", but nothing wears it";
    }
    return unused.empty() ? fmt::format("no material in use has {} > 0", key) : unused;
  }

  template <class Has>
  std::string camera(Has has, const char* what) {
    for (const Camera* c : asked_.cameras) {
      if (has(*c)) return fmt::format("camera \"{}\" names a {}", c->name, what);
    }
    return asked_.cameras.size() == 1
               ? fmt::format("camera \"{}\" names no {}", asked_.cameras.front()->name, what)
               : fmt::format("no camera names a {}", what);
  }

  // Whether lamps with a strength are in no group because their light does not matter.
  [[nodiscard]] bool leaves_lamps_out() const {
    for (std::size_t k = 0; k < scene_.lamps.size(); ++k) {
      const bool strong = base::max_component(lamp_flux_lm(scene_.lamps[k])) > 0.0;
      if (strong && groups_.lamp[k] == no_group) return true;
    }
    return false;
  }

  std::string lamps() {
    if (scene_.lamps.empty()) return "the scene has no [[light]]";
    if (e_.lamps) return "a lamp is lit";
    return pick(leaves_lamps_out(), "no lamp that is on matters: see the rows of their types",
                "every lamp is off");
  }

  std::string no_source() {
    return pick(leaves_lamps_out(), "no source is left that matters", "no source gives light");
  }

  std::string interreflection() {
    if (asked_.paths == LightPaths::Straight || asked_.paths == LightPaths::Distributed) {
      return "the call asks for light straight from the sources";
    }
    if (!e_.sun && !e_.earth && !e_.lamps && !e_.emitters) return no_source();
    return e_.interreflection ? "light falls on diffuse surfaces: " +
                                    material("diffuse", [](const Material& m) { return m.diffuse; })
                              : material("diffuse", [](const Material& m) { return m.diffuse; });
  }

  std::string sun() {
    if (!scene_.sun) return "the scene has no [sun] and no [orbit]";
    if (e_.sun) return "the Sun is up";
    if (visible_sun_share(scene_) <= 0.0) return "the Sun is behind the Earth";
    return "sun.illuminance is 0";
  }

  std::string penumbra() {
    if (!e_.sun) return "no sunlight";
    if (scene_.sun->angular_radius_deg <= 0.0) return "sun.angular_radius_deg is 0";
    if (!e_.penumbra) return "distributed lights have no extent";
    return fmt::format("sun.angular_radius_deg is {:g}", scene_.sun->angular_radius_deg);
  }

  std::string earth() {
    if (!scene_.earth) return "the scene has no [earth] and no [orbit]";
    if (!e_.earth) {
      if (scene_.earth->model == EarthModel::Uniform) return "earth.radiance is 0";
      if (base::max_component(scene_.earth->albedo) <= 0.0) return "earth.albedo is 0";
      const auto& law = scene_.earth->by_latitude;
      if (law && largest_albedo(*law) <= 0.0) return "the albedo is 0 at every latitude";
      return "the part of the Earth in view is dark";
    }
    return fmt::format(
        "part of its disc shines; half angle {:.3g} deg: {}", scene_.earth->half_angle_deg,
        e_.earth_by_gather ? "found by hemisphere rays, without separate rays" : "shadow rays");
  }

  void lamps_of(std::size_t kind) {
    std::size_t all = 0, lit = 0;
    for (std::size_t k = 0; k < scene_.lamps.size(); ++k) {
      if (static_cast<std::size_t>(scene_.lamps[k].kind) != kind) continue;
      ++all;
      if (groups_.lamp[k] != no_group) ++lit;
    }
    const std::string_view type = lamp_rows[kind].type;
    row(std::string(effect_of(kind_of(static_cast<LampKind>(kind)))), e_.lamp_kind[kind],
        all == 0 ? fmt::format("the scene has no [[light]] with type = \"{}\"", type)
                 : fmt::format("{} of {} with type = \"{}\" are lit", lit, all, type) +
                       (kind == static_cast<std::size_t>(LampKind::Distant) ? night() : ""));
  }

  // Of the lamps that [moon] and [airglow] add: why they are off.
  std::string night() {
    std::string text;
    if (scene_.moon && scene_.moon->hidden) {
      text += "; the Moon is behind the Earth";
    } else if (scene_.moon && base::max_component(scene_.moon->illuminance_lx) <= 0.0) {
      const bool sun_is_off = scene_.sun && base::max_component(scene_.sun->illuminance_lx) <= 0.0;
      text += sun_is_off ? "; the Moon is dark: sun.illuminance is 0"
                         : "; the Moon is in the Earth's shadow";
    }
    for (std::size_t k = 0; k < scene_.lamps.size(); ++k) {
      if (scene_.lamps[k].group != airglow_group) continue;
      if (groups_.lamp[k] == no_group) {
        text +=
            "; airglow is off: the Sun lights a part of the Earth in view, or its radiance is 0";
      }
      break;
    }
    return text;
  }

  std::string phong() {
    bool shiny = false;
    for (std::size_t m = 0; m < worn_.size(); ++m) {
      shiny |= worn_[m] && base::max_component(scene_.materials[m].specular) > 0.0;
    }
    if (shiny && !e_.phong) return no_source();
    return material("specular", [](const Material& m) { return m.specular; });
  }

  std::string glossy() {
    if (!e_.phong) return "no phong lobe";
    return pick(e_.glossy, "the lobe reflects surfaces and a wide Earth",
                "the call asks for light straight from the sources, which highlights show");
  }

  std::string depth_of_field() {
    for (const Camera* c : asked_.cameras) {
      if (c->aperture_m > 0.0 && c->focus_m > 0.0) {
        return fmt::format("camera \"{}\" has aperture {:g} m, focus {:g} m", c->name,
                           c->aperture_m, c->focus_m);
      }
    }
    for (const Camera* c : asked_.cameras) {
      if (c->aperture_m > 0.0) return fmt::format("camera \"{}\" has no focus", c->name);
    }
    return asked_.cameras.size() == 1
               ? fmt::format("camera \"{}\" has no aperture", asked_.cameras.front()->name)
               : "no camera has an aperture";
  }

  std::string layers() {
    std::vector<std::string> asked = asked_.layers;
    if (asked_.per_light) asked.insert(asked.begin(), "one per light group");
    return asked.empty() ? "the call asks for none" : fmt::format("{}", fmt::join(asked, ", "));
  }

  const Scene& scene_;
  const LightGroups& groups_;
  Asked asked_;
  Effects e_;
  std::vector<bool> worn_;
  std::vector<EffectRow> rows_;
};

}  // namespace

std::string_view effect_of(LightKind kind) {
  constexpr std::array<std::string_view, light_kinds> names = {
      "sun",        "earth",          "point lamps",   "spot lamps",       "rectangle lamps",
      "disk lamps", "measured lamps", "distant lamps", "emitting surfaces"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<EffectRow> describe_effects(const Scene& scene, const LightGroups& groups,
                                        const Asked& asked) {
  return Rows(scene, groups, asked).all();
}

}  // namespace earthshine::scenes
