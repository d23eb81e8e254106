// SPDX-License-Identifier: Apache-2.0
// Results of a visibility study, as values. The lists of fields in results_fields.h write and read
// study.json; report, tables and texts use the values. Luminances in cd/m^2, angles in degrees,
// times in s, shares and probabilities from 0 to 1; missing values are empty.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/json.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/condition_noise.h"
#include "studies/orbit/wanted_visibility.h"

namespace earthshine::app {

using Number = std::optional<double>;  // nullopt: missing

// Entries that others reference: by their index in a list of StudyResults.
enum class Named { Scene, Camera, Target, Condition };

// Direction of the bay's axis, z of the scene: components of a unit vector along the zenith, the
// direction of flight and the orbit's normal.
struct BayAxis {
  double position_deg = 0.0;
  double zenith = 0.0, forward = 0.0, normal = 0.0;
};
// A scene's [orbit]; positions from orbit noon in the direction of motion.
struct OrbitEntry {
  Number altitude_km, beta_deg, period_s;
  Number position_deg;  // of the scene
  std::string attitude, inertial_as;
  Number inertial_at_deg;
  std::vector<studies::Arc> umbra_deg, penumbra_deg;  // one arc, or none
  std::vector<BayAxis> bay;  // at 0, 90, 180 and 270 deg, if the attitude is known
};
struct SceneEntry {
  std::string id, name, path;
  std::optional<std::size_t> patches;
  std::optional<OrbitEntry> orbit;
};
struct CameraEntry {
  std::size_t scene = 0;
  std::string name;
  std::optional<int> columns, rows;
  Number fov_deg;
  std::string cctv, iris;  // "" if none
  Number relative_noise;
  std::string error_text;
  Number render_seconds;
};
struct Factor {
  std::string group;
  Rgb factor;
};
struct ConditionEntry {
  std::string id;
  std::size_t scene = 0;
  std::string name, lamps;
  std::string utc;  // "" without a trajectory
  Number position_deg, time_s, sun_share;
  std::string phase;  // "day", "penumbra" or "eclipse"; "" if the scene has no Sun
  std::vector<Factor> factors;
  std::string others;
  Number earth_error;
  std::string pose = {};  // of joints and tracks; "" where the scene has none
};

// A light group's share or luminance, or its factor.
struct GroupShare {
  std::string group;
  Number value;
};
// Results of one camera and target in one condition.
struct TargetFindings {
  studies::Sight sight;
  Number lit_fraction;
  std::vector<GroupShare> lit_by, light_by;
  std::vector<studies::LightShare> light_from;
  Number luminance_error, luminance_bound;
  studies::ConditionNoise noise;  // of the camera's picture in the condition
  std::string why;
  std::vector<studies::Reason> reasons;
  std::string why_of;  // the condition in which the reasons were found; "": this one
};
struct ResultEntry : TargetFindings {
  std::size_t condition = 0, camera = 0, target = 0;
};

// Results of one camera and target along the orbit for one lamp setting: lists of equal length.
struct Timeline {
  std::size_t scene = 0;
  std::string camera, target, lamps;
  std::vector<std::string> utc = {};  // with a trajectory, else ""
  std::vector<Number> position_deg = {}, time_s = {}, sun_share = {};
  std::vector<Number> detect = {}, recognise = {}, identify = {}, luminance = {}, weber = {};
  std::vector<std::optional<studies::Verdict>> verdict = {};
};
struct AnswerEntry {
  std::string wanted, target;
  Number least;
  bool found = false;
  std::string text, camera, iris, lamps;
  Number least_factor;
  std::vector<studies::Arc> arcs_deg;
  std::string scene;  // "" in a study of one scene
  Number best_probability;
  Number darkest_deg;  // position of least_factor
};
struct PictureEntry {
  std::string file, caption;
};
struct PairEntry {
  std::string title;
  PictureEntry left, right;
};
struct FigureEntry : PictureEntry {
  std::string name, exr;
  bool clean = false;
  Number white_cd_m2;  // luminance of white in a clean picture
  // The picture with the common white of the study; "" if `file` has it.
  std::string same_file;
  Number same_white_cd_m2;
};
// A condition as a camera shows it, with its own white; monitor: "" without a CCTV.
struct ThumbnailEntry {
  std::size_t condition = 0, camera = 0;
  std::string file, monitor;
  Number white_cd_m2;
};
// Work that was done, or read from an earlier run; seconds: of the run that did it.
struct StudyCost {
  std::string stage;
  Number seconds;
  std::optional<std::uint64_t> rays;
  bool found = false;
};

struct StudyResults {
  std::string name, version;
  bool complete = true;
  std::vector<SceneEntry> scenes;
  std::vector<CameraEntry> cameras;
  std::vector<std::string> targets;
  std::vector<ConditionEntry> conditions;
  std::vector<ResultEntry> results;
  std::vector<AnswerEntry> answers;
  std::vector<PairEntry> pairs;
  std::vector<FigureEntry> figures;
  std::vector<ThumbnailEntry> thumbnails;
  Json settings = Json::object(), provenance = Json::object();
  std::vector<StudyCost> costs;
  std::vector<std::string> notes;
  // Cameras inside a body; the notes say so in study.json.
  std::vector<std::string> skipped = {};
};

// For cameras and targets with results at two or more positions.
[[nodiscard]] std::vector<Timeline> timelines_of(const StudyResults& study);

// The name by which others reference an entry.
[[nodiscard]] const std::string& name_of(const StudyResults& study, Named what, std::size_t number);

// Values of a target's results, by member, for columns of tables.

using Figure = Number (*)(const TargetFindings&);

template <auto Member>
Number figure_of(const TargetFindings& found) {
  return found.*Member;
}
template <auto Member>
Number sight_of(const TargetFindings& found) {
  return found.sight.*Member;
}
template <auto Member>
Number noise_of(const TargetFindings& found) {
  return found.noise.*Member;
}
template <auto Part, auto Member>
Number part_of_sight(const TargetFindings& found) {
  const auto& part = found.sight.*Part;
  return part ? Number((*part).*Member) : Number();
}
template <auto Member>
inline constexpr Figure chance_of = part_of_sight<&studies::Sight::probability, Member>;
template <auto Member>
inline constexpr Figure signal_of = part_of_sight<&studies::Sight::signal, Member>;
template <auto Member>
inline constexpr Figure monitor_of = part_of_sight<&studies::Sight::monitor, Member>;
template <auto Member>
inline constexpr Figure eye_of = part_of_sight<&studies::Sight::eye, Member>;
template <auto Member>
Number eye_chance_of(const TargetFindings& found) {
  const auto& eye = found.sight.eye;
  return eye && eye->probability ? Number((*eye->probability).*Member) : Number();
}

// study.json, written and read by the lists of fields in results_fields.h. Results are rounded to
// four digits; reasons are written only where they were found.

[[nodiscard]] Json to_json(const StudyResults& results);
// Throws base::Error (Input) with the place in `file` of an error.
[[nodiscard]] StudyResults read_results(const std::string& file, const Json& json);

// The results of a visibility study as a table and as text.

// A sentence for each camera and target with a visible black back: the target will look different.
[[nodiscard]] std::vector<std::string> black_back_notes(const StudyResults& results);

// results.csv: one row per condition, camera and target.
[[nodiscard]] std::string results_csv(const StudyResults& results);

// For people: one line per camera, target and lamp setting, the answers, the noise of each camera's
// pictures, and black backs.
[[nodiscard]] std::string study_text(const StudyResults& results);

}  // namespace earthshine::app
