// SPDX-License-Identifier: Apache-2.0
// `earthshine dataset`: pictures and labels of a scene with drawn cameras, poses and lights. An
// image depends on the data set's file, the scene and its number alone. Its labels are written
// last, so that an image with labels is finished.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "app/build_id.h"
#include "app/call/memory.h"
#include "app/call/render_call.h"
#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/dataset/folder.h"
#include "app/dataset/labels.h"
#include "app/dataset/recipe.h"
#include "app/json.h"
#include "app/options.h"
#include "app/output.h"
#include "app/render/draw.h"
#include "app/render/error_json.h"
#include "app/render/kept_lights.h"
#include "base/files/exr_file.h"
#include "base/files/output_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "scenes/read/place_mesh.h"
#include "scenes/read/scene_file.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_attempts = 1000;  // poses of the camera
constexpr double inside = 0.5;               // winding number of a point in a closed body
constexpr int directions = 96;               // along which the clearance is measured

struct DatasetCall {
  std::string recipe, folder, images;
};

struct Numbers {
  std::size_t first = 0, last = 0;
};

// "20-39" or "7"; all of them without --images.
Numbers numbers_of(const DatasetCall& call, std::size_t count) {
  Numbers numbers{0, count - 1};
  if (call.images.empty()) return numbers;
  const char* const end = call.images.data() + call.images.size();
  auto [at, error] = std::from_chars(call.images.data(), end, numbers.first);
  numbers.last = numbers.first;
  bool good = error == std::errc();
  if (good && at != end && *at == '-') {
    const auto second = std::from_chars(at + 1, end, numbers.last);
    at = second.ptr;
    good = second.ec == std::errc();
  }
  if (!good || at != end || numbers.first > numbers.last || numbers.last >= count) {
    throw base::Error(base::Blame::Input, "--images", "is \"" + call.images + "\"",
                      fmt::format("it is FIRST-LAST or one number, from 0 to {}", count - 1));
  }
  return numbers;
}

class DataSet {
 public:
  DataSet(const DatasetCall& call, const Common& common)
      : recipe_(read_recipe(call.recipe)), common_(common), folder_(call.folder) {
    common_.quiet = true;
    common_.progress = std::make_shared<Progress>(true);
    common_.seed = recipe_.seed;
    scenes::Scene scene = scenes::read_scene(recipe_.scene, model_overrides());
    Files inputs = scene.files;
    inputs.push_back(recipe_.path);
    refuse_inputs_in(folder_.path(), inputs);
    if (common.seed != Common().seed) {
      throw base::Error(base::Blame::Input, "--seed", "has no effect on a data set", {},
                        "Set seed in " + recipe_.path.string());
    }
    model_joints_ = joints_of_targets(scene);
    refuse_varied_originals(scene);
    key_ = digests_of(inputs);
    key_["build"] = build_id();
    camera_ = static_cast<std::size_t>(wanted_cameras(recipe_.camera.name.empty()
                                                          ? std::vector<std::string>{}
                                                          : std::vector{recipe_.camera.name},
                                                      scene)
                                           .front() -
                                       scene.cameras.data());
    write_models(scene);
  }

  [[nodiscard]] const Recipe& recipe() const { return recipe_; }
  // The labels of a finished image; null if it is missing or of other files.
  [[nodiscard]] Json finished(std::size_t image) const {
    Json known = labels(image);
    return has_pictures(image) ? known : Json();
  }
  // Removes the lists over all images, which a new image makes wrong.
  void drop_lists() const {
    for (const fs::path& list : folder_.lists()) fs::remove(list);
  }
  // Returns whether the picture has its error.
  bool make(std::size_t image);
  // Writes the lists over all images; false where images are missing.
  bool finish() const;

