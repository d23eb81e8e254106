// SPDX-License-Identifier: Apache-2.0
// Which effects a scene and a call ask for, decided here and nowhere else. An effect that does not
// run casts no rays, takes no memory and changes no byte of the picture.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/light_groups.h"
#include "scenes/light/lamp_light.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// How light gets around in a picture.
enum class LightPaths {
  All,         // from surface to surface, by the radiosity solution
  Traced,      // from surface to surface, by paths
  Straight,    // from sources alone; a wide Earth by rays over the hemisphere
  Distributed  // from sources alone, all by shadow rays
};

// What a call asks for; nothing said: every camera of the scene, all light.
struct Asked {
  std::vector<const Camera*> cameras;  // empty: all of the scene's
  LightPaths paths = LightPaths::All;
  bool earth_on_area = false;  // its lights stand on an [[area]] of the scene, not in the sky
  bool per_light = false;
  std::vector<std::string> layers;
};

// What shadow rays are aimed at; each kind of lamp is one of its own, in LampKind's order.
enum class LightKind {
  Sun,
  Earth,
  PointLamp,
  SpotLamp,
  RectangleLamp,
  DiskLamp,
  MeasuredLamp,
  DistantLamp,
  Emitter
};
inline constexpr std::size_t light_kinds = 9, lamp_kinds = lamp_rows.size();
[[nodiscard]] constexpr LightKind kind_of(LampKind kind) {
  return static_cast<LightKind>(static_cast<int>(LightKind::PointLamp) + static_cast<int>(kind));
}
// Its row of the plan: "point lamps".
[[nodiscard]] std::string_view effect_of(LightKind kind);

struct Effects {
  bool interreflection = false;
  bool solution = false;  // radiosity is solved for: interreflection, or wide emitters in lobes
  bool sun = false;
  bool sun_parts = false;  // Suns of a sky in parts
  bool penumbra = false;
  bool earth = false;
  bool earth_by_gather =
      false;  // the Earth is wide or in cells: escaping gather rays read it; else it is sampled
  bool lamps = false;
  std::array<bool, lamp_kinds> lamp_kind{};
  bool emitters = false;
  bool phong = false;   // highlights of the sources
  bool glossy = false;  // the lobe's reflection of everything else
  bool mirror = false;
  bool refraction = false;
  bool ambient = false;
  bool depth_of_field = false;  // of at least one camera
  bool cctv = false;            // of at least one camera
  bool range_sensor = false;    // of at least one camera
};

[[nodiscard]] Effects find_effects(const Scene& scene, const LightGroups& groups,
                                   const Asked& asked = {});

// One row of `earthshine plan`: the effect, whether it runs, and the fact that decided.
struct EffectRow {
  std::string effect;
  bool runs = false;
  std::string reason;
};
[[nodiscard]] std::vector<EffectRow> describe_effects(const Scene& scene, const LightGroups& groups,
                                                      const Asked& asked = {});

}  // namespace earthshine::scenes
