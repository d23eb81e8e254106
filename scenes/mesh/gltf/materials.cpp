// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "scenes/mesh/gltf/textures.h"
#include "scenes/reflect/ggx_lobes.h"

namespace earthshine::scenes {
namespace {

constexpr double strongest = 1e12;         // emission, cd/m^2
constexpr double blurred_through = 0.1;    // roughness above which glass is not clear
constexpr double largest_gltf_ior = 10.0;  // as for materials of a scene file

// Common parameters of both glTF material models.
struct Facets {
  Rgb base{1.0};    // of the diffuse light and of metals
  Rgb passed{1.0};  // base with textures replaced by their means
  TextureSlot colour;
  double alpha = 1.0;
  double metallic = 0.0;
  double roughness = 1.0;
  Rgb dielectric{0.04};  // reflectance of non-metals at normal incidence
};

// Sets k_d, and the highlight as a lobe or a mirror.
void reflect(const Facets& facets, Material& material) {
  const bool mirror = facets.roughness < mirror_roughness;
  const double plain = 1.0 - facets.metallic;
  const Rgb metal = facets.metallic * facets.passed;
  const Rgb facet = plain * facets.dielectric;
  const double taken = base::max_component(facets.dielectric);  // subtracted from the diffuse light
  if (mirror) {
    material.diffuse = plain * facets.base * (1.0 - taken);
    material.mirror = facet + metal;
    return;
  }
  const PhongLobe lobe = phong_of_ggx(facets.roughness * facets.roughness);
  // A negligible highlight changes nothing.
  const double peak = base::max_component(facet) * lobe.peak;
  const double in_lobe = lobe.albedo() / (lobe.albedo() + lobe.diffuse);
  const double kept = std::clamp(peak / least_highlight - 1.0, 0.0, 1.0);
  material.diffuse =
      facets.base * (plain * (1.0 - taken * kept * in_lobe) + facets.metallic * lobe.diffuse);
  // Diffuse part of rough facets, for dark materials without a diffuse part. It is negligible for
  // dielectrics (0.04).
  constexpr double next_to_nothing = 0.04;
  const double counts = std::clamp(taken / next_to_nothing - 1.0, 0.0, 1.0);
  const Rgb in_diffuse = facets.base * (plain * taken * (1.0 - kept * in_lobe));
  material.diffuse += counts * glm::max(Rgb(0.0), facet * lobe.diffuse - in_diffuse);
  material.specular = (kept * facet + metal) * lobe.peak;
  if (!(base::max_component(material.specular) > 0.0)) return;
  material.shininess = lobe.shininess;
  material.even_lobe = true;
}

// Scales the material by its coverage `alpha`.
void thin_out(double alpha, Material& material) {
  for (Rgb* part : {&material.diffuse, &material.specular, &material.mirror, &material.transmit,
                    &material.emit}) {
    *part *= alpha;
  }
  material.transmit += Rgb(1.0 - alpha);
}

// Converts one source material.
class Converter {
 public:
  Converter(const tinygltf::Material& source, const VertexColours& colours, GltfTextures& textures)
      : source_(source), colours_(colours), textures_(textures) {}

  GltfMaterial convert() {
    Material& material = made_.material;
    material.name = source_.name;
    material.two_sided = source_.doubleSided;
    const tinygltf::Value glossy = extension("KHR_materials_pbrSpecularGlossiness");
    Facets facets = glossy.IsObject() ? specular_glossiness(glossy) : metallic_roughness();
    const Rgb colour(colours_.mean);
    facets.passed = facets.base * colour;
    if (!colours_.vary) facets.base *= colour;
    facets.alpha *= colours_.mean.a;
    texture(facets);
    name_unused();
    if (source_.extensions.count("KHR_materials_unlit") > 0) {
      material.diffuse = facets.base;
      add_unsupported("unlit materials, taken as diffuse");
    } else {
      reflect(facets, material);
    }
    pass(facets);
    // The emissive factor is radiance, in cd/m^2 with the extension; the exitance of a diffuse
    // emitter is pi times the radiance.
    const tinygltf::Value strength = extension("KHR_materials_emissive_strength");
    material.emit = base::pi * colour_of(source_.emissiveFactor, 0.0) *
                    in_range(number_of(strength, "emissiveStrength", 1.0), strongest);
    if (source_.alphaMode == "BLEND") thin_out(facets.alpha, material);
    if (source_.alphaMode == "MASK" && facets.alpha < source_.alphaCutoff) {
      thin_out(0.0, material);
    }
    return std::move(made_);
  }

