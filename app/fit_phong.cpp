// SPDX-License-Identifier: Apache-2.0
// earthshine fit-phong: k_d, k_s and n from measured reflectance.
#include <fmt/format.h>

#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "scenes/phong_fit.h"

namespace earthshine::app {
namespace {

struct FitCall {
  std::string path;
  bool json = false;
};

Json json_of(const scenes::PhongFit& fit) {
  return {{"diffuse", fit.diffuse},         {"specular", fit.specular},
          {"shininess", fit.shininess},     {"residual", fit.residual},
          {"points_used", fit.points_used}, {"reflected_share", scenes::reflected_share(fit)}};
}

std::string text_of(const scenes::PhongFits& fits, std::size_t point_count) {
  std::string text = fmt::format("{} points; R = k_d + k_s cos^n(angle)\n\n", point_count);
  text += fmt::format("{:<14} {:>10} {:>10} {:>10} {:>14} {:>18}\n", "method", "k_d", "k_s", "n",
                      "RMS residual", "k_d + 2 k_s/(n+2)");
  const auto row = [&text](const char* name, const scenes::PhongFit& fit) {
    text +=
        fmt::format("{:<14} {:>10.5f} {:>10.5f} {:>10.3f} {:>14.3g} {:>18.5f}\n", name, fit.diffuse,
                    fit.specular, fit.shininess, fit.residual, scenes::reflected_share(fit));
  };
  row("1990 report", fits.report);
  row("least squares", fits.least_squares);
  for (const std::string& line : fits.notes) text += "note: " + line + "\n";
  return text;
}

}  // namespace

Command add_fit_phong(CLI::App& program) {
  CLI::App* parser = program.add_subcommand(
      "fit-phong", "Phong's k_d, k_s and n from measured reflectance against off-specular angle");
  const auto call = std::make_shared<FitCall>();
  parser->add_option("DATA", call->path, "CSV file: angle in degrees, reflectance factor")
      ->required()
      ->type_name("");
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common&) {
            const auto points = scenes::read_reflectance(call->path);
            const scenes::PhongFits fits = scenes::fit_phong(points, call->path);
            if (!call->json) return print(text_of(fits, points.size()));
            print(dump({{"points", points.size()},
                        {"report", json_of(fits.report)},
                        {"least_squares", json_of(fits.least_squares)},
                        {"notes", fits.notes}}));
          }};
}

}  // namespace earthshine::app
