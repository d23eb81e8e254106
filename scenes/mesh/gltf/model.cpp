// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/model.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/input/input_file.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/json.h"
#include "scenes/mesh/gltf/materials.h"
#include "scenes/mesh/gltf/punctual.h"
#include "scenes/text/confined_path.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// Replaces tinygltf's file access: confines paths to the folders and limits sizes.
struct FileAccess {
  std::filesystem::path path;
  std::span<const std::filesystem::path> folders;
  std::vector<std::filesystem::path> found;
  std::string refused;  // why a path was refused; clearer than tinygltf's "file not found"

  [[nodiscard]] std::filesystem::path inside(const std::string& named) const {
    return confined_path(path.parent_path(), named, folders, base::Location{path.string()});
  }
};

// tinygltf prepends each of its search folders; ours are "" and ".".
std::string plain_name(const std::string& tried) {
  return tried.starts_with("./") ? tried.substr(2) : tried;
}

// Images are read when a material needs them; tinygltf accepts a missing image.
bool is_image(const std::string& name) {
  constexpr std::string_view endings[] = {".png",  ".jpg", ".jpeg", ".webp",
                                          ".ktx2", ".dds", ".basis"};
  return std::any_of(std::begin(endings), std::end(endings),
                     [&](std::string_view ending) { return name.ends_with(ending); });
}

bool file_exists(const std::string& tried, void* access) {
  auto* files = static_cast<FileAccess*>(access);
  try {
    files->found.push_back(files->inside(plain_name(tried)));
    return !is_image(tried);  // a missing file is reported when it is read
  } catch (const Error& error) {
    if (files->refused.empty() && !is_image(tried)) files->refused = error.what();
    return false;
  }
}

std::string expand_path(const std::string& name, void*) { return name; }

bool read_file(std::vector<unsigned char>* out, std::string* problem, const std::string& tried,
               void* access) {
  const auto* files = static_cast<FileAccess*>(access);
  try {
    const auto bytes = base::read_input_file(files->inside(plain_name(tried)), max_mesh_bytes,
                                             base::Location{files->path.string()});
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Error& error) {
    if (problem != nullptr) *problem = error.what();
    return false;
  }
}

bool write_no_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

// tinygltf 2.9 requires one more callback than 2.7, the file size, which it compares with a limit
// before reading. read_file checks the size here.
template <class Callbacks>
Callbacks file_callbacks(FileAccess& files) {
  Callbacks callbacks{};
  callbacks.FileExists = file_exists;
  callbacks.ExpandFilePath = expand_path;
  callbacks.ReadWholeFile = read_file;
  callbacks.WriteWholeFile = write_no_file;
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
    callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string&, void*) {
      *size = 0;
      return true;
    };
  }
  callbacks.user_data = &files;
  return callbacks;
}

// Stores the bytes of an embedded picture without decoding.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
  if (size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// tinygltf's messages have several lines.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.size() > 300) text = text.substr(0, 297) + "...";
  return text.empty() ? "tinygltf gives no reason" : text;
}

[[noreturn]] void refuse_unsound(const std::filesystem::path& path, const std::string& problem) {
  // The JSON parser's message contains names of the library and its exceptions.
  const std::size_t place = problem.find("at line "), end = problem.find(':', place);
  if (problem.find("parse_error") != std::string::npos && end != std::string::npos) {
    gltf_fail(path, fmt::format("not glTF: no JSON {}", problem.substr(place, end - place)),
              "a .gltf file is JSON text, a .glb file begins with the letters glTF");
  }
  gltf_fail(path, fmt::format("not a sound glTF file: {}", one_line(problem)));
}

constexpr std::string_view of_textures[] = {"KHR_texture_basisu", "EXT_texture_webp",
                                            "EXT_texture_avif"};
constexpr std::string_view known[] = {
    "KHR_mesh_quantization",      "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_volume",   "KHR_materials_unlit",
    "KHR_texture_transform",      "EXT_mesh_gpu_instancing"};
