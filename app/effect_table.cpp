// SPDX-License-Identifier: Apache-2.0
#include "app/effect_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cctv_plan.h"

namespace earthshine::app {
namespace {

// A stage runs where one of the cameras needs it; the first that does gives the reason.
void add_cctv_rows(Json& rows, const LoadedScene& loaded, const RenderCall& call,
                   const scenes::Asked& asked) {
  Json stages = Json::array();
  for (const scenes::Camera* camera : asked.cameras) {
    Json planned = plan_cctv(loaded.scene, *camera, !call.cctv.empty());
    if (stages.empty()) {
      stages = std::move(planned);
      continue;
    }
    for (std::size_t k = 0; k < planned.size(); ++k) {
      if (planned[k]["runs"].get<bool>() && !stages[k]["runs"].get<bool>()) stages[k] = planned[k];
    }
  }
  for (const Json& stage : stages) {
    rows.push_back({{"effect", "cctv: " + stage["stage"].get<std::string>()},
                    {"runs", stage["runs"]},
                    {"why", stage["why"]}});
  }
}

}  // namespace

Json effect_rows(const LoadedScene& loaded, const RenderCall& call, const scenes::Asked& asked) {
  Json rows = Json::array();
  for (const auto& row : scenes::describe_effects(loaded.scene, loaded.groups, asked)) {
    rows.push_back({{"effect", row.effect}, {"runs", row.runs}, {"why", row.reason}});
  }
  add_cctv_rows(rows, loaded, call, asked);
  return rows;
}

std::string effect_text(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    text += fmt::format("  {:<4} {:<20} {}\n", row["runs"].get<bool>() ? "yes" : "no",
                        row["effect"].get<std::string>(), row["why"].get<std::string>());
  }
  return text;
}

}  // namespace earthshine::app