 private:
  [[nodiscard]] fs::path here() const { return fs::absolute(recipe_.path).parent_path(); }
  // By their names beside the recipe.
  [[nodiscard]] Json digests_of(const Files& files) const {
    Json digests = Json::object();
    for (const fs::path& file : files) {
      const fs::path name = fs::absolute(file).lexically_relative(here());
      digests[name.generic_string()] = digest_of_file(file);
    }
    return digests;
  }
  // An instance has the shape of its original, which models/ have.
  void refuse_varied_originals(const scenes::Scene& scene) const;
  [[nodiscard]] bool has_pictures(std::size_t image) const {
    std::vector<fs::path> files = {folder_.layers(image), folder_.bop("rgb", image),
                                   folder_.bop("depth", image)};
    for (std::size_t target = 0; target < recipe_.targets.size(); ++target) {
      for (const char* room : {"mask", "mask_visib"}) {
        files.push_back(folder_.mask(room, image, target));
      }
    }
    return std::ranges::all_of(files, [](const fs::path& file) {
      std::error_code missing;
      return fs::file_size(file, missing) > 0 && !missing;
    });
  }
  // Targets that move are placed in the axes of their models.
  [[nodiscard]] std::vector<std::string> model_overrides() const {
    std::vector<std::string> overrides = recipe_.overrides;
    for (const DrawnTarget& target : recipe_.targets) {
      if (!target.moves) continue;
      for (const char* key : {"translate", "rotate"}) {
        overrides.push_back(fmt::format("object.{}.{}=[0, 0, 0]", target.name, key));
      }
    }
    return overrides;
  }
  [[nodiscard]] Json labels(std::size_t image) const {
    if (!fs::is_regular_file(folder_.labels(image))) return {};
    Json known = json_in(folder_.labels(image));
    if (!known.is_object() || !known.contains("key") || known["key"] != key_) return {};
    for (const auto& [name, digest] : known["files"].items()) {
      const fs::path file = here() / name;
      if (!fs::is_regular_file(file) || Json(digest_of_file(file)) != digest) return {};
    }
    return known;
  }
  [[nodiscard]] std::vector<std::uint32_t> targets_in(const scenes::Scene& scene) const;
  [[nodiscard]] std::vector<scenes::Pose> joints_of_targets(const scenes::Scene& scene) const;
  // From the axes of the files in models/: what the joint, the drawn pose and, backward, the joint
  // of the model do.
  [[nodiscard]] std::vector<scenes::Pose> model_to_scene(const scenes::Scene& scene,
                                                         const Draw& draw) const;
  void write_models(const scenes::Scene& scene) const;
  void place_camera(scenes::Scene& scene, const scenes::RayQuery& query, std::size_t image) const;
  // Writes the masks of an image's targets.
  [[nodiscard]] std::vector<Masks> write_masks(const std::vector<studies::TargetView>& views,
                                               const studies::ObjectMap& map,
                                               std::size_t image) const;
  void write_picture(const base::Image& picture, const Draw& draw,
                     const std::optional<CctvSetup>& cctv, std::size_t image) const;

  Recipe recipe_;
  Common common_;
  Folder folder_;
  Json key_;
  std::size_t camera_ = 0;
  std::vector<scenes::Pose> model_joints_;  // in the scene of models/
  KeptLights lights_;
};

std::vector<std::uint32_t> DataSet::targets_in(const scenes::Scene& scene) const {
  std::vector<std::uint32_t> objects;
  for (const DrawnTarget& target : recipe_.targets) {
    const auto found = std::ranges::find(scene.objects, target.name, &scenes::Object::name);
    if (found == scene.objects.end()) {
      throw base::Error(base::Blame::Input, recipe_.path.string(),
                        "[[target]] \"" + target.name + "\" is no object of the scene");
    }
    objects.push_back(static_cast<std::uint32_t>(found - scene.objects.begin()));
  }
  return objects;
}

// Keys of an object that its instances do not share.
constexpr std::string_view no_shape[] = {"material", "translate", "rotate",    "scale",
                                         "velocity", "spin",      "spin_about"};

void DataSet::refuse_varied_originals(const scenes::Scene& scene) const {
  for (const std::uint32_t target : targets_in(scene)) {
    const auto& instance = scene.objects[target].instance;
    if (!instance) continue;
    const std::string& original = scene.objects[instance->object].name;
    const std::string own = fmt::format("object.{}.", original);
    for (const Varied& varied : recipe_.varied) {
      if (!varied.key.starts_with(own)) continue;
      const std::string key = varied.key.substr(own.size());
      if (std::ranges::find(no_shape, key) != std::end(no_shape)) continue;
      throw base::Error(
          base::Blame::Input, recipe_.path.string(),
          fmt::format("[[vary]] {} sets the shape of the original of the target {}",
                      scenes::in_quotes(varied.key), scenes::in_quotes(scene.objects[target].name)),
          "the shape of a target is that of its model", "Leave it out");
    }
  }
}

