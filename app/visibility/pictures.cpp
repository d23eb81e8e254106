// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/console.h"
#include "app/study/study.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "raytrace/render.h"
#include "scenes/effects/quality.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

using studies::PictureWish;
using studies::Shows;

bool by_cctv(Shows shows) { return shows == Shows::Cctv || shows == Shows::DistributedCctv; }
bool distributed(Shows shows) {
  return shows == Shows::Distributed || shows == Shows::DistributedCctv;
}

const StudyCamera* camera_of(const StudyPart& part, const std::string& name) {
  const auto found = std::find_if(part.cameras.begin(), part.cameras.end(),
                                  [&](const StudyCamera& c) { return c.camera->name == name; });
  return found == part.cameras.end() ? nullptr : &*found;
}

std::size_t place_of(const StudyPart& part, const PictureWish& wish) {
  if (wish.time) {
    const auto moment =
        std::find_if(part.moments.begin(), part.moments.end(),
                     [&](const scenes::Instant& t) { return std::abs(t - *wish.time) < 1e-3; });
    return static_cast<std::size_t>(moment - part.moments.begin());
  }
  if (!wish.position_deg || part.positions_deg.empty()) return 0;
  const auto found =
      std::find(part.positions_deg.begin(), part.positions_deg.end(), *wish.position_deg);
  return static_cast<std::size_t>(found - part.positions_deg.begin());
}

std::size_t setting_of(const StudyPart& part, const PictureWish& wish) {
  const auto& settings = part.basis->settings();
  if (wish.lamps.empty()) return 0;
  const auto found =
      std::find_if(settings.begin(), settings.end(),
                   [&](const studies::LampSetting& s) { return s.name == wish.lamps; });
  return static_cast<std::size_t>(found - settings.begin());
}

// Whether the part has the wish's camera and place.
bool can_draw(const StudyPart& part, const PictureWish& wish) {
  return camera_of(part, wish.camera) != nullptr && has_place(part, wish);
}

constexpr const char* same_end = "-same.png";  // by one white for all

// A unique file name of letters, digits, dots and dashes.
std::string file_of(const studies::StudyFile& study, const PictureWish& wish) {
  std::string stem = wish.name;
  for (char& c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '.' && c != '-' && c != '_') c = '_';
  }
  const auto number = &wish - study.pictures.data();
  return fmt::format("pictures/{:02d}-{}", number + 1, stem);
}

CctvSetup cctv_of_wish(const StudyPart& part, const StudyCamera& camera, const PictureWish& wish,
                       const Common& common) {
  if (wish.cctv.empty()) return *camera.cctv;
  const scenes::Scene& scene = part.loaded.scene;
  CctvSetup setup = cctv_of_camera(scene, *camera.camera, common);
  setup.name = wish.cctv;
  setup.chain.camera = degrade::resolve_camera(scene, wish.cctv);
  setup.chain.monitor = degrade::resolve_monitor(scene, wish.cctv);
  return setup;
}

base::Image draw_distributed(const StudyPart& part, const StudyCamera& camera,
                             const PictureWish& wish, const Common& common) {
  const scenes::Scene scene = part.basis->scene_at(place_of(part, wish), setting_of(part, wish));
  const scenes::LightGroups groups = scenes::find_light_groups(scene);
  scenes::Asked asked;
  asked.cameras = {camera.camera};
  asked.paths = scenes::LightPaths::Distributed;
  raytrace::RenderOptions options = raytrace::render_options(scenes::resolve_quality(scene));
  options.columns = camera.columns;
  options.rows = camera.rows;
  options.seed = common.seed;
  options.indirect = raytrace::Indirect::Distributed;
  options.distributed_lights = wish.lights;
  options.stop = Interrupt::leave_or_go_on;
  const scenes::Effects effects = scenes::find_effects(scene, groups, asked);
  return raytrace::render({scene, groups, effects, *part.query}, {}, *camera.camera, options,
                          common.progress->begin("picture " + wish.name, Work::Picture,
                                                 double(camera.columns) * camera.rows))
      .image;
}

}  // namespace

bool has_place(const StudyPart& part, const PictureWish& wish) {
  return place_of(part, wish) < part.basis->places().size();
}

