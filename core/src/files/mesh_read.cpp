#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <set>
#include <system_error>
#include <vector>

#include "files/mesh_builder.h"

namespace skinglow {
namespace {

/// Collects the scene's triangles into one mesh.
class SceneCollector {
  public:
    SceneCollector(const std::filesystem::path& path, const aiScene& scene, const std::string& group)
        : path_(path), scene_(scene), group_(group), builder_(path) {
        visit(*scene.mRootNode, aiMatrix4x4(), group.empty());
        if (!group.empty() && !found_group_) refuse_group();
    }
    TriangleMesh take() { return builder_.take(); }

  private:
    void visit(const aiNode& node, const aiMatrix4x4& parent, bool wanted) {
        const aiMatrix4x4 placement = parent * node.mTransformation;
        const bool all = wanted || node.mName.C_Str() == group_;
        names_.insert(node.mName.C_Str());
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            const aiMesh& part = *scene_.mMeshes[node.mMeshes[i]];
            names_.insert(part.mName.C_Str());
            if (!all && part.mName.C_Str() != group_) continue;
            found_group_ = true;
            add(part, placement);
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], placement, all);
    }

    void add(const aiMesh& part, const aiMatrix4x4& placement) {
        std::vector<std::uint32_t> joined(part.mNumVertices);
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D placed = placement * part.mVertices[i];
            joined[i] = builder_.add_vertex({placed.x, placed.y, placed.z});
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;  // a point or a line
            for (unsigned corner = 0; corner < 3; ++corner) {
                if (face.mIndices[corner] >= part.mNumVertices) {
                    refuse_file(path_, "has a face whose vertex does not exist", damaged_mesh_remedy,
                                "face " + std::to_string(i));
                }
            }
            builder_.add_triangle(joined[face.mIndices[0]], joined[face.mIndices[1]],
                                  joined[face.mIndices[2]]);
        }
    }

    [[noreturn]] void refuse_group() const {
        constexpr std::size_t most_named = 20;
        std::string known;
        std::size_t count = 0;
        for (const std::string& name : names_) {
            if (name.empty() || count++ >= most_named) continue;
            known += known.empty() ? name : ", " + name;
        }
        if (count > most_named) known += " and " + std::to_string(count - most_named) + " more";
        refuse_file(path_, "has no group \"" + group_ + "\"", "it has " + known);
    }

    const std::filesystem::path& path_;
    const aiScene& scene_;
    const std::string& group_;
    MeshBuilder builder_;
    std::set<std::string> names_;
    bool found_group_ = false;
};

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, const std::string& group) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "is not a file", "check the name");
    if (std::filesystem::file_size(path, error) > max_mesh_bytes) {
        refuse_file(path, "is larger than 2 GiB", "cut away what is not skin, or reduce the mesh");
    }
    if (small_extension(path) == ".ply") {
        if (!group.empty())
            refuse_file(path, "has no group \"" + group + "\"", "PLY files have none; read all of it");
        return read_ply(path);
    }
    Assimp::Importer importer;
    // Colors, texture coordinates, animation and the like are not asked for; positions and faces are.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                    aiComponent_COLORS | aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS |
                                    aiComponent_ANIMATIONS | aiComponent_TEXTURES | aiComponent_LIGHTS |
                                    aiComponent_CAMERAS | aiComponent_MATERIALS);
    const aiScene* scene =
        importer.ReadFile(path.string(), aiProcess_RemoveComponent | aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        refuse_file(path, "cannot be read as a mesh (" + std::string(importer.GetErrorString()) + ")",
                    "give a whole OBJ, PLY or GLB file");
    }
    if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0U)
        refuse_file(path, "is incomplete", damaged_mesh_remedy);
    return SceneCollector(path, *scene, group).take();
}

}  // namespace skinglow