std::vector<scenes::Pose> DataSet::joints_of_targets(const scenes::Scene& scene) const {
  std::vector<scenes::JointState> joints;
  if (scene.linkage) joints = scenes::joints_now(scene);
  std::vector<scenes::Pose> poses;
  for (const std::uint32_t object : targets_in(scene)) {
    const std::string& joint = scene.objects[object].joint;
    poses.push_back(joint.empty() ? scenes::Pose()
                                  : joints[scenes::joint_index(*scene.linkage, joint)].pose);
  }
  return poses;
}

std::vector<scenes::Pose> DataSet::model_to_scene(const scenes::Scene& scene,
                                                  const Draw& draw) const {
  std::vector<scenes::Pose> poses = joints_of_targets(scene);
  for (std::size_t t = 0; t < poses.size(); ++t) {
    poses[t] =
        poses[t] *
        scenes::Pose{scenes::rotation_xyz(draw.poses[t].rotate_deg), draw.poses[t].translate_m} *
        scenes::inverse(model_joints_[t]);
  }
  return poses;
}

void DataSet::write_models(const scenes::Scene& scene) const {
  Json sizes = Json::object();
  const std::vector<std::uint32_t> objects = targets_in(scene);
  for (std::size_t t = 0; t < objects.size(); ++t) {
    base::write_text(folder_.path() / "models" / fmt::format("obj_{:06}.ply", t + 1),
                     model_ply(scene, objects[t]));
    sizes[std::to_string(t + 1)] = model_info(scene, objects[t]);
  }
  base::write_text(folder_.path() / "models" / "models_info.json", dump_lines(sizes));
}

bool is_free(const scenes::Scene& scene, const scenes::RayQuery& query,
             const scenes::Camera& camera, double clearance_m) {
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    if (raytrace::winding_number(scene, o, camera.position) > inside) return false;
  }
  for (int k = 0; k < directions && clearance_m > 0.0; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / directions, r = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * base::pi * k * 0.6180339887498949;
    const scenes::Hit hit =
        query.closest(camera.position, {r * std::cos(phi), r * std::sin(phi), z});
    if (!hit.missed() && hit.t < clearance_m) return false;
  }
  try {
    raytrace::check_camera(scene, query, camera);
  } catch (const base::Error&) {
    return false;
  }
  return true;
}

void DataSet::place_camera(scenes::Scene& scene, const scenes::RayQuery& query,
                           std::size_t image) const {
  scenes::Camera& camera = scene.cameras[camera_];
  const CameraPose given{camera.position, camera.look_at, camera.up};
  std::optional<Vec3> target;
  const std::vector<std::uint32_t> objects = targets_in(scene);
  for (std::size_t t = 0; t < objects.size(); ++t) {
    if (recipe_.targets[t].name != recipe_.camera.look_at_target) continue;
    target = scenes::bounds_of(scene, scene.objects[objects[t]]).middle();
  }
  for (std::size_t attempt = 0; attempt < most_attempts; ++attempt) {
    const CameraPose pose = draw_camera(recipe_, image, attempt, given, target);
    camera.position = pose.position;
    camera.look_at = pose.look_at;
    camera.up = pose.up;
    if (is_free(scene, query, camera, recipe_.camera.clearance_m)) return;
  }
  throw base::Error(base::Blame::Input, recipe_.path.string(),
                    fmt::format("image {}: {} places of the camera were inside bodies or nearer to "
                                "a surface than the clearance",
                                image, most_attempts),
                    {}, "Widen the bounds of [camera], or reduce its clearance");
}

void DataSet::write_picture(const base::Image& picture, const Draw& draw,
                            const std::optional<CctvSetup>& cctv, std::size_t image) const {
  const fs::path rgb = folder_.bop("rgb", image);
  if (cctv) {
    degrade::Result shown = run_chain(*cctv, picture);
    degrade::resize_screen(shown, picture.width, picture.height);
    return write_cctv(rgb.string(), *cctv, shown);
  }
  const base::ToneMapped tone =
      draw.white_cd_m2 ? base::expose(picture, *draw.white_cd_m2, base::ToneCurve::Shoulder)
                       : base::tone_map(picture);
  base::write_png(rgb, picture.width, picture.height, 3, tone.rgb);
}

