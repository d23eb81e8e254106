// SPDX-License-Identifier: Apache-2.0
// `earthshine view`: a page that shows the layers of an EXR file, or the surfaces of a solution,
// and needs no network. Values are
// packed as half floats (app/console/pack.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/console/assets.h"
#include "app/console/pack.h"
#include "app/console/page.h"
#include "app/console/view_solution.h"
#include "app/options.h"
#include "app/output.h"
#include "app/report/text.h"
#include "base/files/exr_file.h"
#include "base/files/output_file.h"

namespace earthshine::app {
namespace {

struct ViewCall {
  std::string input, output;
};

// Channels R, G and B, or X, Y and Z, of one prefix; or one channel.
struct ViewLayer {
  std::string name;
  std::vector<const base::Channel*> channels;
  bool has_luminance = false;
};

std::vector<ViewLayer> layers_of(const base::Image& image) {
  std::vector<ViewLayer> layers;
  const auto add = [&](const std::string& prefix, const std::string& letters,
                       const std::string& name) {
    std::vector<const base::Channel*> found;
    for (const char letter : letters) {
      const base::Channel* channel = image.find(prefix + letter);
      if (channel == nullptr) return false;
      found.push_back(channel);
    }
    const bool is_new =
        std::ranges::none_of(layers, [&](const ViewLayer& one) { return one.name == name; });
    if (is_new) layers.push_back({name, found, letters != "XYZ"});
    return true;
  };
  add("", "RGB", "picture");
  for (const base::Channel& channel : image.channels) {
    const std::size_t dot = channel.name.rfind('.');
    const std::string prefix = dot == std::string::npos ? "" : channel.name.substr(0, dot + 1);
    const std::string name = prefix.empty() ? "picture" : prefix.substr(0, dot);
    const std::string last = channel.name.substr(prefix.size());
    if (std::string("RGB").find(last) != std::string::npos && add(prefix, "RGB", name)) continue;
    if (std::string("XYZ").find(last) != std::string::npos && !prefix.empty() &&
        add(prefix, "XYZ", name)) {
      continue;
    }
    layers.push_back({channel.name, {&channel}, channel.name == "Y"});
  }
  return layers;
}

std::string unit_of(const ViewLayer& layer) {
  if (layer.name == "Z" || layer.name == "range" || layer.name == "P") return "m";
  if (!layer.has_luminance || layer.name == "albedo" || layer.name == "error") return "";
  return "cd/m²";
}

// A list of names in the header, such as the objects that the layer "object" numbers.
Json names_for(const ViewLayer& layer, const base::ExrHeader& header) {
  for (const auto& [key, text] : header.text) {
    if (key != "earthshine:" + layer.name + "s") continue;
    const Json names = Json::parse(text, nullptr, false);
    if (names.is_array()) return names;
  }
  return Json::array();
}

class ViewPage {
 public:
  explicit ViewPage(const base::ExrFile& file, const std::string& path)
      : file_(file), title_(std::filesystem::path(path).filename().string()) {
    data_ = {{"name", title_},           {"columns", file.image.width}, {"rows", file.image.height},
             {"x", file.header.whole.x}, {"y", file.header.whole.y},    {"layers", Json::array()},
             {"facts", Json::array()}};
    for (const auto& [key, text] : file.header.text) {
      if (text.size() <= longest_fact) data_["facts"].push_back({key, text});
    }
    for (const auto& [key, number] : file.header.numbers) {
      data_["facts"].push_back({key, fmt::format("{:.6g}", number)});
    }
    for (const ViewLayer& layer : layers_of(file.image)) add(layer);
  }

  [[nodiscard]] std::string html() const {
    return page_of({title_, std::string(console_style()) + std::string(view_style()), view_body(),
                    view_script(), view_script_hash()},
                   data_, blobs_);
  }

 private:
  static constexpr std::size_t longest_fact = 400;

  void add(const ViewLayer& layer) {
    std::vector<std::uint32_t> none;
    std::vector<std::vector<float>> planes;
    for (const base::Channel* channel : layer.channels) planes.push_back(channel->values);
    for (std::size_t i = 0; i < planes.front().size(); ++i) {
      const bool is_finite = std::ranges::all_of(
          planes, [&](const std::vector<float>& plane) { return std::isfinite(plane[i]); });
      if (is_finite) continue;
      none.push_back(static_cast<std::uint32_t>(i));
      for (std::vector<float>& plane : planes) plane[i] = 0.0F;
    }
    const auto plane = [&](std::size_t c) -> const std::vector<float>& {
      return planes[std::min(c, planes.size() - 1)];
    };
    const PackedLayer packed = pack_layer(plane(0), plane(1), plane(2), file_.image.width);
    Json channels = Json::array();
    for (const base::Channel* channel : layer.channels) channels.push_back(channel->name);
    data_["layers"].push_back({{"name", layer.name},
                               {"unit", unit_of(layer)},
                               {"channels", channels},
                               {"names", names_for(layer, file_.header)},
                               {"exponent", packed.exponent},
                               {"data", stored(packed.bytes)},
                               {"none", none.empty() ? "" : stored(pack_runs(none))}});
  }

  std::string stored(const std::string& bytes) {
    if (bytes.empty()) return {};
    blobs_.push_back(base64(bytes));
    return fmt::format("b{}", blobs_.size() - 1);
  }

  const base::ExrFile& file_;
  std::string title_;
  Json data_;
  std::vector<std::string> blobs_;
};

void run(const ViewCall& call, const Common& common) {
  const std::string output =
      call.output.empty() ? std::filesystem::path(call.input).replace_extension(".html").string()
                          : call.output;
  check_outputs({output}, {call.input});
  refuse_other_kind("-o", output, {".html"});
  if (call.input.ends_with(".h5")) {
    const SolutionPage page = solution_page(call.input);
    base::write_text(output, page.html);
    if (common.quiet) return;
    return note(fmt::format("{}: {} patches, {} layers, {:.1f} MB", output, page.patches,
                            page.layers, static_cast<double>(page.html.size()) / 1e6));
  }
  const base::ExrFile file = base::read_exr(call.input);
  const std::string page = ViewPage(file, call.input).html();
  base::write_text(output, page);
  if (common.quiet) return;
  note(fmt::format("{}: {} layers, {:.1f} MB", output, layers_of(file.image).size(),
                   static_cast<double>(page.size()) / 1e6));
}

}  // namespace

Command add_view(CLI::App& program) {
  CLI::App* parser = add_subcommand(
      program, "view", "A picture or a solution as one HTML page: layers, false colours, values");
  const auto call = std::make_shared<ViewCall>();
  parser->add_option("FILE", call->input, "EXR file, or HDF5 file of a solution")
      ->required()
      ->type_name("");
  parser->add_option("-o,--output", call->output, "Page to write; without it FILE.html")
      ->type_name("OUT.html");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
