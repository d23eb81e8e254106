// SPDX-License-Identifier: Apache-2.0
// Decides which effects a scene and a call need; no other code does. An effect that does not run
// casts no rays, uses no memory and does not change the picture.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/effects/light_groups.h"
#include "scenes/light/lamp_light.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// How light propagates in a picture.
enum class LightPaths {
  All,         // interreflection by the radiosity solution
  Traced,      // interreflection by path tracing
  Straight,    // direct light only; a wide Earth by rays over the hemisphere
  Distributed  // direct light only, by shadow rays
};

// Request of a call. Default: every camera of the scene, all light.
struct Asked {
  std::vector<const Camera*> cameras;  // empty: all of the scene's
  LightPaths paths = LightPaths::All;
  bool earth_on_area = false;  // Earth's lights lie on an [[area]] of the scene, not in the sky
  bool per_light = false;
  std::vector<std::string> layers;
};

// Targets of shadow rays; each kind of lamp is a separate entry, in LampKind's order.
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
// Its row of the plan, for example "point lamps".
[[nodiscard]] std::string_view effect_of(LightKind kind);

struct Effects {
  bool interreflection = false;
  bool solution = false;  // radiosity is solved: interreflection, or wide emitters in lobes
  bool sun = false;
  bool sun_parts = false;  // Suns of a sky in parts
  bool penumbra = false;
  bool earth = false;
  bool earth_by_gather =
      false;  // wide or in cells: escaping gather rays read it; false: it is sampled
  bool lamps = false;
  std::array<bool, lamp_kinds> lamp_kind{};
  bool emitters = false;
  bool phong = false;   // highlights of the sources
  bool glossy = false;  // glossy reflection of all other light
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