std::vector<Masks> DataSet::write_masks(const std::vector<studies::TargetView>& views,
                                        const studies::ObjectMap& map, std::size_t image) const {
  std::vector<Masks> masks;
  for (std::size_t t = 0; t < views.size(); ++t) {
    masks.push_back(masks_of(views[t], map));
    base::write_png(folder_.mask("mask", image, t), map.columns, map.rows, 1, masks[t].whole);
    base::write_png(folder_.mask("mask_visib", image, t), map.columns, map.rows, 1,
                    masks[t].visible);
  }
  return masks;
}

Json drawn_json(const Draw& draw, const scenes::Camera& camera) {
  Json drawn = {{"set", draw.overrides},
                {"camera",
                 {{"name", camera.name},
                  {"position_m", to_json(camera.position)},
                  {"look_at_m", to_json(camera.look_at)},
                  {"up", to_json(camera.up)}}},
                {"seed", draw.seed}};
  if (draw.white_cd_m2) drawn["white_cd_m2"] = *draw.white_cd_m2;
  return drawn;
}

bool DataSet::make(std::size_t image) {
  const Draw draw = draw_values(recipe_, image);
  Common common = common_;
  common.seed = draw.seed;
  LoadedScene loaded = check_scene(scenes::read_scene(recipe_.scene, draw.overrides));
  refuse_inputs_in(folder_.path(), loaded.scene.files);
  const scenes::RayQuery query(loaded.scene);
  place_camera(loaded.scene, query, image);
  const scenes::Camera& camera = loaded.scene.cameras[camera_];
  RenderCall call;
  call.scene = {recipe_.scene.string(), draw.overrides};
  call.cameras = {camera.name};
  call.aovs = {"object", "depth", "normal"};
  decide_effects(loaded, wanted_effects(call, {&camera}));
  check_input(loaded, query, {{&camera}}, true, true);
  check_memory(loaded, query, solve_options(loaded.scene, common_), nullptr, true);
  StageTimes times;
  // The solution is sampled with the data set's seed: images that differ in the camera share it.
  const Solved& light = lights_.take({call, common_, loaded, query, {}, Interrupt::asked}, times);
  Interrupt::leave_if_asked();
  const RenderContext context{call, common, loaded, query, light};
  const Drawn drawn = draw_picture(context, camera, times);
  Interrupt::leave_if_asked();

  const base::Image& picture = drawn.frame.image;
  const studies::ObjectMap map = studies::object_map(picture);
  const std::vector<studies::TargetView> all = studies::find_targets(loaded.scene, camera, map);
  std::vector<studies::TargetView> views;
  for (const std::uint32_t object : targets_in(loaded.scene)) {
    views.push_back(*std::ranges::find(all, object, &studies::TargetView::object));
  }
  const std::vector<Masks> masks = write_masks(views, map, image);
  const std::vector<float>& depth_m = picture.find("Z")->values;
  const Depth16 depth = depth16(depth_m);
  base::write_png16(folder_.bop("depth", image), map.columns, map.rows, depth.values);
  std::optional<CctvSetup> cctv;
  if (recipe_.cctv) cctv = cctv_of_camera(loaded.scene, camera, common);
  write_picture(picture, draw, cctv, image);
  base::write_exr(folder_.layers(image), picture, picture_header(context, camera, drawn));

  const raytrace::CameraModel model = raytrace::make_camera_model(camera, map.columns, map.rows);
  Json record = {{"key", key_}, {"files", digests_of(loaded.scene.files)}, {"image", image}};
  record["drawn"] = drawn_json(draw, camera);
  record["reached"] = drawn.limit == raytrace::Limit::None;
  record["columns"] = map.columns;
  record["rows"] = map.rows;
  record["error"] = error_json(drawn, loaded.scene.quality.error)["estimate"];
  std::vector<studies::PixelsOutside> outside;
  for (const std::uint32_t object : targets_in(loaded.scene)) {
    outside.push_back(studies::pixels_outside(loaded.scene, camera, object, map.columns, map.rows));
  }
  record.update(labels_of({recipe_, loaded.scene, query, model, map, depth_m, depth.scale_mm, image,
                           model_to_scene(loaded.scene, draw), std::move(outside)},
                          views, masks));
  record["targets"] = sights_of(camera, picture, map, views, cctv);
  base::write_text(folder_.labels(image), dump_lines(record));
  return record["reached"];
}

