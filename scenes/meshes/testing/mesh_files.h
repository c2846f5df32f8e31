#pragma once

#include "scenes/meshes/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood {

/// Writes mesh files into a folder of its own and loads them.
class MeshFile : public testing::Test {
  protected:
    MeshFile()
        : folder_(std::filesystem::temp_directory_path() /
                  ("boxwood_mesh_" + std::to_string(getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(folder_);
    }
    ~MeshFile() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    TriangleMesh load(const std::string& name, const std::string& bytes) const {
        return load_mesh(write(name, bytes));
    }
    /// The message, which always names the file.
    std::string error(const std::string& name, const std::string& bytes) const {
        return error(write(name, bytes));
    }
    static std::string error(const std::filesystem::path& file) {
        try {
            load_mesh(file);
        } catch (const std::runtime_error& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr(file.string()));
            return e.what();
        }
        return "no error";
    }

    std::filesystem::path folder_;
};

inline std::vector<Triangle<float>> soup(const TriangleMesh& mesh) {
    std::vector<Triangle<float>> triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        triangles.push_back(mesh.triangle(i));
    return triangles;
}

inline const Triangle<float> first{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
inline const Triangle<float> second{{0, 0, 0}, {0, 1, 0}, {0.25f, 0, 1}};

/// The bytes of a value.
template <class T> void append(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

} // namespace boxwood
