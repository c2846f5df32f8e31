#pragma once

#include "kernels/primitives/vec3.h"
#include "kernels/settings.h"
#include "scenes/moving/query.h"
#include "scenes/moving/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// An effect as a scene file lays it on a group of bodies.
struct EffectChoice {
    std::string name; ///< a name of `effects()`
    Settings settings;
    double share = 1; ///< of the group's bodies, drawn at random
};

/// Bodies that come from one generator and have the same effects.
struct BodyGroup {
    std::string generator; ///< a name of `scene_generators()`: a body per box, or one mesh
    std::size_t n = 0;     ///< of the generator; 0: `share` of the scene's n
    double share = 1;
    double overlaps = 10;      ///< as in SceneSpec
    std::string shape;         ///< mesh generator whose mesh fills each body's box; empty: the box
    std::size_t triangles = 0; ///< of that mesh
    double scale = 1;          ///< on what the generator makes
    Vec3<double> at{};         ///< where the generator's origin is put
    double margin = 0;         ///< scene units, by which its boxes are widened for pairs
    bool neighbours_ignored = false; ///< pairs of bodies i, i + 1 are expected and left out
    bool group_ignored = false;      ///< all pairs within the group are
    std::vector<EffectChoice> effects;
};

/// A scene: what is in it, what happens to it, and what is queried in each frame.
struct SceneFile {
    std::string name;    ///< of the file, without .toml
    std::string title;   ///< for people, without the number of bodies; empty: as the name
    std::string summary; ///< one line
    std::string source;  ///< who made it, or after what; empty: not said
    std::string licence; ///< SPDX; empty: not said
    std::size_t n = 1000;
    std::uint64_t seed = 1;
    std::size_t frames = 100;
    double frames_per_second = 30;
    std::string view = "xy"; ///< the plane in which it is drawn: xy, xz or yz
    std::vector<BodyGroup> groups;
    std::vector<SceneQuery> queries{{.name = "pairs"}}; ///< each name once
    /// Played instead of groups and effects, of which there are none then.
    std::shared_ptr<const Recording> recording{};
};

/// The query of this name, or nullptr.
const SceneQuery* query_named(const SceneFile& file, std::string_view name);

/// Throws std::invalid_argument, "file:line: what and how to fix it", for what is no scene.
SceneFile parse_scene_file(std::string_view text, const std::string& file);

/// The scenes that come with Boxwood: the files of scenes/built_in/, by name.
struct BuiltInScene {
    std::string_view name, text;
};
std::span<const BuiltInScene> built_in_scenes();

/// A built-in scene by its name, or a file by its path (which ends in .toml). Throws as
/// parse_scene_file; std::runtime_error if the file cannot be read.
SceneFile load_scene(const std::string& name_or_path);

} // namespace boxwood