void check_pictures(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts) {
  for (const PictureWish& wish : study.pictures) {
    const auto refuse = [&](const std::string& found, const std::string& allowed) {
      throw base::Error(base::Blame::Input, wish.where,
                        fmt::format("[[picture]] {} {}", scenes::in_quotes(wish.name), found),
                        allowed);
    };
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const StudyPart* p) { return can_draw(*p, wish); });
    if (part == parts.end()) {
      part = std::find_if(parts.begin(), parts.end(), [&](const StudyPart* p) {
        return camera_of(*p, wish.camera) != nullptr;
      });
    }
    if (part == parts.end()) {
      std::vector<std::string> names;
      for (const StudyPart* p : parts) {
        for (const StudyCamera& camera : p->cameras) {
          if (std::ranges::find(names, camera.camera->name) == names.end())
            names.push_back(camera.camera->name);
        }
      }
      refuse(fmt::format("names camera {}, which the study does not look through",
                         scenes::in_quotes(wish.camera)),
             "its cameras are " + scenes::listed(names));
    }
    if (by_cctv(wish.shows) && wish.cctv.empty() && !camera_of(**part, wish.camera)->cctv) {
      refuse(fmt::format("shows camera {} by CCTV, which it does not have",
                         scenes::in_quotes(wish.camera)),
             "give it one under camera_models, or show \"clean\"");
    }
    if (!wish.cctv.empty()) {
      const std::string of = fmt::format("cctv of [[picture]] {}", scenes::in_quotes(wish.name));
      (void)degrade::resolve_camera((*part)->loaded.scene, wish.cctv, of, wish.where);
    }
    if (setting_of(**part, wish) == (*part)->basis->settings().size()) {
      std::vector<std::string> names;
      for (const studies::LampSetting& s : (*part)->basis->settings()) names.push_back(s.name);
      refuse(fmt::format("names lamps {}", scenes::in_quotes(wish.lamps)),
             "the study's lamp settings are " + scenes::listed(names));
    }
    if (wish.time && place_of(**part, wish) == (*part)->moments.size()) {
      refuse(fmt::format("is at {}, which is not among the study's moments",
                         scenes::utc_text(*wish.time)),
             "they are start, start + step and so on, under [time]");
    }
    if (wish.position_deg && place_of(**part, wish) == (*part)->basis->places().size()) {
      refuse(fmt::format("is at {:g} deg, which is not among the study's positions",
                         *wish.position_deg),
             "add it to positions_deg under [orbit]");
    }
    if (wish.position_deg && (*part)->positions_deg.empty()) {
      refuse("has a position_deg", "the study has no [orbit]");
    }
  }
}

namespace {

// The pictures that this camera of this scene draws.
std::vector<const PictureWish*> own_wishes(const PictureTask& task) {
  std::vector<const PictureWish*> wishes;
  for (const PictureWish& wish : task.study.pictures) {
    if (wish.camera != task.camera.camera->name) continue;
    const auto first = std::find_if(task.parts.begin(), task.parts.end(),
                                    [&](const StudyPart* part) { return can_draw(*part, wish); });
    if (first != task.parts.end() && *first == &task.part) wishes.push_back(&wish);
  }
  return wishes;
}

// All input of a picture.
Json cache_key_of(const PictureTask& task, const PictureWish& wish) {
  const studies::GroupWeights weights =
      task.part.basis->weights(place_of(task.part, wish), setting_of(task.part, wish));
  Json cache_key = {{"what", "figure"},
                    {"picture", task.frame_cache_key},
                    {"file", file_of(task.study, wish)},
                    {"shows", static_cast<int>(wish.shows)},
                    {"lights", distributed(wish.shows) ? wish.lights : 0}};
  for (const Rgb& weight : weights.weight) cache_key["weights"].push_back(to_json(weight));
  if (by_cctv(wish.shows)) {
    const CctvSetup cctv = cctv_of_wish(task.part, task.camera, wish, task.common);
    cache_key["cctv"] = settings_json(cctv.chain.camera);
    cache_key["monitor"] = monitor_json(cctv.chain.monitor);
  }
  return cache_key;
}

std::uintmax_t bytes_of(const std::filesystem::path& path) {
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  return problem ? 0 : size;
}

bool is_there(const PictureTask& task, const PictureWish& wish) {
  std::string said;
  const auto facts = task.store.find_facts(cache_key_of(task, wish), said);
  if (!facts) return false;
  const std::string stem = file_of(task.study, wish);
  // The PNGs of clean pictures are written last, for all together.
  const bool png =
      !by_cctv(wish.shows) || (*facts)["png_bytes"] == bytes_of(task.folder / (stem + ".png"));
  return png && (*facts)["exr_bytes"] == bytes_of(task.folder / (stem + ".exr"));
}

void draw(const PictureTask& task, const PictureWish& wish, const studies::BasisView& view) {
  const StudyPart& part = task.part;
  const std::string stem = (task.folder / file_of(task.study, wish)).string();
  const base::Image radiance =
      distributed(wish.shows) ? draw_distributed(part, task.camera, wish, task.common)
                              : studies::weighted_sum(view.layers, part.basis->groups().names,
                                                      part.basis->weights(place_of(part, wish),
                                                                          setting_of(part, wish)));
  base::write_exr(stem + ".exr", radiance);
  if (by_cctv(wish.shows)) {
    const CctvSetup cctv = cctv_of_wish(part, task.camera, wish, task.common);
    write_cctv(stem + ".png", cctv, run_chain(cctv, radiance));
  }
  task.store.keep_facts(cache_key_of(task, wish), {{"png_bytes", bytes_of(stem + ".png")},
                                                   {"exr_bytes", bytes_of(stem + ".exr")}});
}

}  // namespace