// Extensions that do not change the picture.
constexpr std::string_view harmless[] = {"KHR_materials_variants", "KHR_xmp", "KHR_xmp_json_ld",
                                         "KHR_animation_pointer", "MSFT_lod"};
constexpr std::string_view compressions[] = {"KHR_draco_mesh_compression",
                                             "EXT_meshopt_compression", "KHR_meshopt_compression"};

template <std::size_t N>
bool among(const std::string& name, const std::string_view (&names)[N]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// Commands of glTF-Transform (gltf-transform.dev, in the npm registry).
std::string remedy_for(const std::string& extension) {
  constexpr const char* run = "npx @gltf-transform/cli";
  if (among(extension, compressions)) {
    return fmt::format("Decompress it: {} copy IN.glb OUT.glb", run);
  }
  return "Export it without";
}

// Whether a vertex attribute is read, or is useless without an attribute that is read.
bool is_read(const std::string& name, const tinygltf::Primitive& primitive) {
  const auto has = [&](const char* other) { return primitive.attributes.count(other) > 0; };
  if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) {
    return has("JOINTS_0") && has("WEIGHTS_0");
  }
  return name == "POSITION" || name == "COLOR_0";
}

// Whether an attribute is a set of texture coordinates that the primitive's material reads.
bool is_coordinates(const std::string& name, const CoordinateSets& sets) {
  const auto is = [&](const std::optional<int>& set) {
    return set && name == fmt::format("TEXCOORD_{}", *set);
  };
  return is(sets.first) || is(sets.second);
}

// Counts unread contents, and those that would change the picture: vertex attributes, morph targets
// of other attributes, lights, cameras, animations, extensions.
void count_unused(GltfModel& model) {
  const tinygltf::Model& file = model.file;
  const auto count = [&](const std::string& what, std::size_t number) {
    if (number > 0) model.unused[what] += number;
  };
  const auto count_unsupported = [&](const std::string& what, std::size_t number) {
    count(what, number);
    if (number > 0) model.unsupported[what] += number;
  };
  for (std::size_t m = 0; m < file.meshes.size(); ++m) {
    for (std::size_t p = 0; p < file.meshes[m].primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = file.meshes[m].primitives[p];
      const std::uint32_t worn = model.worn[m][p];
      const CoordinateSets sets =
          worn < model.coordinates.size() ? model.coordinates[worn] : CoordinateSets{};
      for (const auto& [name, accessor] : primitive.attributes) {
        if (!is_read(name, primitive) && !is_coordinates(name, sets)) count(name, 1);
      }
      for (const auto& target : primitive.targets) {
        for (const auto& [name, accessor] : target) {
          if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") continue;
          count_unsupported("morph targets of " + name, 1);
        }
      }
    }
  }
  for (const tinygltf::Light& light : file.lights) {
    const bool is_lamp =
        light.type == "point" || light.type == "spot" || light.type == "directional";
    count(is_lamp ? lamps_of_file : unknown_lamps_of_file, 1);
  }
  count(cameras_of_file, file.cameras.size());
  count("animations", file.animations.size());
  for (const std::string& extension : file.extensionsUsed) {
    if (among(extension, known) || extension.starts_with("KHR_materials_")) continue;
    const bool is_seen = !among(extension, harmless) && !among(extension, of_textures) &&
                         !among(extension, compressions);
    is_seen ? count_unsupported(extension, 1) : count(extension, 1);
  }
  for (std::size_t m = 0; m < model.unsupported_of_material.size(); ++m) {
    if (model.variant_of[m] != no_index) continue;
    for (const std::string& what : model.unsupported_of_material[m]) count(what, 1);
  }
}

