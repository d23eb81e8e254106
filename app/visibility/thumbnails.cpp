// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/files/png_file.h"
#include "base/parallel.h"
#include "base/tone.h"

namespace earthshine::app {
namespace {

constexpr int widest_px = 160;
// Up to this number of conditions, a camera has a thumbnail of each one in which it misses a
// visible target.
constexpr std::size_t most_pictured = 36;

double degrees_apart(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

std::size_t nearest_place(const std::vector<double>& positions_deg, double wanted_deg) {
  const auto nearer = [wanted_deg](double a, double b) {
    return degrees_apart(a, wanted_deg) < degrees_apart(b, wanted_deg);
  };
  return static_cast<std::size_t>(
      std::min_element(positions_deg.begin(), positions_deg.end(), nearer) - positions_deg.begin());
}

bool same_verdicts(const std::vector<TargetFindings>& one,
                   const std::vector<TargetFindings>& other) {
  return std::equal(one.begin(), one.end(), other.begin(), [](const auto& a, const auto& b) {
    return a.sight.verdict == b.sight.verdict;
  });
}

// Means over squares of `step` pixels with `channels` interleaved values.
template <class Value, class Sum>
std::vector<Value> shrunk(const std::vector<Value>& from, int width, int height, int channels,
                          int step) {
  const int columns = width / step, rows = height / step;
  std::vector<Value> to;
  for (int y = 0; y < rows; ++y) {
    for (int k = 0; k < columns * channels; ++k) {
      Sum sum = 0;
      for (int v = 0; v < step; ++v) {
        for (int u = 0; u < step; ++u) {
          const int x = (k / channels * step + u) * channels + k % channels;
          sum += from[static_cast<std::size_t>((y * step + v) * width * channels + x)];
        }
      }
      to.push_back(static_cast<Value>(sum / static_cast<Sum>(step * step)));
    }
  }
  return to;
}

int step_of(int width) { return (width + widest_px - 1) / widest_px; }

// Returns its white, cd/m^2.
double write_small(const std::filesystem::path& path, const base::Image& radiance) {
  const int step = step_of(radiance.width);
  base::Image small{radiance.width / step, radiance.height / step, {}};
  for (const char* name : {"R", "G", "B"}) {
    small.add(name) =
        shrunk<float, float>(radiance.find(name)->values, radiance.width, radiance.height, 1, step);
  }
  const base::ToneMapped shown = base::tone_map(small);
  base::write_png(path, small.width, small.height, 3, shown.rgb);
  return shown.report.white_cd_per_m2;
}

void write_small(const std::filesystem::path& path, const degrade::Result& shown) {
  const int step = step_of(shown.columns);
  base::write_png(
      path, shown.columns / step, shown.rows / step, shown.channels,
      shrunk<std::uint8_t, int>(shown.pixels, shown.columns, shown.rows, shown.channels, step));
}

// Camera names may differ only in characters that are not valid in file names.
std::string stem_of(const PictureTask& task, std::size_t condition) {
  const auto number = &task.camera - task.part.cameras.data();
  return fmt::format("pictures/small-{}-{}-c{}", task.part.id, number + 1, condition);
}

std::vector<std::string> files_of(const PictureTask& task, std::size_t condition) {
  const std::string stem = stem_of(task, condition);
  if (!task.camera.cctv) return {stem + ".png"};
  return {stem + ".png", stem + "-cctv.png"};
}

Json key_of(const CameraWork& work, const std::vector<std::size_t>& conditions) {
  Json key = work.settings();
  key["what"] = "thumbnails";
  key["width"] = widest_px;
  key["pictured"] = conditions;
  return key;
}

Json bytes_of_all(const PictureTask& task, const std::vector<std::size_t>& conditions) {
  Json bytes = Json::array();
  for (const std::size_t k : conditions) {
    for (const std::string& file : files_of(task, k)) {
      std::error_code problem;
      const std::uintmax_t size = std::filesystem::file_size(task.folder / file, problem);
      bytes.push_back(problem ? 0 : size);
    }
  }
  return bytes;
}

double draw_small(const PictureTask& task, const studies::BasisView& view, std::size_t condition) {
  const std::size_t places = task.part.basis->places().size();
  const base::Image radiance =
      studies::weighted_sum(view.layers, task.part.basis->groups().names,
                            task.part.basis->weights(condition % places, condition / places));
  const std::vector<std::string> files = files_of(task, condition);
  if (task.camera.cctv)
    write_small(task.folder / files.back(), run_chain(*task.camera.cctv, radiance));
  return write_small(task.folder / files.front(), radiance);
}

// Whites of the stored thumbnails, cd/m^2; no value if one of them is missing.
std::optional<std::vector<double>> stored_whites(const CameraWork& work,
                                                 const std::vector<std::size_t>& conditions) {
  const PictureTask& task = work.pictures();
  std::string said;
  const auto facts =
      ResultCache(task.folder / points_folder).find_facts(key_of(work, conditions), said);
  if (!facts || facts->value("bytes", Json()) != bytes_of_all(task, conditions)) return {};
  const Json whites = facts->value("whites", Json());
  const bool sound =
      whites.is_array() && whites.size() == conditions.size() &&
      std::ranges::all_of(whites, [](const Json& white) { return white.is_number(); });
  if (!sound) return {};
  return whites.get<std::vector<double>>();
}

bool misses_one(const std::vector<TargetFindings>& targets) {
  return std::any_of(targets.begin(), targets.end(), [](const TargetFindings& target) {
    const studies::Verdict verdict = target.sight.verdict;
    return verdict == studies::Verdict::Doubtful || verdict == studies::Verdict::NotSeen;
  });
}

}  // namespace

std::vector<std::size_t> pictured_conditions(const StudyPart& part, const Judged& judged) {
  std::vector<std::size_t> pictured;
  const std::size_t places = part.basis->places().size();
  const bool along = part.positions_deg.size() > 1;
  const std::size_t noon = along ? nearest_place(part.positions_deg, 0.0) : 0;
  const std::size_t midnight = along ? nearest_place(part.positions_deg, 180.0) : 0;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    const std::size_t place = k % places;
    if (!judged[k]) continue;
    if (!along || place == 0 || place == noon || place == midnight || !judged[k - 1] ||
        !same_verdicts(*judged[k], *judged[k - 1]) ||
        (judged.size() <= most_pictured && misses_one(*judged[k]))) {
      pictured.push_back(k);
    }
  }
  return pictured;
}

bool thumbnails_are_there(const CameraWork& work, const Judged& judged) {
  return stored_whites(work, pictured_conditions(work.pictures().part, judged)).has_value();
}

std::vector<ThumbnailEntry> draw_thumbnails(const CameraWork& work, const studies::BasisView* view,
                                            const Judged& judged) {
  const PictureTask& task = work.pictures();
  const std::vector<std::size_t> conditions = pictured_conditions(task.part, judged);
  std::optional<std::vector<double>> stored = stored_whites(work, conditions);
  const bool draws = view != nullptr && !stored;
  std::vector<double> whites = stored ? std::move(*stored) : std::vector<double>(conditions.size());
  if (draws) {
    base::parallel_chunks(conditions.size(), 1, [&](std::size_t k, std::size_t) {
      whites[k] = draw_small(task, *view, conditions[k]);
    });
    ResultCache(task.folder / points_folder)
        .keep_facts(key_of(work, conditions),
                    {{"bytes", bytes_of_all(task, conditions)}, {"whites", whites}});
  }
  std::vector<ThumbnailEntry> thumbnails;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const std::vector<std::string> files = files_of(task, conditions[k]);
    thumbnails.push_back({conditions[k], 0, files.front(),
                          task.camera.cctv ? files.back() : std::string(), whites[k]});
  }
  return thumbnails;
}

}  // namespace earthshine::app