 private:
  [[nodiscard]] tinygltf::Value extension(const char* name) const {
    return extension_of(source_.extensions, name);
  }

  void add_unsupported(std::string what) { made_.unsupported.push_back(std::move(what)); }

  // Mean of a texture that is used by its mean only; 1 without a texture.
  glm::dvec4 mean_of(const TextureSlot& slot, bool is_srgb, const char* what) {
    const TextureMap map = textures_.read(slot, is_srgb);
    if (!map.texture) return glm::dvec4(1.0);
    add_unsupported(fmt::format("{}, but for their means", what));
    return map.texture->mean();
  }

  Facets metallic_roughness() {
    const auto& pbr = source_.pbrMetallicRoughness;
    Facets facets;
    facets.colour = slot_of(pbr.baseColorTexture);
    facets.base = colour_of(pbr.baseColorFactor, 1.0);
    if (pbr.baseColorFactor.size() > 3) facets.alpha = in_range(pbr.baseColorFactor[3]);
    const glm::dvec4 mean =
        mean_of(slot_of(pbr.metallicRoughnessTexture), false, "metallic-roughness maps");
    facets.roughness = in_range(pbr.roughnessFactor) * mean.g;
    facets.metallic = in_range(pbr.metallicFactor) * mean.b;
    const double ior = number_of(extension("KHR_materials_ior"), "ior", 1.5);
    // By the extension's text, an index of 0 means a mirror.
    const double root = ior <= 0.0 ? 1.0 : (ior - 1.0) / (ior + 1.0);
    const tinygltf::Value specular = extension("KHR_materials_specular");
    const Rgb tint = colour_of(numbers_of(specular, "specularColorFactor"), 1.0, 1e3) *
                     Rgb(mean_of(slot_of(specular, "specularColorTexture"), true,
                                 "colour maps of specular light"));
    const double weight =
        in_range(number_of(specular, "specularFactor", 1.0)) *
        mean_of(slot_of(specular, "specularTexture"), false, "maps of specular light").a;
    facets.dielectric = weight * glm::min(root * root * tint, Rgb(1.0));
    return facets;
  }

  Facets specular_glossiness(const tinygltf::Value& source) {
    Facets facets;
    facets.colour = slot_of(source, "diffuseTexture");
    const std::vector<double> diffuse = numbers_of(source, "diffuseFactor");
    facets.base = colour_of(diffuse, 1.0);
    if (diffuse.size() > 3) facets.alpha = in_range(diffuse[3]);
    const glm::dvec4 mean =
        mean_of(slot_of(source, "specularGlossinessTexture"), true, "specular-glossiness maps");
    facets.roughness = 1.0 - in_range(number_of(source, "glossinessFactor", 1.0)) * mean.a;
    facets.dielectric = colour_of(numbers_of(source, "specularFactor"), 1.0) * Rgb(mean);
    return facets;
  }