// Throws base::Error (Input) if a mesh exists in compressed form only. This occurs even in files
// that do not list the extension as required.
void check_compression(const tinygltf::Model& model, bool loaded,
                       const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& extension) {
    throw Error(
        Blame::Input, base::Location{path.string()},
        fmt::format("holds meshes compressed by the glTF extension {} alone", in_quotes(extension)),
        "meshes are read uncompressed", remedy_for(extension));
  };
  for (const std::string& extension : model.extensionsUsed) {
    // tinygltf rejects a buffer without data, which the uncompressed form would have.
    if (!loaded && among(extension, compressions)) refuse(extension);
  }
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const auto position = primitive.attributes.find("POSITION");
      if (primitive.extensions.count("KHR_draco_mesh_compression") == 0) continue;
      const auto number = position == primitive.attributes.end()
                              ? model.accessors.size()
                              : static_cast<std::size_t>(position->second);
      if (number >= model.accessors.size()) continue;
      const tinygltf::Accessor& accessor = model.accessors[number];
      if (accessor.bufferView < 0 && !accessor.sparse.isSparse)
        refuse("KHR_draco_mesh_compression");
    }
  }
  for (const tinygltf::BufferView& view : model.bufferViews) {
    const auto buffer = static_cast<std::size_t>(view.buffer);
    const bool has_data = buffer < model.buffers.size() && !model.buffers[buffer].data.empty();
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      if (view.extensions.count(extension) > 0 && !has_data) refuse(extension);
    }
  }
}

// Throws base::Error (Input) for a required extension that is not supported, and names a tool that
// removes it. Extensions of textures only are accepted.
void check_required_extensions(const tinygltf::Model& model, const std::filesystem::path& path) {
  for (const std::string& extension : model.extensionsRequired) {
    if (among(extension, of_textures) || among(extension, known)) continue;
    throw Error(Blame::Input, base::Location{path.string()},
                fmt::format("needs the glTF extension {}", in_quotes(extension)),
                "files that need none, or one of docs/models.md, are read", remedy_for(extension));
  }
}

GltfModel convert(tinygltf::Model&& source, FileAccess& files, std::vector<std::string> warnings) {
  GltfModel model;
  model.warnings = std::move(warnings);
  model.file = std::move(source);
  GltfTextures textures(
      model.file, files.path,
      [&](const std::string& uri) {
        files.found.push_back(files.inside(uri));
        return base::read_input_file(files.found.back(), max_mesh_bytes,
                                     base::Location{files.path.string()});
      },
      model.warnings);
  find_worn_materials(model, textures, files.path);
  count_unused(model);
  model.file.images.clear();
  read_punctual(model);
  return model;
}

}  // namespace

bool is_read_extension(const std::string& name) { return among(name, known); }

void gltf_fail(const std::filesystem::path& path, std::string_view found,
               std::string_view allowed) {
  throw Error(Blame::Input, base::Location{path.string()}, found, allowed);
}

GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                          std::span<const std::filesystem::path> folders) {
  std::vector<std::string> warnings;
  const std::optional<std::string> rewritten = check_gltf_text(bytes, path, warnings);
  if (rewritten) bytes = *rewritten;
  const bool binary = bytes.starts_with("glTF");
  FileAccess files{path, folders, {}, {}};

  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(file_callbacks<tinygltf::FsCallbacks>(files));
  loader.SetImageLoader(keep_image, nullptr);
  tinygltf::Model model;
  std::string problem, warning;
  bool loaded = false;
  try {
    const auto size = static_cast<unsigned>(bytes.size());  // at most max_mesh_bytes
    loaded = binary
                 ? loader.LoadBinaryFromMemory(&model, &problem, &warning,
                                               reinterpret_cast<const unsigned char*>(bytes.data()),
                                               size, "")
                 : loader.LoadASCIIFromString(&model, &problem, &warning, bytes.data(), size, "");
  } catch (const std::exception& error) {
    problem = error.what();
  }
  check_required_extensions(model, path);
  check_compression(model, loaded, path);
  if (!loaded && !files.refused.empty() && problem.find("File not found") != std::string::npos) {
    throw Error(Blame::Input, std::string_view(), files.refused);
  }
  if (!loaded) refuse_unsound(path, problem);
  GltfModel converted = convert(std::move(model), files, std::move(warnings));
  converted.files = std::move(files.found);
  return converted;
}

}  // namespace earthshine::scenes
