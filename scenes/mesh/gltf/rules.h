// SPDX-License-Identifier: Apache-2.0
// Allowed values of a glTF file: a table from glTF 2.0 and from the extensions that are read.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/units.h"
#include "scenes/text/table_reader.h"

namespace earthshine::scenes {

enum class GltfKind { Number, Whole, Entry, Word, Truth, Table, Tables, Texture };

struct GltfRule {
  std::string_view path;  // keys from the top, joined by '/', without list indices; '*': any prefix
  GltfKind kind;
  Range range = any_number;  // of each number
  std::size_t count = 0;     // of numbers; 0: no list
  // Replacement of numbers out of range, for the warning; empty: an error.
  std::string_view otherwise = {};
  // Word: the words; Whole: the numbers, if they are not a range; Entry: the top-level list that
  // the index refers to.
  std::string_view words = {};
};

inline constexpr std::size_t any_count = SIZE_MAX;  // a list, or a table, of any length

namespace gltf_rules {

using enum GltfKind;
constexpr Range whole{0.0, 2147483647.0};  // tinygltf stores 32 bits
constexpr Range length{-1e15, 1e15};
constexpr Range half_angle{0.0, base::pi / 2.0};
constexpr std::string_view none = "taken as none", brought = "the nearest allowed is taken",
                           repeated = "10497 is taken", wraps = "10497, 33071, 33648";

constexpr GltfRule all[] = {
    {"scene", Whole, whole, 0, none},
    {"scenes", Tables},
    {"scenes/nodes", Whole, whole, any_count},
    {"nodes", Tables},
    {"nodes/children", Whole, whole, any_count},
    {"nodes/mesh", Whole, whole, 0, none},
    {"nodes/camera", Whole, whole, 0, none},
    {"nodes/skin", Whole, whole, 0, none},
    {"nodes/weights", Number, length, any_count},
    {"nodes/matrix", Number, length, 16},
    {"nodes/translation", Number, length, 3},
    {"nodes/rotation", Number, length, 4},
    {"nodes/scale", Number, length, 3},
    {"nodes/extensions/KHR_lights_punctual", Table},
    {"nodes/extensions/KHR_lights_punctual/light", Whole, whole},
    {"meshes", Tables},
    {"nodes/extensions/EXT_mesh_gpu_instancing", Table},
    {"nodes/extensions/EXT_mesh_gpu_instancing/attributes", Whole, whole, any_count},
    {"meshes/weights", Number, length, any_count},
    {"meshes/primitives", Tables},
    {"meshes/primitives/attributes", Whole, whole, any_count},
    {"meshes/primitives/indices", Whole, whole, 0, none},
    {"meshes/primitives/material", Whole, whole, 0, none},
    {"meshes/primitives/mode", Whole, {0.0, 6.0}},
    {"meshes/primitives/targets", Tables},
    {"meshes/primitives/targets/POSITION", Whole, whole},
    {"meshes/primitives/targets/NORMAL", Whole, whole},
    {"skins", Tables},
    {"skins/inverseBindMatrices", Whole, whole, 0, none},
    {"skins/joints", Whole, whole, any_count},
    {"buffers", Tables},
    {"buffers/byteLength", Whole, whole},
    {"bufferViews", Tables},
    {"bufferViews/buffer", Whole, whole},
    {"bufferViews/byteOffset", Whole, whole},
    {"bufferViews/byteLength", Whole, whole},
    {"bufferViews/byteStride", Whole, {0.0, 252.0}},
    {"accessors", Tables},
    {"accessors/bufferView", Whole, whole},
    {"accessors/byteOffset", Whole, whole},
    {"accessors/componentType", Whole, whole},
    {"accessors/count", Whole, whole},
    {"accessors/normalized", Truth},
    {"accessors/sparse", Table},
    {"accessors/sparse/count", Whole, whole},
    {"accessors/sparse/indices", Table},
    {"accessors/sparse/indices/bufferView", Whole, whole},
    {"accessors/sparse/indices/byteOffset", Whole, whole},
    {"accessors/sparse/indices/componentType", Whole, whole},
    {"accessors/sparse/values", Table},
    {"accessors/sparse/values/bufferView", Whole, whole},
    {"accessors/sparse/values/byteOffset", Whole, whole},
    {"materials", Tables},
    {"materials/alphaMode", Word, {}, 0, {}, "OPAQUE, MASK, BLEND"},
    {"materials/alphaCutoff", Number, at_least_zero},
    {"materials/doubleSided", Truth},
    {"materials/emissiveFactor", Number, share, 3, brought},
    {"materials/pbrMetallicRoughness", Table},
    {"materials/pbrMetallicRoughness/baseColorFactor", Number, share, 4, brought},
    {"materials/pbrMetallicRoughness/metallicFactor", Number, share, 0, brought},
    {"materials/pbrMetallicRoughness/roughnessFactor", Number, share, 0, brought},
    {"materials/pbrMetallicRoughness/baseColorTexture", Texture},
    {"materials/pbrMetallicRoughness/metallicRoughnessTexture", Texture},
    {"materials/emissiveTexture", Texture},
    {"materials/extensions", Table},
    {"*/extensions/KHR_materials_emissive_strength", Table},
    {"*/extensions/KHR_materials_emissive_strength/emissiveStrength",
     Number,
     {0.0, 1e12},
     0,
     brought},
    {"*/extensions/KHR_materials_ior", Table},
    {"*/extensions/KHR_materials_ior/ior", Number, at_least_zero},
    {"*/extensions/KHR_materials_specular", Table},
    {"*/extensions/KHR_materials_specular/specularFactor", Number, share, 0, brought},
    {"*/extensions/KHR_materials_specular/specularColorFactor", Number, {0.0, 1e3}, 3, brought},
    {"*/extensions/KHR_materials_transmission", Table},
    {"*/extensions/KHR_materials_specular/specularTexture", Texture},
    {"*/extensions/KHR_materials_specular/specularColorTexture", Texture},
    {"*/extensions/KHR_materials_transmission/transmissionTexture", Texture},
    {"*/extensions/KHR_materials_transmission/transmissionFactor", Number, share, 0, brought},
    {"*/extensions/KHR_materials_volume", Table},
    {"*/extensions/KHR_materials_volume/thicknessFactor", Number, at_least_zero},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness", Table},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Number, share, 4, brought},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", Number, share, 3, brought},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Number, share, 0,
     brought},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture", Texture},
    {"*/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture", Texture},
    {"*/extensions/KHR_texture_transform", Table},
    {"*/extensions/KHR_texture_transform/offset", Number, length, 2},
    {"*/extensions/KHR_texture_transform/scale", Number, length, 2},
    {"*/extensions/KHR_texture_transform/rotation", Number, length},
    {"*/extensions/KHR_texture_transform/texCoord", Whole, whole},
    {"textures", Tables},
    {"textures/source", Whole, whole, 0, none},
    {"textures/sampler", Entry, whole, 0, none, "samplers"},
    {"samplers", Tables},
    {"samplers/wrapS", Whole, {}, 0, repeated, wraps},
    {"samplers/wrapT", Whole, {}, 0, repeated, wraps},
    {"samplers/magFilter", Whole, {}, 0, "9729 is taken", "9728, 9729"},
    {"images", Tables},
    {"images/bufferView", Whole, whole},
    {"cameras", Tables},
    {"cameras/type", Word, {}, 0, {}, "perspective, orthographic"},
    {"cameras/perspective", Table},
    {"cameras/perspective/yfov", Number, {0.0, base::pi, true, true}, 0, "the camera is left out"},
    {"cameras/perspective/aspectRatio", Number, {0.0, 32.0, true, true}, 0, "1 is taken"},
    {"extensions/KHR_lights_punctual", Table},
    {"extensions/KHR_lights_punctual/lights", Tables},
    {"extensions/KHR_lights_punctual/lights/color", Number, share, 3, brought},
    {"extensions/KHR_lights_punctual/lights/intensity", Number, light_strength, 0, brought},
    {"extensions/KHR_lights_punctual/lights/range", Number},
    {"extensions/KHR_lights_punctual/lights/spot", Table},
    {"extensions/KHR_lights_punctual/lights/spot/innerConeAngle", Number, half_angle, 0, brought},
    {"extensions/KHR_lights_punctual/lights/spot/outerConeAngle", Number, half_angle, 0, brought}};

// Rules for a table that references a texture.
constexpr GltfRule of_texture[] = {{"index", Whole, whole, 0, none}, {"texCoord", Whole, whole}};

}  // namespace gltf_rules
}  // namespace earthshine::scenes
