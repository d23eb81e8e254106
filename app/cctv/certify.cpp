// SPDX-License-Identifier: Apache-2.0
// earthshine degrade certify: a camera's certificate as a datasheet or as JSON.
#include <fmt/format.h>

#include <memory>

#include "app/cctv/degrade_list.h"
#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "degrade/certify/certificate.h"
#include "degrade/parts/noise.h"

namespace earthshine::app {
namespace {

struct CertifyCall {
  std::string camera, output;
  bool json = false;
};

using degrade::Certificate;
using degrade::CertificateRow;
using degrade::Verdict;

Json row_json(const CertificateRow& row) {
  Json json = {{"group", row.group},
               {"name", row.name},
               {"unit", row.unit},
               {"verdict", degrade::word_of(row.verdict)}};
  if (row.verdict == Verdict::DoesNotApply) {
    json["why"] = row.why;
    return json;
  }
  json["measured"] = row.measured;
  json["expected"] = row.expected;
  json["tolerance"] = row.tolerance;
  json["four_standard_errors"] = row.statistical;
  json["law"] = row.law;
  return json;
}

Json json_of(const std::string& camera, const Certificate& certificate, std::uint64_t seed) {
  Json rows = Json::array(), transfer = Json::array(), sharpness = Json::array();
  for (const CertificateRow& row : certificate.rows) rows.push_back(row_json(row));
  for (const degrade::TransferPoint& point : certificate.photon_transfer) {
    transfer.push_back({{"signal", point.signal},
                        {"mean", point.mean},
                        {"variance_in_time", point.in_time},
                        {"variance_in_space", point.in_space},
                        {"law_in_time", point.law_in_time},
                        {"law_in_space", point.law_in_space}});
  }
  for (const degrade::SharpnessPoint& point : certificate.sharpness) {
    sharpness.push_back({{"cycles_per_resel", point.frequency},
                         {"along", point.along},
                         {"across", point.across},
                         {"law_along", point.law_along},
                         {"law_across", point.law_across}});
  }
  return {{"camera", camera},
          {"version", EARTHSHINE_VERSION},
          {"seed", seed},
          {"passed", certificate.passed()},
          {"pass", certificate.count(Verdict::Pass)},
          {"fail", certificate.count(Verdict::Fail)},
          {"does_not_apply", certificate.count(Verdict::DoesNotApply)},
          {"rows", rows},
          {"photon_transfer", transfer},
          {"mtf", sharpness}};
}

std::string verdict_line(const std::string& camera, const Certificate& certificate) {
  return fmt::format("{}: {} pass, {} fail, {} do not apply", camera,
                     certificate.count(Verdict::Pass), certificate.count(Verdict::Fail),
                     certificate.count(Verdict::DoesNotApply));
}

std::string text_of(const std::string& camera, const degrade::CctvCamera& settings,
                    const Certificate& certificate, std::uint64_t seed) {
  std::string text = fmt::format("certificate of {}, earthshine {}, seed {}\nnoise: {}\n", camera,
                                 EARTHSHINE_VERSION, seed, degrade::describe_noise(settings));
  std::string group;
  for (const CertificateRow& row : certificate.rows) {
    if (row.group != group) {
      group = row.group;
      text +=
          fmt::format("\n{}\n  {:<66}{:>11} {:>11}  {:>10}\n", group, "", "measured", "+-", "law");
    }
    if (row.verdict == Verdict::DoesNotApply) {
      text += fmt::format("  -    {:<60} does not apply: {}\n", row.name, row.why);
      continue;
    }
    text += fmt::format("  {} {:<60} {:>11.5g} {:>11.2g}{} {:>10.5g}  {}\n",
                        row.verdict == Verdict::Pass ? "pass" : "FAIL", row.name, row.measured,
                        row.tolerance, row.statistical ? "*" : " ", row.expected, row.unit);
  }
  return text + "\n* four standard errors of this measurement; the rest is rounding or method\n" +
         verdict_line(camera, certificate) + "\n";
}

void run(const CertifyCall& call, const Common& common) {
  if (!call.output.empty()) check_outputs({call.output}, {file_of_camera(call.camera)});
  const degrade::ResolvedCamera found = camera_of_argument("CAMERA", call.camera);
  const Certificate certificate =
      degrade::certify(found.camera, found.monitor, {.seed = common.seed});
  const Json json = json_of(found.name, certificate, common.seed);
  if (!call.output.empty()) base::write_text(call.output, dump(json));
  print(call.json ? dump(json) : text_of(found.name, found.camera, certificate, common.seed));
  if (!certificate.passed()) {
    throw base::Error(
        base::Blame::Work, found.name,
        fmt::format("{} of {} measurements miss their law: {}", certificate.count(Verdict::Fail),
                    certificate.count(Verdict::Fail) + certificate.count(Verdict::Pass),
                    certificate.failures()));
  }
}

}  // namespace

Command add_certify(CLI::App& degrade) {
  CLI::App* parser = add_subcommand(
      degrade, "certify",
      "Measures a camera on a bench of charts: a datasheet, each number beside its law");
  const auto call = std::make_shared<CertifyCall>();
  parser
      ->add_option("CAMERA", call->camera,
                   "CCTV camera: one that ships (see degrade --list), FILE.toml or FILE.toml:NAME")
      ->type_name("")
      ->required();
  parser->add_option("-o,--output", call->output, "Also write the JSON to a file")
      ->type_name("FILE");
  parser->add_flag("--json", call->json, "Datasheet as JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