bool DataSet::finish() const {
  Json cameras = Json::object(), poses = Json::object(), facts = Json::object();
  Json coco = {
      {"images", Json::array()}, {"annotations", Json::array()}, {"categories", Json::array()}};
  for (std::size_t image = 0; image < recipe_.images; ++image) {
    const Json known = finished(image);
    if (known.is_null()) return false;
    const std::string number = std::to_string(image);
    cameras[number] = known["scene_camera"];
    poses[number] = known["scene_gt"];
    facts[number] = known["scene_gt_info"];
    coco["images"].push_back({{"id", image},
                              {"file_name", fmt::format("train/000000/rgb/{:06}.png", image)},
                              {"width", known["columns"]},
                              {"height", known["rows"]}});
    for (const Json& annotation : known["annotations"]) coco["annotations"].push_back(annotation);
  }
  for (std::size_t t = 0; t < recipe_.targets.size(); ++t) {
    const DrawnTarget& target = recipe_.targets[t];
    Json category = {{"id", t + 1}, {"name", target.name}};
    if (!target.points.empty()) {
      category["keypoints"] = Json::array();
      for (const KeyPoint& point : target.points) category["keypoints"].push_back(point.name);
      category["skeleton"] = Json::array();
    }
    coco["categories"].push_back(category);
  }
  const std::vector<fs::path> lists = folder_.lists();
  const Json* contents[] = {&cameras, &poses, &facts, &coco};
  for (std::size_t k = 0; k < lists.size(); ++k) {
    base::write_text(lists[k], dump_lines(*contents[k]));
  }
  return true;
}

void run(const DatasetCall& call, const Common& common) {
  DataSet set(call, common);
  const Numbers numbers = numbers_of(call, set.recipe().images);
  const Interrupt interrupt;
  const std::size_t total = numbers.last - numbers.first + 1;
  const auto report = common.progress->begin("images", Work::Other, double(total));
  std::vector<std::size_t> noisy;
  try {
    for (std::size_t k = 0; k < total; ++k) {
      report(k, total);
      const std::size_t image = numbers.first + k;
      const Json known = set.finished(image);
      if (known.is_null()) set.drop_lists();
      const bool reached = known.is_null() ? set.make(image) : known["reached"].get<bool>();
      if (!reached) noisy.push_back(image);
    }
  } catch (const Interrupt::Left&) {
    throw base::Error(base::Blame::Work, "dataset", "interrupted", {},
                      "Run the same call again: finished images stay");
  }
  common.progress->end();
  const bool whole = set.finish();
  if (!common.quiet) {
    note(whole
             ? fmt::format("{}: {} images with labels", call.folder, set.recipe().images)
             : fmt::format("{}: images {} to {} are done; the lists of all images are written once "
                           "the others are",
                           call.folder, numbers.first, numbers.last));
  }
  if (noisy.empty()) return;
  throw StoppedShort(
      fmt::format("these images do not have their error: {}", fmt::join(noisy, ", ")));
}

}  // namespace

Command add_dataset(CLI::App& program) {
  CLI::App* parser = add_subcommand(
      program, "dataset",
      "Pictures with depth, masks and poses for training, with drawn cameras and lights");
  const auto call = std::make_shared<DatasetCall>();
  parser->add_option("DATASET", call->recipe, "What is drawn, and between what bounds (TOML)")
      ->required()
      ->type_name("");
  parser->add_option("-o,--output", call->folder, "Folder for pictures and labels")
      ->required()
      ->type_name("DIR");
  parser
      ->add_option("--images", call->images,
                   "These images only; finished ones are not drawn again. All of them, in any "
                   "parts, make the same files")
      ->type_name("FIRST-LAST");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