bool pictures_are_there(const PictureTask& task) {
  const auto wishes = own_wishes(task);
  return std::all_of(wishes.begin(), wishes.end(),
                     [&](const PictureWish* wish) { return is_there(task, *wish); });
}

void draw_pictures(const PictureTask& task, const studies::BasisView* view,
                   std::vector<FigureEntry>& figures) {
  for (const PictureWish* wish : own_wishes(task)) {
    if (view != nullptr && !is_there(task, *wish)) draw(task, *wish, *view);
    const std::string stem = file_of(task.study, *wish);
    figures.push_back({{stem + ".png", wish->title},
                       wish->name,
                       stem + ".exr",
                       !by_cctv(wish->shows),
                       {},
                       {},
                       {}});
  }
}

void expose_figures(const std::filesystem::path& folder, const ToneChoice& tone,
                    std::vector<FigureEntry>& figures) {
  std::vector<std::pair<FigureEntry*, base::Image>> clean;
  std::vector<const base::Image*> images;
  for (FigureEntry& figure : figures) {
    if (figure.clean) clean.emplace_back(&figure, base::read_exr(folder / figure.exr).image);
  }
  if (clean.empty()) return;
  for (const auto& [figure, image] : clean) images.push_back(&image);
  const ToneChoice usual{usual_percent, {}, tone.curve};
  const double white = white_of(tone.shared() ? tone : usual, images);
  for (const auto& [figure, image] : clean) {
    const base::ToneMapped same = base::expose(image, white, tone.curve);
    const base::ToneMapped shown = tone.shared() ? same : base::tone_map(image);
    const auto write = [&, &picture = image](const std::string& file, const base::ToneMapped& as) {
      base::write_png(folder / file, picture.width, picture.height, 3, as.rgb);
    };
    write(figure->file, shown);
    figure->white_cd_m2 = tone.shared() ? white : shown.report.white_cd_per_m2;
    if (tone.shared() || clean.size() < 2) continue;
    figure->same_file = std::filesystem::path(figure->file).replace_extension().string() + same_end;
    figure->same_white_cd_m2 = white;
    write(figure->same_file, same);
  }
}

std::vector<PairEntry> pairs_of(const studies::StudyFile& study,
                                const std::vector<FigureEntry>& figures) {
  std::vector<PairEntry> pairs;
  const auto figure = [&](const std::string& name) {
    return std::find_if(figures.begin(), figures.end(),
                        [&](const FigureEntry& one) { return one.name == name; });
  };
  for (const studies::PairWish& pair : study.pairs) {
    const auto left = figure(pair.left), right = figure(pair.right);
    if (left == figures.end() || right == figures.end()) continue;
    pairs.push_back({pair.title, *left, *right});
  }
  return pairs;
}

}  // namespace earthshine::app
