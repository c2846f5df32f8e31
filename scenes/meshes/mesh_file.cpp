#include "scenes/meshes/mesh_file.h"

#include "scenes/meshes/mesh_scan.h"
#include "scenes/text/read_file.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <bit>
#include <unordered_map>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

/// Not of a pipe, which assimp could not read a second time.
std::string read_bytes(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!error && !fs::is_regular_file(status) && !fs::is_directory(status))
        throw MeshError("is not a regular file");
    std::string bytes = read_file(file, "mesh");
    if (bytes.empty())
        throw MeshError("is empty");
    return bytes;
}

std::string extension_of(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

/// Before any post-processing, which would follow a bad index. True if there are polygons to cut.
bool check_import(const aiScene& scene, NotFinite not_finite) {
    bool polygons = false;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            if (not_finite == NotFinite::refuse && !is_finite(Vec3<float>{p.x, p.y, p.z}))
                throw MeshError(fmt::format("mesh {}, vertex {}: the coordinates ({}, {}, {}) are "
                                            "not finite floats",
                                            m, v, p.x, p.y, p.z));
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            polygons |= face.mNumIndices > 3;
            for (unsigned k = 0; k < face.mNumIndices; ++k)
                if (face.mIndices[k] >= mesh.mNumVertices)
                    throw MeshError(fmt::format(
                        "mesh {}, face {}: vertex index {} is out of range; "
                        "the mesh has {} vertices (counted from 0)",
                        m, f, static_cast<std::int32_t>(face.mIndices[k]), mesh.mNumVertices));
        }
    }
    return polygons;
}

/// Joins the meshes of a scene; vertices with equal coordinates (-0 equals 0) become one.
class Joiner {
  public:
    explicit Joiner(NotFinite not_finite) : not_finite_(not_finite) {}

    void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
        const aiMatrix4x4 transform = parent * node.mTransformation;
        for (unsigned m = 0; m < node.mNumMeshes; ++m)
            add(*scene.mMeshes[node.mMeshes[m]], transform);
        for (unsigned c = 0; c < node.mNumChildren; ++c)
            add(scene, *node.mChildren[c], transform);
    }
    TriangleMesh mesh;

  private:
    struct Hash {
        std::size_t operator()(Vec3<float> p) const {
            std::uint64_t hash = 0;
            for (int axis = 0; axis < 3; ++axis) { // + 0 turns -0 into 0
                hash ^= std::bit_cast<std::uint32_t>(p[axis] + 0.0f);
                hash *= 0x9e3779b97f4a7c15u;
                hash ^= hash >> 32;
            }
            return hash;
        }
    };

    void add(const aiMesh& part, const aiMatrix4x4& transform) {
        const bool moved = transform != aiMatrix4x4(); // IsIdentity() lets 0.01 pass
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) // a point or a line
                continue;
            std::array<std::uint32_t, 3> triangle;
            for (unsigned k = 0; k < 3; ++k) {
                const aiVector3D& p = part.mVertices[face.mIndices[k]];
                triangle[k] = index_of(moved ? transform * p : p);
            }
            mesh.triangles.push_back(triangle);
        }
    }

    std::uint32_t index_of(const aiVector3D& p) {
        const Vec3<float> vertex{p.x, p.y, p.z};
        const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
        if (!is_finite(vertex)) { // NaN equals nothing and would never be found again
            if (not_finite_ == NotFinite::refuse)
                throw MeshError("a node's transform takes a vertex beyond the range of a float");
            mesh.vertices.push_back(vertex);
            return next;
        }
        const auto [entry, is_new] = indices_.try_emplace(vertex, next);
        if (is_new)
            mesh.vertices.push_back(vertex);
        return entry->second;
    }

    NotFinite not_finite_;
    std::unordered_map<Vec3<float>, std::uint32_t, Hash> indices_;
};

/// The polygons cut, in assimp's memory. It gets to see no coordinate that is none.
const aiScene* cut_polygons(Assimp::Importer& importer, const aiScene& scene) {
    std::vector<std::pair<aiVector3D*, aiVector3D>> not_finite;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned v = 0; v < scene.mMeshes[m]->mNumVertices; ++v)
            if (aiVector3D& p = scene.mMeshes[m]->mVertices[v];
                !is_finite(Vec3<float>{p.x, p.y, p.z}))
                not_finite.emplace_back(&p, std::exchange(p, {}));
    const aiScene* const cut = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (cut)
        for (const auto& [place, p] : not_finite)
            *place = p;
    return cut;
}

TriangleMesh load(const fs::path& file, NotFinite not_finite) {
    const std::string bytes = read_bytes(file);
    const std::string extension = extension_of(file);
    std::string ply;
    if (extension == ".obj")
        ply = scan_obj(bytes, not_finite);
    else if (extension == ".ply")
        ply = scan_ply(bytes, not_finite);
    else if (extension == ".stl")
        scan_stl(bytes, not_finite);

    Assimp::Importer importer;
    const aiScene* scene = ply.empty()
                               ? importer.ReadFile(file.string(), 0)
                               : importer.ReadFileFromMemory(ply.data(), ply.size(), 0, "ply");
    if (scene && check_import(*scene, not_finite))
        scene = cut_polygons(importer, *scene);
    if (!scene)
        throw MeshError(importer.GetErrorString());
    Joiner joiner(not_finite);
    if (scene->mRootNode)
        joiner.add(*scene, *scene->mRootNode, aiMatrix4x4());
    if (joiner.mesh.triangles.empty())
        throw MeshError("holds no triangles");
    return std::move(joiner.mesh);
}

} // namespace

TriangleMesh load_mesh(const fs::path& file, NotFinite not_finite) {
    try {
        return load(file, not_finite);
    } catch (const MeshError& error) {
        throw std::runtime_error(fmt::format("mesh {}: {}", file.string(), error.what()));
    }
}

} // namespace boxwood
