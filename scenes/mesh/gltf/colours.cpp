// SPDX-License-Identifier: Apache-2.0
// Vertex colours (COLOR_0) multiply the base colour of a primitive's material (glTF 2.0, 3.9.2). If
// they are all equal, they make a variant of the material; otherwise they are stored in
// Mesh::colours.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "scenes/mesh/gltf/materials.h"

namespace earthshine::scenes {
namespace {

constexpr const char* default_material = "glTF default";

// Weighted by triangle area; for strips and fans the mean over vertices.
glm::dvec4 mean_colour(const GltfModel& model, const tinygltf::Primitive& primitive,
                       const std::vector<glm::dvec4>& colours, const std::filesystem::path& path) {
  glm::dvec4 sum(0.0), plain(0.0);
  double all = 0.0;
  for (const glm::dvec4& colour : colours) plain += colour / static_cast<double>(colours.size());
  const auto position = primitive.attributes.find("POSITION");
  const bool has_triangles = primitive.mode == -1 || primitive.mode == TINYGLTF_MODE_TRIANGLES;
  if (!has_triangles || position == primitive.attributes.end()) return plain;
  const auto places = read_gltf_vectors(model, position->second, 3, "POSITION", path);
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_gltf_indices(model, primitive.indices, path);
  } else {
    for (std::uint32_t i = 0; i < places.size(); ++i) corners.push_back(i);
  }
  const std::size_t count = std::min(places.size(), colours.size());
  for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
    const std::uint32_t a = corners[i], b = corners[i + 1], c = corners[i + 2];
    if (std::max({a, b, c}) >= count) return plain;  // reported when it is used
    const double area = glm::length(glm::cross(places[b] - places[a], places[c] - places[a]));
    sum += area / 3.0 * (colours[a] + colours[b] + colours[c]);
    all += area;
  }
  return all > 0.0 ? sum / all : plain;
}

// Materials of a model in the colours of its primitives.
class Wardrobe {
 public:
  Wardrobe(GltfModel& model, GltfTextures& textures, const std::filesystem::path& path)
      : model_(model), textures_(textures), path_(path) {
    for (const tinygltf::Mesh& mesh : model.file.meshes) {
      const bool any = std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                                   [](const auto& primitive) { return primitive.material < 0; });
      if (any && default_number_ == no_index) add_default();
    }
    std::vector<WantedTexture> wanted;
    for (const tinygltf::Material& source : model.file.materials) {
      const auto more = textures_of(source);
      wanted.insert(wanted.end(), more.begin(), more.end());
    }
    textures.prepare(wanted);
    for (const tinygltf::Material& source : model.file.materials) {
      add(phong_material(source, {}, textures), no_index);
    }
  }

  std::uint32_t worn_by(const tinygltf::Primitive& primitive) {
    const std::uint32_t material =
        primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material) : default_number_;
    if (material >= model_.file.materials.size()) return no_index;  // reported when it is used
    std::vector<glm::dvec4> colours = read_gltf_colours(model_, primitive, path_);
    if (colours.empty()) return material;
    const tinygltf::Material& source = model_.file.materials[material];
    if (source.alphaMode != "BLEND" && source.alphaMode != "MASK") {
      for (glm::dvec4& colour : colours) colour.a = 1.0;
    }
    VertexColours worn{colours.front(), false};
    worn.vary = std::any_of(colours.begin(), colours.end(),
                            [&](const glm::dvec4& colour) { return colour != colours.front(); });
    if (worn.vary) worn.mean = mean_colour(model_, primitive, colours, path_);
    if (!worn.vary && worn.mean == glm::dvec4(1.0)) return material;
    const glm::dvec4& m = worn.mean;
    const auto [entry, fresh] = variants_.emplace(
        std::tuple(material, worn.vary, m.r, m.g, m.b, m.a), static_cast<std::uint32_t>(0));
    if (fresh) entry->second = add_variant(material, worn);
    return entry->second;
  }

 private:
  // Default material of primitives without a material (glTF 2.0, 3.9.6).
  void add_default() {
    default_number_ = static_cast<std::uint32_t>(model_.file.materials.size());
    model_.file.materials.emplace_back();
    model_.file.materials.back().name = default_material;
  }

  std::uint32_t add_variant(std::uint32_t material, const VertexColours& worn) {
    GltfMaterial made = phong_material(model_.file.materials[material], worn, textures_);
    const glm::dvec4& m = worn.mean;
    made.material.name =
        fmt::format("{} {:.3g} {:.3g} {:.3g}", worn.vary ? "vertex colours, mean" : "vertex colour",
                    m.r, m.g, m.b);
    add(std::move(made), material);
    return static_cast<std::uint32_t>(model_.materials.size() - 1);
  }

  void add(GltfMaterial made, std::uint32_t variant_of) {
    model_.materials.push_back(std::move(made.material));
    model_.coordinates.push_back(made.coordinates);
    model_.unsupported_of_material.push_back(std::move(made.unsupported));
    model_.variant_of.push_back(variant_of);
  }

  GltfModel& model_;
  GltfTextures& textures_;
  const std::filesystem::path& path_;
  std::uint32_t default_number_ = no_index;
  std::map<std::tuple<std::uint32_t, bool, double, double, double, double>, std::uint32_t>
      variants_;
};

}  // namespace

std::vector<glm::dvec4> read_gltf_colours(const GltfModel& model,
                                          const tinygltf::Primitive& primitive,
                                          const std::filesystem::path& path) {
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end() || found->second < 0) return {};
  auto colours = read_gltf_fours(model, found->second, {"COLOR_0", 3, 4, true}, path);
  for (glm::dvec4& colour : colours) colour = glm::clamp(colour, 0.0, 1.0);
  return colours;
}

void find_worn_materials(GltfModel& model, GltfTextures& textures,
                         const std::filesystem::path& path) {
  Wardrobe wardrobe(model, textures, path);
  for (const tinygltf::Mesh& mesh : model.file.meshes) {
    model.worn.emplace_back();
    for (const auto& primitive : mesh.primitives) {
      model.worn.back().push_back(wardrobe.worn_by(primitive));
    }
  }
}

}  // namespace earthshine::scenes
