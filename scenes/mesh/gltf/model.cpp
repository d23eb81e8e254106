// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/model.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

#include "base/input/input_file.h"
#include "scenes/mesh/gltf/extras.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/materials.h"
#include "scenes/mesh/gltf/punctual.h"
#include "scenes/text/confined_path.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// tinygltf's JSON reader and the model's values recurse; a deep text ends the stack.
void check_json_depth(std::string_view json, const std::filesystem::path& path) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > max_json_depth) {
      gltf_fail(path, "the JSON is nested too deeply",
                fmt::format("allowed are {} levels", max_json_depth));
    }
  }
}

// The JSON chunk of a GLB, or the whole of a glTF.
std::string_view json_of(std::string_view bytes, bool binary, const std::filesystem::path& path) {
  if (!binary) return bytes;
  std::uint32_t length = 0;
  if (bytes.size() >= 20) std::memcpy(&length, bytes.data() + 12, sizeof length);
  if (bytes.size() < 20 || length > bytes.size() - 20) {
    gltf_fail(path, fmt::format("a GLB file of {} bytes is cut off", bytes.size()),
              "it holds a header of 20 bytes and what this announces");
  }
  return bytes.substr(20, length);
}

// What tinygltf's file access is replaced with: paths stay in the folders, sizes are bounded.
struct FileAccess {
  std::filesystem::path path;
  std::span<const std::filesystem::path> folders;
  std::vector<std::filesystem::path> found;
  std::string refused;  // why a path was, in words clearer than tinygltf's "file not found"

  [[nodiscard]] std::filesystem::path inside(const std::string& named) const {
    return confined_path(path.parent_path(), named, folders, base::Location{path.string()});
  }
};

// tinygltf tries a name behind each of its search folders; ours are "" and ".".
std::string plain_name(const std::string& tried) {
  return tried.starts_with("./") ? tried.substr(2) : tried;
}

// Read where a material needs them; tinygltf does without a missing image.
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

// tinygltf 2.9 takes one function more than 2.7, and all of them or none: the size of a file, which
// it compares with a limit before the reading. Ours is checked in read_file.
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

// Bytes of a picture inside the file or its buffers, kept as they are.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
  if (size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// tinygltf answers in several lines.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.size() > 300) text = text.substr(0, 297) + "...";
  return text.empty() ? "tinygltf gives no reason" : text;
}

GltfNumber number_type(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return GltfNumber::Int8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return GltfNumber::Uint8;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return GltfNumber::Int16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return GltfNumber::Uint16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return GltfNumber::Uint32;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return GltfNumber::Float32;
    default:
      return GltfNumber::Other;
  }
}

GltfAccessor convert(const tinygltf::Accessor& source) {
  GltfAccessor accessor{
      source.bufferView, source.byteOffset, source.count, number_type(source.componentType), 0,
      source.normalized, std::nullopt};
  if (source.type == TINYGLTF_TYPE_SCALAR) accessor.components = 1;
  if (source.type == TINYGLTF_TYPE_VEC2) accessor.components = 2;
  if (source.type == TINYGLTF_TYPE_VEC3) accessor.components = 3;
  if (source.sparse.isSparse) {
    const auto& indices = source.sparse.indices;
    const auto& values = source.sparse.values;
    accessor.sparse = GltfSparse{source.sparse.count,
                                 number_type(indices.componentType),
                                 indices.bufferView,
                                 values.bufferView,
                                 static_cast<std::int64_t>(indices.byteOffset),
                                 static_cast<std::int64_t>(values.byteOffset)};
  }
  return accessor;
}

GltfMesh convert(const tinygltf::Mesh& source) {
  GltfMesh mesh{source.name, {}};
  for (const tinygltf::Primitive& primitive : source.primitives) {
    GltfPrimitive converted{GltfMode::Other, -1, primitive.indices, primitive.material, -1, {}};
    if (primitive.mode == -1 || primitive.mode == TINYGLTF_MODE_TRIANGLES) {
      converted.mode = GltfMode::Triangles;
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) converted.mode = GltfMode::Strip;
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN) converted.mode = GltfMode::Fan;
    const auto position = primitive.attributes.find("POSITION");
    if (position != primitive.attributes.end()) converted.position = position->second;
    const auto normal = primitive.attributes.find("NORMAL");
    if (normal != primitive.attributes.end()) converted.normal = normal->second;
    for (const auto& [name, accessor] : primitive.attributes) {
      constexpr std::string_view coordinates = "TEXCOORD_";
      if (!name.starts_with(coordinates)) continue;
      const char set = name.size() == coordinates.size() + 1 ? name.back() : 'x';
      if (set >= '0' && set <= '9') converted.coordinates[set - '0'] = accessor;
    }
    mesh.primitives.push_back(converted);
  }
  return mesh;
}

GltfModel convert(tinygltf::Model&& source, FileAccess& files) {
  GltfModel model;
  model.unused = unused_of(source);
  GltfTextures textures(
      source, files.path,
      [&](const std::string& uri) {
        files.found.push_back(files.inside(uri));
        return base::read_input_file(files.found.back(), max_mesh_bytes,
                                     base::Location{files.path.string()});
      },
      model.warnings);
  for (auto& buffer : source.buffers) model.buffers.push_back(std::move(buffer.data));
  for (const auto& view : source.bufferViews) {
    model.views.push_back({view.buffer, view.byteOffset, view.byteLength, view.byteStride});
  }
  for (const auto& accessor : source.accessors) model.accessors.push_back(convert(accessor));
  for (const auto& mesh : source.meshes) model.meshes.push_back(convert(mesh));
  for (const auto& node : source.nodes) {
    model.nodes.push_back({node.name, node.mesh, -1, -1, node.children, node.matrix,
                           node.translation, node.rotation, node.scale});
  }
  for (const auto& scene : source.scenes) model.scenes.push_back(scene.nodes);
  model.default_scene = source.defaultScene;
  for (const auto& material : source.materials) {
    GltfMaterial made = phong_material(material, textures, model.unused);
    model.materials.push_back(std::move(made.material));
    model.coordinates.push_back(made.coordinates);
  }
  read_punctual(source, model);
  return model;
}

}  // namespace

void gltf_fail(const std::filesystem::path& path, std::string_view found,
               std::string_view allowed) {
  throw Error(Blame::Input, base::Location{path.string()}, found, allowed);
}

GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                          std::span<const std::filesystem::path> folders) {
  const bool binary = bytes.starts_with("glTF");
  const std::string_view json = json_of(bytes, binary, path);
  check_json_depth(json, path);
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
  if (!loaded && !files.refused.empty() && problem.find("File not found") != std::string::npos) {
    throw Error(Blame::Input, std::string_view(), files.refused);
  }
  check_required_extensions(model, path);
  if (!loaded) gltf_fail(path, fmt::format("not a sound glTF file: {}", one_line(problem)));
  GltfModel converted = convert(std::move(model), files);
  converted.files = std::move(files.found);
  return converted;
}

}  // namespace earthshine::scenes