  // The material's texture maps; parameters that use texture means are set in `facets`.
  void texture(Facets& facets) {
    MaterialMaps maps;
    maps.by_vertex = colours_.vary;
    maps.diffuse = textures_.read(facets.colour, true);
    const TextureSlot emission = slot_of(source_.emissiveTexture);
    maps.emit = textures_.read(emission, true);
    if (maps.diffuse.texture) made_.coordinates.first = facets.colour.coordinates;
    if (maps.emit.texture) {
      std::optional<int>& first = made_.coordinates.first;
      maps.emit.by_second = first && *first != emission.coordinates;
      (maps.emit.by_second ? made_.coordinates.second : first) = emission.coordinates;
    }
    if (maps.diffuse.texture) {
      const glm::dvec4 mean = maps.diffuse.texture->mean();
      facets.passed *= Rgb(mean);
      if (source_.alphaMode == "MASK") {
        maps.opacity = maps.diffuse;
        maps.cutoff = facets.alpha > 0.0 ? source_.alphaCutoff / facets.alpha : 2.0;
        facets.alpha = 1.0;
      } else if (source_.alphaMode == "BLEND" && mean.a < 1.0) {
        facets.alpha *= mean.a;
        add_unsupported("blended alpha of textures, but for its mean");
      }
    }
    if (maps.diffuse.texture || maps.emit.texture || maps.by_vertex) {
      made_.material.maps = std::make_shared<const MaterialMaps>(maps);
    }
  }

  // Transmission.
  void pass(const Facets& facets) {
    Material& material = made_.material;
    const tinygltf::Value passing = extension("KHR_materials_transmission");
    const double passed =
        in_range(number_of(passing, "transmissionFactor", 0.0)) *
        mean_of(slot_of(passing, "transmissionTexture"), false, "transmission maps").r;
    if (!(passed > 0.0) || facets.metallic >= 1.0) return;
    material.transmit = passed * (1.0 - facets.metallic) * facets.passed *
                        (1.0 - base::max_component(facets.dielectric));
    material.diffuse *= 1.0 - passed;
    // Without a thickness it is a sheet, and sheets do not refract.
    const tinygltf::Value volume = extension("KHR_materials_volume");
    if (number_of(volume, "thicknessFactor", 0.0) > 0.0) {
      material.ior =
          std::clamp(number_of(extension("KHR_materials_ior"), "ior", 1.5), 1.0, largest_gltf_ior);
      if (volume.Has("attenuationDistance"))
        add_unsupported("what glass takes away by its thickness");
    }
    if (facets.roughness > blurred_through) add_unsupported("rough glass, taken as clear");
  }

  void name_unused() {
    if (source_.normalTexture.index >= 0) add_unsupported("normal maps");
    for (const auto& [name, table] : source_.extensions) {
      if (!is_read_extension(name) && name != "KHR_materials_variants") add_unsupported(name);
    }
  }

  const tinygltf::Material& source_;
  const VertexColours& colours_;
  GltfTextures& textures_;
  GltfMaterial made_;
};

}  // namespace

std::vector<WantedTexture> textures_of(const tinygltf::Material& source) {
  const auto of = [&](const char* extension, const char* key) {
    return slot_of(extension_of(source.extensions, extension), key);
  };
  std::vector<WantedTexture> wanted{
      {slot_of(source.emissiveTexture), true},
      {of("KHR_materials_transmission", "transmissionTexture"), false}};
  constexpr const char* glossy = "KHR_materials_pbrSpecularGlossiness";
  if (source.extensions.count(glossy) > 0) {
    wanted.push_back({of(glossy, "diffuseTexture"), true});
    wanted.push_back({of(glossy, "specularGlossinessTexture"), true});
  } else {
    wanted.push_back({slot_of(source.pbrMetallicRoughness.baseColorTexture), true});
    wanted.push_back({slot_of(source.pbrMetallicRoughness.metallicRoughnessTexture), false});
    wanted.push_back({of("KHR_materials_specular", "specularTexture"), false});
    wanted.push_back({of("KHR_materials_specular", "specularColorTexture"), true});
  }
  return wanted;
}

GltfMaterial phong_material(const tinygltf::Material& source, const VertexColours& colours,
                            GltfTextures& textures) {
  return Converter(source, colours, textures).convert();
}

}  // namespace earthshine::scenes
