// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/materials.h"

#include "scenes/mesh/gltf/textures.h"
#include "scenes/reflect/specular.h"

namespace earthshine::scenes {
namespace {

constexpr double strongest = 1e12;         // emission, cd/m^2
constexpr double blurred_through = 0.1;    // roughness from which glass is not clear
constexpr double largest_gltf_ior = 10.0;  // as materials of a scene file

// What both of glTF's models come down to.
struct Facets {
  Rgb base{1.0};    // of the diffuse light and of metal
  Rgb passed{1.0};  // the same where a texture is only known by its mean
  TextureSlot colour;
  double alpha = 1.0;
  double metallic = 0.0;
  double roughness = 1.0;
  Rgb dielectric{0.04};  // reflectance at normal incidence of what is no metal
};

Facets metallic_roughness(const tinygltf::Material& source, GltfTextures& textures) {
  const auto& pbr = source.pbrMetallicRoughness;
  Facets facets;
  facets.colour = slot_of(pbr.baseColorTexture);
  facets.base = colour_of(pbr.baseColorFactor, 1.0);
  if (pbr.baseColorFactor.size() > 3) facets.alpha = in_range(pbr.baseColorFactor[3]);
  facets.metallic = in_range(pbr.metallicFactor);
  facets.roughness = in_range(pbr.roughnessFactor);
  if (const TextureMap map = textures.read(slot_of(pbr.metallicRoughnessTexture), false);
      map.texture) {
    facets.roughness *= map.texture->mean().g;
    facets.metallic *= map.texture->mean().b;
  }
  const double ior = number_of(extension_of(source.extensions, "KHR_materials_ior"), "ior", 1.5);
  // An index of 0 stands for a mirror by the extension's text.
  const double root = ior <= 0.0 ? 1.0 : (ior - 1.0) / (ior + 1.0);
  const tinygltf::Value specular = extension_of(source.extensions, "KHR_materials_specular");
  const Rgb tint = colour_of(numbers_of(specular, "specularColorFactor"), 1.0, 1e3);
  facets.dielectric =
      in_range(number_of(specular, "specularFactor", 1.0)) * glm::min(root * root * tint, Rgb(1.0));
  return facets;
}

Facets specular_glossiness(const tinygltf::Value& source) {
  Facets facets;
  facets.colour = slot_of(source, "diffuseTexture");
  const std::vector<double> diffuse = numbers_of(source, "diffuseFactor");
  facets.base = colour_of(diffuse, 1.0);
  if (diffuse.size() > 3) facets.alpha = in_range(diffuse[3]);
  facets.roughness = 1.0 - in_range(number_of(source, "glossinessFactor", 1.0));
  facets.dielectric = colour_of(numbers_of(source, "specularFactor"), 1.0);
  return facets;
}

// k_d, and the highlight as a lobe or a mirror.
void reflect(const Facets& facets, Material& material) {
  const bool mirror = facets.roughness < mirror_roughness;
  const PhongLobe lobe = mirror ? PhongLobe() : phong_of_ggx(facets.roughness * facets.roughness);
  const double plain = 1.0 - facets.metallic;
  Rgb facet = plain * facets.dielectric;
  material.diffuse = plain * facets.base;
  if (!mirror && base::max_component(facet) * lobe.peak < least_highlight) {
    facet = Rgb(0.0);
  } else {
    material.diffuse *= 1.0 - base::max_component(facets.dielectric);
  }
  facet += facets.metallic * facets.passed;
  if (mirror) {
    material.mirror = facet;
  } else if (base::max_component(facet) > 0.0) {
    material.specular = facet * lobe.peak;
    material.shininess = lobe.shininess;
  }
}

// The share `alpha` of the surface is there.
void thin_out(double alpha, Material& material) {
  for (Rgb* part : {&material.diffuse, &material.specular, &material.mirror, &material.transmit,
                    &material.emit}) {
    *part *= alpha;
  }
  material.transmit += Rgb(1.0 - alpha);
}

void count_unused(const tinygltf::Material& source, std::map<std::string, std::size_t>& unused) {
  if (source.normalTexture.index >= 0) ++unused["normal maps"];
  if (source.occlusionTexture.index >= 0) ++unused["occlusion maps"];
  if (source.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0) {
    ++unused["metallic-roughness maps, but for their means"];
  }
  for (const auto& [name, table] : source.extensions) {
    for (const std::string& key : table.IsObject() ? table.Keys() : std::vector<std::string>()) {
      if (key.ends_with("Texture") && key != "diffuseTexture") ++unused[key];
    }
  }
}

// The maps of the material; what only their means go into comes out of `facets`.
void texture(const tinygltf::Material& source, GltfTextures& textures, Facets& facets,
             GltfMaterial& made, std::map<std::string, std::size_t>& unused) {
  MaterialMaps maps;
  maps.diffuse = textures.read(facets.colour, true);
  const TextureSlot emission = slot_of(source.emissiveTexture);
  maps.emit = textures.read(emission, true);
  made.coordinates = maps.diffuse.texture ? facets.colour.coordinates : emission.coordinates;
  if (maps.emit.texture && emission.coordinates != made.coordinates) {
    maps.emit = {};
    ++unused["textures by a second set of coordinates"];
  }
  if (maps.diffuse.texture) {
    const glm::dvec4 mean = maps.diffuse.texture->mean();
    facets.passed *= Rgb(mean);
    if (source.alphaMode == "MASK") {
      maps.opacity = maps.diffuse;
      maps.cutoff = facets.alpha > 0.0 ? source.alphaCutoff / facets.alpha : 2.0;
      facets.alpha = 1.0;
    } else if (source.alphaMode == "BLEND" && mean.a < 1.0) {
      facets.alpha *= mean.a;
      ++unused["blended alpha of textures, but for its mean"];
    }
  }
  if (maps.diffuse.texture || maps.emit.texture) {
    made.material.maps = std::make_shared<const MaterialMaps>(maps);
  }
}

}  // namespace

GltfMaterial phong_material(const tinygltf::Material& source, GltfTextures& textures,
                            std::map<std::string, std::size_t>& unused) {
  GltfMaterial made;
  Material& material = made.material;
  material.name = source.name;
  material.two_sided = source.doubleSided;
  const auto& extensions = source.extensions;
  const tinygltf::Value glossy = extension_of(extensions, "KHR_materials_pbrSpecularGlossiness");
  Facets facets =
      glossy.IsObject() ? specular_glossiness(glossy) : metallic_roughness(source, textures);
  facets.passed = facets.base;
  texture(source, textures, facets, made, unused);
  count_unused(source, unused);
  if (extensions.count("KHR_materials_unlit") > 0) {
    material.diffuse = facets.base;
    ++unused["unlit materials, taken as diffuse"];
  } else {
    reflect(facets, material);
  }
  const tinygltf::Value passing = extension_of(extensions, "KHR_materials_transmission");
  const double passed = in_range(number_of(passing, "transmissionFactor", 0.0));
  if (passed > 0.0 && facets.metallic < 1.0) {
    material.transmit = passed * (1.0 - facets.metallic) * facets.passed *
                        (1.0 - base::max_component(facets.dielectric));
    material.diffuse *= 1.0 - passed;
    // Without a thickness it is a sheet, and sheets do not bend light.
    const tinygltf::Value volume = extension_of(extensions, "KHR_materials_volume");
    if (number_of(volume, "thicknessFactor", 0.0) > 0.0) {
      const tinygltf::Value bends = extension_of(extensions, "KHR_materials_ior");
      material.ior = std::clamp(number_of(bends, "ior", 1.5), 1.0, largest_gltf_ior);
    }
    if (facets.roughness > blurred_through) ++unused["rough glass, taken as clear"];
  }
  // The emissive factor is radiance, in cd/m^2 with the extension; a diffuse emitter's exitance is
  // pi times that.
  const tinygltf::Value strength = extension_of(extensions, "KHR_materials_emissive_strength");
  material.emit = base::pi * colour_of(source.emissiveFactor, 0.0) *
                  in_range(number_of(strength, "emissiveStrength", 1.0), strongest);
  if (source.alphaMode == "BLEND") thin_out(facets.alpha, material);
  if (source.alphaMode == "MASK" && facets.alpha < source.alphaCutoff) thin_out(0.0, material);
  return made;
}

}  // namespace earthshine::scenes
