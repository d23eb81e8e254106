// SPDX-License-Identifier: Apache-2.0
// earthshine fit-phong: fits k_d, k_s and n to measured reflectance.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "scenes/reflect/phong_fit.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

struct FitCall {
  std::string path;
  scenes::ReflectanceNoise noise = scenes::ReflectanceNoise::Proportional;
  bool json = false;
};

const char* name_of(scenes::ReflectanceNoise noise) {
  return noise == scenes::ReflectanceNoise::Constant ? "constant" : "proportional";
}

Json json_of(const scenes::PhongFit& fit) {
  return {{"diffuse", fit.diffuse},
          {"specular", fit.specular},
          {"shininess", fit.shininess},
          {"std_error",
           {{"diffuse", to_json(fit.std_error.diffuse)},
            {"specular", to_json(fit.std_error.specular)},
            {"shininess", to_json(fit.std_error.shininess)}}},
          {"residual", fit.residual},
          {"points_used", fit.points_used},
          {"reflected_share", scenes::reflected_share(fit)}};
}

std::string with_error(double value, const std::optional<double>& error) {
  return fmt::format("{:.5g} ± {}", value, error ? fmt::format("{:.2g}", *error) : "?");
}

std::string text_of(const scenes::PhongFits& fits, scenes::ReflectanceNoise noise,
                    std::size_t point_count) {
  std::string text = fmt::format("{} points; R = k_d + k_s cos^n(angle)", point_count);
  if (fits.noise) {
    text += noise == scenes::ReflectanceNoise::Constant
                ? fmt::format("; noise {:.2g}, the same everywhere", *fits.noise)
                : fmt::format("; noise {} of R", scenes::percent(*fits.noise));
  }
  text += fmt::format("\n\n{:<14} {:>20} {:>20} {:>20} {:>13} {:>18}\n", "method", "k_d", "k_s",
                      "n", "RMS residual", "k_d + 2 k_s/(n+2)");
  const auto row = [&text](const char* name, const scenes::PhongFit& fit) {
    text += fmt::format("{:<14} {:>20} {:>20} {:>20} {:>13.3g} {:>18.5f}\n", name,
                        with_error(fit.diffuse, fit.std_error.diffuse),
                        with_error(fit.specular, fit.std_error.specular),
                        with_error(fit.shininess, fit.std_error.shininess), fit.residual,
                        scenes::reflected_share(fit));
  };
  row("1990 report", fits.report);
  row("least squares", fits.least_squares);
  for (const std::string& line : fits.notes) text += "note: " + line + "\n";
  return text;
}

}  // namespace

Command add_fit_phong(CLI::App& program) {
  CLI::App* parser =
      add_subcommand(program, "fit-phong",
                     "Phong's k_d, k_s and n from measured reflectance against off-specular angle");
  const auto call = std::make_shared<FitCall>();
  parser->add_option("DATA", call->path, "CSV file: angle in degrees, reflectance factor")
      ->required()
      ->type_name("");
  parser
      ->add_option_function<std::string>(
          "--noise",
          [call](const std::string& text) {
            for (const auto noise :
                 {scenes::ReflectanceNoise::Proportional, scenes::ReflectanceNoise::Constant}) {
              if (text == name_of(noise)) {
                call->noise = noise;
                return;
              }
            }
            throw CLI::ValidationError("--noise",
                                       "\"" + text + "\" is not one of proportional, constant");
          },
          "How far a point may be off: a share of R (proportional, default) or the same everywhere "
          "(constant)")
      ->type_name("HOW");
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {
      parser, [call](const Common&) {
        const auto points = scenes::read_reflectance(call->path);
        const scenes::PhongFits fits = scenes::fit_phong(points, call->path, call->noise);
        if (!call->json) return print(text_of(fits, call->noise, points.size()));
        print(dump({{"points", points.size()},
                    {"noise", {{"model", name_of(call->noise)}, {"level", to_json(fits.noise)}}},
                    {"report", json_of(fits.report)},
                    {"least_squares", json_of(fits.least_squares)},
                    {"notes", fits.notes}}));
      }};
}

}  // namespace earthshine::app
