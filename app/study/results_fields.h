// SPDX-License-Identifier: Apache-2.0
// The fields of a study's results, one list per struct, in the order of study.json
// (docs/visibility.md has the keys). A new field needs a member in results.h and a line here.
#pragma once

#include <concepts>
#include <type_traits>

#include "app/study/results.h"

namespace earthshine::app {

// A const value to write, or a value to read into.
template <class Value, class Struct>
concept Either = std::same_as<std::remove_const_t<Value>, Struct>;

// describe(fields, value) calls `fields` for each key, in file order, with its member:
//   fields(key, member)              missing: null
//   fields.or_null(key, text)        "": null
//   fields.if_any(key, member)       missing: no key
//   fields.part(key, struct)         missing: null; in a table columns "key.member"
//   fields.table(key, members)       a list whose keys are written once
//   fields.word(key, enum, last)     its word_of; `last` is the last enumerator
//   fields.one_of(key, text, words)  "": null
//   fields.list(key, members)        a required list
//   fields.entry(what, key, name)    the name of this entry among those of its kind ...
//   fields.names(what, key, list)    ... or of all of them
//   fields.at(what, key, number)     another entry's, by its name ...
//   fields.camera(key, number, condition)  ... of the cameras of a condition's scene
//   fields.shares(key, list)         an object: group to number
//   fields.light(key, key, list)     two such objects: by groups directly, and by objects
//   fields.factors(key, list)        an object: group to number or colour
// Cameras of several scenes may share a name: references to them include the scene.
template <class Fields>
void describe(Fields& fields, Either<studies::Probability> auto& p) {
  fields("detect", p.detect);
  fields("recognise", p.recognise);
  fields("identify", p.identify);
}

template <class Fields>
void describe(Fields& fields, Either<studies::SignalSight> auto& signal) {
  fields("mean", signal.mean);
  fields("surround", signal.surround);
  fields("weber", signal.weber);
  fields("snr", signal.snr);
  fields("cnr", signal.cnr);
  fields("rose", signal.rose);
  fields("snr_d", signal.snr_d);
  fields("dprime", signal.dprime);
  fields("limiting_frequency", signal.limiting_frequency);
}

template <class Fields>
void describe(Fields& fields, Either<studies::MonitorSight> auto& monitor) {
  fields("luminance", monitor.luminance);
  fields("surround", monitor.surround);
  fields("weber", monitor.weber);
  fields("threshold", monitor.threshold);
}

template <class Fields>
void describe(Fields& fields, Either<studies::EyeSight> auto& eye) {
  fields("adaptation", eye.adaptation);
  fields("acuity", eye.acuity);
  fields("cycles", eye.cycles);
  fields("threshold", eye.threshold);
  fields("weber", eye.weber);
  fields.part("probability", eye.probability);
}

template <class Fields>
void describe(Fields& fields, Either<studies::Reason> auto& reason) {
  fields.word("cause", reason.cause, studies::Cause::Small);
  fields.if_any("by", reason.by);
  fields.if_any("share", reason.share);
  fields.if_any("probability_without", reason.probability_without);
  fields("text", reason.text);
}

template <class Fields>
void describe(Fields& fields, Either<studies::Sight> auto& sight) {
  fields.word("verdict", sight.verdict, studies::Verdict::Hidden);
  fields.part("probability", sight.probability);
  fields("pixels", sight.pixels);
  fields("visible_fraction", sight.visible_fraction);
  fields("cut_by_frame", sight.cut_by_frame);
  fields("black_back", sight.black_back);
  fields("angle_deg", sight.angle_deg);
  fields("tv_lines", sight.tv_lines);
  fields("luminance", sight.luminance);
  fields("surround", sight.surround);
  fields("weber", sight.weber);
  fields.part("signal", sight.signal);
  fields.part("monitor", sight.monitor);
  fields.part("eye", sight.eye);
  fields("johnson_cycles", sight.johnson_cycles);
  fields("saturated", sight.saturated);
  fields("crushed", sight.crushed);
  fields("shown_from", sight.shown_from);
  fields("shown_to", sight.shown_to);
}

template <class Fields>
void describe(Fields& fields, Either<TargetFindings> auto& found) {
  describe(fields, found.sight);
  fields("lit_fraction", found.lit_fraction);
  fields.shares("lit_by", found.lit_by);
  fields.shares("light_by", found.light_by);
  fields.light("light_from", "light_by_way_of", found.light_from);
  fields("luminance_error", found.luminance_error);
  fields("luminance_bound", found.luminance_bound);
  fields("picture_noise", found.noise.relative);
  fields("picture_noise_cd_m2", found.noise.cd_m2);
  fields.word("finished_by", found.noise.finished_by, studies::FinishedBy::Nothing);
  fields("why", found.why);
  fields("reasons", found.reasons);
  fields.or_null("why_of", found.why_of);
}

template <class Fields>
void describe(Fields& fields, Either<ResultEntry> auto& result) {
  fields.at(Named::Condition, "condition", result.condition);
  fields.camera("camera", result.camera, result.condition);
  fields.at(Named::Target, "target", result.target);
  using Found = std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(result)>>,
                                   const TargetFindings, TargetFindings>;
  describe(fields, static_cast<Found&>(result));
}

template <class Fields>
void describe(Fields& fields, Either<BayAxis> auto& axis) {
  fields("position_deg", axis.position_deg);
  fields("zenith", axis.zenith);
  fields("forward", axis.forward);
  fields("normal", axis.normal);
}

template <class Fields>
void describe(Fields& fields, Either<OrbitEntry> auto& orbit) {
  fields("altitude_km", orbit.altitude_km);
  fields("beta_deg", orbit.beta_deg);
  fields("period_s", orbit.period_s);
  fields("position_deg", orbit.position_deg);
  fields("attitude", orbit.attitude);
  fields.if_any("inertial_as", orbit.inertial_as);
  fields.if_any("inertial_at_deg", orbit.inertial_at_deg);
  fields("umbra_deg", orbit.umbra_deg);
  fields("penumbra_deg", orbit.penumbra_deg);
  fields("bay", orbit.bay);
}

template <class Fields>
void describe(Fields& fields, Either<SceneEntry> auto& scene) {
  fields.entry(Named::Scene, "id", scene.id);
  fields("name", scene.name);
  fields("path", scene.path);
  fields("patches", scene.patches);
  fields.if_any("orbit", scene.orbit);
}

template <class Fields>
void describe(Fields& fields, Either<CameraEntry> auto& camera) {
  fields.at(Named::Scene, "scene", camera.scene);
  fields.entry(Named::Camera, "name", camera.name, camera.scene);
  fields("columns", camera.columns);
  fields("rows", camera.rows);
  fields("fov_deg", camera.fov_deg);
  fields.or_null("cctv", camera.cctv);
  fields.or_null("iris", camera.iris);
  fields("relative_noise", camera.relative_noise);
  fields("error_text", camera.error_text);
  fields("render_seconds", camera.render_seconds);
}

template <class Fields>
void describe(Fields& fields, Either<ConditionEntry> auto& condition) {
  fields.entry(Named::Condition, "id", condition.id);
  fields.at(Named::Scene, "scene", condition.scene);
  fields("name", condition.name);
  fields("lamps", condition.lamps);
  fields.if_any("utc", condition.utc);
  fields("position_deg", condition.position_deg);
  fields("time_s", condition.time_s);
  fields("sun_share", condition.sun_share);
  fields.one_of("phase", condition.phase, {"day", "penumbra", "eclipse"});
  fields.factors("factors", condition.factors);
  fields("others", condition.others);
  fields("earth_error", condition.earth_error);
  fields.if_any("pose", condition.pose);
}

template <class Fields>
void describe(Fields& fields, Either<AnswerEntry> auto& answer) {
  fields("wanted", answer.wanted);
  fields("target", answer.target);
  fields("least", answer.least);
  fields("found", answer.found);
  fields("text", answer.text);
  fields.or_null("camera", answer.camera);
  fields.or_null("iris", answer.iris);
  fields.or_null("lamps", answer.lamps);
  fields("least_factor", answer.least_factor);
  fields("arcs_deg", answer.arcs_deg);
  fields.if_any("scene", answer.scene);
  fields.if_any("best_probability", answer.best_probability);
  fields.if_any("darkest_deg", answer.darkest_deg);
}

template <class Fields>
void describe(Fields& fields, Either<PictureEntry> auto& picture) {
  fields("file", picture.file);
  fields("caption", picture.caption);
}

template <class Fields>
void describe(Fields& fields, Either<PairEntry> auto& pair) {
  fields("title", pair.title);
  fields("left", pair.left);
  fields("right", pair.right);
}

template <class Fields>
void describe(Fields& fields, Either<FigureEntry> auto& figure) {
  fields("name", figure.name);
  fields("file", figure.file);
  fields("exr", figure.exr);
  fields("caption", figure.caption);
  fields("clean", figure.clean);
  fields.if_any("white_cd_m2", figure.white_cd_m2);
  fields.if_any("same_file", figure.same_file);
  fields.if_any("same_white_cd_m2", figure.same_white_cd_m2);
}

template <class Fields>
void describe(Fields& fields, Either<ThumbnailEntry> auto& small) {
  fields.at(Named::Condition, "condition", small.condition);
  fields.camera("camera", small.camera, small.condition);
  fields("file", small.file);
  fields.or_null("monitor_file", small.monitor);
  fields.if_any("white_cd_m2", small.white_cd_m2);
}

template <class Fields>
void describe(Fields& fields, Either<StudyCost> auto& cost) {
  fields("stage", cost.stage);
  fields("seconds", cost.seconds);
  fields("rays", cost.rays);
  fields("found", cost.found);
}

template <class Fields>
void describe(Fields& fields, Either<StudyResults> auto& study) {
  fields("name", study.name);
  fields("version", study.version);
  fields("complete", study.complete);
  fields.list("scenes", study.scenes);
  fields.list("cameras", study.cameras);
  fields.names(Named::Target, "targets", study.targets);
  fields.list("conditions", study.conditions);
  fields.table("results", study.results);
  fields("answers", study.answers);
  fields("pairs", study.pairs);
  fields("figures", study.figures);
  fields("thumbnails", study.thumbnails);
  fields("settings", study.settings);
  fields("provenance", study.provenance);
  fields("costs", study.costs);
  fields("notes", study.notes);
}

}  // namespace earthshine::app
